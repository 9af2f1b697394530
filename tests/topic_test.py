#!/usr/bin/env python3
"""A camera driver of ROS 2 as the program meets it: images, lens and odometry from topics. The driver is tests/topic_publisher.cpp.

usage: tests/topic_test.py PROGRAM TOPIC_PUBLISHER [unittest arguments]

The environment's TASSILO_FAST_DDS_PEER, when set, is another driver: of another implementation of DDS.
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest

from bus_peer import Program, free_domain
from program import DATA, TIMEOUT_S, Live, ProgramTest, close, decoded, ffmpeg, main, without_timing

RECORDING = DATA / "d01_approach"
VIDEO = RECORDING / "video.mkv"
CAMERA = RECORDING / "camera.yaml"
ODOMETRY = RECORDING / "odometry.jsonl"
ROBOT = ("--robot", RECORDING / "robot.yaml", "--colors", "div.yaml")
IMAGES = "topic:/camera/image_raw"
FRAMES = 40


class Driver:
    """The publisher; its topics are there until the end."""

    def __init__(self, test, domain, source, encoding, **options):
        words = [f"{name}={value}" for name, value in options.items()]
        self.process = subprocess.Popen([PUBLISHER, str(domain), str(source), encoding, *words], cwd=test.folder, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        test.addCleanup(self.stop)
        ready = decoded(self.process.stdout.readline())
        test.assertEqual(ready, "ready\n", ready or decoded(self.process.stderr.read()))

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def wait(self):
        """Until all was sent; the second that stamps count from."""
        self.base = int(re.fullmatch(r"base (\d+)\n", decoded(self.process.stdout.readline()))[1])
        assert decoded(self.process.stdout.readline()) == "done\n"
        return self.base


class TopicLive(Live):
    """The program running on topics."""

    def __init__(self, test, domain, *arguments):
        super().__init__(test, "run", "--domain", domain, *arguments, stdin=subprocess.DEVNULL)


class Topic(ProgramTest):
    def see(self, source, encoding, *arguments, **options):
        """All that a driver sends is seen; the scenes with the times of the recording, and what was told."""
        domain = free_domain()
        name = f"{domain}.jsonl"
        driver = Driver(self, domain, source, encoding, **options)
        live = TopicLive(self, domain, "--source", IMAGES, "--output", name, *arguments)
        base = driver.wait()
        time.sleep(.3)
        told = live.end()
        scenes = self.scenes(name)
        for scene in scenes:
            self.assertIn("wait", scene["timing_ms"])
            scene["t"] = round(scene["t"] - base, 3)
        return scenes, told

    def expect_like(self, scenes, expected, without=("frame",)):
        """Frames may have been missed, but no more than a few."""
        by_time = {round(scene["t"], 3): scene for scene in expected}
        self.assertGreater(len(scenes), len(expected) // 2)
        for scene in scenes:
            one, other = without_timing(scene), without_timing(by_time[scene["t"]])
            for key in without:
                one.pop(key, None), other.pop(key, None)
            self.assertTrue(close(one, other), f"{one}\n{other}")

    def run_file(self, name, *arguments):
        self.succeeds("run", *arguments, "--output", name)
        return self.scenes(name)

    def test_yuv_gives_the_scenes_of_the_recording(self):
        expected = self.run_file("file.jsonl", *ROBOT, "--source", VIDEO, "--odometry", ODOMETRY)
        for encoding, layout in (("yuv422", "uyvy422"), ("yuyv", "yuyv422")):
            with self.subTest(encoding):
                scenes, told = self.see(VIDEO, encoding, *ROBOT, "--odometry", "topic:/odom", camera=CAMERA, odometry=ODOMETRY)
                self.assertIn(f"topic /camera/image_raw: sensor_msgs/msg/Image, {layout} 384x172 px, limited range\n", told)
                self.assertRegex(told, rf"odometry: (\d+) of \1 frames\n")
                self.assertIn("ended by a signal", told)
                self.assertNotIn("camera info", told)
                # A frame that was missed is missing in tracks and in the history of the pose.
                missed = len(scenes) < FRAMES
                self.expect_like(scenes, expected, ("frame", "pose", "lines", "tracks", "why") if missed else ())

    def test_nv12(self):
        ffmpeg("-i", VIDEO, "-pix_fmt", "yuv420p", "-c:v", "ffv1", self.folder / "420.mkv")
        expected = self.run_file("420.jsonl", *ROBOT, "--source", "420.mkv")
        scenes, told = self.see("420.mkv", "nv12", *ROBOT)
        self.assertIn("sensor_msgs/msg/Image, nv12 384x172 px, limited range\n", told)
        self.expect_like(scenes, expected, ("frame", "pose", "lines", "tracks", "why"))

    def test_rgb_and_png_give_the_scenes_of_the_pictures(self):
        (self.folder / "png").mkdir()
        ffmpeg("-i", VIDEO, "-frames:v", 6, self.folder / "png/%04d.png")
        expected = self.run_file("png.jsonl", *ROBOT, "--source", "png", "--fps", 10)
        for encoding in ("rgb8", "bgr8", "file"):
            with self.subTest(encoding):
                scenes, told = self.see("png", encoding, *ROBOT, rate=5)
                self.assertIn("CompressedImage" if encoding == "file" else "msg/Image", told)
                self.assertIn("yuv422p 384x172 px, limited range\n", told)
                for scene in scenes:
                    scene["t"] /= 10  # the driver counts a second from image to image
                self.expect_like(scenes, expected, ("frame", "image", "pose", "lines", "tracks", "why"))

    def test_jpeg_is_full_range(self):
        (self.folder / "jpg").mkdir()
        ffmpeg("-i", DATA / "d06_vga/video.mkv", "-frames:v", 4, "-pix_fmt", "yuvj422p", "-q:v", 2, self.folder / "jpg/%04d.jpg")
        self.judge(self.tell("train", "colors", DATA / "train_vga/samples.yaml", "--output", "vga.yaml", "--quiet"), 0)
        robot = ("--robot", DATA / "d06_vga/robot.yaml", "--colors", "vga.yaml")
        expected = self.run_file("jpg.jsonl", *robot, "--source", "jpg")
        scenes, told = self.see("jpg", "file", *robot, rate=5)
        self.assertIn("sensor_msgs/msg/CompressedImage, yuv422p 640x480 px, full range\n", told)
        self.expect_like(scenes, expected, ("frame", "image", "pose", "lines", "tracks", "why"))
        self.fails_on(says="has full color range, the color table is for limited range", source="jpg", encoding="file", arguments=("--colors", "div.yaml"))

    @unittest.skipUnless("TASSILO_FAST_DDS_PEER" in os.environ, "Fast DDS is not installed; tools/install_deps.sh --references installs it")
    def test_a_driver_of_another_implementation(self):
        (self.folder / "few").mkdir()
        ffmpeg("-i", VIDEO, "-frames:v", 3, self.folder / "few/%04d.png")
        expected = self.run_file("few.jsonl", *ROBOT, "--source", "few")
        domain = free_domain()
        peer = Program(os.environ["TASSILO_FAST_DDS_PEER"], str(domain))
        self.addCleanup(peer.close)

        def ask(**wish):
            return json.loads(peer.ask(json.dumps(wish)))
        for reliable in (True, False):
            with self.subTest(reliable=reliable):
                topic = f"/reliable_{reliable}/image".lower()
                ask(do="writer", topic=f"rt{topic}", type="image", reliable=reliable)
                name = f"fast_{reliable}.jsonl"
                live = TopicLive(self, domain, *ROBOT, "--source", f"topic:{topic}", "--output", name)
                end = time.monotonic() + TIMEOUT_S
                seen = 0
                second = 100
                # Again until it is seen: the first one may be lost while both find each other, and best effort is what it says.
                while seen < len(expected):
                    self.assertLess(time.monotonic(), end, live.told)
                    second += 1
                    picture = (self.folder / f"few/{seen + 1:04d}.png").read_bytes()
                    ask(do="send", topic=f"rt{topic}", value={"sec": second, "nanosec": 0, "frame_id": "camera", "format": "png", "data": picture.hex()})
                    time.sleep(.2)
                    path = self.folder / name
                    seen = path.read_bytes().count(b"\n") if path.exists() else 0
                live.end()
                for scene, other in zip(self.scenes(name), expected):
                    for key in ("balls", "goals"):
                        self.assertTrue(close(scene[key], other[key]), f"{scene[key]}\n{other[key]}")

    def fails_on(self, says, source=VIDEO, encoding="yuv422", arguments=ROBOT, **options):
        domain = free_domain()
        Driver(self, domain, source, encoding, **options)
        return self.fails("run", "--domain", domain, "--source", IMAGES, *arguments, says=says)

    def test_what_does_not_fit(self):
        self.fails_on("topic /camera/image_raw: encoding: is bayer_rggb8, must be uyvy (yuv422), yuyv (yuv422_yuy2), nv12, rgb8 or bgr8", encoding="bayer_rggb8")
        self.fails_on("topic /camera/image_raw: is published as nav_msgs/msg/Odometry, must be sensor_msgs/msg/Image or", encoding="wrong_type")
        self.fails_on("topic /odom: is published as sensor_msgs/msg/Image, must be nav_msgs/msg/Odometry",
                      arguments=(*ROBOT, "--odometry", "topic:/odom"), topic="/odom")
        self.fails_on("has full color range, the color table is for limited", arguments=(*ROBOT, "--range", "full"))

    def test_the_camera_file_is_checked(self):
        text = CAMERA.read_text()
        self.write("shifted.yaml", text.replace("187.3", "189.3"))
        self.fails_on(("topic /camera/camera_info: differs from the camera file by 2.0 px at pixel (", "must be within 1 px; correct the one that is wrong"),
                      camera="shifted.yaml")
        self.write("straight.yaml", text.replace("-0.1458", "-0.10"))
        self.fails_on(("differs from the camera file by", "px at pixel ("), camera="straight.yaml")
        self.write("larger.yaml", text.replace("image_width: 384", "image_width: 400"))
        self.fails_on("topic /camera/camera_info: is for 400x172 px, the camera file for 384x172", camera="larger.yaml")
        self.write("nearly.yaml", text.replace("187.3", "188.0"))
        scenes, told = self.see(VIDEO, "yuv422", *ROBOT, camera="nearly.yaml", frames=5)
        self.assertTrue(scenes)
        self.assertNotIn("camera_info", told)
        # Without a camera file there is nothing to compare with.
        scenes, told = self.see(VIDEO, "yuv422", "--colors", "div.yaml", camera="shifted.yaml", frames=5)
        self.assertTrue(scenes)
        self.assertNotIn("camera_info", told)

    def test_waits_for_a_driver_and_through_silence(self):
        domain = free_domain()
        live = TopicLive(self, domain, *ROBOT, "--source", IMAGES, "--output", "silence.jsonl")
        live.until_told("waiting for topic /camera/image_raw, which nobody publishes\n")
        driver = Driver(self, domain, VIDEO, "yuv422", pause="10:2.5")
        live.until_told("silent: topic /camera/image_raw has sent no image for 1.")
        live.until_told("back: topic /camera/image_raw after 2.")
        driver.wait()
        driver.stop()
        live.until_told("nobody publishes it any more\n")
        told = live.end()
        self.assertIn("images: ", told)
        self.assertIn("silent 2 times\n", told)
        times = [scene["t"] for scene in self.scenes("silence.jsonl")]
        self.assertEqual(times, sorted(set(times)))

    def test_ends_while_it_waits(self):
        live = TopicLive(self, free_domain(), *ROBOT, "--source", IMAGES)
        live.until_told("waiting for topic")
        self.assertIn("ended by a signal before the first frame\n", live.end())

    def test_what_is_malformed_ends_nothing_and_is_told(self):
        scenes, told = self.see(VIDEO, "yuv422", *ROBOT, "--odometry", "topic:/odom", camera=CAMERA, odometry=ODOMETRY, malformed=20, older=30)
        # On a busy machine one of them may be replaced by a newer one, as any other.
        self.assertRegex(told, r"images: (\d+ replaced by newer ones or lost on the way, )?(1 with an older stamp, )?[345] refused, the last: \w+: ")
        self.assertNotIn("\33", told)
        self.assertIn("topic /camera/camera_info: camera info: has distortion model \"mirror\", must be plumb_bob, rational_polynomial or equidistant; "
                      "the camera file is not checked\n", told)
        self.assertIn("camera info: 1 refused, the first: camera info: has distortion model", told)
        self.assertRegex(told, r"odometry: 1 of \d+ messages refused, the first: its orientation is no rotation\n")
        frames = [scene["frame"] for scene in scenes]
        self.assertEqual(frames, sorted(set(frames)))

    def test_a_clock_that_was_set_back(self):
        domain = free_domain()
        Driver(self, domain, VIDEO, "yuv422", back=10, rate=10)
        self.fails("run", "--domain", domain, "--source", IMAGES, *ROBOT,
                   says=("topic /camera/image_raw: has stamps that went back by 3", "and stay there: a clock was set, or something was sent from the future; start again"))

    def test_wrong_usage(self):
        self.refuses("run", "--source", "topic:camera", says="names the topic camera, must be like /camera/image_raw")
        self.refuses("run", "--source", "topic:/a//b", says="must be like /camera/image_raw")
        self.refuses("run", "--source", VIDEO, "--odometry", "topic:/1odom", says="must be like /camera/image_raw")
        self.refuses("run", "--source", VIDEO, "--camera-info", "/camera_info", says="belongs to topics")
        self.refuses("run", "--source", IMAGES, "--camera-info", "camera_info", says="--camera-info: names the topic camera_info")
        self.refuses("run", "--source", IMAGES, "--size", "640x480", says="are what the images of a topic say")
        self.refuses("run", "--source", IMAGES, "--exposure", "auto", says="are the driver's")
        self.refuses("run", "--source", IMAGES, "--domain", 233, says="--domain")
        table = ("--source", IMAGES, "--colors", "div.yaml")
        self.fails("run", *table, "--multicast", says="bus.multicast: is on, must be off on loopback")
        self.fails("run", *table, says="ROS_DOMAIN_ID: is 'many', must be a whole number", env=os.environ | {"ROS_DOMAIN_ID": "many"})
        self.fails("run", *table, "--interface", "nowhere0", says="bus: cannot enter domain")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM TOPIC_PUBLISHER [unittest arguments]")
    PUBLISHER = str(pathlib.Path(sys.argv.pop(2)).resolve())
    main()
