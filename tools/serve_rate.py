#!/usr/bin/env python3
"""Does the vision keep its rate while browsers look? Frames a second and time a frame, without and with clients that take every scene and picture.

usage: tools/serve_rate.py PROGRAM [CLIENTS] [SECONDS] [FAKE_V4L2]    after `make release`; CLIENTS: 4, SECONDS: 10

On the shipped recordings, and with FAKE_V4L2 (build/release/tests/libfake_v4l2.so) on a camera of 640x480 4:2:2 at 30 frames/s.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from program import raw_bytes
from serve_test import Channel  # a WebSocket by hand

DATA = ROOT / "data/msl98"
DEVICE = "/dev/video42"


def listen(port, name, seconds, messages):
    channel = Channel(port, name)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        messages.append((time.monotonic(), channel.receive()[1]))
    channel.close()


def measure(program, recording, colors, clients, seconds, source=None, environment=None):
    """source: instead of the recording's video, with arguments that it needs."""
    robot = colors.parent / "robot.yaml"
    robot.write_text(f"{{camera: {recording / 'camera.yaml'}, field: msl98}}\n")
    process = subprocess.Popen([program, "serve", "--robot", robot, "--colors", colors, "--port", "0",
                                *(source or ["--source", recording / "video.mkv"])], stdout=subprocess.PIPE, text=True, env=environment)
    try:
        port = int(process.stdout.readline().split("http://127.0.0.1:")[1].split("/")[0])
        scenes, pictures, others = [], [], []
        threads = [threading.Thread(target=listen, args=(port, "scene", seconds, scenes))]
        for _ in range(clients):
            threads.append(threading.Thread(target=listen, args=(port, "scene", seconds, others)))
            threads.append(threading.Thread(target=listen, args=(port, "picture", seconds, pictures)))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        process.terminate()
        process.communicate()
    frames = [json.loads(data) for _, data in scenes]
    span = scenes[-1][0] - scenes[0][0]
    total = statistics.median(scene["timing_ms"]["total"] for scene in frames)
    print(f"{'camera' if source else recording.name:14} {clients} clients: {(len(frames) - 1) / span:5.1f} frames/s, {total:.2f} ms a frame, "
          f"{len(pictures) / max(clients, 1) / seconds:4.1f} pictures/s each, {sum(len(data) for _, data in pictures) / seconds / 1e6:.1f} MB/s")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]).resolve())
    clients = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 10
    with tempfile.TemporaryDirectory() as folder:
        for camera, name in (("div", "d01_approach"), ("vga", "d06_vga")):
            colors = pathlib.Path(folder) / f"{camera}.yaml"
            subprocess.run([program, "train", "colors", DATA / f"train_{camera}/samples.yaml", "--output", colors, "--quiet"], check=True)
            for count in (0, clients):
                measure(program, DATA / name, colors, count, seconds)
        if len(sys.argv) > 4:
            frames = pathlib.Path(folder) / "frames.raw"
            frames.write_bytes(raw_bytes(DATA / "d06_vga/video.mkv", "yuyv422", 14))
            script = f"path={DEVICE} frames={frames} format=yuyv width=640 height=480 fps=30 "
            environment = os.environ | {"LD_PRELOAD": str(pathlib.Path(sys.argv[4]).resolve()), "TASSILO_FAKE_CAMERA": script}
            for count in (0, clients):
                measure(program, DATA / "d06_vga", colors, count, seconds, ["--source", DEVICE, "--range", "full"], environment)


if __name__ == "__main__":
    main()
