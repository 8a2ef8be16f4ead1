"""From where a place of a part is seen: directions with a line of sight."""

import numpy as np
from beltgrinding.engine import core
from beltgrinding.inspection import sight


def plate(low, high, z, up=True):
    """A square in the plane z as a surface of a Renderer."""
    corners = [[low, low, z], [high, low, z], [high, high, z], [low, high, z]]
    return {
        "vertices": np.array(corners, dtype=float),
        "triangles": np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32),
        "colours": np.array([0xFF], dtype=np.uint32),
    }


def wall(x, low, high):
    """A square across x, from z 0 up."""
    corners = [[x, low, 0], [x, high, 0], [x, high, high - low], [x, low, high - low]]
    return {**plate(0, 1, 0), "vertices": np.array(corners, dtype=float)}


def test_a_place_in_the_open_is_looked_at_along_its_normal():
    floor = core.Renderer([plate(-10, 10, 0)])
    # Not from straight above a lying part's corner only: any normal.
    for normal in ([0, 0, 1], [0.6, 0, 0.8], [0, -1, 0.2]):
        normal = np.array(normal) / np.linalg.norm(normal)
        away, share = sight.towards(floor, [[0, 0, 0]], [normal], normal, 0.1)
        assert away @ normal > 0.97 and share == 1.0


def test_what_stands_in_the_way_is_looked_past():
    # Under a lid of 20 mm, 6 mm above: only from the side.
    lid = core.Renderer([plate(-10, 10, 0), plate(-10, 10, 6)])
    away, share = sight.towards(lid, [[0, 0, 0]], [[0, 0, 1]], [0, 0, 1], 0.1)
    assert share == 1.0 and 0.05 < away[2] < 0.6
    assert lid.seen([[0, 0, 0]], [away], 0.1)[0, 0]
    # In a closed box from nowhere, and it says so.
    sides = [wall(x, -10, 10) for x in (-10, 10)]
    across = [{**one, "vertices": one["vertices"][:, [1, 0, 2]]} for one in sides]
    box = core.Renderer([plate(-10, 10, 0), plate(-10, 10, 20), *sides, *across])
    assert sight.towards(box, [[0, 0, 0]], [[0, 0, 1]], [0, 0, 1], 0.1)[1] == 0.0


def test_the_first_point_counts_most():
    # A wall hides the first point from where all the others are seen.
    scene = core.Renderer([plate(-20, 20, 0), wall(1.0, -20, 20)])
    points = np.array([[0.0, 0.0, 0.0]] + [[5.0 + k, 0.0, 0.0] for k in range(10)])
    normals = np.tile([0.0, 0.0, 1.0], (11, 1))
    preferred = np.array([1.0, 0.0, 0.5])
    away, share = sight.towards(scene, points, normals, preferred, 0.1)
    assert scene.seen(points[:1], [away], 0.1)[0, 0] and share > 0.4


def test_two_sides_show_two_surfaces():
    high = np.array([[x, y, 0.0] for x in range(-9, 10) for y in range(-9, 10)])
    up = np.tile([0.0, 0.0, 1.0], (len(high), 1))
    slab = core.Renderer([plate(-10, 10, 0), plate(-10, 10, -2)])
    # One side of it: both views from above, apart.
    one = sight.Sides(slab, high, up, np.ones(len(high)), 0.1)
    assert one.front()[2] > 0.3 and one.back()[2] > 0.2 and one.front() @ one.back() < 0.6
    # Both sides of it: one from each.
    points, normals = np.vstack([high, high - [0, 0, 2]]), np.vstack([up, -up])
    both = sight.Sides(slab, points, normals, np.ones(len(points)), 0.1)
    assert both.front()[2] > 0.3 > -0.3 > both.back()[2]


def test_directions_are_even_and_points_thinned():
    ways = sight.around()
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1.0)
    assert np.linalg.norm(ways.mean(axis=0)) < 0.01
    nearest = np.sort(ways @ ways.T, axis=1)[:, -2]
    assert nearest.min() > np.cos(np.radians(18))
    assert sight.thinned(10, 3).tolist() == [0, 4, 9] and len(sight.thinned(5)) == 5
    assert len(sight.thinned(0)) == 0
