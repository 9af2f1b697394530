#!/usr/bin/env python3
"""A camera as the program meets it: frames, trouble, and the way out. The camera is tests/fake_v4l2.cpp, preloaded into the real program.

usage: tests/camera_test.py PROGRAM FAKE_V4L2 [unittest arguments]
"""
import os
import re
import signal
import socket
import subprocess
import sys
import time
import unittest

from program import DATA, Live, ProgramTest, close, ffmpeg, main, raw_bytes, skip, without_timing

DEVICE = "/dev/video42"
RECORDING = DATA / "d01_approach"
FRAMES = 20
ROBOT = ("--robot", RECORDING / "robot.yaml", "--colors", "div.yaml")
SIZE = "width=384 height=172"


def preloaded(program, fake):
    """What LD_PRELOAD must be: a sanitizer wants to be the first of all libraries."""
    libraries = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    sanitizers = re.findall(r"=> (\S*/lib[at]san\.so\S*)", libraries)
    return " ".join([*sanitizers, fake])


class CameraLive(Live):
    """A run with a camera."""

    def __init__(self, test, script, *arguments):
        super().__init__(test, *arguments, env=test.camera(script))

    def end(self):
        super().end()
        self.test.assertIn("ended by a signal", self.told)
        return self.told


class Camera(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name in ("yuyv422", "uyvy422"):
            (cls.folder / f"{name}.raw").write_bytes(raw_bytes(RECORDING / "video.mkv", name, FRAMES))
        cls.succeed = cls.tell("run", *ROBOT, "--source", RECORDING / "video.mkv", "--output", "file.jsonl")
        # The full paths of frames: the program runs in the test's folder, the fake wherever it is.
        cls.yuyv = f"path={DEVICE} frames={cls.folder}/yuyv422.raw format=yuyv {SIZE}"

    @classmethod
    def camera(cls, script):
        return os.environ | {"LD_PRELOAD": PRELOAD, "TASSILO_FAKE_CAMERA": script + " "}

    def run_until(self, script, *arguments, scenes, name):
        live = CameraLive(self, script, "run", "--source", DEVICE, "--output", name, *arguments)
        live.until_scenes(name, scenes)
        return live.end()

    def expect_like_file(self, scenes, file, without=()):
        expected = self.scenes(file)[:len(scenes)]
        start = scenes[0]["t"]
        self.assertLess(abs(start - time.time()), 600, "seconds since the epoch")
        for scene, other in zip(scenes, expected, strict=True):
            self.assertAlmostEqual(scene["t"] - start, other["t"] - expected[0]["t"], places=4)
            self.assertIn("wait", scene["timing_ms"])
            scene, other = without_timing(scene), without_timing(other)
            for key in ("t", *without):
                scene.pop(key), other.pop(key)
            self.assertTrue(close(scene, other), f"{scene}\n{other}")

    def test_frames_give_the_scenes_of_the_recording(self):
        for layout in ("yuyv", "uyvy"):
            script = f"path={DEVICE} frames={self.folder}/{layout}422.raw format={layout} {SIZE} fps=20 once=1 lockstep=1"
            told = self.run_until(script, *ROBOT, scenes=FRAMES, name=f"{layout}.jsonl")
            self.assertIn(f"{DEVICE}: Preloaded Camera, {layout} 384x172 px, limited range, 20 frames/s (asked for 30); no exposure, gain 32 fixed, no white balance\n", told)
            self.assertIn(f"{FRAMES} frames in", told)
            self.assertIn(", 0 dropped\n", told)
            self.assertNotIn("camera:", told)
            self.expect_like_file(self.scenes(f"{layout}.jsonl"), "file.jsonl")

    def test_motion_jpeg_gives_the_scenes_of_its_file(self):
        ffmpeg("-i", DATA / "d06_vga/video.mkv", "-frames:v", 4, "-pix_fmt", "yuvj422p", "-q:v", 2, self.folder / "vga.mjpeg")
        train = self.tell("train", "colors", DATA / "train_vga/samples.yaml", "--output", "vga.yaml", "--quiet")
        self.judge(train, 0)
        robot = ("--robot", DATA / "d06_vga/robot.yaml", "--colors", "vga.yaml")
        self.succeeds("run", *robot, "--source", "vga.mjpeg", "--fps", 20, "--output", "vga_file.jsonl")
        script = f"path={DEVICE} frames={self.folder}/vga.mjpeg format=mjpeg width=640 height=480 fps=20 once=1 lockstep=1"
        told = self.run_until(script, *robot, "--fps", 20, "--camera-format", "mjpeg", scenes=4, name="vga.jsonl")
        self.assertIn("mjpeg 640x480 px, full range, 20 frames/s;", told)
        # Which of two point-mirrored places it is cannot be known, and hangs on the last digit.
        self.expect_like_file(self.scenes("vga.jsonl"), "vga_file.jsonl", without=("pose", "lines"))

    def test_survives_all_trouble_and_counts(self):
        script = self.yuyv + " fps=40 lost=3:2 error=8 short=9 again=12 unplug=30:0.6 stall=60 fails=90"
        live = CameraLive(self, script, "run", *ROBOT, "--source", DEVICE, "--output", "trouble.jsonl")
        live.until_told("is back after")
        self.assertIn(f"unplugged: {DEVICE} (Preloaded Camera) is unplugged, waiting for it\nstreaming: {DEVICE} (Preloaded Camera) is back after ", live.told)
        live.until_told("delivers frames again after")
        self.assertIn(f"stalled: {DEVICE} (Preloaded Camera) has sent no whole frame for 1.", live.told)
        live.until_told("cannot be read: input/output error")
        live.until(lambda: live.told.count("delivers frames again") == 2, "goes on after a failed reading")
        told = live.end()
        self.assertRegex(told, r"camera: (\d+ replaced by newer ones, )?2 lost by the driver, 2 broken; stalled 2 times, unplugged 1 time\n")
        scenes = self.scenes("trouble.jsonl")
        frames = [scene["frame"] for scene in scenes]
        times = [scene["t"] for scene in scenes]
        self.assertEqual(frames, sorted(set(frames)))
        self.assertEqual(times, sorted(set(times)))
        self.assertFalse({3, 4, 10, 11} & set(frames), frames)

    def test_a_camera_that_is_too_fast_is_followed_without_delay(self):
        told = self.run_until(self.yuyv + " fps=400", *ROBOT, "--overlay", "pictures", scenes=40, name="fast.jsonl")
        frames = [scene["frame"] for scene in self.scenes("fast.jsonl")]
        dropped = int(re.search(r", (\d+) dropped", told)[1])
        self.assertEqual(dropped, frames[-1] - frames[0] + 1 - len(frames))
        self.assertGreater(dropped, 0)
        self.assertIn("replaced by newer ones", told)

    def test_odometry_of_this_moment(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            out.bind(("127.0.0.1", 0))
            port = out.getsockname()[1]
        live = CameraLive(self, self.yuyv + " fps=20", "run", *ROBOT, "--source", DEVICE, "--odometry", f"udp:127.0.0.1:{port}", "--output", "udp.jsonl")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            def send_until_scenes():
                out.sendto(f'{{"t": {time.time()}, "x": 0, "y": 0, "theta": 0}}\n'.encode(), ("127.0.0.1", port))
                path = self.folder / "udp.jsonl"
                return path.exists() and path.read_bytes().count(b"\n") >= FRAMES
            live.until(send_until_scenes, "scenes")
        told = live.end()
        known, frames = map(int, re.search(r"odometry: (\d+) of (\d+) frames", told).groups())
        self.assertGreater(known, frames // 2, told)

    def test_ends_while_it_waits(self):
        live = CameraLive(self, self.yuyv + " fps=40 unplug=5:1000", "run", *ROBOT, "--source", f"v4l2:{DEVICE}")
        live.until_told("is unplugged")
        live.end()

    def test_list_of_cameras(self):
        result = self.succeeds("info", "--cameras", env=self.camera(self.yuyv + " fps=20"))
        self.assertIn(f"{DEVICE}: Preloaded Camera, nowhere-1.2\n  yuyv   384x172 (20)\n", result.out)

    def test_what_does_not_fit(self):
        camera = {"env": self.camera(self.yuyv + " fps=20")}
        self.fails("run", "--source", "/dev/video43", "--colors", "div.yaml", says="/dev/video43: cannot be opened as a camera: no such file", **camera)
        self.fails("run", "--source", DEVICE, *ROBOT, "--range", "full", says="has full color range, the color table is for limited", **camera)
        self.fails("run", "--source", DEVICE, *ROBOT, "--exposure", 100, says="has no exposure that can be set; leave it out", **camera)
        self.fails("run", "--source", DEVICE, *ROBOT, "--camera-format", "nv12", says="offers yuyv, must be nv12", **camera)
        self.fails("run", "--source", DEVICE, *ROBOT, "--odometry", "udp:0.0.0.0:5000", says="only this machine is listened to", **camera)
        other = {"env": self.camera(self.yuyv.replace("width=384", "width=380") + " fps=20")}
        self.fails("run", "--source", DEVICE, *ROBOT, says="is 380x172, the camera file is for 384x172", **other)

    def test_wrong_usage(self):
        self.refuses("run", "--source", DEVICE, "--format", "yuyv422", says="--camera-format")
        self.refuses("run", "--source", DEVICE, "--gain", "much", says="must be auto or a whole number")
        self.refuses("run", "--source", DEVICE, "--size", "640", says="must be like 640x480")
        self.refuses("run", "--source", "video.mkv", "--gain", "auto", says="belong to cameras")
        self.refuses("run", "--source", "-", "--odometry", "-", says="cannot both be standard input")
        self.refuses("run", "--source", DEVICE, "--camera-format", "h264", says="mjpeg")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM FAKE_V4L2 [unittest arguments]")
    PRELOAD = preloaded(sys.argv[1], os.path.abspath(sys.argv.pop(2)))
    works = subprocess.run([sys.argv[1], "--version"], env=os.environ | {"LD_PRELOAD": PRELOAD}, capture_output=True, text=True)
    if works.returncode != 0:
        skip(f"the program does not run with a preloaded library: {works.stderr.strip()}")
    main()
