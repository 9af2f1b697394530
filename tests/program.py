"""What the tests of the whole program share: running it, small pictures and videos, and what holds for every answer."""
import contextlib
import json
import os
import pathlib
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
DATA = ROOT / "data/msl98"
SHARED = ROOT.parent / "shared"
TIMEOUT_S = 60  # of one run: something hangs, whatever the machine and the sanitizer

# What no user should ever read.
UNFRIENDLY = ("unexpected:", "terminate called", "what():", "Sanitizer", "runtime error:", "Assertion", "std::", "nlohmann", "YAML::", "broken promise")


class Result:
    """What a run left behind; a text to show when a test fails."""

    def __init__(self, arguments, code, out, err):
        self.arguments, self.code, self.out, self.err = arguments, code, out, err

    def __str__(self):
        return f"$ tassilo {' '.join(map(str, self.arguments))}\n{self.out}\n-- standard error\n{self.err}\n-- exit code {self.code}"


def decoded(data):
    return data if isinstance(data, str) else (data or b"").decode("utf-8", "replace")


class ProgramTest(unittest.TestCase):
    """Each class works in an empty folder of its own, `self.folder`, with the trained table div.yaml in it."""

    program = None  # set by main()

    @classmethod
    def setUpClass(cls):
        cls.exits = contextlib.ExitStack()
        cls.addClassCleanup(cls.exits.close)
        cls.folder = pathlib.Path(cls.exits.enter_context(tempfile.TemporaryDirectory(prefix="tassilo_")))
        train_colors(cls, DATA / "train_div/samples.yaml", "div.yaml")

    @classmethod
    def start(cls, *arguments, **options):
        """The program running, its streams as `options` of Popen say."""
        return subprocess.Popen([cls.program, *map(str, arguments)], cwd=cls.folder, **options)

    @classmethod
    def tell(cls, *arguments, **options):
        """Runs the program to its end, without judging."""
        options = {"stdin": subprocess.DEVNULL} | options if "input" not in options else options
        done = subprocess.run([cls.program, *map(str, arguments)], cwd=cls.folder, timeout=TIMEOUT_S,
                              **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options)
        return Result(arguments, done.returncode, decoded(done.stdout), decoded(done.stderr))

    def judge(self, result, code):
        """What holds for every run: the exit code, no message that is not for people, nothing on standard error unless something is to be told."""
        self.assertEqual(result.code, code, result)
        for word in UNFRIENDLY:
            self.assertNotIn(word, result.err, result)
            self.assertNotIn(word, result.out, result)
        if code == 1:
            last = result.err.splitlines()[-1] if result.err else ""
            self.assertTrue(last.startswith("tassilo: "), result)
            self.assertFalse(last.endswith("."), result)
        return result

    def succeeds(self, *arguments, **options):
        return self.judge(self.tell(*arguments, **options), 0)

    def fails(self, *arguments, says=(), **options):
        """The world failed: exit code 1, one line that holds all of `says`."""
        result = self.judge(self.tell(*arguments, **options), 1)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, result.err, result)
        errors = [line for line in result.err.splitlines() if line.startswith("tassilo: ") and "warning:" not in line]
        self.assertEqual(len(errors), 1, result)
        return result

    def refuses(self, *arguments, says=(), **options):
        """Wrong usage: exit code 2, and how to get help."""
        result = self.judge(self.tell(*arguments, **options), 2)
        for text in [says, "help"] if isinstance(says, str) else [*says, "help"]:
            self.assertIn(text, result.err, result)
        self.assertEqual(result.out, "", result)
        return result

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def scenes(self, name):
        """Scene lines of a file, each a whole one."""
        text = (self.folder / name).read_text()
        self.assertTrue(text == "" or text.endswith("\n"), f"{name} ends within a line")
        return [json.loads(line) for line in text.splitlines()]


def train_colors(test, samples, output):
    """Trains, outside of any test: what goes wrong here is no test's fault."""
    result = test.tell("train", "colors", samples, "--output", output, "--quiet")
    if result.code != 0:
        raise RuntimeError(str(result))


def without_timing(scene):
    return {key: value for key, value in scene.items() if key != "timing_ms"}


def png_bytes(width, rows, channels=3):
    """An RGB (3 channels) or gray (1) PNG from the bytes of its rows."""
    raw = b"".join(b"\0" + row for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, len(rows), 8, 0 if channels == 1 else 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 1)) + chunk(b"IEND", b"")


def png_size(data):
    """(width, height) of the bytes of a PNG."""
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    return struct.unpack(">II", data[16:24])


def ffmpeg(*arguments, **options):
    """Runs ffmpeg to its end; returns what it wrote to standard output."""
    return subprocess.run(["ffmpeg", "-nostdin", "-loglevel", "error", "-y", *map(str, arguments)], check=True, stdout=subprocess.PIPE,
                          timeout=TIMEOUT_S, **options).stdout


def raw_bytes(video, pixel_format, frames):
    """Frames as they are in the video, limited range."""
    return ffmpeg("-i", video, "-frames:v", frames, "-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt", pixel_format, "-")


def close(a, b):
    """Equal, numbers nearly: times of a camera are whole microseconds, seconds since the epoch have steps of a quarter of one."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(close(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(close, a, b))
    if isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        return abs(a - b) <= 1e-3 * max(1, abs(a), abs(b))
    return a == b


class Live:
    """The program running, until it is told to end."""

    def __init__(self, test, *arguments, **options):
        self.test, self.told = test, ""
        self.process = test.start(*arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        test.addCleanup(self.stop)

    def read(self, wait_s):
        if select.select([self.process.stdout], [], [], wait_s)[0]:
            data = os.read(self.process.stdout.fileno(), 65536)
            self.test.assertTrue(data, f"the program ended: {self.told}{decoded(self.process.stderr.read()) if self.process.poll() is not None else ''}")
            self.told += decoded(data)

    def until(self, holds, what):
        end = time.monotonic() + TIMEOUT_S
        while not holds():
            self.test.assertLess(time.monotonic(), end, f"not seen: {what}; but: {self.told}")
            self.read(.02)

    def until_told(self, text):
        self.until(lambda: text in self.told, text)

    def until_scenes(self, name, count):
        path = self.test.folder / name
        self.until(lambda: path.exists() and path.read_bytes().count(b"\n") >= count, f"{count} scenes")

    def end(self):
        """Ctrl-C; returns all that was said."""
        self.process.send_signal(signal.SIGINT)
        out, err = self.process.communicate(timeout=TIMEOUT_S)
        self.told += decoded(out)
        self.test.assertEqual((self.process.returncode, decoded(err)), (0, ""), self.told)
        return self.told

    def stop(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


def do_steps(test, command, timeout_s):
    """Runs steps of webui/e2e in a browser; what they say. Skipped where there is no browser."""
    done = subprocess.run([str(part) for part in command], cwd=test.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=timeout_s, text=True)
    if done.returncode == 77:
        test.skipTest(done.stdout.strip())
    test.assertEqual(done.returncode, 0, done.stdout)
    test.assertIn("all steps passed", done.stdout)
    return done.stdout


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def main():
    """Runs the tests of the calling script: SCRIPT PROGRAM [unittest arguments]."""
    if len(sys.argv) < 2:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM [unittest arguments]")
    ProgramTest.program = str(pathlib.Path(sys.argv.pop(1)).resolve())
    if not shutil.which("ffmpeg"):
        skip("ffmpeg is not installed")
    run = unittest.main(module="__main__", exit=False)
    if run.result.skipped and run.result.wasSuccessful():
        skip(run.result.skipped[0][1])
    sys.exit(not run.result.wasSuccessful())
