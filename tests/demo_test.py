#!/usr/bin/env python3
"""`tassilo demo`: a simulated match, headless against its truth, in the dark, and shown by the monitor.

usage: tests/demo_test.py PROGRAM [unittest arguments]
"""
import json
import re
import signal
import subprocess
import sys
import time
import unittest
import urllib.request

from bus_peer import free_domain
from program import ROOT, TIMEOUT_S, ProgramTest, main

sys.path.insert(0, str(ROOT / "tools"))
from match_score import rows, words_between_robots


class Demo(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.short = ("demo", "--headless", "--report", "--robots", "2", "--fps", "15")

    def test_what_is_seen_and_known_is_near_the_truth(self):
        told = self.succeeds("demo", "--headless", "--radios", "--robots", "3", "--fps", "15", "--duration", "10").out
        report = rows(told)
        self.assertGreater(report["pose"][0], 150, told)
        self.assertLess(report["pose"][1], 6, told)
        self.assertLess(report["ball, as each robot sees it"][1], 10, told)
        for who in ("surest robot by itself", "robots that see it, and hear", "robots that only hear", "bench"):
            moments, median, _, known = report[who][:4]
            self.assertGreater(moments, 20, told)
            self.assertLess(median, 15, told)
            self.assertGreater(known, 90, told)
        self.assertEqual(len([row for row in report if re.match(r"bench, \d+ % lost, \d+ ms late", row)]), 16, told)
        # What is lost and late can only be worse, by more than luck.
        self.assertLess(report["bench, 0 % lost, 0 ms late"][1], report["bench, 60 % lost, 500 ms late"][1], told)

    def test_the_same_seed_is_the_same_match(self):
        first, second, other = (re.sub(r"played in.*", "", self.succeeds(*self.short, "--duration", "2", "--seed", seed).out) for seed in "778")
        self.assertEqual(first, second)
        self.assertNotEqual(first, other)

    def test_in_the_dark_nothing_is_seen(self):
        told = self.succeeds(*self.short, "--duration", "3", "--dark").out
        self.assertRegex(told, r"ball, as each robot sees it +never")
        self.assertRegex(told, r"cyan 0 : \d+ magenta")

    def test_with_unrest_every_message_is_accounted_for(self):
        told = self.succeeds(*self.short, "--duration", "20", "--unrest", "--loss", ".2", "--delay", ".1").out
        words = words_between_robots(told)
        self.assertEqual(words["told"], sum(words.values()) - words["told"], told)
        for what in ("lost", "refused", "taken"):
            self.assertGreater(words[what], 0, told)
        self.assertRegex(told, r"robots left [1-9]\d* times, came back [1-9]\d* times")

    def test_the_monitor_shows_it(self):
        demo = self.start("demo", "--robots", "2", "--fps", "10", "--port", "0", "--domain", free_domain(), "--own-goal", "blue",
                          stdout=subprocess.PIPE, text=True)
        try:
            port = next(found[1] for line in demo.stdout if (found := re.search(r"http://127\.0\.0\.1:(\d+)/", line)))

            def ask(path):
                with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=TIMEOUT_S) as answer:
                    return json.load(answer)
            end = time.monotonic() + TIMEOUT_S / 2
            robots = []
            while not (len(robots) == 2 and all(robot["scene"]["pose"] and robot["role"] for robot in robots)):
                self.assertLess(time.monotonic(), end, robots)
                time.sleep(.2)
                now = ask("/api/monitor")["end"]
                robots = ask(f"/api/monitor/at?t={now}")["robots"] if now else []
            self.assertEqual({robot["role"] for robot in robots} - {"goalkeeper", "striker", "defender"}, set())
            self.assertGreater(robots[0]["scene"]["pose"]["x"], 0, "the goalkeeper defends the blue goal")
            demo.send_signal(signal.SIGINT)
            self.assertEqual(demo.wait(TIMEOUT_S), 0)
        finally:
            demo.kill()
            demo.wait()
            demo.stdout.close()

    def test_fields_without_goals_are_played_on(self):
        told = self.succeeds("demo", "--field", "ssl", *self.short[1:], "--duration", "2").out
        self.assertGreater(rows(told)["pose"][0], 20, told)
        self.fails("demo", "--field", "ssl", "--own-goal", "blue", "--duration", "1", says=["--own-goal", "blue"])

    def test_wrong_usage_is_refused(self):
        self.refuses("demo", "--headless", says="--duration")
        self.refuses("demo", "--robots", "9", says="--robots")
        self.refuses("demo", "--opponents", "2", says="--opponents")
        self.refuses("demo", "--headless", "--duration", "1", "--speed", "2", says="--speed")
        self.fails("demo", "--field", "moon", "--duration", "1", says="moon")


if __name__ == "__main__":
    main()
