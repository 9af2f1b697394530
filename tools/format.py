#!/usr/bin/env python3
"""Formats all C++ sources with the pinned clang-format; --check only says which are not formatted.

exit code: 0 formatted, 1 not formatted (with --check), 77 the pinned version is not installed.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

VERSION = 14  # Debian 12; another version formats differently
FOLDERS = ["src", "tests", "bench", "fuzz", "examples", "python"]
SKIP = 77


def pinned_clang_format():
    """Path of clang-format VERSION, or the reason why there is none."""
    reason = f"clang-format {VERSION} is not installed"
    for name in (f"clang-format-{VERSION}", "clang-format"):
        path = shutil.which(name)
        if not path:
            continue
        text = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout
        found = re.search(r"version (\d+)", text)
        if found and int(found.group(1)) == VERSION:
            return path, ""
        reason = f"{name} is {text.strip()}, must be version {VERSION}"
    return None, reason


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="change nothing, exit 1 when a file is not formatted")
    arguments = parser.parse_args()

    root = pathlib.Path(__file__).resolve().parent.parent
    program, reason = pinned_clang_format()
    if program is None:
        print(f"skipped: {reason}")
        return SKIP
    sources = sorted(str(p.relative_to(root)) for folder in FOLDERS for p in (root / folder).rglob("*")
                     if p.suffix in (".h", ".cpp"))
    mode = ["--dry-run", "--Werror", "--ferror-limit=1"] if arguments.check else ["-i"]
    failed = subprocess.run([program, *mode, *sources], cwd=root).returncode != 0
    if failed and arguments.check:
        print("not formatted; `make format` does it", file=sys.stderr)
    elif not failed:
        print(f"{len(sources)} files formatted")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
