#!/usr/bin/env python3
"""Sees single images from many rough start poses: one scene line a draw, all in one file.

usage: tools/pose_draws.py TASSILO FOLDER COLORS OUTPUT [--draws N]
FOLDER holds robot.yaml, images/ and poses.csv (image, x, y, theta, ..); start poses are the true ones plus a random
error of 30 cm and 15 degrees (a uniform direction each, the same for every run).
"""
import argparse
import csv
import math
import pathlib
import random
import subprocess
import tempfile

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("tassilo")
parser.add_argument("folder", type=pathlib.Path)
parser.add_argument("colors")
parser.add_argument("output", type=pathlib.Path)
parser.add_argument("--draws", type=int, default=50)
arguments = parser.parse_args()

DISTANCE, TURN = .3, math.radians(15)
dice = random.Random(1)
lines = []
with open(arguments.folder / "poses.csv", encoding="utf-8") as file, tempfile.TemporaryDirectory() as folder:
    scene = pathlib.Path(folder) / "scene.jsonl"
    for row in csv.DictReader(file):
        for _ in range(arguments.draws):
            way, turn = dice.uniform(-math.pi, math.pi), dice.choice((-1, 1)) * TURN
            start = (float(row["x"]) + DISTANCE * math.cos(way), float(row["y"]) + DISTANCE * math.sin(way), float(row["theta"]) + turn)
            # sigma per axis: 30 cm in any direction
            text = ",".join(f"{value:.5f}" for value in (*start, DISTANCE / math.sqrt(2), TURN))
            subprocess.run([arguments.tassilo, "run", "--quiet", "--robot", arguments.folder / "robot.yaml", "--colors", arguments.colors,
                            "--source", arguments.folder / "images" / pathlib.Path(row["image"]).name, f"--start-pose={text}",
                            "--output", scene], check=True)
            lines.append(scene.read_text(encoding="utf-8"))
arguments.output.write_text("".join(lines), encoding="utf-8")
