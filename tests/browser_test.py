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

    def setUp(self):
        if shutil.which("node") is None or not (ROOT / "webui/node_modules").exists():
            self.skipTest("node or the packages of webui/ are not installed; tools/install_deps.sh installs them")

    def browse(self, steps, recording, *arguments):
        """Does webui/e2e/STEPS in a browser with the program, which sees a recording; what the steps say."""
        command = ["node", ROOT / "webui/e2e" / steps, "--screenshots", self.screenshots, "--", self.program, "serve", "--robot", "robot.yaml",
                   "--source", recording / "video.mkv", "--odometry", recording / "odometry.jsonl", "--port", "0", "--pages", self.pages, *arguments]
        done = subprocess.run([str(part) for part in command], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT_S,
                              text=True)
        if done.returncode == 77:
            self.skipTest(done.stdout.strip())
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("all steps passed", done.stdout)
        return done.stdout

    def test_colors_are_trained_in_the_browser(self):
        recording = DATA / "d06_vga"
        shutil.copytree(DATA / "train_vga", self.folder / "train_vga")
        self.succeeds("train", "colors", "train_vga/samples.yaml", "-o", "vga.yaml", "-q")
        self.write("robot.yaml", f"{{camera: {recording / 'camera.yaml'}, colors: vga.yaml, field: msl98}}\n")
        print(self.browse("colors.mjs", recording, "--samples", "train_vga/samples.yaml"))
        # What was saved there, the command line trains alike.
        kept = [line for line in (self.folder / "vga.yaml").read_text().splitlines() if line.startswith("table:")]
        self.assertEqual(len(kept), 1)
        self.succeeds("train", "colors", "train_vga/samples.yaml", "-o", "again.yaml", "-q")

    def test_pages_show_and_change_what_the_program_does(self):
        self.write("robot.yaml", f"{{camera: {RECORDING / 'camera.yaml'}, field: msl98}}\n")
        self.browse("browser.mjs", RECORDING, "--colors", "div.yaml")
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
