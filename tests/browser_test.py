#!/usr/bin/env python3
"""The pages of `tassilo serve` in a real browser: webui/e2e/browser.mjs against the program on a shipped recording.

usage: tests/browser_test.py PROGRAM PAGES SCREENSHOTS [unittest arguments]
"""
import shutil
import subprocess
import sys
import unittest

from program import DATA, ROOT, ProgramTest, main, without_timing

RECORDING = DATA / "d01_approach"
TIMEOUT_S = 240  # of all steps


class Browser(ProgramTest):
    pages = screenshots = None

    def test_pages_show_and_change_what_the_program_does(self):
        if shutil.which("node") is None or not (ROOT / "webui/node_modules").exists():
            self.skipTest("node or the packages of webui/ are not installed; tools/install_deps.sh installs them")
        self.write("robot.yaml", f"{{camera: {RECORDING / 'camera.yaml'}, field: msl98}}\n")
        command = ["node", ROOT / "webui/e2e/browser.mjs", "--screenshots", self.screenshots, "--", self.program, "serve", "--robot", "robot.yaml",
                   "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry", RECORDING / "odometry.jsonl", "--port", "0",
                   "--pages", self.pages]
        done = subprocess.run([str(part) for part in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT_S,
                              text=True)
        if done.returncode == 77:
            self.skipTest(done.stdout.strip())
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("all steps passed", done.stdout)
        # What was recorded there is seen again.
        parts = list((self.folder / "recordings").iterdir())
        self.assertTrue(parts)
        for part in parts:
            self.succeeds("run", "--robot", part / "robot.yaml", "--source", part / "video.mkv", "--odometry", part / "odometry.jsonl", "--output",
                          "again.jsonl", "--quiet")
            self.assertEqual([without_timing(scene) for scene in self.scenes("again.jsonl")],
                             [without_timing(scene) for scene in self.scenes(part / "scenes.jsonl")])


if __name__ == "__main__":
    Browser.pages, Browser.screenshots = sys.argv[2:4]
    del sys.argv[2:4]
    main()
