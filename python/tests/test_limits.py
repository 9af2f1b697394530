"""No argument stops the interpreter: what the library takes for granted is a ValueError in Python.

A broken promise would end this process, which pytest cannot report: so the calls run in a process of their own.
"""
import inspect
import itertools
import random
import subprocess
import sys

import numpy as np
import pytest

import tassilo
from tassilo import Region

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


def test_operators_take_or_refuse_regions_at_the_ends_of_16_bit():
    assert sum(count == 2 for _, count in operators_on_regions()) >= 8
    ended = subprocess.run([sys.executable, __file__], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    called, refused = map(int, ended.stdout.split())
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
    call_everything()
