#!/usr/bin/env python3
"""`tassilo calibrate`, on rendered views of targets whose cameras are known, ../shared/data/msl98/calibration, where it is there.

usage: tests/calibrate_test.py PROGRAM [--figures | unittest arguments]     --figures prints the table of docs/accuracy.md
"""
import math
import re
import shutil
import sys
import unittest

from program import SHARED, ProgramTest, main

VIEWS = SHARED / "data/msl98/calibration"
TARGETS = ("--target", "dots:7x7:0.04:0.01", "--target", "checker:9x6:0.04")
NAMES = {"division": ["k"], "plumb_bob": ["k1", "k2", "p1", "p2", "k3"]}
# Camera, images, model; the largest error of where directions show, in pixels: anywhere, and within the part that views cover.
# xga has four views.
CASES = (("div", "circles", "division", .7, .7), ("div", "checker", "division", .7, .7),
         ("vga", "", "plumb_bob", .7, .3), ("xga", "", "plumb_bob", math.inf, .5))


def read_camera(file):
    """Parameters by name, and the size of the image."""
    text = file.read_text()
    numbers = [[float(x) for x in found.split(",")] for found in re.findall(r"data: \[(.*)\]", text)]
    model = re.search(r"distortion_model: (\w+)", text)[1]
    matrix = numbers[0]
    values = {"fx": matrix[0], "fy": matrix[4], "cx": matrix[2], "cy": matrix[5]} | dict(zip(NAMES[model], numbers[1]))
    return values, [int(re.search(rf"image_{side}: (\d+)", text)[1]) for side in ("width", "height")]


def distort(camera, x, y):
    """Normalized coordinates, straight to distorted."""
    q = x * x + y * y
    if "k" in camera:
        scale = 2 / (1 + math.sqrt(max(0, 1 - 4 * camera["k"] * q)))
        return scale * x, scale * y
    g = 1 + q * (camera["k1"] + q * (camera["k2"] + q * camera["k3"]))
    p1, p2 = camera["p1"], camera["p2"]
    return x * g + 2 * p1 * x * y + p2 * (q + 2 * x * x), y * g + p1 * (q + 2 * y * y) + 2 * p2 * x * y


def undistort(camera, xd, yd):
    x, y = xd, yd
    for _ in range(400):
        sx, sy = distort(camera, x, y)
        x, y = x + .7 * (xd - sx), y + .7 * (yd - sy)
    return x, y


def mapped_errors(truth, found, size):
    """(error, distance from the principal point relative to the farthest corner) of pixels all over the image."""
    def far(x, y):
        return math.hypot((x - truth["cx"]) / truth["fx"], (y - truth["cy"]) / truth["fy"])
    farthest = max(far(x, y) for x in (0, size[0] - 1) for y in (0, size[1] - 1))
    out = []
    for i in range(25):
        for k in range(17):
            c, r = i * (size[0] - 1) / 24, k * (size[1] - 1) / 16
            x, y = distort(found, *undistort(truth, (c - truth["cx"]) / truth["fx"], (r - truth["cy"]) / truth["fy"]))
            out.append((math.hypot(found["fx"] * x + found["cx"] - c, found["fy"] * y + found["cy"] - r), far(c, r) / farthest))
    return out


@unittest.skipUnless(VIEWS.is_dir(), "needs ../shared/data/msl98/calibration")
class Calibrate(ProgramTest):
    def calibrate(self, camera, images, model):
        files = sorted((VIEWS / camera).glob(f"{images}*.png"))
        return files, self.succeeds("calibrate", "intrinsics", *files, *TARGETS, "--model", model, "--output", f"camera_{camera}.yaml", "--report", "report")

    def test_true_cameras(self):
        print(f"{'views':24}{'RMS':>7}{'left out':>9}{'focal':>9}{'centre':>8}{'mapped':>8}{'covered':>9}{'sigmas':>8}")
        for camera, images, model, anywhere, covered in CASES:
            with self.subTest(camera=camera, images=images):
                files, result = self.calibrate(camera, images, model)
                self.assertIn(f"{len(files)} of {len(files)} images show a target", result.out)
                self.assertNotIn("not used", result.out)
                truth, size = read_camera(VIEWS / f"{camera}.yaml")
                found, _ = read_camera(self.folder / f"camera_{camera}.yaml")
                sigmas = {name: float(sigma) for name, sigma in re.findall(r"^(\w+) +-?[\d.]+ \+- ([\d.]+)", result.out, re.MULTILINE)}
                rms, left_out = (float(x) for x in re.search(r"RMS ([\d.]+) px in \d+ views; ([\d.]+) px in views left out", result.out).groups())
                reach = int(re.search(r"up to (\d+) % of the way", result.out)[1]) / 100
                self.assertEqual(sigmas.keys(), truth.keys())
                focal = max(abs(found[f] / truth[f] - 1) for f in ("fx", "fy"))
                centre = math.hypot(found["cx"] - truth["cx"], found["cy"] - truth["cy"])
                errors = mapped_errors(truth, found, size)
                worst, worst_covered = max(e for e, _ in errors), max(e for e, far in errors if far <= reach)
                in_sigmas = max(abs(found[name] - truth[name]) / sigmas[name] for name in truth)
                print(f"{camera + ' ' + (images or 'all') + ' ' + model:24}{rms:7.3f}{left_out:9.3f}{100 * focal:7.3f} %{centre:8.3f}{worst:8.3f}"
                      f"{worst_covered:9.3f}{in_sigmas:8.2f}")
                self.assertLess(rms, .3)
                self.assertLess(left_out, 1.2 * rms + .005)
                self.assertLess(focal, .005)
                self.assertLess(centre, 2)
                self.assertLess(worst, anywhere)
                self.assertLess(worst_covered, covered)
                self.assertLess(in_sigmas, 3)
                self.assertEqual("only 4 views" in result.err, camera == "xga")
                self.assertTrue((self.folder / "report/residuals.png").read_bytes().startswith(b"\x89PNG"))

    def test_a_mount_is_kept_unless_asked(self):
        mount = "camera_pose_in_robot: {x: 0.06, y: 0.015, z: 0.52, roll: 0, pitch: 0.24, yaw: 0}"
        text = (VIEWS / "div.yaml").read_text()
        text = re.sub("camera_pose_in_robot.*", mount, text)
        (self.folder / "mounted.yaml").write_text(text)
        arguments = ("calibrate", "intrinsics", VIEWS / "div", *TARGETS, "--model", "division", "--output", "mounted.yaml", "--quiet")
        self.succeeds(*arguments)
        self.assertIn("pitch: 0.24", (self.folder / "mounted.yaml").read_text())
        self.assertIn("camera_name: mounted", (self.folder / "mounted.yaml").read_text())
        self.succeeds(*arguments, "--no-keep-mount")
        self.assertNotIn("camera_pose_in_robot", (self.folder / "mounted.yaml").read_text())

    def test_what_is_there_is_not_lost(self):
        self.write("notes.yaml", "not a camera\n")
        arguments = ("calibrate", "intrinsics", VIEWS / "div", *TARGETS, "--model", "division", "--quiet", "--output")
        self.fails(*arguments, "notes.yaml", says=("notes.yaml", "--no-keep-mount"))
        self.assertEqual((self.folder / "notes.yaml").read_text(), "not a camera\n")
        self.fails(*arguments, "nowhere/camera.yaml", says=("nowhere", "there is no folder"))
        views = self.folder / "views"
        views.mkdir()
        shutil.copy(VIEWS / "div/circles_00.png", views / "a.png")
        self.fails("calibrate", "intrinsics", "views", *TARGETS, "--output", "views/a.png", says=("views/a.png", "would be lost"))
        self.assertTrue((views / "a.png").read_bytes().startswith(b"\x89PNG"))
        self.refuses("calibrate", "target", "dots:7x7:25:6.25", "--output", "mm.png", says="lengths are in metres")

    def test_other_images_have_no_target(self):
        image = VIEWS / "div/circles_00.png"
        self.fails("calibrate", "intrinsics", image, "--target", "checker:9x6:0.04", "--output", "no.yaml", says=("circles_00.png", "shows no target"))
        self.fails("calibrate", "intrinsics", image, VIEWS / "vga/circles_00.png", *TARGETS, "--output", "no.yaml", says=("640 x 480", "384 x 172"))
        self.fails("calibrate", "intrinsics", image, *TARGETS, "--output", "no.yaml", says="1 usable views")
        self.assertFalse((self.folder / "no.yaml").exists())


class Targets(ProgramTest):
    def test_what_is_printed_is_found(self):
        for target in ("dots:7x7:0.02:0.005", "dots:6x9:0.02:0.006", "checker:9x6:0.02", "checker:4x7:0.03", "aprilgrid:4x3:0.02:0.3"):
            with self.subTest(target=target):
                self.succeeds("calibrate", "target", target, "--output", "target.png")
                result = self.tell("calibrate", "intrinsics", "target.png", "--target", target, "--output", "no.yaml")
                self.assertIn("1 of 1 images show a target", result.out)
                for name in ("target.svg", "target.pdf"):
                    self.succeeds("calibrate", "target", target, "--output", name)

    def test_bad_usage(self):
        for arguments in (("target", "stars:7x7:0.02", "--output", "t.svg"), ("target", "checker:8x6:0.02", "--output", "t.svg"),
                          ("intrinsics", "a.png", "--target", "dots:7x7:0.02", "--output", "c.yaml"),
                          ("intrinsics", "a.png", "--target", "checker:9x6:0.02", "--output", "c.yaml", "--model", "fisheye"),
                          ("intrinsics", "a.png", "--output", "c.yaml"),
                          ("intrinsics", "a.png", "--target", "checker:9x6:0.02", "--output", "c.yaml", "--folds", "1")):
            with self.subTest(arguments=arguments):
                self.judge(self.tell("calibrate", *arguments), 2)
        self.fails("calibrate", "target", "checker:9x6:0.02", "--output", "t.jpg", says=(".svg", "t.jpg"))
        self.fails("calibrate", "intrinsics", "missing.png", "--target", "checker:9x6:0.02", "--output", "c.yaml", says="missing.png")


if __name__ == "__main__":
    if "--figures" in sys.argv:
        sys.argv[sys.argv.index("--figures")] = "Calibrate.test_true_cameras"
    main()
