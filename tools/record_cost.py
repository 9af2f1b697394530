#!/usr/bin/env python3
"""What does recording cost the vision? A camera of 640x480 4:2:2 at 30 frames/s (tests/fake_v4l2.cpp, pictures of d06_vga), recording off and on in turns.

usage: tools/record_cost.py PROGRAM FAKE_V4L2 [SECONDS] [TURNS]    after `make release`; SECONDS of each: 5, TURNS: 4
"""
import http.client
import json
import os
import pathlib
import shutil
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


def ask(port, method, path, body=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30)
    connection.request(method, path, body)
    answer = json.loads(connection.getresponse().read())
    connection.close()
    return answer


def cpu_s(pid):
    """Processor time of all threads so far."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(process, port, seconds):
    """Frames a second, median of the time of a frame [ms], median latency [ms], processor time a second [s]."""
    scenes, latencies = [], []
    channel = Channel(port, "scene")
    end = time.monotonic() + seconds
    cpu = cpu_s(process.pid)
    began = ask(port, "GET", "/api/state")["frames"]
    start = time.monotonic()

    def listen():
        while time.monotonic() < end:
            scenes.append(json.loads(channel.receive()[1]))
    listener = threading.Thread(target=listen)
    listener.start()
    while time.monotonic() < end:
        time.sleep(1)
        latencies.append(ask(port, "GET", "/api/state").get("latency_ms") or 0)
    listener.join()
    span = time.monotonic() - start
    frames = ask(port, "GET", "/api/state")["frames"] - began
    channel.close()
    return frames / span, statistics.median(s["timing_ms"]["total"] for s in scenes), statistics.median(latencies), (cpu_s(process.pid) - cpu) / span


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, fake = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 5
    turns = int(sys.argv[4]) if len(sys.argv) > 4 else 4
    folder = pathlib.Path(tempfile.mkdtemp())
    subprocess.run([program, "train", "colors", DATA / "train_vga/samples.yaml", "--output", folder / "vga.yaml", "--quiet"], check=True)
    (folder / "robot.yaml").write_text(f"{{camera: {DATA / 'd06_vga/camera.yaml'}, field: msl98}}\n")
    (folder / "frames.raw").write_bytes(raw_bytes(DATA / "d06_vga/video.mkv", "yuyv422", 14))
    script = f"path={DEVICE} frames={folder}/frames.raw format=yuyv width=640 height=480 fps=30 "
    process = subprocess.Popen([program, "serve", "--robot", folder / "robot.yaml", "--colors", folder / "vga.yaml", "--source", DEVICE, "--range", "full",
                                "--port", "0", "--recordings", folder / "recordings"], stdout=subprocess.PIPE, text=True,
                               env=os.environ | {"LD_PRELOAD": fake, "TASSILO_FAKE_CAMERA": script})
    try:
        port = int(process.stdout.readline().split("http://127.0.0.1:")[1].split("/")[0])
        results = {False: [], True: []}
        dropped = recorded = size = 0
        for turn in range(2 * turns):
            on = turn % 2 == 1
            ask(port, "PUT", "/api/recording", json.dumps({"on": on}))
            time.sleep(1)
            results[on].append(measure(process, port, seconds))
            if on:
                state = ask(port, "PUT", "/api/recording", json.dumps({"on": False}))
                dropped, recorded, size = dropped + state["dropped"], recorded + state["frames"], size + state["bytes"]
                shutil.rmtree(folder / "recordings" / state["name"].partition(".")[0], ignore_errors=True)
        for on, name in ((False, "without"), (True, "with")):
            rate, total, latency, cpu = (statistics.median(column) for column in zip(*results[on]))
            print(f"{name:8} recording: {rate:5.1f} frames/s, {total:.2f} ms a frame, latency {latency:5.1f} ms, {100 * cpu:.0f} % of one core")
        print(f"recorded {recorded} frames, {size / max(recorded, 1) / 1e3:.0f} kB a frame, {dropped} not recorded")
    finally:
        process.terminate()
        process.communicate()
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
