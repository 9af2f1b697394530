#!/usr/bin/env python3
"""Recordings: what was seen is seen again, to the last digit, whatever happened meanwhile.

usage: tests/recording_test.py PROGRAM FAKE_V4L2 [unittest arguments]
"""
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest

import camera_test
from program import DATA, TIMEOUT_S, ProgramTest, main, raw_bytes, train_colors, without_timing
from serve_test import RECORDING, Channel, Served

DEVICE = "/dev/video42"
FAKE = PROGRAM = None
PLUGIN = os.environ.get("TASSILO_PLUGIN")
NAME = r"\d{4}-\d\d-\d\dT\d\d-\d\d-\d\dZ(-\d+)?"


def seen(scenes):
    """Without what a replay cannot know: times, and what happened to the configuration."""
    return [without_timing(scene) | {"why": {key: why for key, why in scene["why"].items() if key != "configuration"}} for scene in scenes]


class Replayed:
    """Of a test with a folder of its own."""

    def parts(self, folder="recordings"):
        def number(path):
            return int(path.suffix.removeprefix(".part")) if path.suffix.startswith(".part") else 1
        return sorted((self.folder / folder).iterdir(), key=lambda path: (path.name.partition(".")[0], number(path)))

    def replay(self, part, code=0):
        """The scenes of a run of the part alone, which was moved: nothing outside of it is needed."""
        moved = self.folder / "moved"
        shutil.rmtree(moved, ignore_errors=True)
        shutil.copytree(part, moved)
        odometry = ("--odometry", "moved/odometry.jsonl") if (moved / "odometry.jsonl").exists() else ()
        self.judge(self.tell("run", "--robot", "moved/robot.yaml", "--source", "moved/video.mkv", *odometry, "--output", "again.jsonl", "--quiet"), code)
        return self.scenes("again.jsonl")

    def expect_replays(self, part, least=1):
        recorded = self.scenes(part / "scenes.jsonl")
        self.assertGreaterEqual(len(recorded), least)
        self.assertFalse([scene for scene in recorded if "configuration" in scene["why"]])
        replayed = self.replay(part)
        self.assertEqual([without_timing(scene) for scene in replayed], [without_timing(scene) for scene in recorded])
        return recorded


class Run(ProgramTest, Replayed):
    def test_a_run_is_seen_again(self):
        train_colors(self, DATA / "train_vga/samples.yaml", "vga.yaml")
        for recording, colors in (("d01_approach", "div"), ("d05_distract", "div"), ("d06_vga", "vga")):
            for options in ((), ("--every", 3), ("--start-pose", "1.2,0,0.1,0.3,0.2")):
                with self.subTest(recording=recording, options=options):
                    shutil.rmtree(self.folder / "made", ignore_errors=True)
                    source = DATA / recording
                    told = self.succeeds("run", "--robot", source / "robot.yaml", "--colors", f"{colors}.yaml", "--source", source / "video.mkv", "--odometry",
                                         source / "odometry.jsonl", "--record", "made/here", "--output", "run.jsonl", *options).out
                    part, = self.parts("made/here")
                    self.assertRegex(part.name, f"^{NAME}$")
                    scenes = self.expect_replays(part)
                    self.assertEqual(seen(scenes), seen(self.scenes("run.jsonl")))
                    self.assertIn(f"recording: {part}, {len(scenes)} frames\n", told)

    def test_of_a_robot_without_a_file_and_of_pictures(self):
        (self.folder / "pictures").mkdir(exist_ok=True)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", RECORDING / "video.mkv", "-frames:v", "5", self.folder / "pictures/p%d.png"], check=True)
        self.succeeds("run", "--colors", "div.yaml", "--source", "pictures", "--record", "of_pictures", "--output", "run.jsonl")
        part, = self.parts("of_pictures")
        scenes = self.expect_replays(part)
        self.assertEqual([scene["image"] for scene in scenes], [f"p{k}.png" for k in range(1, 6)])
        self.assertEqual(seen(scenes), seen(self.scenes("run.jsonl")))

    @unittest.skipUnless(PLUGIN, "TASSILO_PLUGIN, the plug-in for tests, is not set")
    def test_plugins_go_with_it(self):
        self.write("robot.yaml", f"camera: {RECORDING / 'camera.yaml'}\nfield: msl98\nplugins: [{PLUGIN}]\nvision: {{balls: blind}}\n")
        self.succeeds("run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--record", "with_plugin", "--quiet")
        part, = self.parts("with_plugin")
        self.assertIn(f"  - {pathlib.Path(PLUGIN).name}\n", (part / "robot.yaml").read_text())
        self.assertFalse([scene for scene in self.expect_replays(part) if scene["balls"]])

    def test_a_recording_can_be_recorded(self):
        source = DATA / "d01_approach"
        self.succeeds("run", "--robot", source / "robot.yaml", "--colors", "div.yaml", "--source", source / "video.mkv", "--odometry", source / "odometry.jsonl",
                      "--record", "first", "--quiet")
        part, = self.parts("first")
        self.succeeds("run", "--robot", part / "robot.yaml", "--source", part / "video.mkv", "--odometry", part / "odometry.jsonl", "--record", "second", "--quiet")
        again, = self.parts("second")
        self.assertEqual(seen(self.expect_replays(again)), seen(self.scenes(part / "scenes.jsonl")))

    def test_a_full_disk_ends_the_recording_and_not_the_run(self):
        source = DATA / "d01_approach"
        result = self.fails("run", "--robot", source / "robot.yaml", "--colors", "div.yaml", "--source", source / "video.mkv", "--record", "full", "--output",
                            "run.jsonl", says=("recording", "video.mkv"), preexec_fn=lambda: limit_files(1_000_000))
        self.assertEqual(len(self.scenes("run.jsonl")), 40)
        self.assertIn("recording ended: ", result.out)
        part, = self.parts("full")
        replayed = self.replay(part, code=1)  # cut within a frame: told at the end
        self.assertGreater(len(replayed), 5)
        self.assertEqual(seen(replayed), seen(self.scenes("run.jsonl"))[:len(replayed)])

    def test_folders_that_cannot_be(self):
        source = ("--source", DATA / "d01_approach/video.mkv", "--colors", "div.yaml")
        self.write("file", "")
        self.fails("run", *source, "--record", "file", says=("file", "folder for recordings"))
        self.fails("run", *source, "--record", "file/below", says=("file", "folder for recordings"))


def free_udp_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        out.bind(("127.0.0.1", 0))
        return out.getsockname()[1]


def limit_files(size):
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Pressed(Served, Replayed):
    """The button, to be pressed."""

    def setUp(self):
        super().setUp()
        shutil.rmtree(self.folder / "recordings", ignore_errors=True)

    def put(self, on, code=200):
        status, data, _ = self.ask("PUT", "/api/recording", json.dumps({"on": on}))
        self.assertEqual(status, code, data)
        return json.loads(data) if code == 200 else data.decode()

    def recording(self):
        return self.get("/api/recording")

    def end(self):
        self.put(False)
        return self.until(lambda: (state := self.recording()) and not state["finishing"] and state)

    def change(self, **changes):
        status, data, _ = self.ask("PUT", "/api/stages", json.dumps(changes))
        self.assertEqual(status, 200, data)


class Button(Pressed):
    def test_from_the_middle_over_its_end_and_with_changes(self):
        self.serve()
        self.assertEqual(self.recording() | {"folder": ""}, {"on": False, "finishing": False, "folder": "", "name": "", "parts": 0, "seconds": 0, "frames": 0,
                                                            "bytes": 0, "dropped": 0, "trouble": ""})
        self.until(lambda: 10 < self.get("/api/state")["frame"] < 25)
        state = self.put(True)
        self.assertTrue(state["on"])
        self.assertEqual(pathlib.Path(state["folder"]), self.folder / "recordings")
        self.until(lambda: self.recording()["frames"] > 45)
        self.change(localization="boundary", ball_max=3)
        before = self.recording()["frames"]
        self.until(lambda: self.recording()["frames"] > before + 10)
        self.write("robot.yaml", "{robot: {id: 7, team: magenta}, camera: camera.yaml, field: rcj_soccer_walls, vision: {free_space_sector: 4}}\n")
        before = self.recording()["frames"]
        self.until(lambda: self.recording()["frames"] > before + 10)
        state = self.get("/api/state")["recording"]
        self.assertTrue(state["on"])
        state = self.end()
        self.assertEqual((state["on"], state["trouble"], state["dropped"]), (False, "", 0))
        parts = self.parts()
        self.assertEqual(len(parts), state["parts"])
        self.assertGreaterEqual(len(parts), 4)
        self.assertEqual(parts[-1].name, state["name"])
        scenes = [self.expect_replays(part) for part in parts]
        self.assertEqual(sum(map(len, scenes)), state["frames"])
        self.assertGreater(scenes[0][0]["frame"], 10)
        self.assertTrue((parts[0] / "start_state.yaml").exists())
        self.assertFalse((parts[1] / "start_state.yaml").exists(), "the file began again, with nothing known")
        self.assertIn("the source began again", (parts[1] / "robot.yaml").read_text())
        self.assertNotEqual(scenes[0][0]["pose"]["kind"], "start", "what was known goes on")
        files = sum(path.stat().st_size for part in parts for path in part.iterdir() if path.suffix in (".mkv", ".jsonl"))
        self.assertEqual(state["bytes"], files)
        robot = (parts[-1] / "robot.yaml").read_text()
        for line in ("robot: {id: 7, team: magenta}", "  free_space_sector: 4", "  ball_max: 3", "  localization: boundary"):
            self.assertIn(line, robot)
        self.assertEqual(len([part for part in parts if "the configuration was changed" in (part / "robot.yaml").read_text()]), 2)
        self.assertNotIn(str(self.folder), robot)

    def test_a_recording_that_is_played_again_and_again(self):
        """It begins each time with what was known before its first frame."""
        self.serve()
        self.until(lambda: 10 < self.get("/api/state")["frame"] < 20)
        self.put(True)
        self.until(lambda: self.recording()["frames"] > 8)
        self.end()
        first = self.parts()[0]
        self.assertTrue((first / "start_state.yaml").exists())
        length = len(self.expect_replays(first))
        self.stop()
        for name in first.iterdir():
            shutil.copy(name, self.folder / name.name)
        self.process = self.start("serve", "--robot", "robot.yaml", "--source", "video.mkv", "--odometry", "odometry.jsonl", "--port", "0", "--recordings", "again",
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.port = int(re.search(r"http://[\d.]+:(\d+)/", self.process.stdout.readline().decode())[1])
        self.put(True)
        self.until(lambda: self.recording()["parts"] > 2)
        self.end()
        parts = self.parts("again")
        for part in parts:
            self.expect_replays(part)
        self.assertEqual(len(self.scenes(parts[1] / "scenes.jsonl")), length)
        self.assertEqual(seen(self.scenes(parts[1] / "scenes.jsonl")), seen(self.scenes(first / "scenes.jsonl")))

    def test_is_begun_and_ended_as_often_as_wanted_and_nothing_is_overwritten(self):
        self.serve()
        for body in ("", "{}", "{\"on\": 1}", "[]", "{\"on\": true, \"off\": true}"):
            status, data, _ = self.ask("PUT", "/api/recording", body)
            self.assertEqual(status, 400, data)
        self.assertEqual(self.ask("DELETE", "/api/recording")[0], 405)
        self.end()
        for count in range(1, 4):
            self.put(True)
            self.put(True)
            self.until(lambda: self.recording()["frames"] >= 3)
            self.end()
            self.put(False)
            self.assertEqual(len({re.sub(r"\.part\d+$", "", part.name) for part in self.parts()}), count)
        for part in self.parts():
            self.expect_replays(part)

    def test_ctrl_c_finishes_the_files(self):
        self.serve("--recordings", "elsewhere/there")
        self.put(True)
        self.until(lambda: self.recording()["frames"] >= 10)
        self.process.send_signal(signal.SIGINT)
        out, err = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual((self.process.returncode, err), (0, b""), err)
        self.assertIn(b"recording into ", out)
        self.expect_replays(self.parts("elsewhere/there")[0])

    def test_a_folder_that_cannot_be_written(self):
        self.write("in_the_way", "")
        self.serve("--recordings", "in_the_way")
        self.assertIn("folder for recordings", self.put(True, code=409))
        self.assertFalse(self.recording()["on"])

    def test_a_full_disk_is_told_and_the_vision_goes_on(self):
        self.serve(preexec_fn=lambda: limit_files(1_000_000))
        self.put(True)
        state = self.until(lambda: (state := self.recording()) and not state["on"] and state)
        self.assertIn("video.mkv", state["trouble"])
        frames = self.get("/api/state")["frames"]
        self.until(lambda: self.get("/api/state")["frames"] > frames + 5)
        self.assertEqual(self.put(True)["trouble"], "")
        self.until(lambda: self.recording()["frames"] > 1)


class OfACamera(Pressed):
    """With odometry that comes when it comes."""

    def setUp(self):
        super().setUp()
        raw = self.folder / "yuyv.raw"
        if not raw.exists():
            raw.write_bytes(raw_bytes(RECORDING / "video.mkv", "yuyv422", 40))
        self.udp = free_udp_port()

    def serve_camera(self, *arguments, fps=25, **options):
        script = f"path={DEVICE} frames={self.folder}/yuyv.raw format=yuyv width=384 height=172 fps={fps} "
        environment = os.environ | {"LD_PRELOAD": camera_test.preloaded(PROGRAM, FAKE), "TASSILO_FAKE_CAMERA": script}
        self.serve(*arguments, source=(DEVICE, "--odometry", f"udp:127.0.0.1:{self.udp}"), env=environment, **options)
        ending = threading.Event()

        def drive():
            """A robot that turns and stops, whose odometry comes late, in bursts, twice, and out of order."""
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
                late, count = [], 0
                while not ending.wait(.013):
                    now, count = time.time(), count + 1
                    late.append(json.dumps({"t": now, "x": .3 * (now % 10), "y": .01 * (count % 7), "theta": .5 * (now % 6)}))
                    if count % 3 == 0:
                        lines = [*reversed(late), late[0]] if count % 2 else late
                        out.sendto(("\n".join(lines) + "\n").encode(), ("127.0.0.1", self.udp))
                        late = []
        driver = threading.Thread(target=drive)
        driver.start()
        self.addCleanup(lambda: (ending.set(), driver.join()))
        self.until(lambda: self.get("/api/state")["frames"] > 20)

    def test_what_was_known_when_is_known_again(self):
        self.serve_camera()
        scenes = Channel(self.port, "scene")
        self.put(True)
        self.until(lambda: self.recording()["frames"] > 20)
        self.change(localization="boundary")
        before = self.recording()["frames"]
        self.until(lambda: self.recording()["frames"] > before + 20)
        state = self.get("/api/state")
        self.assertGreater(state["latency_ms"], 0)
        self.assertLess(state["latency_ms"], 1000)
        self.assertEqual(state["web"]["viewers"], 1)
        self.assertIn("wait", json.loads(scenes.receive()[1])["timing_ms"])
        scenes.close()
        self.assertEqual(self.end()["parts"], 2)
        for part in self.parts():
            recorded = self.expect_replays(part, least=20)
            lines = [json.loads(line) for line in (part / "odometry.jsonl").read_text().splitlines()]
            self.assertGreater(len([line for line in lines if "frame" in line]), 10)
            self.assertGreater(recorded[0]["t"], 1.7e9)
            # The test means something: with all odometry known from the start other scenes come.
            (self.folder / "known.jsonl").write_text("".join(json.dumps({k: v for k, v in line.items() if k != "frame"}) + "\n" for line in lines))
            self.succeeds("run", "--robot", part / "robot.yaml", "--source", part / "video.mkv", "--odometry", "known.jsonl", "--output", "known_scenes.jsonl",
                          "--quiet")
            self.assertNotEqual(seen(self.scenes("known_scenes.jsonl")), seen(recorded))
        self.process.send_signal(signal.SIGINT)
        self.assertRegex(self.process.communicate(timeout=TIMEOUT_S)[0].decode(), r"latency from capture to scene: median [\d.]+ ms, p99 [\d.]+ ms\n")

    def test_killed_it_is_seen_again_up_to_its_last_frame(self):
        for wait in (8, 25):
            with self.subTest(wait):
                shutil.rmtree(self.folder / "recordings", ignore_errors=True)
                self.serve_camera()
                self.put(True)
                self.until(lambda: self.recording()["frames"] >= wait)
                frames = self.recording()["frames"]
                self.process.kill()
                self.process.communicate()
                part, = self.parts()
                recorded = self.scenes(part / "scenes.jsonl")
                self.assertGreaterEqual(len(recorded), frames)
                moved_code = self.tell("run", "--robot", part / "robot.yaml", "--source", part / "video.mkv", "--odometry", part / "odometry.jsonl", "--output",
                                       "killed.jsonl", "--quiet").code
                self.assertIn(moved_code, (0, 1))
                replayed = self.scenes("killed.jsonl")
                self.assertGreaterEqual(len(replayed), frames)
                common = min(len(replayed), len(recorded))
                self.assertEqual(seen(replayed[:common]), seen(recorded[:common]))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM FAKE_V4L2 [unittest arguments]")
    PROGRAM, FAKE = sys.argv[1], os.path.abspath(sys.argv.pop(2))
    main()
