#!/usr/bin/env python3
"""The same recording gives the same scenes: byte for byte but for the timing, whatever the threads, the way the frames come in and the kernel; and
`tassilo compare` says so. Two that differ are shown side by side.

usage: tests/replay_test.py PROGRAM [unittest arguments]
"""
import json
import os
import pathlib
import re
import subprocess
import unittest

from program import DATA, ROOT, SHARED, TIMEOUT_S, ProgramTest, main, raw_bytes, train_colors

SHIPPED = (DATA / "d01_approach", DATA / "d05_distract", DATA / "d06_vga")
CAMERA_OF = {"d06_vga": "vga", "d07_vga_window": "vga", "d08_xga": "xga"}
SIZE_OF = {"div": ("384x172", "limited"), "vga": ("640x480", "full")}
TIMING = re.compile(rb',"timing_ms":\{[^}]*\}')


class Replay(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        train_colors(cls, DATA / "train_vga/samples.yaml", "vga.yaml")
        cls.once = {recording: cls.run_on(recording, f"{recording.name}.jsonl") for recording in SHIPPED}

    @classmethod
    def run_on(cls, recording, output, *arguments, source=None, **options):
        colors = f"{CAMERA_OF.get(recording.name, 'div')}.yaml"
        return cls.tell("run", "--robot", recording / "robot.yaml", "--colors", colors, "--source", source or recording / "video.mkv",
                        "--odometry", recording / "odometry.jsonl", "--output", output, "--quiet", *arguments, **options)

    def lines(self, name):
        """The lines without their timing, as bytes; each has one."""
        lines = (self.folder / name).read_bytes().splitlines()
        bare = [TIMING.sub(b"", line) for line in lines]
        self.assertTrue(lines)
        self.assertTrue(all(len(a) < len(b) for a, b in zip(bare, lines)), f"{name} has a line without timing_ms")
        return bare

    def same(self, first, again):
        self.assertEqual(self.lines(first), self.lines(again))
        self.assertIn("the runs are equal", self.succeeds("compare", first, again, "--exit-code").out)

    def differ(self, first, again):
        """What `compare --json` says of two that are not the same."""
        self.judge(self.tell("compare", first, again, "--exit-code", "--json", "differences.json"), 3)
        return json.loads((self.folder / "differences.json").read_text())

    def test_whatever_the_threads(self):
        for recording, first in self.once.items():
            self.judge(first, 0)
            for run, threads in enumerate((1, 2, 4)):
                with self.subTest(recording=recording.name, threads=threads):
                    self.judge(self.run_on(recording, f"again{run}.jsonl", "--threads", threads), 0)
                    self.same(f"{recording.name}.jsonl", f"again{run}.jsonl")

    def test_raw_frames(self):
        for recording in SHIPPED:
            with self.subTest(recording.name):
                size, color_range = SIZE_OF[CAMERA_OF.get(recording.name, "div")]
                raw = raw_bytes(recording / "video.mkv", "yuv422p", 1000)
                self.judge(self.run_on(recording, "raw.jsonl", "--format", "yuv422p", "--size", size, "--range", color_range, "--fps", 20, "--threads", 2,
                                       source="-", input=raw), 0)
                self.same(f"{recording.name}.jsonl", "raw.jsonl")

    def test_encoded_frames_on_standard_input(self):
        recording = SHIPPED[0]
        self.judge(self.run_on(recording, "stdin.jsonl", source="-", input=(recording / "video.mkv").read_bytes()), 0)
        self.same(f"{recording.name}.jsonl", "stdin.jsonl")

    def test_whatever_the_kernel(self):
        """All kernels that this machine runs, the plain one at least."""
        told = self.succeeds("info", env={key: value for key, value in os.environ.items() if key != "TASSILO_KERNEL"}).out
        in_use, others = re.search(r"^kernel: ([\w-]+), .*; this machine also runs (.*) \(", told, re.MULTILINE).groups()
        kernels = [in_use, *(others.split(", ") if others != "no other" else [])]
        self.assertIn("plain", kernels)
        print(f"kernels: {', '.join(kernels)}")
        for kernel in kernels:
            for recording in SHIPPED:
                with self.subTest(kernel=kernel, recording=recording.name):
                    self.judge(self.run_on(recording, "kernel.jsonl", env={**os.environ, "TASSILO_KERNEL": kernel}), 0)
                    self.same(f"{recording.name}.jsonl", "kernel.jsonl")

    def test_a_part_of_the_frames(self):
        """Every other frame: the pose remembers, and which line of the field a line is follows from it; all else is told of each frame alone. Frames that
        are not there are named."""
        recording = SHIPPED[0]
        self.judge(self.run_on(recording, "other.jsonl", "--every", 2), 0)
        told = self.differ(f"{recording.name}.jsonl", "other.jsonl")
        self.assertEqual(told["frames"]["only_a"], list(range(1, 40, 2)))
        self.assertEqual((told["frames"]["only_b"], told["frames"]["both"], told["equal"]), ([], 20, False))
        for subject in ("t", "balls", "goals", "robots", "free_space"):
            self.assertEqual(told["differs_in"][subject], [], f"{subject} of a frame depends on another frame")

    def test_two_configurations_side_by_side(self):
        first = f"{SHIPPED[0].name}.jsonl"
        robot = "".join(f"{key}: {value}\n" for key, value in (("camera", SHIPPED[0] / "camera.yaml"), ("field", "msl98")))
        (self.folder / "b.yaml").write_text(robot + "vision: {free_space_sector: 4}\n")
        self.succeeds("run", "--robot", "b.yaml", "--colors", "div.yaml", "--source", SHIPPED[0] / "video.mkv", "--output", "b.jsonl", "--quiet")
        told = self.differ(first, "b.jsonl")
        self.assertEqual(told["free_space"]["other_sectors"], 40)
        self.assertEqual(told["differs_in"]["balls"], [])
        truth = SHIPPED[0] / "gt.jsonl"
        self.succeeds("compare", first, "b.jsonl", "--truth", truth, "--json", "both.json")
        both = json.loads((self.folder / "both.json").read_text())["truth"]
        for name, scenes in (("a", first), ("b", "b.jsonl")):  # the figures are those of eval
            self.succeeds("eval", truth, scenes, "--json", "one.json")
            self.assertEqual(both[name], json.loads((self.folder / "one.json").read_text()))

    def test_side_by_side_has_the_rows_of_eval(self):
        scenes, truth = f"{SHIPPED[0].name}.jsonl", SHIPPED[0] / "gt.jsonl"
        one = self.succeeds("eval", truth, scenes).out
        two = self.succeeds("compare", scenes, scenes, "--truth", truth).out
        two = two[two.index("against the truth"):]
        rows = [re.match(r"(.{12,}?)  +[-\d]", line) for line in one[:one.index("\ntime")].splitlines()[1:]]
        self.assertGreater(len(rows), 20)
        for row in rows:
            name = row.group(1).split("  ")[-1].strip()
            self.assertIn(name, two)
        self.assertNotRegex(two, r"[AB]\n")  # nobody is better than itself

    @unittest.skipUnless((SHARED / "data/msl98").is_dir(), "needs ../shared/data/msl98")
    def test_all_recordings(self):
        train_colors(self, SHARED / "data/msl98/train_xga/samples.yaml", "xga.yaml")
        for recording in sorted((SHARED / "data/msl98").glob("d0*")):
            with self.subTest(recording.name):
                for threads in (1, 4):
                    self.judge(self.run_on(recording, f"all{threads}.jsonl", "--threads", threads), 0)
                self.same("all1.jsonl", "all4.jsonl")


class Documents(ProgramTest):
    def test_commands_of_the_how_to(self):
        """docs/accuracy.md, two algorithms on one recording: its commands do what it says."""
        text = (ROOT / "docs/accuracy.md").read_text()
        section = text[text.index("## Two algorithms on one recording"):]
        commands = "".join(line[4:] + "\n" for line in re.search(r"\n\n((?:    .*\n|\n(?=    ))+)", section).group(1).splitlines())
        self.assertEqual(commands.count("tassilo "), 4, commands)
        (self.folder / "data").symlink_to(ROOT / "data")
        (self.folder / "bin").mkdir()
        (self.folder / "bin/tassilo").symlink_to(pathlib.Path(self.program))
        done = subprocess.run(["bash", "-euc", commands], cwd=self.folder, env={**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"},
                              capture_output=True, text=True, timeout=3 * TIMEOUT_S, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("against the truth", done.stdout)


class Misuse(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, recording in (("a", "d01_approach"), ("other", "d05_distract")):
            cls.tell("run", "--robot", DATA / recording / "robot.yaml", "--colors", "div.yaml", "--source", DATA / recording / "video.mkv", "--every", 20,
                     "--output", f"{name}.jsonl", "--quiet")

    def test_usage(self):
        self.refuses("compare", says="a is required")
        self.refuses("compare", "a.jsonl", says="b is required")
        self.refuses("compare", "a.jsonl", "a.jsonl", "--max-rows", "-1", says="--max-rows")
        self.refuses("compare", "a.jsonl", "a.jsonl", "--meta", "x.json", says="--truth")
        self.refuses("compare", "a.jsonl", "a.jsonl", "--exitcode", says="did you mean --exit-code?")
        told = self.succeeds("compare", "--help").out
        for word in ("--truth", "--meta", "--json", "--max-rows", "--exit-code", "exit with 3"):
            self.assertIn(word, told)

    def test_files_that_are_wrong(self):
        self.write("empty.jsonl", "")
        lines = (self.folder / "a.jsonl").read_text()
        self.write("half.jsonl", lines[:-50])
        self.write("late.jsonl", lines.replace('"t":1', '"t":7'))
        for pair, says in ((("a.jsonl", "empty.jsonl"), "empty.jsonl: has no lines"), (("half.jsonl", "a.jsonl"), "half.jsonl:2"),
                           (("a.jsonl", DATA / "d01_approach/gt.jsonl"), "gt.jsonl:1"), (("a.jsonl", "none.jsonl"), "none.jsonl"),
                           (("a.jsonl", "late.jsonl"), ("late.jsonl: frame 20 is at t = 7", "a.jsonl", "one recording")),
                           (("a.jsonl", "a.jsonl", "--truth", "a.jsonl"), "a.jsonl:1"), (("a.jsonl", "a.jsonl", "--truth", "none.jsonl"), "none.jsonl"),
                           (("a.jsonl", "a.jsonl", "--json", "a.jsonl"), ("--json", "lost"))):
            with self.subTest(pair):
                self.fails("compare", *pair, says=says)

    def test_exit_codes(self):
        self.succeeds("compare", "a.jsonl", "other.jsonl")
        self.assertIn("balls", self.judge(self.tell("compare", "a.jsonl", "other.jsonl", "--exit-code"), 3).out)
        result = self.judge(self.tell("compare", "a.jsonl", "other.jsonl", "--exit-code", "--json", "-"), 3)
        self.assertFalse(json.loads(result.out)["equal"])
        self.assertIn("differs in", result.err)


if __name__ == "__main__":
    main()
