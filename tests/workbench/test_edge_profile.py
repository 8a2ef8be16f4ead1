"""The ground profile at edges: radius left and chord loss, of sections whose answer is known, and of zones."""

import math

import numpy as np
import pytest
import Part

from beltgrinding.engine import core
from beltgrinding.inspection import edge_profile, section_plot

TURN = math.radians(120.0)  # from one flank of the wedge to the other


def wedge(radius, height, pieces=1, step=0.02, flank=3.0):
    """A section of a wedge with a nose of ``radius``, its tip at 0 0 0, the z axis out of it; ``height`` of
    (point (n, 3), normal (n, 3)) mm."""
    count = max(int(radius * TURN / step), 1)
    angle = np.linspace(-TURN / 2, TURN / 2, count + 1) if radius else np.array([-TURN, TURN]) / 2
    nose = radius * np.stack([np.sin(angle), np.cos(angle) - 1.0], axis=1)
    way = np.arange(step, flank, step)[:, None] * [math.cos(TURN / 2), -math.sin(TURN / 2)]
    left, right = nose[0] + (way * [-1, 1])[::-1], nose[-1] + way
    points = np.concatenate([left, nose, right])
    sides = np.concatenate([np.full(len(way), -TURN / 2), angle, np.full(len(way), TURN / 2)])
    normals = np.stack([np.sin(sides), np.cos(sides)], axis=1)
    points, normals = (np.insert(values, 1, 0.0, axis=1) for values in (points, normals))
    found = []
    middle = len(left) + len(nose) // 2
    for part in [slice(None)] if pieces == 1 else [slice(0, middle), slice(middle, None)]:
        p, n = points[part], normals[part]
        h = np.asarray(height(p, n), dtype=float) + np.zeros(len(p))
        found.append(
            {
                "face": len(found),
                "closed": False,
                "s": np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))]),
                "point": p,
                "normal": n,
                "ray": n,
                "height": h,
                "stock_height": h,
            }
        )
    return {
        "point": [0, 0, 0],
        "normal": [0.0, 1.0, 0.0],
        "tolerance": (-0.1, 0.1),
        "pieces": found,
    }


@pytest.mark.parametrize("radius", (0.2, 1.0))
@pytest.mark.parametrize("height", (-0.08, 0.0, 0.1))
def test_an_even_layer_changes_the_radius_by_itself(radius, height):
    (edge,) = edge_profile.edges(wedge(radius, lambda p, n: height))
    assert edge["turn_deg"] == pytest.approx(120.0, abs=1e-6)
    assert edge["design_radius_mm"] == pytest.approx(radius, rel=1e-3)
    assert edge["radius_mm"] == pytest.approx(radius + height, rel=2e-3)
    assert edge["chord_loss_mm"] == pytest.approx(-height, abs=1e-4)
    assert edge["residual_mm"] < 1e-6


def test_a_tip_that_is_cut_off_is_told_as_lost_chord_and_a_larger_radius():
    cut = edge_profile.edges(wedge(0.2, lambda p, n: np.minimum(0, (-0.06 - p[:, 2]) / n[:, 2])))
    (edge,) = cut
    assert edge["chord_loss_mm"] == pytest.approx(0.06, abs=1e-3)
    assert edge["radius_mm"] > 1.0


def test_a_profile_with_steps_has_no_radius():
    found = wedge(0.5, lambda p, n: np.where(np.abs(n[:, 0]) < 0.35, 0.2, 0.0))
    (edge,) = edge_profile.edges(found)
    assert edge["radius_mm"] is None and edge["residual_mm"] > 0.01
    assert edge["chord_loss_mm"] == pytest.approx(-0.2, abs=1e-3)


def test_a_blunted_nose_has_the_radius_of_the_circle_that_was_ground():
    """A nose of 0.2 mm ground to one of 0.5 mm that touches the same flanks."""
    new, old = 0.5, 0.2
    centre = np.array([0, 0, -old - (new - old) / math.cos(TURN / 2)])

    def height(p, n):
        # Where the ray from the point against its normal meets the circle.
        to = p - centre
        along = (to * n).sum(axis=1)
        square = np.maximum(along**2 - ((to**2).sum(axis=1) - new**2), 0.0)
        return np.minimum(np.sqrt(square) - along, 0.0)

    (edge,) = edge_profile.edges(wedge(old, height, step=0.005))
    assert edge["radius_mm"] == pytest.approx(new, rel=0.02)
    # From the centre to the flanks' corner it is one over the cosine of half the turn.
    lost = (new - old) * (1 / math.cos(TURN / 2) - 1)
    assert edge["chord_loss_mm"] == pytest.approx(lost, rel=0.01)


@pytest.mark.parametrize("heights", ((0.0, 0.0), (-0.1, -0.1), (-0.1, 0.0)))
def test_a_sharp_edge_ends_where_its_ground_sides_cross(heights):
    found = wedge(0.0, lambda p, n: np.where(n[:, 0] < 0, *heights), pieces=2)
    (edge,) = edge_profile.edges(found)
    assert edge["faces"] == [1, 2] and edge["design_radius_mm"] == 0.0
    assert edge["radius_mm"] == 0.0
    # Each side that goes back by 1 takes the corner back by half of what both would.
    lost = -sum(heights) / 2 / math.cos(TURN / 2)
    assert edge["chord_loss_mm"] == pytest.approx(lost, abs=1e-6)


def test_what_is_not_known_is_told_so_and_hollows_are_no_edges():
    (edge,) = edge_profile.edges(wedge(0.2, lambda p, n: np.where(p[:, 2] > -0.1, np.nan, 0.0)))
    assert edge["radius_mm"] is None and edge["chord_loss_mm"] is None
    assert "not known" in edge_profile.text(edge)
    hollow = wedge(0.2, lambda p, n: 0.0)
    for piece in hollow["pieces"]:
        piece["normal"] = piece["ray"] = -piece["normal"]
    assert edge_profile.edges(hollow) == []
    assert edge_profile.edges(wedge(5.0, lambda p, n: 0.0)) == []


def test_the_plot_tells_of_the_edge():
    assert "chord loss 0.080 mm" in section_plot.svg(wedge(0.2, lambda p, n: -0.08), "shape")


@pytest.fixture(scope="module")
def rod(freecad, tmp_path_factory):
    """A plate 40 x 30 mm, 1.6 mm thick, one of its long edges round."""
    path = tmp_path_factory.mktemp("plate") / "plate.brep"
    freecad.call(make_rod, path)
    return core.Shape.read(str(path))


def test_a_zone_has_the_figures_of_sections_across_its_edges(rod):
    field, _ = core.sample_faces(rod, [], 0.4, precision=0.001)
    core.apply_allowance(field, 0.05)
    zone = {"tolerance": (-0.1, 0.1), "faces": [], "edge_radius": 0.8}
    inside = np.flatnonzero(np.asarray(core.zone_of_samples(field, [zone])) == 0)
    fillet = inside[field.points[inside, 0] < 0.45]
    fillet = fillet[np.abs(field.points[fillet, 1] - 15.0) < 12.0]
    found = edge_profile.of_zone(field, fillet, 0.8)
    assert found["sections"] >= 12
    for name, value in (("design_radius_mm", 0.5), ("radius_mm", 0.55), ("chord_loss_mm", -0.05)):
        assert found[name]["min"] == pytest.approx(value, rel=0.03)
        assert found[name]["max"] == pytest.approx(value, rel=0.03)
    ends = inside[np.isin(field.points[inside, 1], (0.0, 30.0))]
    for number in ends[:50]:  # planes that only touch the faces
        edge_profile.of_zone(field, np.array([number]), 0.8)
    assert edge_profile.of_zone(field, inside, 0.8)["sections"] > 6
    flat = np.flatnonzero(field.normals[:, 2] > 0.999)
    assert edge_profile.of_zone(field, flat[field.points[flat, 0] > 20.0][:50], 0.8) is None


def make_rod(path):
    plate = Part.makeBox(40, 30, 1.6)
    edges = [
        e for e in plate.Edges if abs(e.CenterOfMass.x) < 1e-6 and abs(e.CenterOfMass.y - 15) < 1e-6
    ]
    plate.makeFillet(0.5, edges).exportBrep(str(path))
