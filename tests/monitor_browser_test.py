#!/usr/bin/env python3
"""The page of `tassilo monitor` in a real browser: the steps of webui/e2e/monitor.mjs with ten robots of several processes on the bus, and with a log.

usage: tests/monitor_browser_test.py PROGRAM PAGES SCREENSHOTS TEAM_TRAFFIC [unittest arguments]
"""
import re
import shutil
import subprocess
import sys
import time
import unittest

from monitor_test import Watched
from program import ROOT, do_steps, main

TIMEOUT_S = 240  # of all steps
HEARD_S = 15     # that can be looked back at, before the steps begin


class Browser(Watched):
    pages = screenshots = None

    def setUp(self):
        if shutil.which("node") is None or not (ROOT / "webui/node_modules").exists():
            self.skipTest("node or the packages of webui/ are not installed; tools/install_deps.sh installs them")
        super().setUp()

    def browse(self, *options):
        """What the steps say."""
        command = ["node", ROOT / "webui/e2e/monitor.mjs", *options, "--screenshots", self.screenshots, "--url", f"http://127.0.0.1:{self.port}/"]
        print(do_steps(self, command, TIMEOUT_S))

    def heard(self):
        monitor = self.ask("/api/monitor")
        return monitor["end"] is not None and monitor["end"] - monitor["begin"] > HEARD_S and len(self.robots()) >= 10

    def test_the_team_is_watched(self):
        self.live("--pages", self.pages, "--record", "watched.mcap")
        for robots in ("1,2,3,4", "5,6,7", "8,9,10"):
            self.talk(robots)
        self.wait_for("the robots", self.heard)
        self.browse("--robots", "10")
        # Beside ten that are well: one of whom there are two, one of another time, one that sends garbage.
        self.talk("3,11", "--clock-ahead", "600")
        self.talk("12", "--garbage")
        self.wait_for("troubles", lambda: all(self.robots().get(robot, {}).get("troubles") for robot in (3, 11, 12)))
        time.sleep(1)
        self.browse("--robots", "12", "--only", "troubles")
        self.end()
        self.end_all()
        self.monitor("watched.mcap", "--pages", self.pages)
        self.browse("--robots", "10")

    def test_a_match_is_watched(self):
        self.process = self.start("demo", "--fps", "10", "--port", "0", "--domain", self.domain, "--pages", self.pages, stdout=subprocess.PIPE, text=True)
        self.running.append(self.process)
        self.port = next(found[1] for line in self.process.stdout if (found := re.search(r"http://127\.0\.0\.1:(\d+)/", line)))
        self.browse("--robots", "4", "--only", "match")


if __name__ == "__main__":
    Browser.pages, Browser.screenshots, Browser.traffic = sys.argv[2:5]
    del sys.argv[2:5]
    main()
