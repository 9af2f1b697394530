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
    assert tassilo.fill_holes(region, max_area_px=0) == tassilo.fill_holes(region, min_area_px=2) == region
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


def test_boundaries_hats_and_noise_are_their_definitions():
    for seed in range(5):
        region = Region.from_mask(random_mask(seed))
        square, cross = tassilo.rectangle(3, 3), tassilo.diamond(1)
        assert tassilo.inner_boundary(region) == region - tassilo.erosion(region, cross)
        assert tassilo.outer_boundary(region, neighbors=8) == tassilo.dilation(region, square) - region
        assert tassilo.top_hat(region, cross) == region - tassilo.opening(region, cross)
        assert tassilo.bottom_hat(region, cross) == tassilo.closing(region, cross) - region
        ring = square - Region([(0, 0, 1)])
        assert tassilo.remove_noise(region) == region & tassilo.dilation(region, ring)
        assert tassilo.remove_noise(region, "n_4") == region & tassilo.dilation(region, cross - Region([(0, 0, 1)]))
        assert tassilo.hit_or_miss(region, Region([(0, 0, 1)]), ring) == region - tassilo.remove_noise(region)
        assert tassilo.hit_or_miss(region, cross, Region()) == tassilo.erosion(region, cross)
    with pytest.raises(ValueError, match="neighbors is 'n_9', must be one of n_4, n_8, n_48"):
        tassilo.remove_noise(region, "n_9")


def test_elements():
    assert len(tassilo.diamond(2)) == 13 and tassilo.octagon(1) == tassilo.diamond(1)
    assert tassilo.line_element(5) == Region([(0, -2, 3)])
    assert tassilo.line_element(5, np.pi / 2) == tassilo.transposed(tassilo.line_element(5))


def test_transforms():
    mask = random_mask(7)
    region = Region.from_mask(mask)
    assert tassilo.mirrored_left_right(region, (mask.shape[1] - 1) / 2) == Region.from_mask(mask[:, ::-1].copy())
    assert tassilo.mirrored_top_bottom(region, (mask.shape[0] - 1) / 2) == Region.from_mask(mask[::-1])
    assert tassilo.zoomed(region, 2, 3) == Region.from_mask(mask.repeat(3, 0).repeat(2, 1))
    parts = tassilo.partition_into_rectangles(region, 8, 8)
    assert tassilo.union_of(parts) == region and sum(map(len, parts)) == len(region)


def test_outlines_come_back():
    for seed in range(5):
        mask = random_mask(seed)
        region = Region.from_mask(mask)
        for foreground in (4, 8):
            lines = tassilo.outlines(region, foreground)
            assert tassilo.region_from_outlines(lines, window(mask)) == region
            assert sum(is_hole for _, is_hole in lines) == tassilo.hole_count(region, foreground)
    (corners, is_hole), = tassilo.center_outlines(Region.from_box((1, 2, 5, 6)))
    assert not is_hole and sorted(map(tuple, corners)) == [(1, 2), (1, 5), (4, 2), (4, 5)]


def test_relations_are_those_of_sets():
    for seed in range(5):
        a, b = Region.from_mask(random_mask(seed)), Region.from_mask(random_mask(seed + 50))
        assert tassilo.common_area(a, b) == len(a & b) and tassilo.hamming_distance(a, b) == len(a ^ b)
        assert tassilo.overlaps(a, b) == bool(a & b) and tassilo.is_subset(a & b, a) and not tassilo.is_subset(a, a & b)
        assert tassilo.intersection_over_union(a, b) == pytest.approx(len(a & b) / len(a | b))


def test_maps_move_regions():
    region = Region.from_mask(random_mask(2))
    assert tassilo.mapped(region, [[1, 0, 4], [0, 1, -3]]) == tassilo.translated(region, 4, -3)
    turn = tassilo.rotation_about(0, 0, np.pi / 2)
    assert turn == pytest.approx(np.array([[0, 1, 0], [-1, 0, 0]]))
    assert tassilo.mapped(region, turn.round()) == tassilo.mirrored_top_bottom(tassilo.transposed(region), 0)
    for bad in ([[1, 0], [0, 1]], [[1e9, 0, 0], [0, 1, 0]], [[1, 0, float("nan")], [0, 1, 0]]):
        with pytest.raises(ValueError, match="must"):
            tassilo.mapped(region, bad)


def test_shapes_anywhere():
    rows, columns = np.indices((40, 50))
    assert tassilo.circle_region(20, 15, 7.5) == Region.from_mask((columns - 20) ** 2 + (rows - 15) ** 2 <= 7.5**2)
    assert tassilo.ellipse_region(20, 15, 9, 9, 1) == tassilo.circle_region(20, 15, 9)
    assert tassilo.rectangle_region(20, 15, 5, 2) == Region.from_box((15, 13, 26, 18))
    for call in (lambda: tassilo.circle_region(32760, 0, 9), lambda: tassilo.circle_region(0, 0, -1),
                 lambda: tassilo.ellipse_region(0, 0, 1, float("nan")), lambda: tassilo.rectangle_region(0, 0, 1, 1, float("inf"))):
        with pytest.raises(ValueError, match="must"):
            call()


def test_skeletons():
    region = tassilo.closing(Region.from_mask(random_mask(9, (60, 80))), tassilo.disc(1))
    middle = tassilo.skeleton(region)
    assert middle <= region and tassilo.skeleton(middle) == middle
    assert len(tassilo.components(middle)) == len(tassilo.components(region))
    assert tassilo.hole_count(middle) == tassilo.hole_count(region)


def test_component_features_tell_what_the_components_are():
    region = Region.from_mask(np.random.default_rng(4).random((40, 60)) < 0.4)
    for connectivity in (4, 8):
        parts = tassilo.components(region, connectivity)
        told = tassilo.component_features(region, connectivity)
        assert [f["area"] for f in told] == [len(part) for part in parts]
        assert [f["box"] for f in told] == [part.box for part in parts]
