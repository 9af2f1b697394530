"""Frames: looks at arrays without a copy, in all layouts, that nothing leaves dangling."""
import gc
import subprocess
import weakref

import numpy as np
import pytest

import tassilo
from conftest import DATA
from tassilo import Frame


def random_bytes(*shape):
    return np.random.default_rng(7).integers(0, 256, shape, np.uint8)


def repeated(plane, width, height):
    return plane.repeat(2, 1)[:, :width] if plane.shape[0] == height else plane.repeat(2, 0).repeat(2, 1)[:height, :width]


def test_packed_frames():
    array = random_bytes(5, 8, 2)
    for make, luma in ((Frame.yuyv, 0), (Frame.uyvy, 1)):
        yuv = make(array).to_yuv()
        assert np.array_equal(yuv[:, :, 0], array[:, :, luma])
        chroma = array[:, :, 1 - luma]
        assert np.array_equal(yuv[:, :, 1], chroma[:, 0::2].repeat(2, 1))
        assert np.array_equal(yuv[:, :, 2], chroma[:, 1::2].repeat(2, 1))


@pytest.mark.parametrize("width, height", [(8, 6), (7, 5), (1, 1)])
def test_planar_frames(width, height):
    y = random_bytes(height, width)
    for make, rows in ((Frame.yuv422p, height), (Frame.yuv420p, (height + 1) // 2)):
        u, v = random_bytes(2, rows, (width + 1) // 2)
        yuv = make(y, u, v).to_yuv()
        for channel, plane in enumerate((y, repeated(u, width, height), repeated(v, width, height))):
            assert np.array_equal(yuv[:, :, channel], plane)
    uv = random_bytes((height + 1) // 2, (width + 1) // 2, 2)
    expected = Frame.yuv420p(y, np.ascontiguousarray(uv[:, :, 0]), np.ascontiguousarray(uv[:, :, 1])).to_yuv()
    assert np.array_equal(Frame.nv12(y, uv).to_yuv(), expected)
    assert np.array_equal(Frame.nv12(y, uv.reshape(uv.shape[0], -1)).to_yuv(), expected)


def test_frames_are_looks_without_a_copy():
    array = random_bytes(6, 8, 2)
    frame = Frame.yuyv(array[::-2])
    assert frame.to_yuv()[0, 0, 0] == array[5, 0, 0]
    array[5, 0, 0] ^= 255
    assert frame.to_yuv()[0, 0, 0] == array[5, 0, 0]


def test_frames_keep_their_arrays():
    class Owned(np.ndarray):
        pass

    array = random_bytes(4, 4, 2).view(Owned)
    seen = weakref.ref(array)
    frame = Frame.yuyv(array)
    del array
    gc.collect()
    assert seen() is not None and frame.to_yuv().shape == (4, 4, 3)
    del frame
    gc.collect()
    assert seen() is None


def test_rgb_becomes_bt601():
    rgb = np.zeros((2, 4, 3), np.uint8)
    rgb[:, :2] = 255, 0, 0
    assert Frame.rgb(rgb).to_yuv()[0, 0].tolist() == [81, 90, 240]
    assert Frame.rgb(rgb, range="full").to_yuv()[0, 0].tolist() == [76, 85, 255]
    noise = random_bytes(3, 7, 3)[:, ::-1, ::-1]  # any strides: it is copied anyway
    assert np.array_equal(Frame.rgb(noise).to_yuv(), Frame.rgb(noise.copy()).to_yuv())
    smooth = np.broadcast_to(np.arange(0, 256, 5, np.uint8)[:, None, None], (52, 2, 3))
    assert np.abs(Frame.rgb(smooth, range="full").to_rgb().astype(int) - smooth).max() <= 1


def test_rgb_and_a_png_of_it_are_the_same_frame(tmp_path):
    rgb = random_bytes(9, 11, 3)
    tassilo.write_png(tmp_path / "a.png", rgb)
    assert np.array_equal(tassilo.read_png(tmp_path / "a.png"), rgb)
    for range_ in ("limited", "full"):
        (read,) = tassilo.open_source(tmp_path / "a.png", images_range=range_)
        assert np.array_equal(read.to_yuv(), Frame.rgb(rgb, range=range_).to_yuv())
        assert read.image == "a.png" and read.range == range_


def test_facts_of_a_frame():
    frame = Frame.rgb(random_bytes(2, 4, 3), range="full", t=1.5, index=7, image="x.png")
    assert (frame.width, frame.height, frame.format, frame.range) == (4, 2, "yuv422p", "full")
    assert (frame.t, frame.index, frame.image) == (1.5, 7, "x.png")
    assert repr(frame) == "<tassilo.Frame: yuv422p 4x2, full range>"


@pytest.mark.parametrize("call", [
    lambda: Frame.yuyv(random_bytes(4, 5, 2)),
    lambda: Frame.yuyv(random_bytes(4, 4, 3)),
    lambda: Frame.yuyv(random_bytes(4, 4)),
    lambda: Frame.yuyv(random_bytes(4, 4, 2).astype(np.uint16)),
    lambda: Frame.yuyv(random_bytes(4, 8, 2)[:, ::2]),
    lambda: Frame.yuyv(random_bytes(4, 4, 4)[:, :, ::2]),
    lambda: Frame.yuyv(random_bytes(0, 4, 2)),
    lambda: Frame.yuyv(np.zeros((1, 32768, 2), np.uint8)),
    lambda: Frame.yuv420p(random_bytes(4, 4), random_bytes(2, 2), random_bytes(2, 3)),
    lambda: Frame.yuv420p(random_bytes(5, 5), random_bytes(2, 3), random_bytes(2, 3)),
    lambda: Frame.yuv422p(random_bytes(4, 4), random_bytes(4, 4)[:, ::2], random_bytes(4, 2)),
    lambda: Frame.nv12(random_bytes(4, 4), random_bytes(2, 2)),
    lambda: Frame.nv12(random_bytes(4, 4), random_bytes(2, 2, 3)),
    lambda: Frame.rgb(random_bytes(4, 4, 4)),
    lambda: Frame.rgb(random_bytes(4, 4, 3) / 255),
    lambda: Frame.rgb(random_bytes(4, 4, 3), t=float("inf")),
    lambda: Frame.rgb(random_bytes(4, 4, 3), range="pc"),
    lambda: tassilo.write_png("never.png", random_bytes(4)),
    lambda: tassilo.write_png("never.png", random_bytes(4, 0)),
    lambda: tassilo.write_png("never.png", random_bytes(4, 4, 4)),
])
def test_arrays_that_are_no_frame_are_refused_in_words(call):
    with pytest.raises(ValueError, match="must"):
        call()


def test_sources_are_iterators():
    source = tassilo.open_source(DATA / "d01_approach/video.mkv")
    assert (source.width, source.height, source.range) == (384, 172, "limited")
    frames = list(source)
    assert len(frames) == source.frame_count and [f.index for f in frames] == list(range(len(frames)))
    assert not list(source)
    with pytest.raises(tassilo.Error, match="missing.mkv"):
        tassilo.open_source("missing.mkv")


def test_raw_bytes_of_another_program_are_the_same_frame():
    video = DATA / "d01_approach/video.mkv"
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", video, "-frames:v", "1", "-f", "rawvideo", "-pix_fmt", "yuyv422", "-"],
                         capture_output=True, check=True).stdout
    array = np.frombuffer(raw, np.uint8).reshape(172, 384, 2)
    assert np.array_equal(Frame.yuyv(array).to_yuv(), next(tassilo.open_source(video)).to_yuv())
