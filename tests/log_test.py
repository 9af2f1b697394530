#!/usr/bin/env python3
"""Logs of `tassilo run --record NAME.mcap`, read by programs that are not ours: every value of every scene.

usage: tests/log_test.py PROGRAM [unittest arguments]
"""
import json
import math
import shutil
import signal
import subprocess
import time
import unittest

from bus_peer import free_domain
from program import DATA, ROOT, TIMEOUT_S, ProgramTest, main

RECORDING = DATA / "d01_approach"
TEAMS = {"unknown": 0, "cyan": 1, "magenta": 2}
KINDS = {"two_lines": 1, "one_line": 2, "predicted": 3, "goal": 4, "model": 5, "start": 6}


def heading(q):
    return math.atan2(2 * (q["w"] * q["z"] + q["x"] * q["y"]), 1 - 2 * (q["y"] ** 2 + q["z"] ** 2))


def number(value):
    return {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}.get(value, value) if isinstance(value, str) else value


class Log(ProgramTest):
    def setUp(self):
        if shutil.which("node") is None or not (ROOT / "webui/node_modules/@mcap/core").exists():
            self.skipTest("node or the packages of webui/ are not installed; tools/install_deps.sh installs them")
        self.write("robot.yaml", f"robot: {{id: 3, team: cyan}}\ncamera: {RECORDING / 'camera.yaml'}\nfield: msl98\n")
        self.run_arguments = ["run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry",
                              RECORDING / "odometry.jsonl"]

    def messages(self, name):
        """{topic: [message, ...]} as @mcap/core and the decoders of ROS 2 read them."""
        done = subprocess.run(["node", ROOT / "webui/e2e/read_mcap.mjs", self.folder / name], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=TIMEOUT_S, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        topics = {}
        for line in done.stdout.splitlines():
            message = json.loads(line)
            topics.setdefault(message["topic"], []).append(message)
        return topics

    def near(self, a, b, what, digits=5e-6):
        a = number(a)
        self.assertTrue(a == b or abs(a - b) <= digits * max(1, abs(b)), f"{what}: {a} is not {b}")

    def near_all(self, a, b, what):
        self.assertEqual(len(a), len(b), what)
        for i, (x, y) in enumerate(zip(a, b)):
            self.near(x, y, f"{what}[{i}]", 1e-5)

    def test_every_value_is_that_of_the_scenes(self):
        self.succeeds(*self.run_arguments, "--output", "scenes.jsonl", "--record", "run.mcap")
        scenes = self.scenes("scenes.jsonl")
        topics = self.messages("run.mcap")
        self.assertEqual(set(topics), {"/tf"} | {f"/robot3/{name}" for name in
                         ("pose", "odom", "scan", "free_space", "balls", "robots", "goals", "lines", "tracks", "team_state", "image/compressed")})
        self.assertEqual(topics["/robot3/pose"][0]["schema"], "geometry_msgs/msg/PoseWithCovarianceStamped")
        self.assertEqual(topics["/robot3/scan"][0]["schema"], "sensor_msgs/msg/LaserScan")
        # One message a scene, in its order; stamps as far apart as times.
        for name in ("free_space", "scan", "balls", "robots", "goals", "lines", "tracks", "team_state"):
            self.assertEqual(len(topics[f"/robot3/{name}"]), len(scenes), name)
        poses = iter(topics["/robot3/pose"])

        def seconds(message):
            stamp = message["message"]["header"]["stamp"]
            return stamp["sec"] + 1e-9 * stamp["nanosec"]

        offset = seconds(topics["/robot3/balls"][0]) - scenes[0]["t"]
        for i, scene in enumerate(scenes):
            got = {name: topics[f"/robot3/{name}"][i]["message"] for name in
                   ("free_space", "scan", "balls", "robots", "goals", "lines", "tracks", "team_state")}
            for name, message in got.items():
                self.near(seconds(topics[f"/robot3/{name}"][i]) - offset, scene["t"], name)
                self.assertEqual(message["header"]["frame_id"], "robot3/free_space" if name == "scan" else "robot3/base_link")
            if pose := scene["pose"]:
                message = next(poses)["message"]
                self.assertEqual(message["header"]["frame_id"], "map")
                at = message["pose"]["pose"]
                self.near_all([at["position"]["x"], at["position"]["y"], heading(at["orientation"])], [pose["x"], pose["y"], pose["theta"]], "pose")
                c = message["pose"]["covariance"]
                self.near_all([c[6 * r + k] for r in (0, 1, 5) for k in (0, 1, 5)], pose["cov"], "covariance")
                self.assertEqual(got["team_state"]["pose_kind"], KINDS[pose["kind"]])
                self.near(got["team_state"]["pose_age"], pose["age"], "age")
                self.assertEqual(got["team_state"]["pose_is_mirrored"], pose["mirror"])
            self.assertEqual(got["team_state"]["robot"], 3)
            self.assertEqual(got["team_state"]["team"], 1)
            self.assertEqual(len(got["balls"]["balls"]), len(scene["balls"]))
            for a, b in zip(got["balls"]["balls"], scene["balls"]):
                self.near_all([a["center"]["x"], a["center"]["y"], a["near"]], [b["x"], b["y"], b["near"]], "ball")
                self.near(a["confidence"], b["confidence"], "confidence", 1e-4)  # lines have four digits of it
                self.near(a["far"], math.inf if b["far"] is None else b["far"], "far")
                self.near_all(a["covariance"], b["cov"], "ball's covariance")
            self.assertEqual(len(got["robots"]["robots"]), len(scene["robots"]))
            for a, b in zip(got["robots"]["robots"], scene["robots"]):
                self.assertEqual(a["team"], TEAMS[b["team"]])
                self.near_all([a["nearest"]["x"], a["nearest"]["y"], a["center"]["x"], a["center"]["y"], a["width"], a["near"]],
                              [b["x"], b["y"], *b["center"], b["width"], b["near"]], "robot")
                self.near_all(a["covariance"], b["cov"], "robot's covariance")
            self.assertEqual(len(got["goals"]["goals"]), len(scene["goals"]))
            for a, b in zip(got["goals"]["goals"], scene["goals"]):
                self.assertEqual(a["color"], ["yellow", "blue"].index(b["color"]))
                self.near(a["bearing"], b["bearing"], "bearing")
                self.assertEqual(len(a["posts"]), len(b["posts"]))
                if b["x"] is None:
                    self.assertTrue(math.isnan(number(a["center"]["x"])))
                else:
                    self.near_all([a["center"]["x"], a["center"]["y"]], [b["x"], b["y"]], "goal")
            straight = [line for line in scene["lines"] if line["kind"] != "circle"]
            self.assertEqual(len(got["lines"]["lines"]), len(straight))
            for a, b in zip(got["lines"]["lines"], straight):
                self.assertEqual((a["kind"], a["model"]), (["line", "boundary"].index(b["kind"]), b["model"] or ""))
                self.near_all([a["p"]["x"], a["p"]["y"], a["q"]["x"], a["q"]["y"]], [*b["p"], *b["q"]], "line")
            self.assertEqual(len(got["lines"]["circles"]), len(scene["lines"]) - len(straight))
            free, space = got["free_space"], scene["free_space"]
            self.near_all([free["origin"]["x"], free["origin"]["y"], free["angle_min"], free["angle_increment"]],
                          [*space["origin"], space["angle_min"], space["angle_increment"]], "free space")
            for a, scan, b, state in zip(free["ranges"], got["scan"]["ranges"], space["ranges"], space["state"]):
                if state == "unseen":
                    self.assertTrue(math.isnan(number(a)) and math.isnan(number(scan)))
                    continue
                self.near(a, b, "range")
                if state == "blocked":
                    self.near(scan, b, "range of the scan")
                else:  # clears what is before it, so only where all of it was seen
                    self.assertTrue(number(scan) == math.inf if b >= free["range_max"] else math.isnan(number(scan)), (scan, b))
            self.assertEqual(free["states"], [["unseen", "free", "blocked"].index(state) for state in space["state"]])
            self.assertEqual(len(got["tracks"]["tracks"]), len(scene["tracks"]))
            for a, b in zip(got["tracks"]["tracks"], scene["tracks"]):
                self.assertEqual((a["id"], a["kind"], a["team"]), (b["id"], ["ball", "robot"].index(b["kind"]), TEAMS[b["team"] or "unknown"]))
                self.near_all([a["position"]["x"], a["position"]["y"], a["velocity"]["x"], a["velocity"]["y"], a["age"]],
                              [b["x"], b["y"], b["vx"], b["vy"], b["age"]], "track")
                self.near_all(a["covariance"], b["cov"], "track's covariance")
        self.assertEqual(list(poses), [])
        for picture in topics["/robot3/image/compressed"]:
            self.assertEqual(picture["message"]["format"], "jpeg")
            self.assertGreater(picture["message"]["data"]["bytes"], 2000)

    def test_what_a_killed_run_leaves_is_read_to_its_last_second(self):
        # In real time, so that it is still at it when it is killed.
        process = self.start(*self.run_arguments, "--bus", "--domain", free_domain(), "--record", "killed.mcap", stdout=subprocess.DEVNULL)
        path = self.folder / "killed.mcap"
        end = time.monotonic() + TIMEOUT_S
        while not (path.exists() and path.stat().st_size > 200_000):
            self.assertLess(time.monotonic(), end)
            time.sleep(.05)
        process.kill()
        process.wait()
        topics = self.messages("killed.mcap")
        self.assertGreater(len(topics["/robot3/balls"]), 10)
        self.monitor_shows("killed.mcap")

    def monitor_shows(self, name):
        process = self.start("monitor", name, "--port", "0", stdout=subprocess.PIPE, text=True)
        line = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=TIMEOUT_S)
        self.assertIn("http://127.0.0.1:", line)
        self.assertEqual(process.returncode, 0)

    def test_a_log_is_not_replaced_and_a_full_disk_is_told(self):
        self.succeeds(*self.run_arguments, "--record", "once.mcap", "-q")
        before = (self.folder / "once.mcap").read_bytes()
        self.fails(*self.run_arguments, "--record", "once.mcap", "-q", says="once.mcap")
        self.assertEqual((self.folder / "once.mcap").read_bytes(), before)
        limited = subprocess.run(["bash", "-c", 'ulimit -f 300; trap "" XFSZ; exec "$@"', "limited", self.program, *map(str, self.run_arguments),
                                  "--record", "full.mcap", "-q"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                 timeout=TIMEOUT_S)
        self.assertEqual(limited.returncode, 1, limited.stderr)
        self.assertIn("full.mcap", limited.stderr)
        self.messages("full.mcap")


if __name__ == "__main__":
    main()
