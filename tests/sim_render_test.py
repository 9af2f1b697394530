#!/usr/bin/env python3
"""`tassilo sim render`: recordings are complete, the same for the same seed, never overwritten, and are seen.

usage: tests/sim_render_test.py PROGRAM [--figures | unittest arguments]     --figures prints how well they are seen
"""
import json
import math
import subprocess
import sys
import unittest

from program import DATA, SHARED, ProgramTest, main, png_size, raw_bytes

CAMERA = DATA / "d01_approach/camera.yaml"
FILES = ["camera.yaml", "gt.jsonl", "labels", "meta.json", "odometry.jsonl", "robot.yaml", "samples.yaml", "video.mkv"]


def read_lines(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


class Render(ProgramTest):
    @classmethod
    def render(cls, folder, *arguments):
        """A recording, and its folder."""
        result = cls.tell("sim", "render", "--output", folder, "--camera", CAMERA, *arguments)
        if result.code != 0:
            raise RuntimeError(str(result))
        return cls.folder / folder

    def test_a_recording_is_complete(self):
        folder = self.render("complete", "--field", "msl98", "--seconds", .2, "--fps", 30, "--seed", 3, "--rays", 1)
        self.assertTrue(set(FILES) <= {path.name for path in folder.iterdir()}, list(folder.iterdir()))
        truth, odometry = read_lines(folder / "gt.jsonl"), read_lines(folder / "odometry.jsonl")
        self.assertEqual([line["frame"] for line in truth], list(range(6)))
        self.assertEqual([line["t"] for line in truth], [.0, .033, .067, .1, .133, .167])
        self.assertEqual([line["t"] for line in odometry], [line["t"] for line in truth])
        meta = json.loads((folder / "meta.json").read_text())
        self.assertEqual((meta["frames"], meta["image_size"], meta["field"]["goal_width"]), (6, [384, 172], 1.5))
        for frame in range(6):
            self.assertEqual(png_size((folder / f"labels/{frame:04}.png").read_bytes()), (384, 172))
        # The form is that of the recordings: the same keys, everywhere.
        real = read_lines(DATA / "d01_approach/gt.jsonl")[0]

        def shape(value):
            return {key: shape(item) for key, item in value.items()} if isinstance(value, dict) else None

        self.assertEqual(shape(truth[0]), shape(real))
        self.assertEqual(set(truth[0]["robots"][0]), set(real["robots"][0]))
        # Motion adds up to where the robot is.
        x, y, theta = (truth[0]["robot"][name] for name in ("x", "y", "theta"))
        for line in truth[1:]:
            motion = line["odom_true"]
            x += math.cos(theta) * motion["dx"] - math.sin(theta) * motion["dy"]
            y += math.sin(theta) * motion["dx"] + math.cos(theta) * motion["dy"]
            theta += motion["dtheta"]
        self.assertAlmostEqual(x, truth[-1]["robot"]["x"], places=4)
        self.assertAlmostEqual(y, truth[-1]["robot"]["y"], places=4)

    def test_the_same_seed_gives_the_same_bytes(self):
        one, two, other = (self.render(name, "--field", "msl98", "--seconds", .1, "--rays", 1, "--seed", seed)
                           for name, seed in (("one", 5), ("two", 5), ("other", 6)))
        for name in FILES:
            if name not in ("labels", "meta.json", "video.mkv"):  # the container numbers itself by chance
                self.assertEqual((one / name).read_bytes(), (two / name).read_bytes(), name)
        pixels = [raw_bytes(folder / "video.mkv", "yuv422p", 2) for folder in (one, two, other)]
        self.assertEqual(len(pixels[0]), 2 * 2 * 384 * 172)
        self.assertEqual(pixels[0], pixels[1])
        self.assertNotEqual(pixels[0], pixels[2])
        self.assertNotEqual((one / "gt.jsonl").read_bytes(), (other / "gt.jsonl").read_bytes())

    def test_a_folder_is_never_overwritten(self):
        kept = self.folder / "kept"
        kept.mkdir()
        (kept / "video.mkv").write_text("precious")
        self.fails("sim", "render", "--output", "kept", "--camera", CAMERA, "--field", "msl98", says=["kept", "exists already"])
        self.assertEqual([path.name for path in kept.iterdir()], ["video.mkv"])
        self.assertEqual((kept / "video.mkv").read_text(), "precious")

    def test_what_is_wrong_is_said(self):
        self.fails("sim", "render", "--output", "a", "--camera", CAMERA, says="--field")
        self.fails("sim", "render", "--output", "a", "--camera", CAMERA, "--field", "no_such_field", says="msl98")
        self.fails("sim", "render", "--output", "a", "--camera", CAMERA, "--field", "msl98", "--size", "640", says=["--size", "640x480"])
        self.refuses("sim", "render", "--output", "a", "--field", "msl98", says="--camera")
        self.refuses("sim", "render", "--output", "a", "--camera", CAMERA, "--field", "msl98", "--difficulty", "evil", says="--difficulty")
        text = CAMERA.read_text().split("camera_pose_in_robot")[0]
        self.write("unmounted.yaml", text)
        self.fails("sim", "render", "--output", "a", "--camera", "unmounted.yaml", "--field", "msl98", says=["unmounted.yaml", "camera_pose_in_robot"])
        self.assertFalse((self.folder / "a").exists())

    def test_another_size_shows_the_same(self):
        small = self.render("small", "--field", "rcj_soccer", "--seconds", .05, "--size", "192x86", "--rays", 1, "--seed", 2, "--others", 1)
        large = self.render("large", "--field", "rcj_soccer", "--seconds", .05, "--rays", 1, "--seed", 2, "--others", 1)
        self.assertEqual(png_size((small / "labels/0000.png").read_bytes()), (192, 86))
        a, b = (read_lines(folder / "gt.jsonl")[0]["ball"]["center_px"] for folder in (small, large))
        if a and b:
            self.assertAlmostEqual(2 * (a[0] + .5), b[0] + .5, delta=.02)
            self.assertAlmostEqual(2 * (a[1] + .5), b[1] + .5, delta=.02)

    def test_a_robot_file_gives_camera_field_and_team_but_no_start(self):
        self.write("robot.yaml", f"robot: {{id: 4, team: magenta}}\ncamera: {CAMERA}\nfield: msl98\nstart_pose: {{x: 1, y: 0, theta: 0}}\n")
        result = self.succeeds("sim", "render", "--output", "by_robot", "--robot", "robot.yaml", "--seconds", .05, "--rays", 1, "--quiet")
        self.assertEqual(result.out, "")
        text = (self.folder / "by_robot/robot.yaml").read_text()
        self.assertIn("{id: 4, team: magenta}", text)
        self.assertIn("camera: camera.yaml", text)
        self.assertNotIn("start_pose", text)
        self.succeeds("sim", "render", "--output", "with_start", "--robot", "robot.yaml", "--seconds", .05, "--rays", 1, "--start-pose", "--quiet")
        self.assertIn("start_pose", (self.folder / "with_start/robot.yaml").read_text())

    def seen(self, name, *arguments):
        """Renders, trains on stills of another seed as one would, sees, and measures; all figures."""
        self.render(f"{name}_train", *arguments, "--seed", 11, "--stills", 16)
        folder = self.render(name, *arguments, "--seed", 1, "--seconds", 2)
        self.succeeds("train", "colors", f"{name}_train/samples.yaml", "--output", f"{name}/colors.yaml", "--quiet")
        self.succeeds("run", "--robot", f"{name}/robot.yaml", "--source", f"{name}/video.mkv", "--odometry", f"{name}/odometry.jsonl",
                      "--output", f"{name}/scenes.jsonl", "--label-maps", f"{name}/maps", "--quiet")
        result = self.succeeds("eval", f"{name}/gt.jsonl", f"{name}/scenes.jsonl", "--colors", f"{name}/labels", f"{name}/maps", "--json",
                               f"{name}/scores.json")
        self.assertEqual(len(self.scenes(f"{name}/scenes.jsonl")), 40)
        score = SHARED / "tools/score.py"
        if score.exists():
            done = subprocess.run(["/usr/bin/python3", score, folder / "gt.jsonl", folder / "scenes.jsonl"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        return result.out

    def figure(self, text, subject, row):
        """The first number of a row of the table."""
        found = None
        for line in text.splitlines():
            if not line.startswith(" "):
                found = line.split("  ")[0]
            if found == subject and row in line:
                return float(line.split(row)[1].split()[0])
        self.fail(f"no {subject}, {row} in\n{text}")

    def test_what_is_rendered_is_seen(self):
        text = self.seen("normal", "--field", "msl98")
        if FIGURES:
            print(text)
        self.assertGreaterEqual(self.figure(text, "ball", "recall"), 80, text)
        self.assertGreaterEqual(self.figure(text, "ball", "precision"), 80, text)
        self.assertLessEqual(self.figure(text, "ball", "position error"), .06, text)
        self.assertGreaterEqual(self.figure(text, "pose", "good: 0.10 m, 3 deg"), 80, text)
        self.assertLessEqual(self.figure(text, "pose", "position error"), .05, text)
        self.assertGreaterEqual(self.figure(text, "robots", "recall"), 60, text)
        self.assertGreaterEqual(self.figure(text, "mean of 9", "mean of 9"), 95, text)


FIGURES = "--figures" in sys.argv
if FIGURES:
    sys.argv.remove("--figures")
    sys.argv.append("Render.test_what_is_rendered_is_seen")

if __name__ == "__main__":
    main()
