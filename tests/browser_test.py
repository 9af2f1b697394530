#!/usr/bin/env python3
"""The pages of `tassilo serve` in a real browser: the steps of webui/e2e against the program on shipped recordings and calibration images.

usage: tests/browser_test.py PROGRAM PAGES SCREENSHOTS [unittest arguments]
"""
import re
import shutil
import sys
import unittest

from program import DATA, ROOT, SHARED, ProgramTest, do_steps, main, without_timing

RECORDING = DATA / "d01_approach"
TIMEOUT_S = 240  # of all steps


def seen(recording):
    return "--source", recording / "video.mkv", "--odometry", recording / "odometry.jsonl"


class Browser(ProgramTest):
    pages = screenshots = None

    def setUp(self):
        if shutil.which("node") is None or not (ROOT / "webui/node_modules").exists():
            self.skipTest("node or the packages of webui/ are not installed; tools/install_deps.sh installs them")

    def browse(self, steps, *arguments, options=()):
        """Does webui/e2e/STEPS in a browser with the program; what the steps say."""
        command = ["node", ROOT / "webui/e2e" / steps, *options, "--screenshots", self.screenshots, "--", self.program, "serve", "--robot", "robot.yaml",
                   "--port", "0", "--pages", self.pages, *arguments]
        return do_steps(self, command, TIMEOUT_S)

    def test_colors_are_trained_in_the_browser(self):
        recording = DATA / "d06_vga"
        shutil.copytree(DATA / "train_vga", self.folder / "train_vga")
        self.succeeds("train", "colors", "train_vga/samples.yaml", "-o", "vga.yaml", "-q")
        self.write("robot.yaml", f"{{camera: {recording / 'camera.yaml'}, colors: vga.yaml, field: msl98}}\n")
        print(self.browse("colors.mjs", *seen(recording), "--samples", "train_vga/samples.yaml"))
        # What was saved there can be trained from the command line, too.
        self.succeeds("train", "colors", "train_vga/samples.yaml", "-o", "again.yaml", "-q")

    def test_a_camera_is_calibrated_in_the_browser(self):
        calibration = SHARED / "data/msl98/calibration"
        if not calibration.exists():
            self.skipTest(f"{calibration} is not there: ../shared")
        # All but the focal length as it is; that is to be found.
        camera = (calibration / "div.yaml").read_text()
        true = float(re.search(r"data: \[([\d.]+),", camera)[1])
        self.write("camera.yaml", re.sub(r"(camera_matrix:.*?data: \[)[\d.]+", rf"\g<1>{true + 20}", camera, flags=re.S))
        self.write("robot.yaml", "{camera: camera.yaml, field: msl98}\n")
        self.browse("calibration.mjs", "--colors", "div.yaml", "--source", calibration / "div", "--fps", "5",
                    options=("--target", "checker:9x6:0.04", "--model", "division", "--views", "8", "--patience", "60"))
        found = float(re.search(r"data: \[([\d.]+),", (self.folder / "camera.yaml").read_text())[1])
        self.assertLess(abs(found - true), .005 * true)
        self.assertIn("camera_pose_in_robot", (self.folder / "camera.yaml").read_text())

    def test_pages_show_and_change_what_the_program_does(self):
        self.write("robot.yaml", f"{{camera: {RECORDING / 'camera.yaml'}, field: msl98}}\n")
        self.browse("browser.mjs", *seen(RECORDING), "--colors", "div.yaml")
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
