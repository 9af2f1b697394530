#!/usr/bin/env python3
"""Logs go between us and others: what tests/write_log.cpp writes comes out of @mcap/core and Foxglove's decoders, by webui/e2e/read_mcap.mjs, and
what @mcap/core writes, by webui/e2e/write_mcap.mjs, comes out of tests/read_log.cpp.

usage: tests/log_exchange_test.py WRITE_LOG READ_LOG [unittest arguments]     the programs built from those sources
"""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGES = ("@mcap/core", "@foxglove/crc", "@foxglove/rosmsg", "@foxglove/rosmsg2-serialization")
BEGIN = 1764288000 * 10**9
TIMEOUT_S = 60


def header(i):
    return {"stamp": {"sec": 1764288000 + i, "nanosec": i}, "frame_id": "robot_" + "x" * (i % 7)}


def numbers(i):
    raw = bytes(k % 256 for k in range(20 * i))
    shown = list(raw) if len(raw) <= 64 else {"bytes": len(raw), "crc32": f"{zlib.crc32(raw):08x}"}
    return {"few": [.5 * i, "nan", "-inf"], "large": str(-2**63 + i), "bytes": shown, "pair": [1.5, "inf"]}


def message(i):
    """What WRITE_LOG writes as its i-th message."""
    time = BEGIN + 10_000_000 * i - (25_000_000 if i % 4 == 3 else 0)
    topic, schema, content = [("/pose/header", "std_msgs/msg/Header", header), ("/numbers", "tassilo_test/msg/Numbers", numbers),
                              ("/ball/header", "std_msgs/msg/Header", header)][i % 3]
    return {"topic": topic, "schema": schema, "log_time": str(time), "publish_time": str(time - 1000), "sequence": i // 3, "message": content(i)}


class LogExchange(unittest.TestCase):
    write_log = read_log = None  # set below

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tassilo_")
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "a.mcap"

    def write(self, count, *killed):
        done = subprocess.run([self.write_log, self.file, str(count), *killed], stderr=subprocess.PIPE, text=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, -signal.SIGKILL if killed else 0, done.stderr)

    def read(self, code=0):
        """Messages that the other reader finds, and what it says."""
        done = subprocess.run(["node", ROOT / "webui/e2e/read_mcap.mjs", self.file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, code, done.stderr)
        return [json.loads(line) for line in done.stdout.splitlines()], done.stderr

    def test_others_read_every_message_in_order_of_log_time(self):
        for count in (0, 1, 100):
            with self.subTest(count=count):
                self.file.unlink(missing_ok=True)
                self.write(count)
                messages, said = self.read()
                self.assertEqual(said, "")
                self.assertEqual(messages, sorted((message(i) for i in range(count)), key=lambda one: int(one["log_time"])))

    def test_others_read_what_a_killed_process_leaves(self):
        self.write(50, "killed")
        messages, said = self.read()
        self.assertIn("has no end: 0 bytes after its last whole record", said)
        self.assertGreater(len(messages), 40)
        self.assertEqual(messages, [message(i) for i in range(len(messages))])
        # And when a disk took half of a chunk.
        whole = self.file.read_bytes()
        self.file.write_bytes(whole[:len(whole) // 2])
        messages, said = self.read()
        self.assertIn("has no end: ", said)
        self.assertGreater(len(messages), 10)
        self.assertEqual(messages, [message(i) for i in range(len(messages))])

    def test_others_find_our_checksums_wrong_where_bytes_are(self):
        self.write(50)
        whole = self.file.read_bytes()
        in_chunk, in_index = whole.index(b"robot_x"), whole.rindex(b"/numbers")
        in_note = whole.index(b"cyan")  # outside of chunks
        for place, says in ((in_chunk, "CRC"), (in_index, "CRC"), (in_note, "must be ")):
            with self.subTest(place=place):
                self.file.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1:])
                _, said = self.read(code=1)
                self.assertIn(says, said)

    def written_by_others(self, kind, count):
        subprocess.run(["node", ROOT / "webui/e2e/write_mcap.mjs", kind, str(count), self.file], check=True, timeout=TIMEOUT_S)
        return subprocess.run([self.read_log, self.file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=TIMEOUT_S)

    def test_we_read_what_others_write(self):
        def line(i):
            time = BEGIN + 1000 * i - i % 7 * 20000
            channel = "/odd a/msg/Odd json" if i % 2 else "/even a/msg/Even cdr"
            return time, f"{channel} {time} {time - 1} {i // 2} {(bytes([i % 256]) * (i % 50)).hex() or '-'}"

        for kind in ("chunks", "no_index", "no_chunks", "small"):
            for count in (0, 300):
                with self.subTest(kind=kind, count=count):
                    done = self.written_by_others(kind, count)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    messages = [text for _, text in sorted((line(i) for i in range(count)), key=lambda one: one[0])]
                    self.assertEqual(done.stdout.splitlines(), [*messages, *(["metadata robot id=3"] if count > 20 else []), "complete"])

    def test_what_others_compressed_is_refused_with_the_remedy(self):
        done = self.written_by_others("lz4", 30)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stderr, r"^/.*a\.mcap: chunk at byte \d+ is compressed by lz4, must not be compressed; `mcap compress --compression none` makes such a file\n$")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(f"usage: {sys.argv[0]} WRITE_LOG READ_LOG [unittest arguments]")
    LogExchange.write_log, LogExchange.read_log = (str(pathlib.Path(program).resolve()) for program in sys.argv[1:3])
    del sys.argv[1:3]
    if shutil.which("node") is None or not all((ROOT / "webui/node_modules" / package).exists() for package in PACKAGES):
        print("skipped: node or the packages of webui/ are not installed; tools/install_deps.sh installs them")
        sys.exit(77)
    unittest.main()
