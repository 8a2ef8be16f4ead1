"""A sharp edge between two ground faces, with and without stock on it, against a resolved plane-strain calculation
whose profile is a height over the wheel's own coordinate; and a face beside such an edge against the face alone."""

import math

import numpy as np
import pytest
import Part
from test_edges_plane_strain import COEFFICIENT, RADIUS, REMOVAL, WIDTH, held, influence, pressed
from FreeCAD import Vector

from beltgrinding.inspection import edge_profile, section


def reference(turn, stock, depth, step=0.01, times=320, half=1.5):
    """(x (n,), profile (n,) mm after grinding, N/mm on the mean) of an edge whose normals differ by twice ``turn``
    rad, under ``stock`` mm, with the wheel held ``depth`` mm below the edge."""
    x = np.arange(-round(half / step), round(half / step) + 1) * step
    profile = stock / math.cos(turn) - np.abs(x) * math.tan(turn)
    near = np.abs(x) < stock * math.sin(turn)
    profile[near] = np.sqrt(stock**2 - x[near] ** 2)  # round the edge
    matrix, inside, forces = influence(len(x), step), np.abs(x) < 0.1, []
    for _ in range(times):
        along = RADIUS * np.arctan2(x, RADIUS - profile)
        gap = np.interp(x, along, np.hypot(x, RADIUS - profile) - RADIUS)
        pressure = pressed(matrix, depth - gap, inside)
        inside = pressure > 0
        assert not inside[[0, -1]].any()
        forces.append(pressure.sum() * step)
        # Square to the profile as the pressure says, the volume as the force does.
        lowered = np.interp(along, x, pressure) * np.hypot(1.0, np.gradient(profile, x))
        profile = profile - REMOVAL / times * forces[-1] * lowered / (lowered.sum() * step)
    return x, profile, float(np.mean(forces))


@pytest.fixture(scope="module")
def parts(freecad, tmp_path_factory):
    """{degrees: the file of a wedge with its sharp edge along y}, and that of a "box" with its top's edge there."""
    folder = tmp_path_factory.mktemp("sharp")
    freecad.call(make_parts, folder)
    return {name: folder / f"{name}.brep" for name in (45, 60, "box")}


@pytest.mark.parametrize(
    "degrees, stock, depth, spacing, cell, force, top, profile",
    (
        # share of the force; mm of the profile's highest point; root mean square of the tops off the profile, mm
        (60, 0.0, 0.25, 0.1, 0.15, 0.16, 0.035, 0.011),
        (60, 0.0, 0.25, 0.05, 0.08, 0.10, 0.006, 0.004),
        (60, 0.1, 0.15, 0.1, 0.15, 0.11, 0.02, 0.008),
        (60, 0.3, 0.1, 0.1, 0.15, 0.02, 0.045, 0.025),
        (45, 0.0, 0.12, 0.05, 0.08, 0.02, 0.013, 0.004),
        (45, 0.1, 0.02, 0.05, 0.08, 0.02, 0.003, 0.004),
    ),
)
def test_a_sharp_edge_is_ground_as_in_plane_strain(
    parts, degrees, stock, depth, spacing, cell, force, top, profile
):
    x, wanted, mean = reference(math.radians(degrees), stock, depth)
    poses = [{"x_mm": 0, "y_mm": y, "z_mm": -depth, "feed_mm_s": 0.5} for y in (-0.25, 0.25)]
    result = held(parts[degrees], [1, 2], cell, poses, {"spacing_mm": spacing}, stock)
    assert result.steps["force"].mean() / WIDTH == pytest.approx(mean, rel=force)
    assert abs(result.summary["lost_volume_mm3"]) < 0.002 * result.summary["removed_volume_mm3"]
    field = result.field
    tops = field.points + field.height[:, None] * field.rays
    near = (np.abs(field.points[:, 1]) < 1.0) & (np.abs(tops[:, 0]) < 0.6)
    assert tops[near, 2].max() == pytest.approx(wanted.max(), abs=top)
    square = 1.0 / np.hypot(1.0, np.gradient(wanted, x))
    off = (tops[near, 2] - np.interp(tops[near, 0], x, wanted)) * np.interp(
        tops[near, 0], x, square
    )
    assert np.sqrt((off**2).mean()) < profile
    (edge,) = edge_profile.edges(section.section(result, (0, 0.01, 0), (0, 1, 0)))
    assert edge["design_radius_mm"] == pytest.approx(0.0, abs=1e-6)
    assert edge["chord_loss_mm"] == pytest.approx(-tops[near, 2].max(), abs=0.003)


@pytest.mark.parametrize("middle", (-2.0, 0.0, 1.0))
def test_a_face_is_ground_beside_a_sharp_edge_as_it_is_alone(parts, middle):
    """The wheel, flat on the top, overhangs its edge; the side is ground too, or is not among the faces."""
    poses = [{"x_mm": middle, "y_mm": y, "z_mm": -0.3, "feed_mm_s": 5} for y in (-3, 3)]
    alone, both = (
        held(parts["box"], faces, 0.6, poses, {"spacing_mm": 0.4}, coefficient=8 * COEFFICIENT)
        for faces in ([6], [6, 2])
    )
    assert both.steps["force"].mean() == pytest.approx(alone.steps["force"].mean(), rel=0.02)
    top = both.field.faces == 5
    np.testing.assert_array_equal(both.field.points[top], alone.field.points)
    inner = alone.field.points[:, 0] < -0.1
    assert np.abs(both.field.height[top] - alone.field.height)[inner].max() < 0.006
    assert -alone.field.height.min() > 0.1


def make_parts(folder):
    folder = str(folder)
    for degrees in (45, 60):
        turn = math.radians(degrees)
        left, right = (Vector(side * math.cos(turn), 0, -math.sin(turn)) * 2 for side in (-1, 1))
        wire = [
            Part.makeLine(left, Vector()),
            Part.makeLine(Vector(), right),
            Part.makeLine(right, left),
        ]
        solid = Part.Face(Part.Wire(wire)).extrude(Vector(0, 18, 0))
        solid.translate(Vector(0, -9, 0))
        solid.exportBrep(folder + f"/{degrees}.brep")
    box = Part.makeBox(20, 18, 6, Vector(-20, -9, -6))
    box.exportBrep(folder + "/box.brep")
