"""Contours: borders, skeletons taken apart, and edges between pixels."""
import numpy as np
import pytest

import tassilo
from tassilo import Frame, Region


def test_borders_are_the_border_pixels():
    ring = Region.from_box((0, 0, 9, 7)) - Region.from_box((3, 3, 6, 5))
    (outer, outer_is_hole), (inner, inner_is_hole) = tassilo.boundary_contours(ring)
    assert not outer_is_hole and inner_is_hole
    steps = np.diff(np.vstack([outer, outer[:1]]), axis=0)
    assert abs(steps).max() == 1 and np.hypot(*steps.T).sum() == tassilo.contour_length(ring)
    assert {tuple(p) for p in np.vstack([outer, inner]).astype(int)} <= {
        (c, r) for r, begin, end in tassilo.inner_boundary(ring).runs.tolist() for c in range(begin, end)}
    assert tassilo.boundary_contours(Region()) == []


def test_skeletons_come_apart_at_junctions():
    cross = Region([(10, 0, 21)]) | tassilo.transposed(Region([(10, 0, 21)]))
    parts = tassilo.skeleton_contours(tassilo.skeleton(cross))
    assert len(parts["junctions"]) == 1 and len(parts["contours"]) == 4 and len(parts["ends"]) == 4
    assert (parts["junctions"][0]["column"], parts["junctions"][0]["row"]) == (10, 10)
    assert all(-1 in (part["from"], part["to"]) and not part["closed"] for part in parts["contours"])
    assert tassilo.skeleton_contours(cross, min_points=50)["contours"] == []
    with pytest.raises(ValueError, match="min_points is 0, must be >= 1"):
        tassilo.skeleton_contours(cross, 0)


def test_edges_lie_between_pixels():
    rows, columns = np.indices((80, 80))
    image = 60 + 120 / (1 + np.exp(2 * (np.hypot(columns - 40.3, rows - 39.6) - 20)))
    y = image.round().astype(np.uint8)
    gray = np.full((80, 40), 128, np.uint8)
    edges = tassilo.sub_pixel_edges(Frame.yuv422p(y, gray, gray), Region.from_box((0, 0, 80, 80)))
    points = np.vstack([points for points, _ in edges])
    assert len(points) > 100 and abs(np.hypot(*(points - (40.3, 39.6)).T) - 20).max() < 0.2
    for bad in ({"filter_size_px": 4}, {"low": 0}, {"low": float("nan")}, {"low": 9, "high": 8}, {"min_points": 0}):
        with pytest.raises(ValueError, match="must"):
            tassilo.sub_pixel_edges(Frame.yuv422p(y, gray, gray), Region(), **bad)
