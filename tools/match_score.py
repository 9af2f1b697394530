#!/usr/bin/env python3
"""Plays matches of `tassilo demo` without monitor and tells what they were like together: goals, and what was seen and known beside what was true.

usage: tools/match_score.py build/release/bin/tassilo [--seeds 1-10] [--duration 120] [--fps 15] [--jobs 2] [-- OPTIONS OF THE DEMO]
       of each figure: the middle one of the matches, and the worst
"""
import argparse
import concurrent.futures
import re
import statistics
import subprocess
import sys

COLUMNS = ("values", "median cm", "90 % cm", "known %", "squared", "above 9.21 %")
BETTER = {"known %": max}  # of all others the smaller one is better


def rows(report):
    """{what: [values or moments, median in cm, 90 % in cm, known in %, ...]} of a report of the demo."""
    found = {}
    for line in report.splitlines():
        if match := re.fullmatch(r"(\S.*?)((?: +[\d.]+){3,6})", line):
            found[match[1]] = [float(word) for word in match[2].split()]
    return found


def words_between_robots(text):
    """{what became of them: how many}; "told" is all."""
    line = re.search(r"words between robots: (.+)", text)[1]
    return {name: int(number) for number, name in re.findall(r"(\d+) ([a-z ]+?)(?: [=+]|$)", line)}


def play(program, seed, arguments):
    command = [program, "demo", "--headless", "--radios", "--seed", str(seed), "--duration", str(arguments.duration), "--fps", str(arguments.fps), *arguments.options]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"match_score: seed {seed}: {done.stderr.strip() or done.returncode}")
    cyan, magenta = map(int, re.search(r"cyan (\d+) : (\d+) magenta", done.stdout).groups())
    lost = float(re.search(r"longest time without a pose within half a metre: ([\d.]+) s", done.stdout)[1])
    played = re.search(r"([\d.]+) s played in ([\d.]+) s", done.stdout)
    print(f"seed {seed}: cyan {cyan} : {magenta} magenta, {played[0]}, longest without a pose {lost} s", flush=True)
    return cyan, magenta, lost, rows(done.stdout)


def main():
    own, options = (sys.argv[1:sys.argv.index("--")], sys.argv[sys.argv.index("--") + 1:]) if "--" in sys.argv else (sys.argv[1:], [])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", default="1-10", help="FIRST-LAST")
    parser.add_argument("--duration", type=float, default=120)
    parser.add_argument("--fps", type=float, default=15)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args(own)
    arguments.options = options
    if not (seeds := re.fullmatch(r"(\d+)-(\d+)", arguments.seeds)) or int(seeds[1]) > int(seeds[2]):
        parser.error(f"--seeds is {arguments.seeds}, must be FIRST-LAST")
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        matches = list(pool.map(lambda seed: play(arguments.program, seed, arguments), range(int(seeds[1]), int(seeds[2]) + 1)))
    print(f"\ngoals in the mean: cyan {statistics.mean(m[0] for m in matches):.2f}, magenta {statistics.mean(m[1] for m in matches):.2f}; "
          f"longest without a pose {max(m[2] for m in matches)} s\n")
    print(f"{'':30}" + "".join(f"{column:>20}" for column in COLUMNS))
    for what in dict.fromkeys(name for match in matches for name in match[3]):
        line = f"{what:30}"
        for i, column in enumerate(COLUMNS):
            values = [match[3][what][i] for match in matches if len(match[3].get(what, ())) > i]
            if not values:
                continue
            worst = min(values) if BETTER.get(column) is max or i == 0 else max(values)
            line += f"{statistics.median(values):12.2f} {worst:7.2f}"
        print(line)


if __name__ == "__main__":
    main()
