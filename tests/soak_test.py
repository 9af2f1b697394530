#!/usr/bin/env python3
"""A long match at full speed with everything going wrong around it: robots leave and come back, garbage is sent among the players and on the bus, robots
without a match come and go. It must not crash, its memory must not grow, what the bus's monitor counts must not go back, and each word between the players must be accounted for.

usage: tests/soak_test.py PROGRAM TEAM_TRAFFIC [--minutes .5] [--robots 4] [--fps 15] [--seed 1]
       minutes are of play; memory is compared with that after the first minute, or after a third of a shorter match
"""
import argparse
import http.client
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import urllib.request

from bus_peer import free_domain

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools"))
from match_score import words_between_robots

GROWTH = .05           # of memory after the first minute: what an allocator needs to settle
LEAST_GROWTH_KB = 8192  # a page cache of a thread or two, whatever the size
GUEST_S = 1.5          # that a robot without a match stays
MEMORY_S = 5           # that can be looked back at: full long before the first minute is over
SLOWEST = 30           # seconds for one of play, with sanitizers on a busy machine


def memory_kb(process):
    """What it has in memory now, of its own."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(re.search(r"RssAnon:\s+(\d+)", status)[1])


def is_sanitized(process):
    """AddressSanitizer keeps what was freed: memory says nothing."""
    return "libasan" in pathlib.Path(f"/proc/{process.pid}/maps").read_text()


def ask(port, path):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=30) as answer:
        return json.load(answer)


class Guests:
    """Robots that only talk: one that goes mad under the number of a player, one that nobody knows, one that comes and goes."""

    def __init__(self, program, domain):
        self.program, self.domain, self.running, self.came = program, domain, [], 0
        self.stay = [self.talk("2", "--garbage"), self.talk("33", "--garbage")]
        self.comes_and_goes, self.until = None, 0

    def talk(self, robot, *options):
        return subprocess.Popen([self.program, "--domain", str(self.domain), "--robots", robot, "--rate", "20", *options], stderr=subprocess.DEVNULL)

    def look(self, now):
        if now < self.until:
            return
        if self.comes_and_goes is None:
            self.comes_and_goes = self.talk(str(40 + self.came % 3), "--clock-ahead", str(600 * (self.came % 2)))
            self.came += 1
        else:
            self.end(self.comes_and_goes)
            self.comes_and_goes = None
        self.until = now + GUEST_S

    @staticmethod
    def end(process):
        process.kill()
        process.wait()

    def close(self):
        for process in [*self.stay, *([self.comes_and_goes] if self.comes_and_goes else [])]:
            self.end(process)


def accounted(report):
    """What became of the words between robots; it must add up."""
    words = words_between_robots(report)
    told = words.pop("told")
    assert told == sum(words.values()), f"{told} told, but {words}"
    assert words["refused"] > 0, f"no garbage was refused: {words}"
    return f"of {told} words: {words}"


def soak(arguments):
    domain = free_domain()
    seconds = 60 * arguments.minutes
    settled_s = min(60, seconds / 3)
    with tempfile.NamedTemporaryFile("w+", prefix="tassilo_soak_") as out:
        process = subprocess.Popen(
            [arguments.program, "demo", "--speed", "0", "--unrest", "--report", "--robots", str(arguments.robots), "--fps", str(arguments.fps), "--seed",
             str(arguments.seed), "--duration", str(seconds), "--port", "0", "--domain", str(domain), "--memory", str(MEMORY_S)],
            stdout=out, stderr=subprocess.STDOUT)
        guests, samples, settled, most, port, refused, heard, sanitized = None, [], None, 0, None, 0, 0, False
        begin = time.monotonic()
        try:
            while process.poll() is None:
                now = time.monotonic() - begin
                assert now < 60 + SLOWEST * seconds, "it hangs"
                time.sleep(.25)
                text = pathlib.Path(out.name).read_text()
                if port is None:
                    if found := re.search(r"http://127\.0\.0\.1:(\d+)/", text):
                        port, guests, sanitized = int(found[1]), Guests(arguments.team_traffic, domain), is_sanitized(process)
                    continue
                guests.look(now)
                played = float(([0] + re.findall(r"^ *([\d.]+) s  played", text, re.M))[-1])
                try:
                    counts = ask(port, f"/api/monitor/at?t={ask(port, '/api/monitor')['end']}")["counts"]
                    kb = memory_kb(process)
                except (OSError, TypeError, ValueError, http.client.HTTPException):  # it has just begun, or is about to end
                    continue
                assert counts["refused"] >= refused and counts["heard"] >= heard, "counts went back"
                refused, heard = counts["refused"], counts["heard"]
                if played >= settled_s:
                    settled = settled or kb
                    most = max(most, kb)
                if not samples or played > samples[-1][0]:
                    samples.append((played, kb))
                    print(f"{played:7.1f} s of play after {now:6.1f} s: {kb / 1024:6.1f} MB, {heard} messages heard on the bus, {refused} refused", flush=True)
        finally:
            if guests:
                guests.close()
            process.kill()
            process.wait()
        report = pathlib.Path(out.name).read_text()
    print(report)
    assert process.returncode == 0, f"it ended with {process.returncode}"
    assert "Sanitizer" not in report and "runtime error" not in report
    print(accounted(report))
    assert guests.came > 0 and refused > 0, "nobody disturbed it"
    assert settled, "it was over before its memory was looked at"
    grown = most - settled
    print(f"memory after {settled_s:.0f} s of play {settled / 1024:.1f} MB, at most {most / 1024:.1f} MB afterwards")
    assert sanitized or grown <= max(GROWTH * settled, LEAST_GROWTH_KB), f"memory grew by {grown} kB"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("team_traffic")
    parser.add_argument("--minutes", type=float, default=.5)
    parser.add_argument("--robots", type=int, default=4)
    parser.add_argument("--fps", type=float, default=15)
    parser.add_argument("--seed", type=int, default=1)
    soak(parser.parse_args())


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"soak: {error}")
