"""Color tables: trained from files and from arrays, saved, loaded, and what they make of frames."""
import numpy as np
import pytest

import tassilo
from conftest import DATA
from tassilo import ColorTable, Frame, Region

RED, GREEN, GRAY = (200, 40, 30), (30, 150, 60), (128, 128, 128)


def picture(shift=0):
    """Red left, green right, gray below, with noise."""
    image = np.empty((60, 80, 3), float)
    image[:40, :40], image[:40, 40:], image[40:] = RED, GREEN, GRAY
    image += np.random.default_rng(shift).normal(0, 3, image.shape) + shift
    return Frame.rgb(image.clip(0, 255).astype(np.uint8))


def samples():
    return [(frame, Region.from_box(box), name) for frame in (picture(), picture(4))
            for box, name in (((2, 2, 38, 38), "red"), ((42, 2, 78, 38), "green"))]


def test_arrays_train_a_table():
    table = tassilo.train_colors(samples())
    assert set(table.brightness) == {"red", "green"} and table.range == "limited"
    quality = table.trained_from["quality"]
    assert quality["red"]["recall"] > 0.9 and quality["green"]["precision"] > 0.9
    found = tassilo.segment(picture(2), table)
    assert len(found["red"] & Region.from_box((0, 0, 40, 40))) > 1500 and not found["red"] & Region.from_box((42, 0, 80, 60))
    figures = tassilo.color_quality(table, samples())
    assert figures["recall"]["red"] > 0.9 and figures["confusion"].shape == (9, 9)
    assert figures["confusion"].sum() == sum(len(region) for _, region, _ in samples())


def test_samples_files_train_the_table_of_the_program(colors, tmp_path):
    assert set(colors.brightness) == {"black", "white", "green", "blue", "cyan", "magenta", "red", "yellow"}
    assert colors.trained_from["samples"].endswith("samples.yaml")
    assert all(0.8 < figures["recall"] <= 1 for figures in colors.trained_from["quality"].values())
    held_out = tassilo.train_colors(DATA / "train_div/samples.yaml", held_out=str(DATA / "train_div/samples_mask.yaml"))
    assert held_out == colors and "samples_mask" in held_out.trained_from["notes"]


def test_tables_come_back_from_files(colors, tmp_path):
    colors.save(tmp_path / "colors.yaml")
    again = ColorTable.load(str(tmp_path / "colors.yaml"))
    assert again == colors and again.trained_from == colors.trained_from
    with pytest.raises(tassilo.Error, match="none.yaml"):
        ColorTable.load(tmp_path / "none.yaml")


def test_tables_come_back_from_arrays(colors):
    again = ColorTable(colors.chroma, colors.brightness, range=colors.range, priority=colors.priority)
    assert again == colors and again.trained_from is None
    assert not colors.chroma.flags.writeable and colors.chroma.shape == (256, 256)


def test_segmentations_are_labels_and_regions(colors, frame):
    found = tassilo.segment(frame, colors)
    assert found.labels.shape == (frame.height, frame.width) == (found.height, found.width)
    assert tassilo.regions_of_labels(found.labels, 9)[1:] == list(found.regions.values())
    assert found["red"] == found.regions["red"]
    yuv = frame.to_yuv()
    names = ["no_color", *found.regions]
    for row, column in ((10, 10), (80, 190), (150, 300), (90, 1)):
        assert names[found.labels[row, column]] == colors.classify(*yuv[row, column].tolist())
    labels = found.labels
    with pytest.raises(ValueError):
        labels[0, 0] = 1
    del found
    assert labels.max() <= 8


def test_other_layouts_of_the_same_pixels_segment_alike(colors, frame):
    yuv = frame.to_yuv()
    packed = np.stack([yuv[:, :, 0], np.where(np.arange(frame.width) % 2, yuv[:, :, 2], yuv[:, :, 1])], axis=2)
    assert np.array_equal(tassilo.segment(Frame.yuyv(packed), colors).labels, tassilo.segment(frame, colors).labels)


@pytest.mark.parametrize("call", [
    lambda c: ColorTable(c.chroma[:100], {}),
    lambda c: ColorTable(c.chroma.astype(int), {}),
    lambda c: ColorTable(c.chroma, {"red": (0, 300)}),
    lambda c: ColorTable(c.chroma, {"rot": (0, 30)}),
    lambda c: ColorTable(c.chroma, {"no_color": (0, 30)}),
    lambda c: ColorTable(c.chroma, {}, priority=["red"]),
    lambda c: ColorTable(c.chroma, {}, priority=["red"] * 8),
    lambda c: ColorTable(c.chroma, {}, range="half"),
    lambda c: tassilo.segment(Frame.rgb(np.zeros((2, 2, 3), np.uint8), range="full"), c),
    lambda c: tassilo.train_colors([(picture(), Region(), "red")]),
    lambda c: tassilo.train_colors([(picture(), "red")]),
    lambda c: tassilo.train_colors(samples(), options={"closing": 3}),
    lambda c: tassilo.train_colors(samples(), options={"closing_px": 3.5}),
    lambda c: tassilo.train_colors(samples(), options={"closing_px": 99}),
    lambda c: tassilo.train_colors(samples(), options={"noise_margin": float("nan")}),
])
def test_wrong_arguments_are_refused_in_words(colors, call):
    with pytest.raises(ValueError, match="must"):
        call(colors)


def test_wrong_types_are_type_errors():
    for bad in ((1, Region(), "red"), (picture(), 2, "red"), (picture(), Region.from_box((0, 0, 5, 5)), 3)):
        with pytest.raises(TypeError, match="must be"):
            tassilo.train_colors([bad])


def test_nothing_to_learn_from_is_an_error():
    for nothing in ([], [(picture(), Region.from_box((0, 0, 5, 5)), "no_color")]):
        with pytest.raises(tassilo.Error, match="sample"):
            tassilo.train_colors(nothing)


def test_what_is_odd_is_a_warning(tmp_path):
    tassilo.write_png(tmp_path / "a.png", picture().to_rgb())
    (tmp_path / "samples.yaml").write_text("- {image: a.png, class: red, rectangle: [2, 2, 30, 30]}\n"
                                           "- {image: a.png, class: green, rectangle: [60, 2, 90, 30]}\n")
    with pytest.warns(UserWarning, match="leaves the image"):
        tassilo.train_colors(tmp_path / "samples.yaml")


def test_an_opened_segmentation_has_every_region_opened():
    table = tassilo.train_colors(samples())
    noisy = picture(9)
    plain, opened = tassilo.segment(noisy, table), tassilo.segment_opened(noisy, table)
    assert tassilo.opening3x3(plain).regions == opened.regions
    for color in ("red", "green"):
        assert opened[color] == tassilo.opening(plain[color], tassilo.rectangle(3, 3))
