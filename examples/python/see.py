#!/usr/bin/env python3
"""From samples to a picture of what a robot sees; a script in cells, as notebooks and editors know them (# %%).

usage: examples/python/see.py [PICTURE.png]     from the project's folder, with the package in PYTHONPATH
"""
# %% Colors: trained from labelled rectangles, with their measured quality.
import sys

import numpy as np

import tassilo
from tassilo import components, disc, feature_array, opening

colors = tassilo.train_colors("data/msl98/train_div/samples.yaml")
for name, quality in colors.trained_from["quality"].items():
    print(f"{name:8} recall {quality['recall']:.3f}  precision {quality['precision']:.3f}")

# %% One frame, and its regions: what is green, in parts that a disc fits into.
frame = list(tassilo.open_source("data/msl98/d01_approach/video.mkv"))[25]
found = tassilo.segment(frame, colors)
parts = components(opening(found["green"], disc(2.5)))
features = feature_array(parts, ["area", "convexity"])
print(f"\n{len(parts)} green parts, the largest has {features['area'].max():.0f} px of {len(found['green'])}")

# %% The whole vision: positions in metres, with their bounds.
vision = tassilo.Vision(colors, "data/msl98/d01_approach/camera.yaml", "msl98")
scene = vision(frame)
for ball in scene["balls"]:
    print(f"ball {ball['distance']:.2f} m away, between {ball['near']:.2f} and {ball['far']:.2f}")

# %% The picture: the scene, and below it the color classes of all pixels.
drawn = vision.draw(frame, scene)
palette = np.uint8([(40, 40, 40), (0, 0, 0), (255, 255, 255), (0, 140, 60), (40, 80, 220), (0, 200, 200), (220, 0, 200),
                    (230, 60, 20), (250, 210, 0)])
classes = palette[found.labels].repeat(2, 0).repeat(2, 1)
canvas = np.zeros((drawn.shape[0] + classes.shape[0], max(drawn.shape[1], classes.shape[1]), 3), np.uint8)
canvas[:drawn.shape[0], :drawn.shape[1]] = drawn
canvas[drawn.shape[0]:, :classes.shape[1]] = classes
picture = sys.argv[1] if len(sys.argv) > 1 else "see.png"
tassilo.write_png(picture, canvas)
print(f"wrote {picture}")
