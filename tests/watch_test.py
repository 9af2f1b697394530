#!/usr/bin/env python3
"""Configuration exchanged while `tassilo run --watch` works: the robot file and what it names are edited between frames that this test feeds.

usage: tests/watch_test.py PROGRAM [unittest arguments]
"""
import json
import os
import pathlib
import select
import shutil
import subprocess
import time
import unittest

from program import DATA, TIMEOUT_S, ProgramTest, main, raw_bytes, without_timing

FRAMES = 40
FRAME_BYTES = 384 * 172 * 2
RECORDING = DATA / "d01_approach"
PLUGIN = os.environ.get("TASSILO_PLUGIN")


class Live:
    """A run that sees one frame after the other, as a camera would bring them."""

    def __init__(self, test, *arguments):
        self.test, self.fed, self.told = test, 0, ""
        self.process = test.start("run", "--watch", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", "-", "--format", "yuv422p",
                                  "--size", "384x172", "--range", "limited", "--fps", "20", "--odometry", RECORDING / "odometry.jsonl",
                                  "--output", "live.jsonl", *arguments,
                                  stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        test.addCleanup(self.stop)

    def feed(self):
        k = self.fed % FRAMES
        self.process.stdin.write(self.test.frames[k * FRAME_BYTES:(k + 1) * FRAME_BYTES])
        self.process.stdin.flush()
        self.fed += 1

    def until_told(self, *words):
        """Feeds frames until the program says all of `words` in one line; returns that line."""
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:
            self.feed()
            wait_until = time.monotonic() + .05
            while (left := wait_until - time.monotonic()) > 0:
                if select.select([self.process.stdout], [], [], left)[0]:
                    data = os.read(self.process.stdout.fileno(), 65536).decode()
                    self.test.assertTrue(data, "the program ended")
                    self.told += data
            for line in self.told.splitlines():
                if all(word in line for word in words):
                    self.told = ""
                    return line
        self.test.fail(f"not told in {TIMEOUT_S} s: {words}; but: {self.told}")

    def finish(self):
        out, err = self.process.communicate(timeout=TIMEOUT_S)
        self.test.assertEqual(self.process.returncode, 0, err.decode())
        self.test.assertEqual(err.decode(), "")
        return out.decode()

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()


class Watch(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.frames = raw_bytes(RECORDING / "video.mkv", "yuv422p", FRAMES)
        shutil.copy(RECORDING / "camera.yaml", cls.folder / "camera.yaml")

    def robot(self, vision, field="msl98"):
        """Written at once, as editors do."""
        (self.folder / "robot.new").write_text(f"camera: camera.yaml\nfield: {field}\nvision: {{{vision}}}\n")
        os.replace(self.folder / "robot.new", self.folder / "robot.yaml")

    def test_changes_are_taken_over_between_frames_and_bad_ones_refused(self):
        self.robot("localization: model")
        live = Live(self)
        for _ in range(5):
            live.feed()
        self.robot("localization: boundary")
        live.until_told("taken over")
        boundary_from = live.fed
        live.feed()

        self.robot("localization: boundary,\n  ball_max: 1000")
        told = live.until_told("refused", "the former one goes on")
        for word in ("robot.yaml:4:", "ball_max", "1000", "must be"):
            self.assertIn(word, told)
        bad_until = live.fed
        live.feed()

        # Half a file is not taken for a change; and what was refused once is told once.
        self.robot("localization: model, ball_max: 1")
        live.until_told("taken over")
        live.feed()
        out = live.finish()
        self.assertNotIn("refused", out)

        scenes = self.scenes("live.jsonl")
        self.assertEqual([scene["frame"] for scene in scenes], list(range(live.fed)), "every frame was seen")
        changes = [(scene["frame"], scene["why"]["configuration"]) for scene in scenes if "configuration" in scene["why"]]
        self.assertEqual([text.split(",")[0].split(" was")[0] for _, text in changes], ["a changed one", "refused", "a changed one"])
        first, _, last = (frame for frame, _ in changes)
        for scene in scenes:
            kinds = ("two_lines", "one_line", "predicted") if first <= scene["frame"] < last else ("model", "predicted")
            self.assertIn((scene["pose"] or {"kind": "predicted"})["kind"], kinds, scene["frame"])
        self.assertIn("boundary", scenes[boundary_from]["timing_ms"])
        self.assertIn("boundary", scenes[bad_until]["timing_ms"], "the former configuration goes on")

    def test_files_that_the_robot_file_names_are_watched(self):
        self.robot("localization: model")
        live = Live(self)
        live.feed()
        camera = (self.folder / "camera.yaml").read_text()
        (self.folder / "camera.yaml").write_text(camera.replace("image_width: 384", "image_width: 640"))
        told = live.until_told("refused")
        for word in ("384x172", "640x172"):
            self.assertIn(word, told)
        (self.folder / "camera.yaml").write_text(camera)
        live.until_told("taken over")
        # A file that is missing for a while: another one is tried until it is there.
        self.robot("localization: model", field="own.yaml")
        self.assertIn("own.yaml", live.until_told("refused"))
        self.write("own.yaml", "{length: 8.22, width: 4.575}\n")
        live.until_told("taken over")
        self.robot("localization: boundary", field="own.yaml")
        self.assertIn("walls", live.until_told("refused"))
        live.finish()

    @unittest.skipUnless(PLUGIN, "TASSILO_PLUGIN, the plug-in for tests, is not set")
    def test_plugins_come_and_are_exchanged(self):
        def put(plugin):
            """As linkers do: another file of the same name."""
            shutil.copy(plugin, self.folder / "new.so")
            os.replace(self.folder / "new.so", self.folder / "blind.so")

        put(PLUGIN)
        self.robot("ball_max: 3")
        live = Live(self)
        live.feed()
        self.robot("balls: blind")
        self.assertIn("must be sphere", live.until_told("refused"))
        (self.folder / "robot.yaml").write_text("camera: camera.yaml\nfield: msl98\nplugins: [blind.so]\nvision: {balls: blind}\n")
        live.until_told("taken over")
        blind_from = live.fed
        live.feed()
        put(pathlib.Path(PLUGIN).with_name("test_plugin_of_another_version.so"))
        self.assertIn("was built for 'tassilo 0.0.1", live.until_told("refused"))
        put(PLUGIN)
        live.until_told("taken over")
        blind_until = live.fed
        self.robot("ball_max: 3")
        live.until_told("taken over")
        live.feed()
        live.finish()
        scenes = self.scenes("live.jsonl")
        self.assertEqual({scene["why"].get("balls") for scene in scenes[blind_from:blind_until]}, {"blind"})
        self.assertTrue(scenes[0]["balls"] and scenes[-1]["balls"])

    def test_nothing_changes_without_a_change(self):
        self.robot("localization: model")
        live = Live(self, "--quiet")
        for _ in range(FRAMES):
            live.feed()
        self.assertEqual(live.finish(), "")
        self.succeeds("run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry",
                      RECORDING / "odometry.jsonl", "--output", "plain.jsonl", "--quiet")
        self.assertEqual([without_timing(scene) for scene in self.scenes("live.jsonl")],
                         [without_timing(scene) for scene in self.scenes("plain.jsonl")])

    def test_needs_a_robot_file(self):
        self.refuses("run", "--watch", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", says=("--watch", "--robot"))


if __name__ == "__main__":
    main()
