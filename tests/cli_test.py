#!/usr/bin/env python3
"""What users also try: wrong files, wrong words, broken and odd recordings, pipes, Ctrl-C. Each gets one clear line, or a sensible scene.

usage: tests/cli_test.py PROGRAM [unittest arguments]
"""
import contextlib
import json
import os
import pathlib
import pty
import signal
import subprocess
import time
import unittest

from program import DATA, TIMEOUT_S, ProgramTest, decoded, ffmpeg, main, png_bytes, raw_bytes, Result, without_timing

APPROACH = DATA / "d01_approach"
VIDEO = APPROACH / "video.mkv"
ROBOT = ("--robot", APPROACH / "robot.yaml")
SEE = ("--colors", "div.yaml")
RAW = ("--format", "yuv420p", "--size", "384x172", "--range", "limited", "--fps", "10")


class CliTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        ffmpeg("-i", VIDEO, "-c", "copy", "-frames:v", 3, cls.folder / "clip.mkv")
        (cls.folder / "one.png").write_bytes(png_bytes(1, [bytes((255, 128, 0))]))

    def run_clip(self, *arguments):
        return ("run", "--source", "clip.mkv", *SEE, *arguments)


class Usage(CliTest):
    def test_nothing_said(self):
        result = self.refuses(says=("Usage: tassilo", "run", "train", "eval"))
        self.assertEqual(result.out, "")
        self.refuses("train", says=("Usage: tassilo train", "colors"))

    def test_words_that_are_not_known(self):
        self.refuses("rum", says=("'rum' is not known; did you mean run?", "`tassilo --help`"))
        self.refuses("bogus", says="'bogus' is not known")
        self.refuses("run", "--colours", "x.yaml", says=("'--colours' is not known; did you mean --colors?", "`tassilo run --help`"))
        self.refuses(*self.run_clip("--bogus"), says="'--bogus' is not known")
        self.refuses(*self.run_clip("extra"), says="'extra' is not known")
        self.refuses("train", "color", says="did you mean colors?")

    def test_what_is_missing(self):
        self.refuses("run", says="--source is required")
        self.refuses("run", "--source", says="--source")
        self.refuses("train", "colors", says="samples is required")
        self.refuses("train", "colors", "samples.yaml", says="--output is required")
        self.fails("run", "--source", "clip.mkv", says="--colors FILE")

    def test_values_that_are_none(self):
        self.refuses(*self.run_clip("--threads", "0"), says="--threads")
        self.refuses(*self.run_clip("--threads", "many"), says="--threads")
        self.refuses(*self.run_clip("--fps", "-1"), says="--fps")
        self.refuses(*self.run_clip("--format", "yuv999"), says=("yuv999", "nv12"))
        self.refuses(*self.run_clip("--range", "studio"), says=("studio", "limited"))
        self.refuses(*self.run_clip("--every", "0"), says="--every")
        for pose in ("1,2", "1,2,3,4,5,6", "1,2,north", "1,,3", "1,2,3,0", "1,2,nan", "1,2,3,"):
            with self.subTest(pose):
                self.refuses(*self.run_clip(f"--start-pose={pose}"), says=("--start-pose", pose, "must be X,Y,THETA"))

    def test_sizes_of_raw_frames(self):
        (self.folder / "some.yuv").write_bytes(b"\x80" * 1000)
        raw = ("run", "--source", "some.yuv", *SEE, "--format", "yuv420p", "--range", "limited", "--fps", "10")
        for size in ("384", "384X172", "x172", "384x", "384x172x3", "384x172.5", "axb", "", "99999999999x3"):
            with self.subTest(size):
                self.refuses(*raw, "--size", size, says="--size")
        for size in ("0x0", "-3x4", "99999x3"):
            with self.subTest(size):
                self.refuses(*raw, "--size", size, says=(size, "must be 1..32767"))
        self.refuses(*raw, says="--size WxH")
        self.refuses("run", "--source", "some.yuv", *SEE, "--size", "384x172", says="--format is missing")
        self.fails("run", "--source", "some.yuv", *SEE, says=("some.yuv", "raw frames need --format, --size, --range and --fps"))

    def test_help_and_version(self):
        self.assertIn("--odometry", self.succeeds("run", "--help").out)
        self.assertRegex(self.succeeds("--version").out, r"^\d+\.\d+\.\d+\n$")
        self.assertIn("mount_angle_sigma", self.succeeds("info", "--options").out)

    def test_stages(self):
        told = self.succeeds("info", "--stages").out
        self.assertRegex(told, r"\nfield_boundary: .+\n  \* subpixel .+\n    skeleton .+\n    boundary_reach +3  px +0.1 .. 100 ")
        self.write("stages.yaml", "vision: {field_boundary: skeleton, ball_max: 2}\n")
        told = self.succeeds("info", "--stages", "--robot", "stages.yaml").out
        self.assertRegex(told, r"\n    subpixel .+\n  \* skeleton ")
        self.assertRegex(told, r"\n    ball_max +5 .+; here 2\n")
        self.assertRegex(self.succeeds("info", "--options", "--robot", "stages.yaml").out, r"\nfield_boundary +subpixel, skeleton; here skeleton\n")
        self.write("stages.yaml", "vision: {field_boundary: skeletom}\n")
        self.fails("info", "--stages", "--robot", "stages.yaml", says=("stages.yaml:1:26", "did you mean skeleton?"))
        self.refuses("info", "--stages", "--options", says="excludes")
        self.refuses("info", "--robot", "stages.yaml", says="--stages is missing")

    def test_plugins_that_are_none(self):
        self.write("junk.so", "no library")
        self.write("plugins.yaml", "plugins: [none.so]\n")
        for verb in (("info", "--stages"), self.run_clip()):
            with self.subTest(verb):
                self.fails(*verb, "--plugin", "none.so", says="none.so: does not exist")
                self.fails(*verb, "--plugin", "junk.so", says="junk.so: cannot be loaded as a shared library: file too short")
                self.fails(*verb, "--robot", "plugins.yaml", says=("plugins.yaml: names none.so as a plug-in", "does not exist"))

    def test_kernels(self):
        self.assertIn("kernel: ", self.succeeds("info").out)
        plain = {**os.environ, "TASSILO_KERNEL": "plain"}
        self.assertIn("kernel: plain, chosen by TASSILO_KERNEL", self.succeeds("info", env=plain).out)
        self.fails("info", env={**os.environ, "TASSILO_KERNEL": "mmx"}, says=("TASSILO_KERNEL: is 'mmx'", "plain"))


class RobotFiles(CliTest):
    def robot(self, text):
        self.write("robot.yaml", text)
        return self.run_clip("--robot", "robot.yaml")

    def test_wrong_keys_and_values(self):
        camera = f"camera: {APPROACH / 'camera.yaml'}\n"
        for text, says in (("camra: camera.yaml\n", ("robot.yaml:1:1", "'camra'", "did you mean camera?")),
                           (f"{camera}field: msl98\nvision: {{ball_min_areaa: 3}}\n", ("robot.yaml:3:", "ball_min_areaa")),
                           (f"{camera}field: msl98\nvision: {{mount_height_sigma: 7}}\n", ("robot.yaml:3:", "mount_height_sigma")),
                           ("robot: {id: 300, team: cyan}\n", ("robot.yaml:1:13", "'300'", "<= 255")),
                           ("robot: {id: 1, team: green}\n", ("robot.yaml:1:22", "must be cyan or magenta")),
                           (f"{camera}field: msl99\n", ("robot.yaml", "'msl99'", "did you mean msl98?")),
                           (f"{camera}field: nofield.yaml\n", ("robot.yaml", "nofield.yaml", "does not exist")),
                           ("camera: nocamera.yaml\nfield: msl98\n", ("robot.yaml", "nocamera.yaml", "does not exist")),
                           (camera, ("robot.yaml", "`field:`")),
                           ("robot: {id: 1\n", ("robot.yaml:", "YAML")),
                           ("field: msl98\nfield: msl\n", ("robot.yaml:2:", "field")),
                           ("", ("robot.yaml", "is empty"))):
            with self.subTest(text):
                self.fails(*self.robot(text), says=says)

    def test_files_that_are_not_there(self):
        self.fails(*self.run_clip("--robot", "norobot.yaml"), says="norobot.yaml: cannot be opened")
        self.fails(*self.run_clip("--robot", "."), says="is a directory")
        self.write("robot.yaml", "field: msl98\ncolors: nocolors.yaml\n")
        self.fails("run", "--source", "clip.mkv", "--robot", "robot.yaml", says=("robot.yaml", "nocolors.yaml", "`tassilo train colors`", "--colors FILE"))
        self.fails("run", "--source", "clip.mkv", "--colors", "nocolors.yaml", says="nocolors.yaml: cannot be opened")
        self.fails("run", "--source", "clip.mkv", "--colors", APPROACH / "camera.yaml", says="camera.yaml:1:1")

    def test_camera_of_another_resolution(self):
        self.write("before.jsonl", "{}\n")
        self.write("robot.yaml", f"camera: {DATA / 'd06_vga/camera.yaml'}\nfield: msl98\n")
        self.fails(*self.run_clip("--robot", "robot.yaml", "--output", "before.jsonl"), says=("clip.mkv", "384x172", "640x480", "camera:"))
        self.assertEqual((self.folder / "before.jsonl").read_text(), "{}\n", "a run that cannot begin took the scenes of another")

    def test_table_of_another_range(self):
        self.fails("run", "--robot", DATA / "d06_vga/robot.yaml", *SEE, "--source", DATA / "d06_vga/video.mkv",
                   says=("d06_vga/video.mkv", "has full color range", "limited", "train"))


class OdometryFiles(CliTest):
    def odometry(self, lines):
        self.write("odometry.jsonl", "".join(line + "\n" for line in lines))
        return ("run", *ROBOT, *SEE, "--source", VIDEO, "--odometry", "odometry.jsonl", "--output", "odometry_scenes.jsonl")

    def test_starts_late(self):
        samples = (APPROACH / "odometry.jsonl").read_text().splitlines()
        begin = json.loads(samples[10])["t"]
        result = self.succeeds(*self.odometry(samples[10:]))
        scenes = self.scenes("odometry_scenes.jsonl")
        missing = [s["why"].get("odometry") for s in scenes]
        self.assertEqual(missing, ["missing at this time" if s["t"] < begin - .1 - 1e-9 else None for s in scenes])
        count = sum(text is not None for text in missing)
        self.assertTrue(0 < count < 11)
        self.assertIn(f"odometry: {40 - count} of 40 frames, {count} missing\n", result.out)

    def test_goes_back_in_time(self):
        samples = (APPROACH / "odometry.jsonl").read_text().splitlines()
        result = self.succeeds(*self.odometry(samples[:3] + samples[2:10] + samples[11:12] + samples[10:11] + samples[12:]))
        self.assertIn("odometry: 40 of 40 frames; 1 sample out of order, 1 duplicate sample\n", result.out)

    def test_has_a_long_gap(self):
        samples = (APPROACH / "odometry.jsonl").read_text().splitlines()
        begin, end = (json.loads(samples[k])["t"] for k in (7, 30))
        self.assertGreater(end - begin, 1)
        result = self.succeeds(*self.odometry(samples[:8] + samples[30:]))
        scenes = self.scenes("odometry_scenes.jsonl")
        missing = [s["t"] for s in scenes if "odometry" in s["why"]]
        self.assertEqual(missing, [s["t"] for s in scenes if s["t"] - begin > .1 and end - s["t"] > .1])
        self.assertIn(f"odometry: {40 - len(missing)} of 40 frames, {len(missing)} missing\n", result.out)

    def test_of_another_clock(self):
        line = '{"t":1700000000,"x":0,"y":0,"theta":0}'
        result = self.succeeds(*self.odometry([line]))
        self.assertIn("odometry: 0 of 40 frames, 40 missing: is it on the clock of the frames?\n", result.out)

    def test_lines_that_are_none(self):
        good = '{"t":0,"x":0,"y":0,"theta":0}'
        for line, says in (('{"t":1,"x":0,"y":0}', "theta"), ("hello", "JSON"), ("[1]", "must be a map"), ('{"t":1,"x":0,"y":0,"theta":NaN}', "JSON"),
                           ('{"t":"1","x":0,"y":0,"theta":0}', "finite number"), ('{"t":1,"x":0,"y":0,"theta":0,"z":1}', "'z'")):
            with self.subTest(line):
                self.fails(*self.odometry([good, line]), says=("odometry.jsonl:2", says))


class Pictures(CliTest):
    def test_one_pixel(self):
        self.succeeds("run", "--source", "one.png", *SEE, "--output", "one.jsonl", "--overlay", "one_overlay", "--label-maps", "one_maps")
        (scene,) = self.scenes("one.jsonl")
        self.assertEqual((scene["image"], scene["balls"], scene["robots"], scene["free_space"]), ("one.png", [], [], None))
        self.assertTrue((self.folder / "one_overlay/0000.png").exists() and (self.folder / "one_maps/0000.png").exists())
        self.fails("run", "--source", "one.png", *SEE, *ROBOT, says=("one.png", "is 1x1", "384x172"))

    def test_one_calibrated_pixel(self):
        camera = (APPROACH / "camera.yaml").read_text().replace("image_width: 384", "image_width: 1").replace("image_height: 172", "image_height: 1")
        self.write("pixel_camera.yaml", camera)
        self.write("pixel_robot.yaml", "camera: pixel_camera.yaml\nfield: msl98\n")
        result = self.tell("run", "--source", "one.png", *SEE, "--robot", "pixel_robot.yaml", "--output", "pixel.jsonl")
        # The camera's principal point lies outside of so small an image: either that is said, or there is a scene.
        self.judge(result, result.code)
        self.assertIn(result.code, (0, 1), result)
        if result.code == 0:
            (scene,) = self.scenes("pixel.jsonl")
            self.assertTrue(all(s != "free" or r > 0 for s, r in zip(scene["free_space"]["state"], scene["free_space"]["ranges"])))
        else:
            self.assertIn("pixel_camera.yaml", result.err)

    def test_large_photo(self):
        # Every 40 pixels another color, as no field ever is: many regions.
        palette = [(20, 20, 20), (240, 240, 240), (20, 120, 30), (30, 40, 200), (230, 110, 20), (230, 200, 20), (30, 200, 210), (220, 30, 200)]
        bands = [b"".join(bytes(palette[(c * 3 + k * 5) % 8]) * 40 for c in range(100)) for k in range(8)]
        (self.folder / "photo.png").write_bytes(png_bytes(4000, [bands[r // 40 % 8] for r in range(3000)]))
        result = self.succeeds("run", "--source", "photo.png", *SEE, "--output", "photo.jsonl")
        self.assertIn("4000x3000", result.out)
        (scene,) = self.scenes("photo.jsonl")
        self.assertEqual(scene["image"], "photo.png")
        for thing in scene["balls"] + scene["robots"] + scene["goals"]:
            x0, y0, x1, y1 = thing["box"]
            self.assertTrue(0 <= x0 < x1 <= 4000 and 0 <= y0 < y1 <= 3000, thing)
        self.assertGreater(scene["timing_ms"]["total"], 0)

    def test_not_one_green_pixel(self):
        ffmpeg("-f", "lavfi", "-i", "color=gray:size=384x172:duration=1:rate=5", "-pix_fmt", "yuv422p", "-c:v", "ffv1", self.folder / "gray.mkv")
        self.succeeds("run", *ROBOT, *SEE, "--source", "gray.mkv", "--output", "gray.jsonl")
        scenes = self.scenes("gray.jsonl")
        self.assertEqual(len(scenes), 5)
        for scene in scenes:
            self.assertEqual((scene["balls"], scene["goals"], scene["robots"], scene["lines"]), ([], [], [], []))
            self.assertNotIn("free", scene["free_space"]["state"])

    def test_folder_of_pictures(self):
        folder = self.folder / "pictures"
        folder.mkdir()
        ffmpeg("-i", VIDEO, "-frames:v", 3, folder / "%d.png")
        (folder / "notes.txt").write_text("no picture\n")
        self.succeeds("run", *ROBOT, *SEE, "--source", "pictures", "--output", "pictures.jsonl", "--fps", "10")
        scenes = self.scenes("pictures.jsonl")
        self.assertEqual([(s["frame"], s["image"], s["t"]) for s in scenes], [(0, "1.png", 0.0), (1, "2.png", .1), (2, "3.png", .2)])
        self.assertTrue(all(s["balls"] for s in scenes))

    def test_one_picture_of_a_folder_is_wrong(self):
        folder = self.folder / "mixed"
        folder.mkdir()
        ffmpeg("-i", VIDEO, "-frames:v", 2, folder / "%d.png")
        (folder / "3.png").write_bytes((self.folder / "one.png").read_bytes())
        result = self.fails("run", *ROBOT, *SEE, "--source", "mixed", "--output", "mixed.jsonl", says=("mixed/3.png", "is 1x1"))
        self.assertEqual(len(self.scenes("mixed.jsonl")), 2)
        self.assertIn("2 frames in", result.out)
        self.succeeds("run", *SEE, "--source", "mixed", "--output", "mixed.jsonl")
        self.assertEqual(len(self.scenes("mixed.jsonl")), 3)
        self.fails("run", *SEE, "--source", "mixed", "--overlay", "mixed.mkv", says=("mixed.mkv", "picture 2 is"))
        (folder / "3.png").write_bytes((folder / "2.png").read_bytes()[:1000])
        self.fails("run", *SEE, "--source", "mixed", "--output", "mixed.jsonl", says="mixed/3.png")
        self.assertEqual(len(self.scenes("mixed.jsonl")), 2)

    def test_photo_of_full_range(self):
        ffmpeg("-i", VIDEO, "-frames:v", 1, "-q:v", 2, self.folder / "photo.jpg")
        self.fails("run", *SEE, "--source", "photo.jpg", says=("photo.jpg", "full color range", "limited", "train"))
        ffmpeg("-i", DATA / "train_div/stills.mkv", "-frames:v", 1, self.folder / "still.png")
        self.write("full_samples.yaml", "- {image: still.png, class: green, rectangle: [310, 79, 353, 119]}\n")
        self.succeeds("train", "colors", "full_samples.yaml", "--output", "full.yaml", "--range", "full")
        self.succeeds("run", "--colors", "full.yaml", "--source", "photo.jpg")

    def test_names_of_all_kinds(self):
        for name in ("a b.png", 'quote".png', "ünï.png", os.fsdecode(b"bad\xff.png"), "--dash.png"):
            with self.subTest(repr(name)):
                (self.folder / name).write_bytes((self.folder / "one.png").read_bytes())
                self.judge(self.tell("run", *SEE, "--source=" + name, "--output", "name.jsonl"), 0)
                (scene,) = self.scenes("name.jsonl")
                self.assertEqual(scene["image"], name.encode("utf-8", "surrogateescape").decode("utf-8", "replace"))


class BrokenSources(CliTest):
    def test_not_there_or_empty(self):
        self.fails("run", *SEE, "--source", "novideo.mkv", says="novideo.mkv: does not exist")
        (self.folder / "empty.mkv").touch()
        self.fails("run", *SEE, "--source", "empty.mkv", says="empty.mkv: is empty")
        (self.folder / "empty").mkdir()
        self.fails("run", *SEE, "--source", "empty", says=("empty", "folder without images"))
        self.fails("run", *SEE, "--source", APPROACH / "gt.jsonl", says="gt.jsonl")
        self.fails("run", *SEE, "--source", "", says="source")

    def test_cut_video(self):
        (self.folder / "cut.mkv").write_bytes(VIDEO.read_bytes()[:500000])
        result = self.fails("run", *ROBOT, *SEE, "--source", "cut.mkv", "--output", "cut.jsonl", "--label-maps", "cut", says=("cut.mkv", "frame "))
        scenes = self.scenes("cut.jsonl")
        self.assertGreater(len(scenes), 5)
        self.assertIn(f"frame {len(scenes)} ", result.err)
        self.assertIn(f"{len(scenes)} frames in", result.out)
        self.assertEqual(len(list((self.folder / "cut").iterdir())), len(scenes))
        self.succeeds("run", *ROBOT, *SEE, "--source", VIDEO, "--output", "whole.jsonl", "--quiet")
        self.assertEqual([without_timing(s) for s in scenes], [without_timing(s) for s in self.scenes("whole.jsonl")[:len(scenes)]])

    def test_cut_before_the_first_frame(self):
        (self.folder / "cut0.mkv").write_bytes(VIDEO.read_bytes()[:3000])
        self.fails("run", *SEE, "--source", "cut0.mkv", "--output", "cut0.jsonl", says=("cut0.mkv", "frame 0"))
        self.assertFalse((self.folder / "cut0.jsonl").exists())

    def test_last_raw_frame_is_cut(self):
        raw = raw_bytes(VIDEO, "yuv420p", 2)
        result = self.fails("run", *SEE, "--source", "-", *RAW, "--output", "cutraw.jsonl", input=raw[:-1000], says=("standard input: frame 1 is cut short", "must be 99072"))
        self.assertEqual(len(self.scenes("cutraw.jsonl")), 1)
        self.assertIn("1 frames in", result.out)


class Pipes(CliTest):
    def test_encoded_standard_input(self):
        self.succeeds("run", *ROBOT, *SEE, "--source", "-", "--output", "stdin.jsonl", input=(self.folder / "clip.mkv").read_bytes())
        self.succeeds("run", *ROBOT, *SEE, "--source", "clip.mkv", "--output", "file.jsonl")
        self.assertEqual([without_timing(s) for s in self.scenes("stdin.jsonl")], [without_timing(s) for s in self.scenes("file.jsonl")])
        self.fails("run", *SEE, "--source", "-", input=b"", says="standard input")
        self.fails("run", *SEE, "--source", "-", input=b"\x80" * 5000, says=("standard input", "raw frames need --format"))

    def test_scenes_on_standard_output(self):
        result = self.succeeds(*self.run_clip("--output", "-"))
        self.assertEqual([json.loads(line)["frame"] for line in result.out.splitlines()], [0, 1, 2])
        self.assertIn("3 frames in", result.err)
        self.assertEqual(self.succeeds(*self.run_clip("--output", "-", "--quiet")).err, "")

    def test_progress_on_a_terminal(self):
        (self.folder / "cut.mkv").write_bytes(VIDEO.read_bytes()[:500000])
        ours, theirs = pty.openpty()
        child = self.start("run", *SEE, "--source", "cut.mkv", "--output", "terminal.jsonl", stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        with contextlib.suppress(OSError):  # how the end of a terminal looks
            while piece := os.read(ours, 4096):
                shown += piece
        os.close(ours)
        self.assertEqual(child.wait(TIMEOUT_S), 1)
        *progress, blank, end, _ = decoded(shown).replace("\r\n", "\n\r").split("\r")[1:]
        self.assertTrue(all(line.startswith("frame ") for line in progress) and progress, shown)
        self.assertEqual(blank.strip(), "", shown)
        self.assertTrue(end.startswith("tassilo: cut.mkv: frame "), shown)

    def test_full_device(self):
        self.fails(*self.run_clip("--output", "/dev/full"), says="/dev/full: cannot be written: No space left on device")
        with open("/dev/full", "wb") as full:
            self.fails(*self.run_clip("--output", "-"), stdout=full, says="standard output: cannot be written")
            self.fails(*self.run_clip(), stdout=full, says="standard output: cannot be written")
            self.fails("info", "--options", stdout=full, says="standard output: cannot be written")
            self.judge(self.tell(*self.run_clip("--quiet"), stderr=full), 0)

    def test_reader_that_goes(self):
        child = self.start("run", *ROBOT, *SEE, "--source", VIDEO, "--output", "-", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        first = child.stdout.readline()
        child.stdout.close()
        err = decoded(child.stderr.read())
        child.stderr.close()
        json.loads(first)
        result = self.judge(Result(["run", "| head -1"], child.wait(TIMEOUT_S), "", err), 1)
        self.assertIn("standard output: cannot be written: Broken pipe", result.err)

    def test_streams_that_are_closed(self):
        def without(number):
            return {"preexec_fn": lambda: os.close(number)}

        self.fails(*self.run_clip("--output", "closed.jsonl"), **without(1), says="standard output: cannot be written")
        self.assertEqual(len(self.scenes("closed.jsonl")), 3)  # nothing but scenes got into it
        self.fails(*self.run_clip("--output", "-"), **without(1), says="standard output: cannot be written")
        self.judge(self.tell(*self.run_clip("--output", "closed.jsonl"), **without(2)), 0)
        self.assertEqual(len(self.scenes("closed.jsonl")), 3)

    def test_output_that_cannot_be(self):
        self.fails(*self.run_clip("--output", "nofolder/x.jsonl"), says="nofolder/x.jsonl: cannot be opened for writing")
        self.fails(*self.run_clip("--output", "."), says="directory")
        self.fails(*self.run_clip("--overlay", "nofolder/x.mkv"), says="nofolder")
        self.fails(*self.run_clip("--overlay", "x.avi"), says=("x.avi", ".mkv or .mp4"))
        self.fails(*self.run_clip("--label-maps", "one.png"), says="one.png")

    def test_what_is_read_is_never_overwritten(self):
        pictures = self.folder / "own"
        pictures.mkdir()
        (pictures / "0000.png").write_bytes((self.folder / "one.png").read_bytes())
        os.symlink("clip.mkv", self.folder / "link.mkv")
        kept = {path: path.read_bytes() for path in (self.folder / "clip.mkv", self.folder / "div.yaml", self.folder / "div.png", pictures / "0000.png")}
        self.fails(*self.run_clip("--overlay", "clip.mkv"), says=("--overlay", "clip.mkv", "--source", "lost"))
        self.fails(*self.run_clip("--overlay", "link.mkv"), says=("--overlay", "lost"))
        self.fails(*self.run_clip("--output", "./div.yaml"), says=("--output", "color table", "lost"))
        self.fails(*self.run_clip("--output", "div.png"), says=("--output", "color table", "lost"))
        self.fails("run", *SEE, "--source", "own", "--label-maps", "own", says=("--label-maps", "own", "lost"))
        self.fails("run", *SEE, "--source", "own/0000.png", "--overlay", "own/", says=("--overlay", "lost"))
        self.fails(*self.run_clip("--overlay", "both", "--label-maps", "both"), says=("--label-maps", "--overlay"))
        self.assertEqual(kept, {path: path.read_bytes() for path in kept})

    def test_ctrl_c_ends_cleanly(self):
        endless = subprocess.Popen(["ffmpeg", "-nostdin", "-loglevel", "quiet", "-re", "-f", "lavfi", "-i", "testsrc2=size=384x172:rate=50",
                                    "-pix_fmt", "yuv420p", "-f", "rawvideo", "-"], stdout=subprocess.PIPE)
        self.addCleanup(endless.wait)
        self.addCleanup(endless.kill)
        child = self.start("run", *ROBOT, *SEE, "--source", "-", *RAW, "--output", "endless.jsonl", "--overlay", "endless.mkv", stdin=endless.stdout,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(child.kill)
        endless.stdout.close()
        scenes = self.folder / "endless.jsonl"
        self.wait_for(child, lambda: scenes.exists() and scenes.read_bytes().count(b"\n") >= 3)
        result = self.interrupted(child)
        self.assertIn("ended by a signal; all lines are complete", result.out)
        frames = len(self.scenes("endless.jsonl"))
        self.assertIn(f"{frames} frames in", result.out)
        self.assertTrue((self.folder / "endless.mkv").exists())
        self.assertFalse((self.folder / "endless.mkv.part.mkv").exists())

    def test_ctrl_c_before_the_first_frame(self):
        for raw in (RAW, ()):
            with self.subTest(raw):
                child = self.start("run", *SEE, "--source", "-", *raw, "--output", "never.jsonl", stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
                self.addCleanup(child.kill)
                self.wait_for(child, lambda: self.catches(child, signal.SIGINT))
                result = self.interrupted(child)
                child.stdin.close()
                self.assertIn("ended by a signal before the first frame", result.out)
                self.assertEqual(result.err, "")
                self.assertFalse((self.folder / "never.jsonl").exists())

    def wait_for(self, child, happens):
        end = time.monotonic() + TIMEOUT_S
        while not happens():
            self.assertIsNone(child.poll(), "the program ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(.02)

    @staticmethod
    def catches(child, number):
        status = pathlib.Path(f"/proc/{child.pid}/status").read_text()
        caught = next(line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:"))
        return bool(int(caught, 16) >> (number - 1) & 1)

    def interrupted(self, child):
        child.send_signal(signal.SIGINT)
        child.wait(TIMEOUT_S)
        out, err = decoded(child.stdout.read()), decoded(child.stderr.read())
        child.stdout.close()
        child.stderr.close()
        return self.judge(Result(["run", "and Ctrl-C"], child.returncode, out, err), 0)


class TrainColors(CliTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        ffmpeg("-i", DATA / "train_div/stills.mkv", "-frames:v", 1, cls.folder / "still.png")

    def train(self, *samples, options=()):
        """Arguments that train from these samples, each without its braces."""
        self.write("samples.yaml", "".join(f"- {{{sample}}}\n" for sample in samples))
        return ("train", "colors", "samples.yaml", "--output", "trained.yaml", *options)

    GREEN = "image: still.png, class: green, rectangle: [310, 79, 353, 119]"

    def test_samples_that_are_none(self):
        for text, says in (("", "is empty"), ("# nothing\n", "is empty"), ("[]\n", "holds no samples"), ("{}\n", "must be a list"), ("- 3\n", "samples.yaml:1:")):
            with self.subTest(text):
                self.write("samples.yaml", text)
                self.fails("train", "colors", "samples.yaml", "--output", "none.yaml", says=("samples.yaml", says))
        self.fails("train", "colors", "nosamples.yaml", "--output", "none.yaml", says="nosamples.yaml")
        self.assertFalse((self.folder / "none.yaml").exists() or (self.folder / "none.png").exists())

    def test_wrong_samples(self):
        where = "image: still.png, class: green"
        for sample, says in (("image: still.png, class: gren, rectangle: [0, 0, 9, 9]", ("'gren'", "did you mean green?")),
                             ("image: still.png, class: purple, rectangle: [0, 0, 9, 9]", ("'purple'", "magenta")),
                             ("image: noimage.png, class: green, rectangle: [0, 0, 9, 9]", ("noimage.png", "does not exist")),
                             ("image: still.png, frame: 3, class: green, rectangle: [0, 0, 9, 9]", ("still.png", "frame 3")),
                             ("image: still.png, frame: -1, class: green, rectangle: [0, 0, 9, 9]", ("'-1'",)),
                             (where, ("rectangle, polygon, stroke or mask",)),
                             (f"{where}, rectangle: [5, 5, 5, 9]", ("rectangle is empty",)),
                             (f"{where}, rectangle: [5, 5, 9]", ("rectangle",)),
                             (f"{where}, polygon: [[0, 0], [3, 3]]", ("3",)),
                             (f"{where}, polygon: [[.nan, 0], [3, 3], [0, 3]]", ("finite",)),
                             (f"{where}, polygon: [[1e9, 0], [3, 3], [0, 3]]", ("'1e9'",)),
                             (f"{where}, mask: nomask.png, value: 3", ("nomask.png",)),
                             (f"{where}, mask: still.png, value: 3", ("still.png", "8-bit gray"))):
            with self.subTest(sample):
                self.fails(*self.train(self.GREEN, sample), says=("samples.yaml:2", *says))

    def test_mask_of_another_size(self):
        (self.folder / "small.png").write_bytes(png_bytes(8, [bytes([3] * 8)] * 8, channels=1))
        self.fails(*self.train("image: still.png, class: green, mask: small.png, value: 3"), says=("samples.yaml:1", "small.png is 8x8", "384x172"))

    def test_polygons_outside_of_the_image(self):
        outside = "image: still.png, class: blue, polygon: [[1000, 1000], [1030, 1000], [1000, 1030]]"
        result = self.succeeds(*self.train(self.GREEN, outside))
        self.assertIn("warning: samples.yaml:2: blue has no pixel in the image (384x172); ignored", result.err)
        self.assertRegex(result.out, r"blue +0 +no samples: the class stays empty")
        self.fails(*self.train(outside), says=("warning:", "has no sample with a pixel in its image"))
        partly = "image: still.png, class: green, polygon: [[370, 100], [430, 100], [430, 130], [370, 130]]"
        self.assertRegex(self.succeeds(*self.train(partly)).err, r"warning: samples.yaml:1: green leaves the image; \d+ of \d+ pixels are used")

    def test_class_without_pixels_of_its_mask(self):
        labels = DATA / "train_div/labels/0000.png"
        result = self.succeeds(*self.train(self.GREEN, f"image: still.png, class: cyan, mask: {labels}, value: 77"))
        self.assertIn("warning: samples.yaml:2: cyan has no pixel", result.err)
        self.succeeds("run", "--colors", "trained.yaml", "--source", "clip.mkv")

    def test_overlapping_polygons(self):
        result = self.succeeds(*self.train(self.GREEN, "image: still.png, class: black, polygon: [[320, 80], [330, 80], [330, 119], [320, 119]]"))
        self.assertRegex(result.err, r"warning: samples.yaml:2: black shares \d+ pixels with green in line 1")

    def test_images_of_two_ranges(self):
        limited, full = (f"image: {DATA / name / 'stills.mkv'}, class: green, rectangle: [310, 79, 353, 119]" for name in ("train_div", "train_vga"))
        self.fails(*self.train(limited, limited, full, full),
                   says=("samples.yaml:3: ", "train_vga/stills.mkv has full color range, the image in line 1 has limited", "one range"))
        self.fails(*self.train(full, limited), says=("samples.yaml:2: ", "train_div/stills.mkv has limited color range, the image in line 1 has full"))

    def test_few_samples(self):
        self.assertIn("quality not measured", self.succeeds(*self.train(self.GREEN)).out)
        black = "image: still.png, class: black, rectangle: [0, 0, 9, 9]"
        result = self.succeeds(*self.train(self.GREEN, self.GREEN.replace("310", "320"), black))
        self.assertRegex(result.out, r"(?m)^green +[1-9]\d+ +[\d.]+ %")
        self.assertRegex(result.out, r"(?m)^black +0 +not measured +\d+\.\.\d+$", "a class is not bad for lack of a second sample")
        self.assertNotIn("black: {", (self.folder / "trained.yaml").read_text())
        self.fails(*self.train("image: still.png, class: no_color, rectangle: [0, 0, 9, 9]"), says=("samples.yaml", "no_color alone"))
        self.succeeds(*self.train("image: one.png, class: red, rectangle: [0, 0, 1, 1]"))
        self.succeeds("run", "--colors", "trained.yaml", "--source", "one.png")

    def test_options_out_of_range(self):
        self.refuses(*self.train(self.GREEN, options=("--outlier-share", "7")), says=("outlier_share", "is 7, must be in [0, 0.2]"))
        self.refuses(*self.train(self.GREEN, options=("--closing", "wide")), says="--closing")
        self.fails(*self.train(self.GREEN, options=("--test", "nosamples.yaml")), says="nosamples.yaml")

    def test_what_is_read_is_never_overwritten(self):
        arguments = self.train(self.GREEN)
        kept = {name: (self.folder / name).read_bytes() for name in ("samples.yaml", "still.png")}
        self.fails(*arguments[:-1], "samples.yaml", says=("--output", "samples.yaml", "lost"))
        self.fails(*arguments[:-1], "still.yaml", says=("PNG of --output", "still.png", "lost"))
        self.assertEqual(kept, {name: (self.folder / name).read_bytes() for name in kept})
        self.assertFalse((self.folder / "still.yaml").exists())


class Eval(CliTest):
    TRUTH = APPROACH / "gt.jsonl"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.tell("run", *ROBOT, *SEE, "--source", "clip.mkv", "--output", "clip.jsonl")

    def test_misuse(self):
        self.refuses("eval", says="TRUTH SCENES")
        self.refuses("eval", self.TRUTH, says="each TRUTH needs its SCENES")
        self.refuses("eval", "--colors", APPROACH / "labels", says="--colors")
        self.refuses("eval", "--balls", "x.json", says="--balls")
        self.refuses("eval", "--exclude", "a.png", self.TRUTH, "clip.jsonl", says="--balls")

    def test_files_that_are_wrong(self):
        text = (self.folder / "clip.jsonl").read_text()
        self.write("half.jsonl", text[:-100])
        self.write("twice.jsonl", text + text)
        self.write("empty.jsonl", "")
        for pair, says in (((self.TRUTH, "noscenes.jsonl"), "noscenes.jsonl"), (("notruth.jsonl", "clip.jsonl"), "notruth.jsonl"),
                           (("clip.jsonl", self.TRUTH), "clip.jsonl:1"), ((self.TRUTH, self.TRUTH), "gt.jsonl:1"), ((self.TRUTH, "half.jsonl"), "half.jsonl:3"),
                           ((self.TRUTH, "twice.jsonl"), "twice.jsonl:4"), ((self.TRUTH, "empty.jsonl"), "empty.jsonl"),
                           ((self.TRUTH, "clip.jsonl", "--meta", "nometa.json"), "nometa.json"), (("--colors", APPROACH / "labels", "nomaps"), "nomaps"),
                           (("--poses", self.TRUTH, "clip.jsonl"), "gt.jsonl"), (("--balls", "noballs.json", "clip.jsonl"), "noballs.json")):
            with self.subTest(pair):
                self.fails("eval", *pair, says=says)

    def test_a_run_that_ended_early(self):
        result = self.succeeds("eval", self.TRUTH, "clip.jsonl", "--json", "-")
        figures = json.loads(result.out)
        self.assertEqual((figures["overall"]["frames"], figures["overall"]["frames_missing"]), (40, 37))
        self.assertIn("37", result.err)

    def test_figures_go_where_they_may(self):
        kept = (self.folder / "clip.jsonl").read_bytes()
        self.fails("eval", self.TRUTH, "clip.jsonl", "--json", "clip.jsonl", says=("--json", "clip.jsonl", "lost"))
        self.assertEqual((self.folder / "clip.jsonl").read_bytes(), kept)
        self.fails("eval", self.TRUTH, "clip.jsonl", "--json", "nofolder/figures.json", says="nofolder/figures.json")
        # A pipe, as /dev/null, stays one. Never a real device here: the program that gets this wrong takes it away.
        os.mkfifo(self.folder / "pipe")
        reader = os.open(self.folder / "pipe", os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)
        self.succeeds("eval", self.TRUTH, "clip.jsonl", "--json", "pipe")
        self.assertTrue((self.folder / "pipe").is_fifo())
        self.assertEqual(json.loads(os.read(reader, 1 << 20))["overall"]["frames"], 40)


if __name__ == "__main__":
    main()
