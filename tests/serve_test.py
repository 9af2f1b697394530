#!/usr/bin/env python3
"""`tassilo serve` as browsers and programs use it: state, stages, scenes and pictures, and those who may not.

usage: tests/serve_test.py PROGRAM [unittest arguments]
"""
import base64
import hashlib
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import time
import unittest

from program import DATA, ROOT, SHARED, TIMEOUT_S, ProgramTest, main, png_size, without_timing

try:
    import jsonschema
except ImportError:
    jsonschema = None

RECORDING = DATA / "d01_approach"
CALIBRATION = SHARED / "data/msl98/calibration"
TOKEN = "0123456789abcdefABCDEF"


class Channel:
    """A WebSocket by hand: just enough of RFC 6455 to listen."""

    def __init__(self, port, name, headers=()):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=TIMEOUT_S)
        self.stream = self.socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET /ws/{name} HTTP/1.1", f"Host: 127.0.0.1:{port}", "Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13",
                 f"Sec-WebSocket-Key: {key}", *headers]
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.status = int(self.stream.readline().split()[1])
        answer = {}
        while (line := self.stream.readline().strip()):
            name, _, value = line.decode().partition(":")
            answer[name.lower()] = value.strip()
        if self.status == 101:
            accept = base64.b64encode(hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()).decode()
            assert answer["sec-websocket-accept"] == accept

    def receive(self):
        """(is text, bytes) of the next message; pings are passed over."""
        while True:
            first, second = self.stream.read(2)
            length = second & 127
            if length == 126:
                length, = struct.unpack(">H", self.stream.read(2))
            elif length == 127:
                length, = struct.unpack(">Q", self.stream.read(8))
            data = self.stream.read(length)
            if first & 15 in (1, 2):
                return first & 15 == 1, data

    def close(self):
        self.stream.close()
        self.socket.close()


class Served(ProgramTest):
    """A server to ask; other tests of it begin with this, too."""

    def serve(self, *arguments, robot="robot.yaml", colors="div.yaml",
              source=(RECORDING / "video.mkv", "--odometry", RECORDING / "odometry.jsonl"), **options):
        """Starts the program on a port of its choice and waits until frames are seen."""
        colors = ["--colors", colors] if colors else []
        self.process = self.start("serve", "--robot", robot, *colors, "--source", *source, "--port", "0", *arguments,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(self.stop)
        self.said = self.process.stdout.readline().decode()
        self.port = int(re.search(r"http://[\d.]+:(\d+)/", self.said)[1])
        return self.port

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def ask(self, method, path, body=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT_S)
        connection.request(method, path, body, headers or {})
        answer = connection.getresponse()
        data = answer.read()
        connection.close()
        return answer.status, data, answer

    def get(self, path):
        status, data, _ = self.ask("GET", path)
        self.assertEqual(status, 200, data)
        return json.loads(data)

    def until(self, holds):
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:
            if (value := holds()):
                return value
            time.sleep(.02)
        self.fail("waited in vain")

    def setUp(self):
        shutil.copy(RECORDING / "camera.yaml", self.folder / "camera.yaml")
        self.write("robot.yaml", "{camera: camera.yaml, field: msl98}\n")

    def send(self, method, path, value, status=200):
        got, data, _ = self.ask(method, path, json.dumps(value), {"Content-Type": "application/json"})
        self.assertEqual(got, status, data)
        return json.loads(data) if got == 200 else data.decode()

    def training_folder(self):
        """A robot file with a color table of its own."""
        training = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        shutil.copy(RECORDING / "camera.yaml", training)
        for name in ("div.yaml", "div.png"):
            shutil.copy(self.folder / name, training)
        (training / "robot.yaml").write_text("{camera: camera.yaml, field: msl98, colors: div.yaml}\n")
        return training


class Serve(Served):
    def test_shows_what_it_sees(self):
        port = self.serve()
        scenes, pictures = Channel(port, "scene"), Channel(port, "picture")
        is_text, data = scenes.receive()
        self.assertTrue(is_text)
        scene = json.loads(data)
        if jsonschema is not None:
            jsonschema.Draft202012Validator(json.loads((ROOT / "schema/scene.schema.json").read_text())).validate(scene)
        self.assertTrue(scene["balls"])
        self.assertEqual(scene["pose"]["kind"], "model")
        is_text, picture = pictures.receive()
        self.assertFalse(is_text)
        self.assertRegex(picture[:2000], rb"frame \d+")
        self.assertEqual((picture[:2], picture[-2:]), (b"\xff\xd8", b"\xff\xd9"))
        # The picture is whole: another program decodes it.
        decoded = subprocess.run(["ffmpeg", "-loglevel", "error", "-f", "mjpeg", "-i", "-", "-f", "rawvideo", "-pix_fmt", "gray", "-"], input=picture,
                                 stdout=subprocess.PIPE, timeout=TIMEOUT_S, check=True).stdout
        self.assertGreater(len(decoded), 768 * 344)
        # A file plays in real time, and again and again.
        frames = [json.loads(scenes.receive()[1])["frame"] for _ in range(60)]
        self.assertIn(0, frames)
        state = self.get("/api/state")
        self.assertGreaterEqual(state["frames"], 60)
        self.assertLess(abs(state["rate_hz"] - 20), 10)
        self.assertEqual(state["dropped"], 0)
        self.assertEqual(state["field"]["length"], 8.22)
        self.assertEqual([goal["color"] for goal in state["field"]["goals"]], ["blue", "yellow"])
        self.process.send_signal(signal.SIGINT)
        out, err = self.process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(self.process.returncode, 0, err)
        self.assertIn(b"ended by a signal", out)
        self.assertIn(b", 0 dropped", out)
        for channel in (scenes, pictures):
            channel.close()

    def test_scenes_are_those_of_a_run_whoever_listens(self):
        self.succeeds("run", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--odometry",
                      RECORDING / "odometry.jsonl", "--output", "run.jsonl", "--quiet")
        port = self.serve("--output", "serve.jsonl")
        listeners = [Channel(port, name) for name in ("scene", "scene", "picture", "picture")]  # four clients, two of whom take nothing
        self.until(lambda: self.process.poll() is not None)
        for listener in listeners:
            listener.close()
        self.assertEqual([without_timing(scene) for scene in self.scenes("serve.jsonl")],
                         [without_timing(scene) for scene in self.scenes("run.jsonl")])

    def test_stages_are_exchanged_while_it_runs(self):
        port = self.serve()
        scenes = Channel(port, "scene")
        scenes.receive()
        stages = {stage["key"]: stage for stage in self.get("/api/stages")}
        chosen = {key: [a["name"] for a in stage["alternatives"] if a["chosen"]] for key, stage in stages.items()}
        self.assertEqual(chosen["localization"], ["model"])
        status, data, _ = self.ask("PUT", "/api/stages", json.dumps({"localization": "boundary", "ball_max": 3}))
        self.assertEqual(status, 200, data)
        stages = {stage["key"]: stage for stage in json.loads(data)}
        self.assertTrue(stages["localization"]["changed"])
        option = next(o for o in stages["balls"]["options"] if o["key"] == "ball_max")
        self.assertEqual((option["value"], option["changed"], option["default"]), (3, True, 5))
        kinds = ("two_lines", "one_line", "predicted")
        self.until(lambda: json.loads(scenes.receive()[1])["pose"]["kind"] in kinds)
        for body, says in (({"ball_max": 300}, "must be >= 1"), ({"localization": "magic"}, "model or boundary"), ({"ball_mx": 3}, "did you mean"),
                           ("[1", "JSON"), ("[1]", "map"), ({"ball_max": [1]}, "ball_max")):
            status, data, _ = self.ask("PUT", "/api/stages", body if isinstance(body, str) else json.dumps(body))
            self.assertEqual(status, 400, data)
            self.assertIn(says, data.decode())
        self.assertIn(json.loads(scenes.receive()[1])["pose"]["kind"], kinds, "the former one goes on")
        # What was chosen here outlasts a change of the file; null gives it back to the file.
        self.write("robot.yaml", "{camera: camera.yaml, field: msl98, vision: {ball_max: 7}}\n")
        self.until(lambda: self.get("/api/state")["configuration"]["taken_over"] >= 2)
        values = lambda: {o["key"]: o["value"] for stage in self.get("/api/stages") for o in stage["options"]}
        self.assertEqual(values()["ball_max"], 3)
        self.ask("PUT", "/api/stages", json.dumps({"ball_max": None, "localization": "model"}))
        self.assertFalse(any(stage["changed"] for stage in self.get("/api/stages")), "back to what the file says is no change")
        self.assertEqual(values()["ball_max"], 7)
        self.until(lambda: json.loads(scenes.receive()[1])["pose"]["kind"] == "model")
        scenes.close()

    @staticmethod
    def frame_of(data):
        """(width, height, full range, index, Y rows) of the bytes of a frame."""
        magic, width, height, full, index, _ = struct.unpack("<4sIIIqd", data[:32])
        assert magic == b"TYUV" and len(data) == 32 + height * (width + 2 * ((width + 1) // 2))
        return width, height, full, index

    def test_frames_come_as_they_are_classified(self):
        self.serve()
        channel = Channel(self.port, "frame")
        is_text, data = channel.receive()
        channel.close()
        self.assertFalse(is_text)
        width, height, full, index = self.frame_of(data)
        self.assertEqual((width, height, full), (384, 172, 0))
        kept = self.send("POST", "/api/training/images", {"frame": index})
        status, again, _ = self.ask("GET", f"/api/training/images/{kept['id']}")
        self.assertEqual((status, again), (200, data))
        # Nobody listens: the next one is kept.
        kept = self.send("POST", "/api/training/images", {"frame": None})
        self.assertFalse(kept["kept"])
        self.assertGreater(self.frame_of(self.ask("GET", f"/api/training/images/{kept['id']}")[1])[3], -1)

    def test_colors_are_trained_saved_taken_over_and_rolled_back(self):
        training = self.training_folder()
        self.serve(robot=training / "robot.yaml", colors=None)
        self.until(lambda: self.get("/api/state")["frames"] > 0)
        before = self.get("/api/training")
        self.assertEqual(before["files"]["refusal"], "")
        self.assertEqual((before["samples"], before["history"], before["is_saved"]), ([], [], True))
        table = self.get("/api/training/table")
        image = self.send("POST", "/api/training/images", {})["id"]
        draft = {"version": before["version"], "options": {"closing_px": 7}, "brightness": {"green": [40, 200]},
                 "samples": [{"image": image, "class": "green", "rectangle": [180, 140, 220, 165]},
                             {"image": image, "class": "green", "stroke": [[150, 150], [170, 160]], "radius": 4}]}
        result = self.send("PUT", "/api/training/draft?class=green", draft)
        self.assertEqual(result["version"], before["version"] + 1)
        self.assertEqual(result["table"]["brightness"], {"green": [40, 200]})
        self.assertEqual([c["samples"] for c in result["classes"] if c["class"] == "green"], [2])
        self.assertEqual(len(base64.b64decode(result["table"]["chroma"])), 65536)
        density = base64.b64decode(result["seen"]["density"])
        self.assertEqual(max(density), 255)
        self.assertEqual(sum(result["seen"]["brightness"]), sum(c["pixels"] for c in result["classes"]))
        # Densest where the table says green.
        self.assertTrue(base64.b64decode(result["table"]["chroma"])[density.index(255)] & 1 << 2)

        self.assertIn("somebody else", self.send("PUT", "/api/training/draft", draft, 409))
        self.assertIn("closing_px", self.send("PUT", "/api/training/draft", draft | {"options": {"closing_px": 99}}, 400))
        self.assertIn("must be one of the pictures",
                      self.send("PUT", "/api/training/draft", draft | {"version": result["version"], "samples": [draft["samples"][0] | {"image": "9"}]}, 409))
        self.until(lambda: self.get("/api/training/quality")["version"] == result["version"])

        self.assertIn("version", self.send("POST", "/api/training/save", {"version": 0}, 409))
        self.assertEqual(sorted(path.name for path in training.iterdir()), ["camera.yaml", "div.png", "div.yaml", "robot.yaml"])
        saved = self.send("POST", "/api/training/save", {"version": result["version"], "notes": "in the test"})
        self.assertTrue(saved["is_saved"] and saved["images"][0]["kept"])
        self.assertEqual([entry["in_use"] for entry in saved["history"]], [True, False])
        self.assertTrue(saved["history"][0]["notes"].startswith("in the test"))
        self.assertRegex(saved["history"][0]["date"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertEqual(self.get("/api/training/table"), result["table"])
        self.until(lambda: self.get("/api/state")["configuration"]["taken_over"] > 0)
        self.assertEqual(self.get("/api/state")["configuration"]["refusal"], "")
        # The command line makes the same of the same files.
        done = self.tell("train", "colors", training / "samples.yaml", "-o", training / "again.yaml", "--closing", "7", "--brightness", "green=40,200")
        self.assertEqual(done.code, 0, done)
        named = re.search("table: (.*)", (training / "div.yaml").read_text())[1]
        self.assertEqual((training / "again.png").read_bytes(), (training / named).read_bytes())

        back = self.send("POST", "/api/training/restore", {"id": saved["history"][1]["id"]})
        self.assertEqual([entry["in_use"] for entry in back["history"]], [False, True])
        self.assertEqual(self.get("/api/training/table"), table)
        self.assertEqual(len(back["samples"]), 2)
        self.send("POST", "/api/training/restore", {"id": "../../div"}, 404)
        self.assertEqual(self.ask("DELETE", f"/api/training/images/{image}")[0], 409)
        self.assertEqual(self.ask("DELETE", "/api/training/images/x")[0], 404)

    def test_training_starts_from_the_samples_file(self):
        self.serve("--samples", DATA / "train_div/samples.yaml")
        self.until(lambda: self.get("/api/state")["frames"] > 0)
        training = self.get("/api/training")
        self.assertEqual(training["files"]["refusal"], "")
        self.assertEqual({entry["class"] for entry in training["samples"]}, {"black", "white", "green", "blue", "cyan", "magenta", "red", "yellow"})
        self.assertTrue(all(image["kept"] for image in training["images"]))
        # The table in use was trained from the same file.
        self.assertEqual(self.get("/api/training/result")["table"], self.get("/api/training/table"))

    def test_a_target_is_looked_for(self):
        self.succeeds("calibrate", "target", "dots:7x7:0.02:0.005", "--output", "target.png")
        self.write("no_camera.yaml", "{colors: div.yaml}\n")
        self.serve(robot="no_camera.yaml", colors=None, source=("target.png",))
        self.until(lambda: self.get("/api/state")["frames"] > 0)
        state = self.get("/api/calibration")
        self.assertEqual((state["is_on"], state["views"], state["result"], state["now"]), (False, [], None, None))
        self.assertIn("names no `camera:`", state["file"]["refusal"])
        self.assertIn("is not on", self.send("POST", "/api/calibration/views", {}, 409))
        for body, says in (({"targets": []}, "targets"), ({"targets": ["dots:7x7:0.02:0.005"] * 5}, "targets"), ({"targets": ["stars:7x7:0.02"]}, "must be dots"),
                           ({"targets": ["dots:7x7:0." + "0" * 1000 + "2:0.005"]}, "letters"), ({"targets": "dots:7x7:0.02:0.005"}, "list"),
                           ({"model": "fisheye"}, "model"), ({"is_on": "perhaps"}, "is_on"), ({"on": True}, "on"), ("{", "JSON"), ([], "map")):
            text = body if isinstance(body, str) else json.dumps(body)
            status, data, _ = self.ask("PUT", "/api/calibration", text)
            self.assertEqual(status, 400, data)
            self.assertIn(says, data.decode())
        state = self.send("PUT", "/api/calibration", {"is_on": True, "targets": ["checker:9x6:0.02", "dots:7x7:0.02:0.005"], "model": "equidistant"})
        self.assertEqual((state["is_on"], state["model"], state["targets"]), (True, "equidistant", ["checker:9x6:0.02", "dots:7x7:0.02:0.005"]))
        view, = self.until(lambda: self.get("/api/calibration")["views"])
        self.assertEqual((view["target"], len(view["points"]), view["rms_px"], view["rejected"]), ("dots:7x7:0.02:0.005", 49, None, ""))
        state = self.until(lambda: (now := self.get("/api/calibration"))["now"]["verdict"] == f"like view {view['id']}" and now)
        self.assertEqual((state["now"]["target"], state["now"]["is_captured"]), (view["target"], False))
        self.assertEqual((state["width"], state["height"]), png_size((self.folder / "target.png").read_bytes()))
        self.assertEqual(sum(state["coverage"]["points"]), 49)
        self.assertEqual(len(self.send("POST", "/api/calibration/views", {})["views"]), 2, "asked for, however alike")
        self.assertIn("must be at least 3", self.send("POST", "/api/calibration/solve", {}, 409))
        self.assertIn("not worked out", self.send("POST", "/api/calibration/save", {}, 409))
        self.assertEqual(self.ask("GET", "/api/calibration/residuals")[0], 404)
        self.assertEqual(self.ask("DELETE", "/api/calibration/views/../1")[0], 404)
        self.assertEqual(self.ask("DELETE", "/api/calibration/solve")[0], 405)
        self.send("PUT", "/api/calibration", {"is_automatic": False})
        self.assertEqual(len(self.send("DELETE", f"/api/calibration/views/{view['id']}", None)["views"]), 1)
        self.assertEqual(self.send("DELETE", "/api/calibration/views", None)["views"], [])
        self.assertFalse(self.send("PUT", "/api/calibration", {"is_on": False})["is_on"])

    @unittest.skipUnless(CALIBRATION.is_dir(), "needs ../shared/data/msl98/calibration")
    def test_a_camera_is_calibrated_saved_and_taken_over(self):
        if "libasan" in subprocess.run(["ldd", self.program], capture_output=True, text=True).stdout:
            self.skipTest("sanitized, it takes seconds to look at an image")
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        for name in ("div.yaml", "div.png"):
            shutil.copy(self.folder / name, folder)
        mount = "camera_pose_in_robot: {x: 0.06, y: 0.015, z: 0.52, roll: 0, pitch: 0.24, yaw: 0}"
        text = re.sub("camera_pose_in_robot.*", "", (CALIBRATION / "vga.yaml").read_text()) + mount + "\n"
        # A focal length that somebody guessed.
        before = re.sub(r"(camera_matrix:(?:.|\n)*?data: \[)[\d.]+", r"\g<1>600.0", text)
        self.assertNotEqual(before, text)
        camera = folder / "camera.yaml"
        camera.write_text(before)
        (folder / "robot.yaml").write_text("{camera: camera.yaml, field: msl98, colors: div.yaml}\n")
        self.serve("--fps", "5", robot=folder / "robot.yaml", colors=None, source=(CALIBRATION / "vga",))
        self.until(lambda: self.get("/api/state")["frames"] > 0)
        self.send("PUT", "/api/calibration", {"is_on": True, "targets": ["dots:7x7:0.04:0.01", "checker:9x6:0.04"], "model": "plumb_bob"})
        images = len(list((CALIBRATION / "vga").glob("*.png")))
        self.until(lambda: len(self.get("/api/calibration")["views"]) == images)
        self.until(lambda: self.get("/api/calibration")["now"]["verdict"].startswith("like view"))
        self.send("PUT", "/api/calibration", {"is_automatic": False})
        self.send("POST", "/api/calibration/solve", {})
        state = self.until(lambda: not (now := self.get("/api/calibration"))["is_solving"] and now)
        self.assertEqual(state["failure"], "")
        result = state["result"]
        self.assertEqual((result["model"], result["views"]), ("plumb_bob", images))
        self.assertLess(result["rms_px"], .3)
        self.assertEqual([value["name"] for value in result["values"]][:4], ["fx", "fy", "cx", "cy"])
        truth = float(re.search(r"camera_matrix:(?:.|\n)*?data: \[([\d.]+)", text)[1])
        self.assertLess(abs(result["values"][0]["value"] / truth - 1), .005)
        self.assertTrue(all(view["rms_px"] > 0 and view["rejected"] == "" for view in state["views"]))
        status, picture, answer = self.ask("GET", "/api/calibration/residuals")
        self.assertEqual((status, answer.getheader("Content-Type")), (200, "image/png"))
        self.assertGreaterEqual(png_size(picture)[0], 900)
        self.assertEqual((state["file"]["is_saved"], state["file"]["refusal"], camera.read_text()), (False, "", before))

        camera.write_text("half a fi")
        self.assertNotEqual(self.get("/api/calibration")["file"]["refusal"], "")
        self.assertIn("camera.yaml", self.send("POST", "/api/calibration/save", {}, 409))
        self.assertEqual(camera.read_text(), "half a fi")
        camera.write_text(before)
        taken_over = self.get("/api/state")["configuration"]["taken_over"]
        self.assertTrue(self.send("POST", "/api/calibration/save", {})["file"]["is_saved"])
        self.until(lambda: self.get("/api/state")["configuration"]["taken_over"] > taken_over)
        self.assertEqual(self.get("/api/state")["configuration"]["refusal"], "")
        self.assertIn("pitch: 0.24", camera.read_text())
        kept, = (folder / "camera_history").iterdir()
        self.assertEqual(kept.read_text(), before)
        self.assertRegex(kept.name, r"^\d{4}-\d\d-\d\dT\d\d-\d\d-\d\dZ\.yaml$")
        # The command line makes the same camera of the same images, but for the order of the views.
        self.succeeds("calibrate", "intrinsics", CALIBRATION / "vga", "-t", "dots:7x7:0.04:0.01", "-t", "checker:9x6:0.04", "-o", folder / "again.yaml", "-q")
        focal = [float(re.search(r"camera_matrix:(?:.|\n)*?data: \[([\d.]+)", file.read_text())[1]) for file in (folder / "again.yaml", camera)]
        self.assertAlmostEqual(*focal, delta=.05)

    def test_keeps_others_out(self):
        port = self.serve("--token", TOKEN)
        self.assertEqual(self.ask("GET", "/api/state")[0], 401)
        self.assertEqual(self.ask("POST", "/api/calibration/save", "{}")[0], 401)
        self.assertEqual(Channel(port, "scene").status, 401)
        status, _, answer = self.ask("GET", f"/?token={TOKEN}")
        self.assertEqual((status, answer.getheader("Location")), (303, "/"))
        cookie = answer.getheader("Set-Cookie")
        self.assertIn("HttpOnly", cookie)
        headers = {"Cookie": cookie.split(";")[0]}
        self.assertEqual(self.ask("GET", "/api/state", headers=headers)[0], 200)
        self.assertEqual(self.ask("PUT", "/api/stages", "{}", headers | {"Origin": "http://evil.example"})[0], 403)
        self.assertEqual(self.ask("PUT", "/api/stages", "{}", headers | {"Host": "evil.example"})[0], 403)
        # What is too long is refused by its announced length, before any of it came.
        self.assertEqual(self.ask("PUT", "/api/stages", headers=headers | {"Content-Length": "2000000"})[0], 413)
        self.assertEqual(self.ask("DELETE", "/api/stages", headers=headers)[0], 405)
        self.assertEqual(self.ask("GET", "/api/../../robot.yaml", headers=headers)[0], 404)
        self.assertEqual(Channel(port, "scene", [f"Cookie: {headers['Cookie']}"]).status, 101)

    def test_beyond_this_machine_a_token_is_made(self):
        self.serve("--address", "0.0.0.0")
        self.assertRegex(self.said, r"/\?token=[0-9a-f]{32} ")
        self.assertEqual(self.ask("GET", "/api/state")[0], 401)

    def test_errors_are_told_before_it_runs(self):
        port = self.serve()
        self.fails("serve", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--port", port,
                   says=(str(port), "cannot listen"))
        self.fails("serve", "--robot", "robot.yaml", "--colors", "div.yaml", "--source", RECORDING / "video.mkv", "--address", "robot",
                   says=("robot", "must be an IP address"))
        self.refuses("serve", "--robot", "robot.yaml", "--source", "x.mkv", "--token", "short", says="16 or more")


if __name__ == "__main__":
    main()
