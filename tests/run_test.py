#!/usr/bin/env python3
"""From samples and a recording to scenes and their accuracy, on the recordings that the repository ships.

usage: tests/run_test.py PROGRAM [unittest arguments]
"""
import json
import random
import unittest

from program import DATA, ROOT, ProgramTest, ffmpeg, main, png_size, raw_bytes, train_colors, without_timing

try:
    import jsonschema
except ImportError:
    jsonschema = None

RECORDINGS = ("d01_approach", "d05_distract")
CLIP_FRAMES = 3


def robot(recording):
    return ("--robot", DATA / recording / "robot.yaml")


def recording_of(recording):
    return (*robot(recording), "--source", DATA / recording / "video.mkv", "--odometry", DATA / recording / "odometry.jsonl")


class Run(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.summaries = {r: cls.tell("run", *recording_of(r), "--colors", "div.yaml", "--output", f"{r}.jsonl", "--label-maps", f"maps/{r}")
                         for r in RECORDINGS}
        ffmpeg("-i", DATA / "d01_approach/video.mkv", "-c", "copy", "-frames:v", CLIP_FRAMES, cls.folder / "clip.mkv")

    def test_says_what_it_saw(self):
        for recording, result in self.summaries.items():
            self.judge(result, 0)
            self.assertIn("40 frames in", result.out)
            self.assertIn(", 0 dropped", result.out)
            self.assertIn("odometry: 40 of 40 frames\n", result.out)
            for word in ("ball", "cyan robot", "segment", "total", "median ms", "p99 ms", f"scenes: {recording}.jsonl", f"label maps: maps/{recording}"):
                self.assertIn(word, result.out)
            self.assertEqual(result.err, "")

    def test_every_line_is_as_the_schema_says(self):
        if jsonschema is None:
            self.skipTest("python3-jsonschema is not installed")
        validator = jsonschema.Draft202012Validator(json.loads((ROOT / "schema/scene.schema.json").read_text()))
        for recording in RECORDINGS:
            scenes = self.scenes(f"{recording}.jsonl")
            self.assertEqual([scene["frame"] for scene in scenes], list(range(40)))
            for scene in scenes:
                faults = [f"frame {scene['frame']}: {error.json_path}: {error.message}" for error in validator.iter_errors(scene)]
                self.assertEqual(faults, [])
                self.assertIsNotNone(scene["free_space"])
                self.assertGreaterEqual(scene["timing_ms"]["total"], 0)

    def test_the_ball_stays_the_same_ball(self):
        for recording in RECORDINGS:
            for scene in self.scenes(f"{recording}.jsonl"):
                if not scene["balls"]:
                    continue
                track = scene["tracks"][0]
                self.assertEqual((track["kind"], track["id"], track["age"]), ("ball", 1, 0))
                self.assertLess(abs(track["x"] - scene["balls"][0]["x"]) + abs(track["y"] - scene["balls"][0]["y"]), .05)

    def test_sees_what_is_there(self):
        pairs = [path for r in RECORDINGS for path in (DATA / r / "gt.jsonl", f"{r}.jsonl")]
        colors = [path for r in RECORDINGS for path in ("--colors", DATA / r / "labels", f"maps/{r}")]
        table = self.succeeds("eval", *pairs, *colors, "--json", "figures.json").out
        figures = json.loads((self.folder / "figures.json").read_text())
        self.assertEqual(set(figures["sequences"]), set(RECORDINGS))
        overall = figures["overall"]
        ball, goals, robots, free = overall["ball"], overall["goals"]["both"], overall["robots"], overall["free_space"]
        pose = overall["pose"]
        mean = figures["colors"]["overall"]
        self.assertEqual((overall["frames"], overall["frames_missing"], mean["missing"]), (80, 0, 0))
        at_least = {"ball recall": (ball["recall_best"], .95), "ball precision": (ball["precision_best"], .98),
                    "ball within near..far": (ball["bracketed"], .95),
                    "goals recall": (goals["recall"], .95), "goals precision": (goals["precision"], .98),
                    "robots recall": (robots["recall"], .90), "robots precision": (robots["precision"], .92), "robots team": (robots["team_right"], .95),
                    "free space coverage": (free["coverage"], .95), "pose known": (pose["share"], .97), "pose good": (pose["good_after_fix"], .9),
                    "colors recall": (mean["mean_recall"], .93), "colors precision": (mean["mean_precision"], .93)}
        at_most = {"ball error": (ball["error_relative"]["median"], .03), "ball bracket width": (ball["bracket_width_relative"], .12),
                   "pose wrong": (pose["wrong"], 0), "pose error": (pose["position_m"]["median"], .03), "heading": (pose["heading_deg"]["median"], .8),
                   "goals bearing": (goals["bearing_deg"]["median"], 1), "robots nearest point": (robots["to_nearest_m"]["median"], .12),
                   "free space dangerous": (free["dangerous"], .02), "free space timid": (free["timid"], .08)}
        faults = [f"{name} is {value}, must be >= {bound}" for name, (value, bound) in at_least.items() if not value >= bound]
        faults += [f"{name} is {value}, must be <= {bound}" for name, (value, bound) in at_most.items() if not value <= bound]
        self.assertEqual(faults, [], table)
        # Enough to judge by: an empty list of robots has no false ones.
        self.assertGreater(ball["frames"], 50)
        self.assertGreater(robots["robots"], 100)
        self.assertGreater(free["blocked"], 1000)

    def test_every_third_frame(self):
        run = ("run", *robot("d01_approach"), "--source", "clip.mkv", "--colors", "div.yaml", "--output", "third.jsonl", "--quiet")
        self.succeeds(*run, "--every", 3)
        self.assertEqual([scene["frame"] for scene in self.scenes("third.jsonl")], list(range(0, CLIP_FRAMES, 3)))

    def test_a_start_pose_decides_which_half(self):
        start = self.scenes("d01_approach.jsonl")[0]["pose"]
        run = ("run", *robot("d01_approach"), "--source", "clip.mkv", "--colors", "div.yaml", "--output", "start.jsonl", "--quiet")
        self.succeeds(*run, f"--start-pose={start['x'] + .1},{start['y'] - .1},{start['theta'] + .05}")
        pose = self.scenes("start.jsonl")[0]["pose"]
        self.assertLess(abs(pose["x"] - start["x"]) + abs(pose["y"] - start["y"]), .05)
        self.assertFalse(pose["mirror"])

    def test_same_frames_give_the_same_scenes(self):
        self.succeeds("run", *recording_of("d01_approach"), "--colors", "div.yaml", "--output", "again.jsonl", "--quiet", "--threads", 2)
        first, again = self.scenes("d01_approach.jsonl"), self.scenes("again.jsonl")
        self.assertEqual([without_timing(s) for s in first], [without_timing(s) for s in again])

    def test_odometry_in_any_order_gives_the_same_scenes(self):
        lines = (DATA / "d01_approach/odometry.jsonl").read_text().splitlines(keepends=True)
        shuffled = lines + lines[5:8]
        random.Random(1).shuffle(shuffled)
        times = [json.loads(line)["t"] for line in shuffled]
        late = sum(t < max(times[:k], default=t) and t not in times[:k] for k, t in enumerate(times))
        self.write("shuffled.jsonl", "".join(shuffled))
        result = self.succeeds("run", *robot("d01_approach"), "--source", DATA / "d01_approach/video.mkv", "--odometry", "shuffled.jsonl", "--colors", "div.yaml", "--output", "any_order.jsonl")
        self.assertIn(f"odometry: 40 of 40 frames; {late} samples out of order, 3 duplicate samples\n", result.out)
        expected = [without_timing(s) for s in self.scenes("d01_approach.jsonl")]
        self.assertEqual([without_timing(s) for s in self.scenes("any_order.jsonl")], expected)

    def test_odometry_on_standard_input_gives_the_same_scenes(self):
        run = ("run", *robot("d01_approach"), "--source", DATA / "d01_approach/video.mkv", "--odometry", "-", "--colors", "div.yaml", "--output", "piped.jsonl")
        lines = (DATA / "d01_approach/odometry.jsonl").read_text()
        result = self.succeeds(*run, input=(lines + '{"t": 99}\nnonsense\n').encode())
        self.assertIn("odometry: 40 of 40 frames\n", result.out)
        expected = [without_timing(s) for s in self.scenes("d01_approach.jsonl")]
        self.assertEqual([without_timing(s) for s in self.scenes("piped.jsonl")], expected)
        result = self.succeeds(*run, input=b'nonsense\n{"t": 99}\n')
        self.assertIn("odometry: 2 of 2 lines refused, the first: standard input:1: ", result.out)
        self.assertIn("odometry: 0 of 40 frames, 40 missing", result.out)

    def test_raw_frames_on_standard_input_give_the_same_scenes(self):
        raw = raw_bytes(DATA / "d01_approach/video.mkv", "yuv422p", CLIP_FRAMES)
        self.succeeds("run", *robot("d01_approach"), "--odometry", DATA / "d01_approach/odometry.jsonl", "--colors", "div.yaml", "--source", "-", "--format", "yuv422p", "--size", "384x172", "--range",
                      "limited", "--fps", 20, "--output", "raw.jsonl", "--quiet", input=raw)
        scenes = self.scenes("raw.jsonl")
        self.assertEqual([s.pop("t") for s in scenes], [k / 20 for k in range(CLIP_FRAMES)])
        expected = [without_timing(s) for s in self.scenes("d01_approach.jsonl")[:CLIP_FRAMES]]
        self.assertEqual([without_timing(s) for s in scenes], [{k: v for k, v in s.items() if k != "t"} for s in expected])

    def test_annotates_pictures_and_videos(self):
        for target in ("pictures", "video.mkv"):
            result = self.succeeds("run", *robot("d01_approach"), "--colors", "div.yaml", "--source", "clip.mkv", "--overlay", target)
            self.assertIn(f"annotated picture: {target}", result.out)
        pictures = sorted((self.folder / "pictures").iterdir())
        self.assertEqual([p.name for p in pictures], [f"{k:04}.png" for k in range(CLIP_FRAMES)])
        width, height = png_size(pictures[0].read_bytes())
        self.assertGreaterEqual(width, 384)
        video = ffmpeg("-i", self.folder / "video.mkv", "-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt", "gray", "-")
        self.assertEqual(len(video) % CLIP_FRAMES, 0)
        self.assertGreaterEqual(len(video) // CLIP_FRAMES, 384 * 172)

    def test_full_range_camera_with_its_own_table(self):
        ffmpeg("-i", DATA / "d06_vga/video.mkv", "-c", "copy", "-frames:v", 2, self.folder / "vga.mkv")
        train_colors(self, DATA / "train_vga/samples.yaml", "vga.yaml")
        self.succeeds("run", *robot("d06_vga"), "--colors", "vga.yaml", "--source", "vga.mkv", "--output", "vga.jsonl")
        self.assertTrue(all(scene["robots"] for scene in self.scenes("vga.jsonl")))

    def test_without_a_robot_file_it_sees_in_the_image(self):
        self.succeeds("run", "--colors", "div.yaml", "--source", "clip.mkv", "--output", "image.jsonl")
        for scene in self.scenes("image.jsonl"):
            self.assertIsNone(scene["free_space"])
            self.assertTrue(scene["balls"] and scene["robots"] and scene["goals"])
            self.assertIsNone(scene["balls"][0]["x"])


if __name__ == "__main__":
    main()
