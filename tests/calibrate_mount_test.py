#!/usr/bin/env python3
"""`tassilo calibrate mount`, on rendered images of a target on the floor and on the recordings, whose mounts are known.

usage: tests/calibrate_mount_test.py PROGRAM [unittest arguments]
"""
import math
import pathlib
import random
import re
import shutil
import unittest

from program import DATA, ProgramTest, main, png_bytes, train_colors

NAMES = ("x", "y", "z", "roll", "pitch", "yaw")
CAMERA = dict(fx=216.0, fy=177.631578947, cx=187.3, cy=88.9, k=-.1458)  # that of data/msl98/d01_approach
MOUNT = dict(x=.06, y=.015, z=.52, roll=.006981317, pitch=.244346095, yaw=-.013962634)
COLUMNS, ROWS, PITCH = 6, 5, .12
TARGET = f"checker:{COLUMNS}x{ROWS}:{PITCH}"


def camera_yaml(mount, camera=DATA / "d01_approach/camera.yaml"):
    """The text of a camera file with another mount."""
    text = camera.read_text()
    return re.sub(r"camera_pose_in_robot: .*", "camera_pose_in_robot: {" + ", ".join(f"{n}: {mount[n]:.9f}" for n in NAMES) + "}", text)


def read_mount(file):
    found = re.search(r"camera_pose_in_robot:\s*\{(.*)\}", pathlib.Path(file).read_text())
    return {key.strip(): float(value) for key, value in (item.split(":") for item in found[1].split(","))}


def rotation(mount):
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(mount[n]), math.sin(mount[n])) for n in ("roll", "pitch", "yaw"))
    return ((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr), (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr), (-sp, cp * sr, cp * cr))


def ink(u, v):
    """Is a place of the checkerboard black, in squares from corner (0, 0)? None beside the paper."""
    if min(u, v) < -1.5 or u > COLUMNS + .5 or v > ROWS + .5:
        return None
    return min(u, v) >= -1 and u <= COLUMNS and v <= ROWS and (math.floor(u + 1) + math.floor(v + 1)) % 2 == 0


def floor_image(mount, place, grid=8):
    """The floor with a target on it, through the camera, as a gray PNG."""
    x, y, yaw = place
    r = rotation(mount)
    c, s = math.cos(yaw), math.sin(yaw)

    def brightness(column, row):
        xd, yd = (column - CAMERA["cx"]) / CAMERA["fx"], (row - CAMERA["cy"]) / CAMERA["fy"]
        scale = 1 + CAMERA["k"] * (xd * xd + yd * yd)
        body = (1, -xd / scale, -yd / scale)
        d = [sum(a * b for a, b in zip(line, body)) for line in r]
        if d[2] >= 0:
            return 90
        px, py = mount["x"] - mount["z"] / d[2] * d[0] - x, mount["y"] - mount["z"] / d[2] * d[1] - y
        black = ink((c * px + s * py) / PITCH, (s * px - c * py) / PITCH)  # face up: rows run to the right of columns
        return 90 if black is None else 40 if black else 190

    # A pixel sees twice its own width, at places that are random so that no edge is seen askew.
    dice = random.Random(1)
    rows = []
    for row in range(172):
        line = bytearray()
        for column in range(384):
            corners = {brightness(column + dx, row + dy) for dx in (-1.5, 0, 1.5) for dy in (-1.5, 0, 1.5)}
            if corners == {90}:
                line.append(90)
                continue
            samples = [brightness(column + 2 * (i + dice.random()) / grid - 1, row + 2 * (k + dice.random()) / grid - 1) for i in range(grid) for k in range(grid)]
            line.append(round(sum(samples) / len(samples)))
        rows.append(bytes(line))
    return png_bytes(384, rows, 1)


class FromTarget(ProgramTest):
    PLACES = ((.95, -.25, math.pi / 2), (.95, -.2, .35))

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "floor").mkdir()
        for i, place in enumerate(cls.PLACES):
            (cls.folder / f"floor/{i}.png").write_bytes(floor_image(MOUNT, place))

    def calibrate(self, *arguments):
        return ("calibrate", "mount", *arguments, "--target", TARGET)

    def at(self, number):
        return ("--at", ",".join(f"{v:.6f}" for v in self.PLACES[number]))

    def test_the_true_mount(self):
        for images, places in ((["floor/0.png"], [0]), (["floor/1.png"], [1]), (["floor"], [0, 1])):
            with self.subTest(images=images):
                (self.folder / "camera.yaml").write_text(camera_yaml(MOUNT | {"pitch": 0, "z": .3}))
                before = (self.folder / "camera.yaml").read_text()
                result = self.succeeds(*self.calibrate(*images), "--camera", "camera.yaml", *[a for p in places for a in self.at(p)], "--report", "report")
                found = read_mount(self.folder / "camera.yaml")
                sigmas = dict(zip(NAMES, (float(s) for s in re.findall(r"^\w+ \[\w+\].* ([\d.]+)$", result.out, re.MULTILINE))))
                self.assertEqual(sigmas.keys(), set(NAMES), result)
                for name in NAMES:
                    sigma = math.radians(sigmas[name]) if name in ("roll", "pitch", "yaw") else sigmas[name] / 1000
                    self.assertLess(abs(found[name] - MOUNT[name]), 3 * sigma, (name, result.out))
                self.assertLess(abs(found["pitch"] - MOUNT["pitch"]), math.radians(.05))
                self.assertLess(abs(found["z"] - MOUNT["z"]), .002)
                self.assertTrue((self.folder / "report/residuals.png").read_bytes().startswith(b"\x89PNG"))
                # Only the mount is another one.
                after = (self.folder / "camera.yaml").read_text()
                for line in ("216", "-0.1458", "384"):
                    self.assertIn(line, before)
                    self.assertIn(line, after)

    def test_elsewhere_and_quiet(self):
        text = re.sub(r"camera_pose_in_robot.*\n?", "", camera_yaml(MOUNT))
        (self.folder / "lens.yaml").write_text(text)
        result = self.succeeds(*self.calibrate("floor/0.png"), "--camera", "lens.yaml", *self.at(0), "--output", "mounted.yaml", "--quiet")
        self.assertEqual(result.out, "")
        self.assertEqual((self.folder / "lens.yaml").read_text(), text)
        self.assertLess(abs(read_mount(self.folder / "mounted.yaml")["pitch"] - MOUNT["pitch"]), math.radians(.05))

    def test_what_is_wrong_is_told(self):
        (self.folder / "kept.yaml").write_text(camera_yaml(MOUNT))
        camera = ("--camera", "kept.yaml")
        self.fails(*self.calibrate("floor"), *camera, *self.at(0), *self.at(0), *self.at(0), says=("--at", "3 times", "2 images"))
        shutil.copy(DATA / "train_vga/labels/0000.png", self.folder / "vga.png")
        self.fails(*self.calibrate("floor/missing.png"), *camera, *self.at(0), says="missing.png")
        self.fails(*self.calibrate("vga.png"), *camera, *self.at(0), says="shows no target")
        self.fails(*self.calibrate("floor/0.png"), "--camera", "nowhere.yaml", *self.at(0), says="nowhere.yaml")
        self.fails(*self.calibrate("floor/0.png"), *camera, *self.at(0), "--output", "floor/0.png", says="would be lost")
        self.fails(*self.calibrate("floor/0.png"), *camera, *self.at(0), "--output", "nowhere/camera.yaml", says="there is no folder")
        self.assertEqual((self.folder / "kept.yaml").read_text(), camera_yaml(MOUNT))
        for arguments in ((), ("--at", "1,2"), ("--at", "1,2,3,4,5"), ("--at", "one,2,3"), ("--at", "1000,0,0"), (*self.at(0), "--at-sigma", "0")):
            with self.subTest(arguments=arguments):
                self.refuses(*self.calibrate("floor/0.png"), *camera, *arguments)
        self.refuses("calibrate", "mount", "floor/0.png", *self.at(0), "--target", TARGET, says="--target")


class FromLines(ProgramTest):
    """On the shipped recordings, whose true mount is in their camera files."""

    def robot(self, recording, change=None, colors="div.yaml"):
        folder = self.folder / recording
        folder.mkdir(exist_ok=True)
        truth = read_mount(DATA / recording / "camera.yaml")
        (folder / "camera.yaml").write_text(camera_yaml({n: truth[n] + (change or {}).get(n, 0) for n in NAMES}, DATA / recording / "camera.yaml"))
        (folder / "robot.yaml").write_text(f"camera: camera.yaml\ncolors: ../{colors}\nfield: msl98\n")
        return truth

    def test_a_disturbed_mount_comes_back(self):
        train_colors(type(self), DATA / "train_vga/samples.yaml", "vga.yaml")
        degree = math.radians(1)
        for recording, colors in (("d01_approach", "div.yaml"), ("d05_distract", "div.yaml"), ("d06_vga", "vga.yaml")):
            for change in ({}, {"pitch": degree, "roll": degree, "z": .02}, {"pitch": -degree}, {"roll": -degree}):
                with self.subTest(recording=recording, change=change):
                    truth = self.robot(recording, change, colors)
                    result = self.succeeds("calibrate", "mount", "--robot", f"{recording}/robot.yaml", DATA / recording / "video.mkv",
                                           "--odometry", DATA / recording / "odometry.jsonl", "--report", "report")
                    found = read_mount(self.folder / recording / "camera.yaml")
                    sigmas = dict(re.findall(r"^(\w+) \[\w+\].* ([\d.]+|kept)$", result.out, re.MULTILINE))
                    for name in ("x", "y", "yaw"):
                        self.assertEqual(found[name], truth[name])
                        self.assertEqual(sigmas[name], "kept", result)
                    for name, unit, most in (("z", .001, .005), ("roll", math.radians(1), math.radians(.15)), ("pitch", math.radians(1), math.radians(.15))):
                        off = abs(found[name] - truth[name])
                        self.assertLess(off, most, (name, result.out))
                        self.assertLess(off, 3 * unit * float(sigmas[name]), (name, result.out))

    def test_a_run_tells_when_the_mount_has_drifted(self):
        degree = math.radians(1)
        for recording in ("d01_approach", "d05_distract"):
            video, odometry = DATA / recording / "video.mkv", DATA / recording / "odometry.jsonl"
            run = ("run", "--robot", f"{recording}/robot.yaml", "--source", video, "--odometry", odometry, "--output", f"{recording}.jsonl")
            self.robot(recording)
            self.assertNotIn("drifted", self.succeeds(*run).out)
            for name, change in (("pitch", degree), ("pitch", -degree), ("roll", degree)):
                with self.subTest(recording=recording, name=name, change=change):
                    self.robot(recording, {name: change})
                    told = re.search(rf"^mount: has drifted from the camera file: .*{name} ([-+.\d]+) deg \(sigma ([.\d]+)\)", self.succeeds(*run).out, re.MULTILINE)
                    self.assertTrue(told)
                    self.assertLess(abs(float(told[1]) + math.degrees(change)), .25)

    def test_what_is_wrong_is_told(self):
        self.robot("d01_approach")
        self.write("lensless.yaml", "colors: div.yaml\n")
        video = DATA / "d01_approach/video.mkv"
        self.fails("calibrate", "mount", "--robot", "lensless.yaml", video, says="names no camera")
        self.fails("calibrate", "mount", "--robot", "d01_approach/robot.yaml", DATA / "d06_vga/video.mkv", says="full color range")
        self.write("gray.png", "")
        (self.folder / "gray.png").write_bytes(png_bytes(384, [bytes(384)] * 172, 1))
        before = (self.folder / "d01_approach/camera.yaml").read_text()
        self.fails("calibrate", "mount", "--robot", "d01_approach/robot.yaml", "gray.png", says="shows no place of the field")
        self.assertEqual((self.folder / "d01_approach/camera.yaml").read_text(), before)
        self.refuses("calibrate", "mount", video, says="--robot")
        self.refuses("calibrate", "mount", "--robot", "d01_approach/robot.yaml", video, "--at", "1,0,0", says="--at")
        self.refuses("calibrate", "mount", "--robot", "d01_approach/robot.yaml", video, "--start-pose", "1,0", says="--start-pose")


if __name__ == "__main__":
    main()
