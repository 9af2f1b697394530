"""Regions in Python: what comes in comes out, operators are the library's, and sets behave like sets."""
import copy
import gc
import pickle

import numpy as np
import pytest

import tassilo
from tassilo import Region


def random_mask(seed, shape=(23, 31)):
    return np.random.default_rng(seed).random(shape) < 0.6


def window(mask):
    return (0, 0, mask.shape[1], mask.shape[0])


def test_masks_and_runs_come_back():
    for seed in range(20):
        mask = random_mask(seed)
        region = Region.from_mask(mask)
        assert np.array_equal(tassilo.to_mask(region, window(mask), 1), mask)
        assert len(region) == region.area == tassilo.area(region) == mask.sum()
        assert Region(region.runs) == region
        shuffled = np.random.default_rng(seed).permutation(region.runs)
        assert Region(shuffled.tolist()) == region


def test_masks_may_have_any_distance_between_rows():
    mask = random_mask(1, (40, 60))
    for view in (mask[::2], mask[::-1], mask[3:9, 5:20], mask[:, :0]):
        assert Region.from_mask(view) == Region.from_mask(view.copy())
    for bad in (mask[:, ::2], mask.astype(float), mask[0], mask[:, :, None], np.zeros((1, 40000), bool)):
        with pytest.raises(ValueError, match="^mask .* must"):
            Region.from_mask(bad)
    assert Region.from_mask(np.uint8([[0, 7, 1]])) == Region([(0, 1, 3)])


def test_runs_are_a_read_only_view_that_keeps_the_region():
    runs = Region.from_box((2, 3, 5, 6)).runs
    gc.collect()
    assert runs.dtype == np.int16 and runs.tolist() == [[3, 2, 5], [4, 2, 5], [5, 2, 5]]
    region = Region([(0, 0, 9)])
    assert region.runs.ctypes.data == region.runs.ctypes.data  # no copy
    with pytest.raises(ValueError):
        runs[0, 0] = 1
    with pytest.raises(ValueError):
        runs.flags.writeable = True
    assert Region().runs.shape == (0, 3)


def test_runs_are_sorted_and_joined():
    assert Region([(1, 4, 9), (0, 5, 5), (1, 0, 4)]).runs.tolist() == [[1, 0, 9]]
    assert Region([]) == Region() == Region(np.empty((0, 3), np.int64))
    for bad in ([1, 2, 3], [[1, 2]], [[0.0, 1.0, 2.0]], [[0, 0, 32768]], [[-32769, 0, 1]], [[0, 0, 2**60]]):
        with pytest.raises(ValueError, match="must be"):
            Region(bad)


def test_a_region_is_a_set_of_pixels():
    a, b = Region.from_box((0, 0, 6, 4)), Region.from_box((3, 2, 9, 8))
    assert (5, 3) in a and (6, 3) not in a and (-1, 0) not in a and (2**40, 0) not in a
    assert len(a | b) + len(a & b) == len(a) + len(b)
    assert a - b == a & (a ^ b) and a & b <= a and not a <= b
    assert not Region() and a and Region() <= a
    assert a == Region.from_box((0, 0, 6, 4)) and a != b and a != 3
    assert {a: 1}[Region.from_box((0, 0, 6, 4))] == 1
    with pytest.raises(TypeError):
        iter(a)
    with pytest.raises(TypeError):
        a | 3


def test_repr_is_short():
    assert repr(Region()) == "<tassilo.Region: empty>"
    assert repr(Region.from_box((1, 2, 4, 3))) == "<tassilo.Region: 3 px, 1 run, box (1, 2, 4, 3)>"
    assert len(repr(Region.from_mask(random_mask(0)))) < 80


def test_pickles_and_copies_are_equal():
    region = Region.from_mask(random_mask(3))
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(region, protocol)) == region
    assert copy.deepcopy(region) == copy.copy(region) == region
    with pytest.raises(ValueError):
        Region.__new__(Region).__setstate__((b"12345",))


def test_plain_calls_read_well():
    region = Region.from_mask(random_mask(4, (80, 80))) | Region.from_box((20, 20, 60, 60))
    opened = tassilo.opening(region, tassilo.disc(3.5))
    assert opened <= region and opened == tassilo.opening(opened, tassilo.disc(3.5))
    assert opened == tassilo.dilation(tassilo.erosion(region, tassilo.disc(3.5)), tassilo.disc(3.5))
    assert region <= tassilo.closing(region, tassilo.rectangle(3, 3))


def test_morphology_is_its_definition():
    element = Region([(0, 0, 2), (1, -1, 1)])
    offsets = [(c, r) for r, begin, end in element.runs.tolist() for c in range(begin, end)]
    for seed in range(10):
        region = Region.from_mask(random_mask(seed, (9, 9)))
        moved = [tassilo.translated(region, columns=c, rows=r) for c, r in offsets]
        back = [tassilo.translated(region, -c, -r) for c, r in offsets]
        assert tassilo.dilation(region, element) == tassilo.union_of(moved)
        common = back[0]
        for other in back[1:]:
            common &= other
        assert tassilo.erosion(region, element) == common


def test_set_algebra_is_that_of_masks():
    for seed in range(10):
        a, b = random_mask(seed), random_mask(seed + 100)
        ra, rb = Region.from_mask(a), Region.from_mask(b)
        assert tassilo.union_of(ra, rb) == tassilo.union_of([ra, rb]) == Region.from_mask(a | b)
        assert tassilo.intersection(ra, rb) == Region.from_mask(a & b)
        assert tassilo.difference(ra, rb) == Region.from_mask(a & ~b)
        assert tassilo.symmetric_difference(ra, rb) == Region.from_mask(a ^ b)
        assert tassilo.complement(ra, window(a)) == Region.from_mask(~a)
        assert tassilo.clipped(ra, (4, 5, 9, 8)) == ra & Region.from_box((4, 5, 9, 8))
        assert tassilo.transposed(ra) == Region.from_mask(np.ascontiguousarray(a.T))
        assert tassilo.reflected(tassilo.reflected(ra)) == ra


def test_components_and_holes():
    mask = np.pad(np.uint8([[1, 1, 1, 0], [1, 0, 1, 0], [1, 1, 1, 0], [0, 0, 0, 1]]), 1)
    region = Region.from_mask(mask)
    assert len(tassilo.components(region)) == 1 and len(tassilo.components(region, connectivity=4)) == 2
    labels, count = tassilo.label_runs(region, 4)
    assert count == 2 and len(labels) == len(region.runs)
    assert tassilo.holes(region) == Region([(2, 2, 3)])
    assert tassilo.fill_holes(region) == region | tassilo.holes(region)
    assert tassilo.fill_holes(region, max_area_px=0) == region
    assert tassilo.euler_number(region) == 0 and tassilo.hole_count(region) == 1
    with pytest.raises(ValueError, match="connectivity is 6, must be 4 or 8"):
        tassilo.components(region, 6)


def test_labels_come_back():
    labels = np.random.default_rng(5).integers(0, 5, (20, 30), np.uint8)
    regions = tassilo.regions_of_labels(labels, 5)
    assert [len(r) for r in regions] == np.bincount(labels.ravel()).tolist()
    assert np.array_equal(tassilo.to_labels(regions, window(labels)), labels)
    assert tassilo.to_labels(regions, (0, 0, 0, 0)).shape == (0, 0)


def test_polygons():
    square = tassilo.region_from_polygon([(0, 0), (4, 0), (4, 3), (0, 3)], (0, 0, 10, 10))
    assert square == Region.from_box((0, 0, 4, 3))
    assert not tassilo.region_from_polygon([], (0, 0, 10, 10))
    for bad in ([(0, 0, 1)], [(0, float("nan"))] * 3, [(0, 1e300)] * 3):
        with pytest.raises(ValueError, match="vertices"):
            tassilo.region_from_polygon(bad, (0, 0, 10, 10))


def test_features_are_those_of_the_pixels():
    mask = random_mask(6)
    region = Region.from_mask(mask)
    rows, columns = np.nonzero(mask)
    shape = tassilo.shape_features(region)
    assert shape["area"] == mask.sum()
    assert shape["column"] == pytest.approx(columns.mean()) and shape["row"] == pytest.approx(rows.mean())
    assert shape["rr"] == pytest.approx(rows.var()) and shape["cc"] == pytest.approx(columns.var())
    assert tuple(shape[k] for k in ("x0", "y0", "x1", "y1")) == region.box == tassilo.bounding_box(region)
    assert all(isinstance(value, (int, float)) for value in shape.values())


def test_feature_arrays_have_the_keys_of_the_dict_as_fields():
    regions = [Region.from_mask(random_mask(seed)) for seed in range(5)] + [Region()]
    array = tassilo.feature_array(regions)
    assert array.shape == (6,)
    for region, row in zip(regions, array):
        assert dict(zip(array.dtype.names, row.item())) == tassilo.shape_features(region)
    assert (array["area"] > 300).sum() == sum(len(r) > 300 for r in regions)


def test_single_features():
    box = Region.from_box((0, 0, 8, 5))
    assert tassilo.convex_hull(box).tolist() == [[0, 0], [7, 0], [7, 4], [0, 4]]
    assert tassilo.convex_area(box) == 40 and tassilo.convexity(box) == 1 and tassilo.rectangularity(box) == pytest.approx(1)
    assert tassilo.contour_length(box) == 22 and tassilo.compactness(box) == 1
    assert tassilo.convex_hull(Region()).shape == (0, 2)
