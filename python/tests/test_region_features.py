"""Features, shapes around and inside regions, distances, and what regions look like on images: as numpy computes them."""
import json

import numpy as np
import pytest

import tassilo
from tassilo import Frame, Region


def random_mask(seed, shape=(23, 31)):
    return np.random.default_rng(seed).random(shape) < 0.6


def window(mask):
    return (0, 0, mask.shape[1], mask.shape[0])


def test_features_are_those_of_the_pixels():
    mask = random_mask(6)
    region = Region.from_mask(mask)
    rows, columns = np.nonzero(mask)
    values = tassilo.features(region)
    assert list(values) == [info["name"] for info in tassilo.all_features()]
    assert values["area"] == mask.sum()
    assert values["column"] == pytest.approx(columns.mean()) and values["row"] == pytest.approx(rows.mean())
    assert values["moments_m20"] == pytest.approx(rows.var() * mask.sum())
    assert (values["column1"], values["row1"], values["column2"] + 1, values["row2"] + 1) == region.box
    assert region.box == tassilo.bounding_box(region)
    assert tassilo.features(region, ["rb", "area"]) == {"rb": values["rb"], "area": values["area"]}
    assert not any(tassilo.features(Region()).values())


def test_feature_arrays_have_the_names_as_fields():
    regions = [Region.from_mask(random_mask(seed)) for seed in range(5)] + [Region()]
    array = tassilo.feature_array(regions)
    assert array.shape == (6,)
    for region, row in zip(regions, array):
        assert dict(zip(array.dtype.names, row.item())) == tassilo.features(region)
    assert (array["area"] > 300).sum() == sum(len(r) > 300 for r in regions)
    few = tassilo.feature_array(regions, ["area", "anisometry"])
    assert few.dtype.names == ("area", "anisometry") and np.array_equal(few["area"], array["area"])
    assert tassilo.feature_array([]).shape == (0,)


def test_regions_are_selected_and_sorted_by_features():
    parts = tassilo.components(Region.from_mask(random_mask(1) & random_mask(2)), 4)
    large = tassilo.select(parts, {"area": (4, 10), "height": (2, float("inf"))})
    assert large == [p for p in parts if 4 <= len(p) <= 10 and p.box[3] - p.box[1] >= 2] and large
    by_area = tassilo.sorted_by(parts, "area", "falling")
    assert [len(p) for p in by_area] == sorted(map(len, parts), reverse=True)
    assert [p.runs[0].tolist() for p in tassilo.sorted_by_first_point(by_area)] == [p.runs[0].tolist() for p in parts]
    ring = Region.from_box((0, 0, 9, 9)) - Region.from_box((3, 3, 5, 5)) - Region([(7, 7, 8)])
    assert len(tassilo.fill_up(ring, {"area": (2, 9)})) == 80


@pytest.mark.parametrize("call", [
    lambda r: tassilo.features(r, ["areal"]),
    lambda r: tassilo.features(r, []),
    lambda r: tassilo.features(r, ["area", "area"]),
    lambda r: tassilo.select([r], {"areal": (1, 2)}),
    lambda r: tassilo.select([r], {"area": (2, 1)}),
    lambda r: tassilo.select([r], {"area": (1, float("nan"))}),
    lambda r: tassilo.sorted_by([r], "area", "up"),
    lambda r: tassilo.features(Region.from_box((-30000, -30000, 30000, 30000))),
    lambda r: tassilo.inner_circle(Region([(0, 32766, 32767)])),
    lambda r: tassilo.distance_to(r, (-20000, 0, 20000, 1)),
    lambda r: tassilo.distance_to(r, (0, 0, 20000, 20000)),
    lambda r: tassilo.distance_to(r, (0, 0, 2, 2), "taxi"),
    lambda r: tassilo.feret_diameter(r, float("nan")),
    lambda r: tassilo.gray_features(r, np.zeros((3, 3))),
    lambda r: tassilo.gray_quantile(r, np.zeros((3, 3), np.uint8), 1.5),
    lambda r: tassilo.write_png_region("never.png", r, (0, 0, 0, 0)),
    lambda r: tassilo.coco_json(r, 0, 3),
    lambda r: tassilo.coco_json(r, 3, 3, "bits"),
])
def test_wrong_arguments_are_refused_in_words(call):
    with pytest.raises(ValueError, match="must"):
        call(Region.from_box((0, 0, 3, 3)))


def test_wrong_types_are_type_errors():
    region = Region.from_box((0, 0, 3, 3))
    for ranges in ({"area": 3}, {"area": ("a", "b")}, {3: (1, 2)}):
        with pytest.raises(TypeError, match="must be"):
            tassilo.select([region], ranges)


def test_single_features():
    box = Region.from_box((0, 0, 8, 5))
    assert tassilo.convex_hull(box).tolist() == [[0, 0], [7, 0], [7, 4], [0, 4]]
    assert tassilo.convex_area(box) == 40 and tassilo.convexity(box) == 1 and tassilo.rectangularity(box) == pytest.approx(1)
    assert tassilo.contour_length(box) == 22 and tassilo.compactness(box) == 1
    assert tassilo.convex_hull(Region()).shape == (0, 2)
    assert abs(tassilo.orientation(box)) < 1e-9
    assert tassilo.roundness(tassilo.disc(30))["roundness"] > 0.95


def test_shapes_around_and_inside():
    box = Region.from_box((10, 20, 19, 25))
    around = tassilo.smallest_rectangle(box)
    assert (around["column"], around["row"], around["half_length"], around["half_width"]) == (14, 22, 4, 2)
    circle = tassilo.smallest_circle(box)
    assert (circle["column"], circle["row"]) == (14, 22) and circle["radius"] == pytest.approx(np.hypot(4, 2))
    inner = tassilo.inner_circle(box)
    assert inner["radius"] == 2.5 and inner["row"] == 22
    assert tassilo.inner_rectangle(box) == (10, 20, 19, 25)
    assert tassilo.convex_region(box | Region([(30, 14, 15)])) >= box
    assert tassilo.diameter(box)["length"] == pytest.approx(np.hypot(8, 4)) == tassilo.feret_diameters(box)["max"]
    assert tassilo.feret_diameter(box, 0) == pytest.approx(8) and tassilo.feret_diameters(box)["min"] == pytest.approx(4)


def test_distances_are_those_of_brute_force():
    mask = random_mask(3, (9, 12)) & random_mask(4, (9, 12))
    rows, columns = np.indices(mask.shape)
    def nearest(where, metric):
        r, c = np.nonzero(where)
        dr, dc = abs(rows[..., None] - r), abs(columns[..., None] - c)
        return {"euclidean_squared": dr**2 + dc**2, "chessboard": np.maximum(dr, dc), "city_block": dr + dc}[metric].min(-1)
    for metric in ("euclidean_squared", "chessboard", "city_block"):
        assert np.array_equal(tassilo.distance_to(Region.from_mask(mask), window(mask), metric), nearest(mask, metric))
    outside = np.pad(mask, 1)
    rows, columns = np.indices(outside.shape)
    expected = nearest(~outside, "euclidean_squared")[1:-1, 1:-1]
    assert np.array_equal(tassilo.distance_inside(Region.from_mask(mask), window(mask)), expected)


def test_gray_values_are_those_of_the_image():
    mask, image = random_mask(5), np.random.default_rng(5).integers(0, 256, (23, 31), np.uint8)
    region, values = Region.from_mask(mask), image[mask]
    assert np.array_equal(tassilo.gray_histogram(region, image), np.bincount(values, minlength=256))
    found = tassilo.gray_features(region, image)
    assert found["count"] == len(values) and found["mean"] == pytest.approx(values.mean())
    assert found["deviation"] == pytest.approx(values.std()) and (found["min"], found["max"]) == (values.min(), values.max())
    assert tassilo.gray_quantile(region, image, 0.25) == np.sort(values)[int(np.ceil(len(values) / 4)) - 1]
    assert tassilo.gray_moments(region, image)["volume"] == values.sum()
    with_gaps = image.repeat(2, 0).repeat(3, 1)[::-2, ::3]
    assert tassilo.gray_features(region, with_gaps) == tassilo.gray_features(region, with_gaps.copy())
    packed = Frame.yuyv(np.stack([image[:, :30], image[:, :30]], 2))
    assert tassilo.gray_features(region, packed) == tassilo.gray_features(region, image[:, :30])


def test_regions_come_back_from_files(tmp_path):
    mask = random_mask(8)
    region = Region.from_mask(mask)
    tassilo.write_png_region(tmp_path / "mask.png", region, window(mask))
    assert tassilo.read_png_region(tmp_path / "mask.png") == region
    assert np.array_equal(tassilo.read_png(tmp_path / "mask.png")[:, :, 0], mask * 255)
    for counts in ("string", "list"):
        text = tassilo.coco_json(region, mask.shape[1], mask.shape[0], counts)
        assert tassilo.region_from_coco_json(text) == region and json.loads(text)["size"] == list(mask.shape)
    lengths = json.loads(text)["counts"]
    assert np.array_equal(np.repeat(np.arange(len(lengths)) % 2, lengths).reshape(mask.shape[::-1]).T, mask)
    with pytest.raises(tassilo.Error, match="mask"):
        tassilo.region_from_coco_json("{}")
    regions = [region, Region()]
    height, width = mask.shape
    tassilo.write_coco_masks(tmp_path / "masks.json", regions, width, height, "list")
    assert tassilo.read_coco_masks(tmp_path / "masks.json") == regions
    with pytest.raises(ValueError, match="image"):
        tassilo.write_coco_masks(tmp_path / "masks.json", regions, 0, height)
    assert tassilo.read_coco_masks(tmp_path / "masks.json") == regions
