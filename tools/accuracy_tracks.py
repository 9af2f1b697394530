#!/usr/bin/env python3
"""How well objects are followed over time: the table "Tracks" of docs/accuracy.md, all recordings pooled.

usage: tools/accuracy_tracks.py DATA [OUT] [--by-recording]    after `tools/accuracy.sh DATA OUT`, whose scene lines are judged

The ball is the first ball among the tracks; robots go to the nearest true ones within REACH, each to one. Velocities are
over the field, in the robot's axes; the true ones are differences of true places. Settled: tracked for SETTLED seconds.
"""
import argparse
import json
import math
import pathlib
import sys

REACH = .6    # [m]
SETTLED = .5  # [s]
HIDDEN = .5   # [s]


def quantile(values, share):
    values = sorted(values)
    return values[min(int(share * len(values)), len(values) - 1)] if values else math.nan


def mean(values):
    return sum(values) / len(values) if values else math.nan


def solve(matrix, vector):
    """x of matrix x = vector, by Gaussian elimination with pivots."""
    rows = [list(row) + [value] for row, value in zip(matrix, vector)]
    n = len(rows)
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, n):
            factor = rows[r][i] / rows[i][i]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][k] * x[k] for k in range(i + 1, n))) / rows[i][i]
    return x


def normalized(error, covariance):
    """Squared error of x y vx vy relative to its row-major covariance."""
    return sum(a * b for a, b in zip(error, solve([covariance[4 * i:4 * i + 4] for i in range(4)], error)))


def true_states(truth):
    """By frame: {name: (x, y, vx, vy in the robot's axes, visible)}; name is ball or the robot's id."""
    def things(line):
        return {"ball": line["ball"], **{robot["id"]: robot for robot in line["robots"]}}

    states = []
    for k, line in enumerate(truth):
        before, after = truth[max(k - 1, 0)], truth[min(k + 1, len(truth) - 1)]
        c, s = math.cos(line["robot"]["theta"]), math.sin(line["robot"]["theta"])
        then, later = things(before), things(after)
        state = {}
        for name, thing in things(line).items():
            vx, vy = ((later[name][axis] - then[name][axis]) / (after["t"] - before["t"]) for axis in "xy")
            state[name] = (thing["rx"], thing["ry"], c * vx + s * vy, -s * vx + c * vy, thing["visible"])
        states.append(state)
    return states


def pairs_of(tracks, state):
    """{name: track}: the nearest first, none twice."""
    near = sorted((math.dist((t["x"], t["y"]), state[name][:2]), t["id"], name) for t in tracks for name in state if name != "ball")
    by_id, used, pairs = {t["id"]: t for t in tracks}, set(), {}
    for away, number, name in near:
        if away <= REACH and number not in used and name not in pairs:
            pairs[name] = by_id[number]
            used.add(number)
    return pairs


class Figures:
    """What is counted of one kind of object."""

    def __init__(self):
        self.place, self.detected, self.speed, self.settled, self.nees, self.nees_settled, self.hidden_place = ([] for _ in range(7))
        self.switches = self.objects = self.false = self.told = self.seen = self.followed = self.hidden = self.kept = 0


def judge(truth, scenes, ball, robots):
    """Adds one recording to the figures of the ball and of the robots."""
    id_of, first_t, seen_t = {}, {}, {}
    for state, line, scene in zip(true_states(truth), truth, scenes):
        t = line["t"]
        of_balls = [track for track in scene["tracks"] if track["kind"] == "ball"]
        of_robots = [track for track in scene["tracks"] if track["kind"] == "robot"]
        pairs = pairs_of(of_robots, state)
        robots.told += len(of_robots)
        robots.false += len(of_robots) - len(pairs)
        ball.told += len(of_balls)
        ball.false += sum(math.dist((b["x"], b["y"]), state["ball"][:2]) > REACH for b in of_balls)
        if of_balls and math.dist((of_balls[0]["x"], of_balls[0]["y"]), state["ball"][:2]) <= REACH:
            pairs["ball"] = of_balls[0]
        for name, (x, y, vx, vy, visible) in state.items():
            figures, track = (ball if name == "ball" else robots), pairs.get(name)
            if visible:
                seen_t[name] = t
                figures.seen += 1
                figures.followed += track is not None
            elif name in seen_t and t - seen_t[name] < HIDDEN and name in id_of:
                figures.hidden += 1
                figures.kept += track is not None
            if track is None:
                continue
            if name not in id_of:
                figures.objects += 1
            elif id_of[name] != track["id"]:
                figures.switches += 1
            if id_of.get(name) != track["id"]:
                id_of[name], first_t[name] = track["id"], t
            error = (track["x"] - x, track["y"] - y, track["vx"] - vx, track["vy"] - vy)
            settled = t - first_t[name] >= SETTLED
            if track["age"] > 0:
                if not visible:
                    figures.hidden_place.append(math.hypot(*error[:2]))
                continue
            figures.place.append(math.hypot(*error[:2]))
            figures.speed.append(math.hypot(*error[2:]))
            figures.nees.append(normalized(error, track["cov"]))
            if settled:
                figures.settled.append(figures.speed[-1])
                figures.nees_settled.append(figures.nees[-1])
            if name == "ball":
                figures.detected.append(math.hypot(scene["balls"][0]["x"] - x, scene["balls"][0]["y"] - y) if scene["balls"] else math.nan)
            else:
                figures.detected.append(min((math.dist(robot["center"], (x, y)) for robot in scene["robots"] if robot["center"]), default=math.nan))


def show(title, ball, robots):
    print(f"\n{title:52}{'ball':>16}{'robots':>16}")

    def row(name, text):
        print(f"  {name:50}{text(ball):>16}{text(robots):>16}")

    def both(values, unit):
        return f"{quantile(values, .5) * unit:.1f} / {quantile(values, .9) * unit:.1f}"

    row("frames in which it shows / with a track [%]", lambda f: f"{f.seen} / {100 * f.followed / f.seen:.1f}" if f.seen else "-")
    row("place, median / 90 % [cm]", lambda f: both(f.place, 100))
    row("place as detected in the frame alone [cm]", lambda f: both(f.detected, 100))
    row("velocity, median / 90 % [cm/s]", lambda f: both(f.speed, 100))
    row(f"velocity, tracked for {SETTLED} s [cm/s]", lambda f: both(f.settled, 100))
    row("normalized squared error, mean (4 is exact)", lambda f: f"{mean(f.nees):.2f}")
    row(f"  tracked for {SETTLED} s", lambda f: f"{mean(f.nees_settled):.2f}")
    row("objects / changes of identity", lambda f: f"{f.objects} / {f.switches}")
    row(f"hidden < {HIDDEN} s: frames / with a track [%]", lambda f: f"{f.hidden} / {100 * f.kept / f.hidden:.1f}" if f.hidden else "0 / -")
    row("  place while hidden, median / 90 % [cm]", lambda f: both(f.hidden_place, 100))
    row("tracks told / of nothing", lambda f: f"{f.told} / {f.false}")


def lines_of(file):
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?", default=pathlib.Path("out/accuracy"))
    parser.add_argument("--by-recording", action="store_true")
    arguments = parser.parse_args()
    ball, robots = Figures(), Figures()
    folders = sorted((arguments.data / "msl98").glob("d0*"))
    for folder in folders:
        file = arguments.out / f"{folder.name}.jsonl"
        if not file.exists():
            sys.exit(f"accuracy_tracks: {file} is missing; run tools/accuracy.sh first")
        truth, scenes = lines_of(folder / "gt.jsonl"), lines_of(file)
        judge(truth, scenes, ball, robots)
        if arguments.by_recording:
            alone = Figures(), Figures()
            judge(truth, scenes, *alone)
            show(folder.name, *alone)
    show(f"{len(folders)} recordings", ball, robots)


if __name__ == "__main__":
    main()
