#!/usr/bin/env python3
"""Runs the tests of one preset through ctest and lists every skipped test with its reason at the end.

A skip is a test that did not say anything; tests/allowed_skips names the ones we live with. Where CI is set (CI=true), any
other skip is a failure; elsewhere skips are only listed.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent


def skips_in(junit_file):
    """[(test name, reason)] of all tests that ctest's JUnit file reports as not run."""
    skips = []
    for case in ElementTree.parse(junit_file).getroot().iter("testcase"):
        if case.get("status") == "disabled":
            skips.append((case.get("name"), "disabled in the source"))
        elif case.find("skipped") is not None:
            skips.append((case.get("name"), skip_reason(case.findtext("system-out") or "")))
    return skips


def skip_reason(output):
    """What a skipped test says: `skipped: reason` (scripts) or the line after GoogleTest's `file:line: Skipped`."""
    script = re.search(r"^skipped: (.+)$", output, re.MULTILINE)
    if script:
        return script.group(1).strip()
    googletest = re.search(r": Skipped\s*\n(.+)", output)
    if googletest and not googletest.group(1).startswith("["):
        return googletest.group(1).strip()
    return "no reason given"


def allowed_skips(path):
    """The patterns of tests/allowed_skips; blank lines and lines that start with # say nothing."""
    lines = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
    return [re.compile(line) for line in lines if line and not line.startswith("#")]


def report(skips, allowed, strict):
    """Prints the skips; True when none of them is a failure."""
    refused = 0
    if skips:
        print(f"\n{len(skips)} tests skipped:")
    for name, reason in skips:
        text = f"{name}: {reason}"
        known = any(pattern.search(text) for pattern in allowed)
        refused += not known
        print(f"  {text}{'' if known else '   <- not named in tests/allowed_skips'}")
    if refused and strict:
        print(f"failed: {refused} skipped tests are not named in tests/allowed_skips")
    return not (refused and strict)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog="other arguments go to ctest")
    parser.add_argument("--preset", required=True, help="a test preset of CMakePresets.json, already built")
    arguments, ctest_arguments = parser.parse_known_args()
    strict = os.environ.get("CI", "").lower() not in ("", "0", "false")

    with tempfile.TemporaryDirectory() as folder:
        junit_file = pathlib.Path(folder) / "tests.xml"
        command = ["ctest", "--preset", arguments.preset, "--output-junit", str(junit_file),
                   "--test-output-size-passed", "100000", *ctest_arguments]
        status = subprocess.run(command, cwd=ROOT).returncode
        skips = skips_in(junit_file) if junit_file.exists() else []
    sys.stdout.flush()
    acceptable = report(skips, allowed_skips(ROOT / "tests" / "allowed_skips"), strict)
    return status if status != 0 else int(not acceptable)


if __name__ == "__main__":
    sys.exit(main())
