#!/usr/bin/env python3
"""What `tassilo run --bus` says, heard by a program on another implementation of DDS (Fast DDS): the poses and scans of its scenes.

usage: tests/run_to_fast_dds_test.py PROGRAM FAST_DDS_PEER [unittest arguments]
"""
import json
import math
import subprocess
import sys
import time
import unittest

from bus_peer import Program, free_domain
from program import DATA, TIMEOUT_S, ProgramTest, main

RECORDING = DATA / "d01_approach"


class Stranger(ProgramTest):
    theirs = None

    def setUp(self):
        self.domain = free_domain()
        self.stranger = Program(self.theirs, str(self.domain))
        self.addCleanup(self.stranger.close)

    def ask(self, **wish):
        answer = json.loads(self.stranger.ask(json.dumps(wish)))
        self.assertNotIn("error", answer, wish)
        return answer

    def test_poses_and_scans_are_those_of_the_scenes(self):
        self.write("robot.yaml", f"robot: {{id: 5, team: cyan}}\ncamera: {RECORDING / 'camera.yaml'}\nfield: msl98\n")
        topics = {"pose": "rt/robot5/pose", "scan": "rt/robot5/scan"}
        for kind, topic in topics.items():
            self.ask(do="reader", topic=topic, type=kind, reliable=False)
        heard = {"pose": [], "scan": []}
        run = self.start("run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry",
                         RECORDING / "odometry.jsonl", "--output", "scenes.jsonl", "--bus", "--domain", self.domain, "-q",
                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + TIMEOUT_S
        while run.poll() is None and time.monotonic() < end:
            for kind, topic in topics.items():
                while (value := self.ask(do="take", topic=topic)["value"]) is not None:
                    heard[kind].append(value)
            time.sleep(.005)
        self.assertEqual((run.wait(), run.stderr.read()), (0, ""))
        run.stderr.close()
        scenes = self.scenes("scenes.jsonl")
        # Both find each other while it runs already: most of it is heard.
        self.assertGreater(len(heard["pose"]), len(scenes) / 4)
        self.assertGreater(len(heard["scan"]), 2)
        for pose in heard["pose"]:
            self.assertEqual(pose["frame_id"], "map")
            x, y, z, w = pose["orientation"]
            theta = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
            self.assertTrue(any(scene["pose"] and math.dist(pose["position"][:2], (scene["pose"]["x"], scene["pose"]["y"])) < 1e-5 and
                                abs(math.remainder(theta - scene["pose"]["theta"], 2 * math.pi)) < 1e-5 for scene in scenes), pose)
        for scan in heard["scan"]:
            self.assertEqual(scan["frame_id"], "robot5/free_space")
            ranges = [math.nan if value == "nan" else float(value) for value in scan["ranges"]]

            def is_that_of(space):
                if len(space["ranges"]) != len(ranges):
                    return False
                for a, b, state in zip(ranges, space["ranges"], space["state"]):
                    if state == "blocked" and abs(a - b) > 1e-5:
                        return False
                    if state != "blocked" and not (math.isnan(a) or a == math.inf):
                        return False
                return True
            self.assertTrue(any(is_that_of(scene["free_space"]) for scene in scenes))


if __name__ == "__main__":
    Stranger.theirs = sys.argv.pop(2)
    main()
