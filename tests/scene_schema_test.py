#!/usr/bin/env python3
"""Every line that is written validates against schema/scene.schema.json; every spoiled one is refused, by the schema and by the reader.

usage: tests/scene_schema_test.py SCENE_LINES     the program built from tests/scene_lines.cpp
"""
import copy
import json
import pathlib
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

SCHEMA = pathlib.Path(__file__).resolve().parent.parent / "schema/scene.schema.json"
SCENES = 12  # every seed of the scenes leaves out something else
OPTIONAL = {("image",)}
FORGIVEN = {"tracks missing"}  # by the reader: lines from before there were tracks are read as well


def places(value, path=()):
    """Paths of all values inside a value, itself included."""
    yield path
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from places(inner, path + (key,))
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from places(inner, path + (i,))


def at(scene, path):
    for step in path:
        scene = scene[step]
    return scene


def changed(scene, path, change):
    """A copy of the scene in which change(container, key) was done to the value at path."""
    spoiled = copy.deepcopy(scene)
    change(at(spoiled, path[:-1]), path[-1])
    return spoiled


def free_text(path):
    """Keys below why and timing_ms are not fixed, only `total` is."""
    return path[0] in ("why", "timing_ms") and path[-1] != "total"


def spoiled_scenes(scene):
    """(what was done, scene) for one fault at a time, at every place."""
    for path in places(scene):
        value = at(scene, path)
        name = "/".join(map(str, path))
        if path:
            yield f"{name} of another type", changed(scene, path, lambda c, k: c.__setitem__(k, {"unknown": 1}))
            if isinstance(path[-1], str) and path not in OPTIONAL and not free_text(path):
                yield f"{name} missing", changed(scene, path, lambda c, k: c.__delitem__(k))
        if isinstance(value, dict):
            yield f"{name} with an unknown key", changed({"": scene}, ("",) + path + ("unknown",), lambda c, k: c.__setitem__(k, []))[""]
        if isinstance(value, str) and not free_text(path) and path not in OPTIONAL and path[-1] != "model":
            yield f"{name} with an unknown word", changed(scene, path, lambda c, k: c.__setitem__(k, "other"))
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            yield f"{name} as text", changed(scene, path, lambda c, k: c.__setitem__(k, "1"))
        if isinstance(value, list) and path[-1] in ("box", "cov", "center", "p", "q", "image", "origin"):
            yield f"{name} with one value more", changed(scene, path, lambda c, k: c[k].append(0))
        if path[-1:] == ("x",) and value is not None and path[0] in ("balls", "goals", "robots"):
            yield f"{name} alone null", changed(scene, path, lambda c, k: c.__setitem__(k, None))
    yield "an array", [scene]


def main():
    program = sys.argv[1]
    schema = json.loads(SCHEMA.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)

    written = subprocess.run([program, str(SCENES)], capture_output=True, check=True, text=True).stdout.splitlines()
    faults = [] if len(written) == SCENES else [f"{len(written)} lines were written, must be {SCENES}"]
    scenes = [json.loads(line) for line in written]
    for i, scene in enumerate(scenes):
        faults += [f"scene {i} is refused: {error.json_path}: {error.message}" for error in validator.iter_errors(scene)]

    cases = [(f"scene {i}, {what}", spoiled) for i, scene in enumerate(scenes) for what, spoiled in spoiled_scenes(scene)]
    faults += [f"{what}: the schema accepts it" for what, spoiled in cases if validator.is_valid(spoiled)]
    lines = "".join(json.dumps(spoiled) + "\n" for _, spoiled in cases)
    answers = subprocess.run([program], input=lines, capture_output=True, check=True, text=True).stdout.splitlines()
    if len(answers) != len(cases):
        faults.append(f"{len(answers)} answers to {len(cases)} lines")
    faults += [f"{what}: the reader accepts it" for (what, _), answer in zip(cases, answers)
               if answer == "ok" and what.split(", ", 1)[1] not in FORGIVEN]

    print("\n".join(faults[:40] + [f"{len(scenes)} scenes, {len(cases)} spoiled ones, {len(faults)} faults"]))
    return 1 if faults or len(cases) < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
