"""What the tests of the Python package share."""
import pathlib

import pytest

import tassilo

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "data/msl98"


@pytest.fixture(scope="session")
def colors():
    return tassilo.train_colors(DATA / "train_div/samples.yaml")


@pytest.fixture
def frame():
    return next(iter(tassilo.open_source(DATA / "d01_approach/video.mkv")))
