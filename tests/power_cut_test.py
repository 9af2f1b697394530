#!/usr/bin/env python3
"""A power cut at any moment of a save leaves the old or the new table, and samples with all their pictures.

A preloaded library writes down what the program does to files while samples and tables are saved and rolled back. From that this test makes every
state that a disk may be in after a cut: content that was not flushed is there, cut off or missing; names that were not flushed have changed or not.

usage: tests/power_cut_test.py PROGRAM RECORD_WRITES [unittest arguments]
"""
import copy
import itertools
import os
import pathlib
import re
import sys

from camera_test import preloaded
from program import main
from serve_test import Served


class Disk:
    """Files as they are, and as they may come back."""

    def __init__(self, folder):
        self.inodes = {}   # number -> [all bytes, flushed bytes]
        self.names = {}    # path -> number: as programs see it
        self.flushed_names = {}
        self.pending = []  # changes of names since their folder was flushed, in order
        self.open = {}
        for path in folder.rglob("*"):
            if path.is_file():
                self.names[str(path)] = self.new(path.read_bytes())
        self.flushed_names = dict(self.names)

    def new(self, data=b""):
        self.inodes[len(self.inodes)] = [data, data]
        return len(self.inodes) - 1

    @staticmethod
    def apply(change, names):
        what, path, extra = change
        if what == "link":
            names[path] = extra
        elif what == "unlink":
            names.pop(path, None)
        elif path in names:
            names[extra] = names.pop(path)

    def change(self, *change):
        self.apply(change, self.names)
        self.pending.append(change)

    def do(self, line):
        what, first, *rest = line.split(" ")
        if what == "open":
            path = rest[0]
            if path not in self.names:
                self.change("link", path, self.new())
            self.open[first] = self.names[path]
        elif what == "write":
            self.inodes[self.open[first]][0] += bytes.fromhex(rest[0])
        elif what == "sync" and first in self.open:
            inode = self.inodes[self.open[first]]
            inode[1] = inode[0]
        elif what == "sync":  # a folder: its names are safe
            for change in self.pending:
                self.apply(change, self.flushed_names)
            self.pending = []
        elif what == "rename":
            self.change("rename", first, rest[0])
        elif what == "unlink":
            self.change("unlink", first, None)

    def as_seen(self):
        """{path: bytes} without a cut."""
        return {path: self.inodes[number][0] for path, number in self.names.items()}

    def states(self):
        """{path: bytes} of each way in which the disk may come back. File systems keep the order of names, not that of names and content."""
        for kept, loss in itertools.product(range(len(self.pending) + 1), ("none", "cut", "all")):
            names = dict(self.flushed_names)
            for change in self.pending[:kept]:
                self.apply(change, names)
            state = {}
            for path, number in names.items():
                whole, flushed = self.inodes[number]
                lost = whole[len(flushed):]
                state[path] = whole if loss == "none" else flushed + lost[:len(lost) // 2] if loss == "cut" else flushed
            yield state


def table_of(state, file):
    """The bytes of a colors file and of the PNG that it names."""
    text = state.get(file, b"")
    name = re.match(rb"table: (\S+)\n", text)
    return text, state.get(str(pathlib.Path(file).parent / name[1].decode())) if name else None


class PowerCut(Served):
    def saved(self):
        """Saves three times and rolls back, all written down: (folder, disk before, lines of each step)."""
        training = self.training_folder()
        disk = Disk(training)
        writes = self.folder / "writes"
        self.serve(robot=training / "robot.yaml", colors=None,
                   env=os.environ | {"LD_PRELOAD": PRELOAD, "TASSILO_RECORD_WRITES": str(writes), "TASSILO_RECORD_FOLDER": str(training)})
        self.until(lambda: self.get("/api/state")["frames"] > 0)
        steps, done = [], 0

        def step():
            nonlocal done
            lines = writes.read_text().splitlines()
            steps.append(lines[done:])
            done = len(lines)

        version, samples = self.get("/api/training")["version"], []
        for brightness in ([40, 200], [50, 210], [60, 220]):
            image = self.send("POST", "/api/training/images", {})["id"]
            samples.append({"image": image, "class": "green", "rectangle": [180, 140, 220, 165]})
            draft = {"version": version, "options": {}, "brightness": {"green": brightness}, "samples": samples}
            version = self.send("PUT", "/api/training/draft", draft)["version"]
            history = self.send("POST", "/api/training/save", {"version": version})["history"]
            step()
        self.send("POST", "/api/training/restore", {"id": history[-1]["id"]})
        step()
        self.stop()
        return training, disk, steps

    def judge(self, training, disk, steps, flushes=True):
        """How many states were looked at, and what is wrong with them."""
        colors, samples = str(training / "div.yaml"), str(training / "samples.yaml")
        disk = copy.deepcopy(disk)
        looked_at, wrong = 0, []
        for number, lines in enumerate(steps):
            after = copy.deepcopy(disk)
            for line in lines:
                after.do(line)
            before, after = disk.as_seen(), after.as_seen()
            tables = [table_of(state, colors) for state in (before, after)]
            self.assertNotEqual(*tables)
            for line in lines:
                if flushes or not line.startswith("sync"):
                    disk.do(line)
                for state in disk.states():
                    looked_at += 1
                    where = f"step {number}, after '{line[:80]}': "
                    if table_of(state, colors) not in tables:
                        wrong.append(where + "half a table")
                    if state.get(samples) not in (before.get(samples), after.get(samples)):
                        wrong.append(where + "half of the samples")
                    for image in re.findall(rb"image: (\S+),", state.get(samples) or b""):
                        path = str(training / image.decode())
                        if path not in state or state[path] != after[path]:
                            wrong.append(where + f"{path} is not whole")
        return looked_at, wrong

    def test_old_or_new_at_any_moment(self):
        saved = self.saved()
        looked_at, wrong = self.judge(*saved)
        self.assertEqual(wrong, [])
        self.assertGreater(looked_at, 500)
        # The same without flushing would not do: this test sees what it is there to see.
        _, wrong = self.judge(*saved, flushes=False)
        for what in ("half a table", "half of the samples", "is not whole"):
            self.assertTrue(any(what in fault for fault in wrong), what)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM RECORD_WRITES [unittest arguments]")
    PRELOAD = preloaded(sys.argv[1], os.path.abspath(sys.argv.pop(2)))
    main()
