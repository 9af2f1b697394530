#!/usr/bin/env python3
"""Definitions of the standard messages of ROS 2 are those of ROS 2, Humble to Jazzy: compared with a copy that others keep.

usage: tests/definitions_test.py WRITE_DEFINITIONS
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

WEBUI = pathlib.Path(__file__).resolve().parent.parent / "webui"

if shutil.which("node") is None or not (WEBUI / "node_modules/@foxglove/rosmsg-msgs-common").exists():
    print("skipped: node or the packages of webui/ are not installed; tools/install_deps.sh installs them")
    sys.exit(77)
with tempfile.NamedTemporaryFile() as file:
    subprocess.run([sys.argv[1]], stdout=file, check=True)
    sys.exit(subprocess.run(["node", WEBUI / "e2e/compare_definitions.mjs", file.name]).returncode)
