"""No argument stops the interpreter: what the library takes for granted is a ValueError in Python.

A broken promise would end this process, which pytest cannot report: so the calls run in a process of their own.
"""
import ctypes
import inspect
import itertools
import mmap
import random
import subprocess
import sys

import numpy as np
import pytest

import tassilo
from conftest import DATA
from tassilo import Frame, Region

LOW, HIGH = -32768, 32767


def extreme_regions():
    ends = (LOW, LOW + 1, -1, 0, 1, HIGH - 2, HIGH - 1)
    pixels = [Region([(row, column, column + 1)]) for row, column in itertools.product((*ends, HIGH), ends)]
    pairs = [a | b for a, b in itertools.combinations(random.Random(1).sample(pixels, 12), 2)]
    frame = Region([(LOW, LOW, HIGH), (HIGH, LOW, HIGH)]) | Region([(row, LOW, LOW + 1) for row in range(LOW, HIGH)])
    return [Region(), Region.from_box((-3, -3, 4, 4)), frame, *pixels, *pairs]


def operators_on_regions():
    """Public functions whose arguments without default are regions, with how many they take."""
    for name in tassilo.__all__:
        function = getattr(tassilo, name)
        if inspect.isclass(function):
            continue
        for line in function.__doc__.splitlines():
            head = line.partition("(")[2].partition(") ->")[0]
            required = [p for p in head.split(", ") if p and "=" not in p and p != "*"]
            if "->" in line and required and all(p.endswith(": tassilo.Region") for p in required):
                yield function, len(required)
                break


def call_everything():
    regions = extreme_regions()
    called = refused = 0
    for function, count in operators_on_regions():
        some = regions if count == 1 else random.Random(2).sample(regions, 40)
        for arguments in itertools.product(some, repeat=count):
            try:
                function(*arguments)
                called += 1
            except ValueError as error:
                assert "must" in str(error), error
                refused += 1
    print(called, refused)


def call_with_junk():
    """Every function and constructor with arguments of all kinds, most of them wrong."""
    chance = random.Random(3)
    image = np.random.default_rng(3).integers(0, 256, (20, 30, 3), np.uint8)
    regions = [Region(), Region.from_box((0, 0, 9, 9)), Region([(HIGH, HIGH - 1, HIGH)]), Region([(LOW, LOW, HIGH)])]
    values = [None, 0, 1, -1, 3, 2**31, 2**70, 1.5, -1e300, float("nan"), float("inf"), "red", "limited", "rising", "", b"x",
              (0, 0, 5, 5), (0, 0, HIGH, 3), (-10**9, 0, 10**9, 3), (1, 2), [], {}, {"area": (0, 5)}, [(0, 0), (3, 0), (3, 3)],
              [(0, float("nan"))] * 3, [(np.zeros((4, 2)), True)], image, image[:, :, 0], image[:, ::2, 0], image / 2,
              np.zeros((0, 3), int), np.zeros((5, 0), np.uint8), np.array(3), Frame.rgb(image), *regions, regions, object()]
    calls = [getattr(tassilo, name) for name in tassilo.__all__ if not name.startswith("write")]
    calls += [Region.from_box, Region.from_mask, Frame.rgb, Frame.yuyv, Frame.nv12, Frame.yuv420p]
    done = 0
    for _ in range(20000):
        try:
            chance.choice(calls)(*chance.choices(values, k=chance.randint(0, 4)))
            done += 1
        except (ValueError, TypeError, tassilo.Error):
            pass
    print(done)


def guarded(shape, at_end):
    """Random bytes in memory of their own; what lies behind (or before) them must not be touched."""
    count = int(np.prod(shape))
    size = -(-count // mmap.PAGESIZE) * mmap.PAGESIZE
    libc = ctypes.CDLL(None)
    libc.mmap.restype = ctypes.c_void_p
    libc.mmap.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int, ctypes.c_int, ctypes.c_int, ctypes.c_long]
    libc.mprotect.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int]
    start = libc.mmap(None, size + 2 * mmap.PAGESIZE, mmap.PROT_READ | mmap.PROT_WRITE,
                      mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS, -1, 0)
    for page in (start, start + mmap.PAGESIZE + size):
        assert libc.mprotect(page, mmap.PAGESIZE, 0) == 0
    first = start + mmap.PAGESIZE + (size - count if at_end else 0)
    array = np.ctypeslib.as_array((ctypes.c_uint8 * count).from_address(first)).reshape(shape)
    array[...] = np.random.default_rng(count).integers(0, 256, shape, np.uint8)
    return array


def see_guarded_frames():
    colors = tassilo.train_colors(DATA / "train_div/samples.yaml")
    vision = tassilo.Vision(colors)
    for at_end, width, height in itertools.product((True, False), (*range(1, 70), 127, 128, 129, 257), (1, 2, 3)):
        def of(*shape):
            return guarded(shape, at_end)

        half, low = (width + 1) // 2, (height + 1) // 2
        frames = [Frame.yuv422p(of(height, width), of(height, half), of(height, half)),
                  Frame.yuv420p(of(height, width), of(low, half), of(low, half)), Frame.nv12(of(height, width), of(low, half, 2))]
        if width % 2 == 0:
            frames += [Frame.yuyv(of(height, width, 2)), Frame.uyvy(of(height, width, 2))]
        for frame in frames:
            vision(frame)
            frame.to_rgb()
            tassilo.gray_features(Region.from_box((0, 0, width, height)), frame)
    print(width)


def in_a_process_of_its_own(name):
    """The numbers `name` printed; fails when the interpreter did not live to the end."""
    ended = subprocess.run([sys.executable, __file__, name], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    return [int(number) for number in ended.stdout.split()]


def test_junk_is_refused():
    assert in_a_process_of_its_own("call_with_junk")[0] > 100


def test_frames_are_read_to_their_last_byte_and_no_further():
    assert in_a_process_of_its_own("see_guarded_frames") == [257]


def test_operators_take_or_refuse_regions_at_the_ends_of_16_bit():
    assert sum(count == 2 for _, count in operators_on_regions()) >= 8
    called, refused = in_a_process_of_its_own("call_everything")
    assert called > 5000 and refused > 1000


def test_operators_near_the_ends_that_fit_are_not_refused():
    far = Region.from_box((32000, -32000, 32010, -31990))
    assert tassilo.opening(far, tassilo.disc(3.5)) <= far
    assert len(tassilo.dilation(Region([(0, 0, 1)]), tassilo.disc(5000))) > 7e7


@pytest.mark.parametrize("call", [
    lambda r: tassilo.translated(r, columns=2**31 - 1),
    lambda r: tassilo.translated(r, rows=-65536),
    lambda r: tassilo.complement(r, (0, 0, 40000, 1)),
    lambda r: tassilo.to_mask(r, (0, 0, 10**9, 10**9)),
    lambda r: tassilo.to_labels([r] * 257, (0, 0, 2, 2)),
    lambda r: tassilo.to_labels([r], (-10**9, 0, 10**9, 1)),
    lambda r: tassilo.clipped(r, (0, 0, 2**70, 1)),
    lambda r: tassilo.regions_of_labels(np.zeros((2, 2), np.uint8), -1),
    lambda r: tassilo.regions_of_labels(np.zeros((2, 2), np.uint8), 257),
    lambda r: tassilo.region_from_polygon([(0, 0)] * 3, (0, 0, 40000, 2)),
    lambda r: tassilo.fill_holes(r, -1),
    lambda r: tassilo.rectangle(0, 3),
    lambda r: tassilo.rectangle(65534, 3),
    lambda r: tassilo.disc(-1),
    lambda r: tassilo.disc(float("nan")),
    lambda r: tassilo.disc(1e300),
    lambda r: Region.from_box((0, 0, 32768, 1)),
    lambda r: Region.from_box((0, -32769, 1, 1)),
    lambda r: tassilo.opening(r, Region()),
])
def test_what_would_break_a_promise_is_refused_in_words(call):
    with pytest.raises(ValueError, match="must"):
        call(Region.from_box((0, 0, 5, 5)))


def test_other_types_are_type_errors():
    for call in (lambda: tassilo.disc("3"), lambda: tassilo.opening(3, tassilo.disc(1)), lambda: tassilo.rectangle(1.5, 2),
                 lambda: Region.from_box((1, 2, 3)), lambda: Region.from_box((0.5, 0, 2, 2)), lambda: Region.from_mask(None)):
        with pytest.raises(TypeError):
            call()


if __name__ == "__main__":
    globals()[sys.argv[1]]()
