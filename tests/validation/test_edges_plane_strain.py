"""Edges of radius 0.2 and 1.0 mm, ground by a wheel held against them, against a resolved plane-strain
calculation with a discretisation of its own: half a wedge of 60 degrees, its nose to the wheel."""

import math

import numpy as np
import pytest
import Part
from FreeCAD import Vector

from beltgrinding.inspection import edge_profile, section
from beltgrinding.job import load
from beltgrinding.simulation import run as runs

RADIUS, LAYER = 50.0, 2.0  # mm: the wheel, its rubber on a rigid core
MODULUS, POISSON = 5.0, 0.45  # MPa
DEPTH = 0.25  # mm that the wheel is held into the edge
WIDTH, LENGTH, FLANK = 12.0, 18.0, 2.0  # mm: wheel, part along the edge, flanks
TURN = math.radians(60.0)  # of the normal from the tip to a flank
COEFFICIENT, BELT_SPEED, DURATION = 2e-6, 10.0, 1.0  # mm2/N, m/s, s
REMOVAL = COEFFICIENT * 1000.0 * BELT_SPEED * DURATION  # mm a MPa


def influence(count, step):
    """(count, count) mm per MPa: how far cells of ``step`` mm press the middles of others into an infinite
    strip of rubber on a rigid base; from its compliance by wavenumber (Johnson, Contact Mechanics, section 5.8).
    """
    period = 40.0 * LAYER
    k = np.arange(1, int(period * 4 / step)) * 2 * math.pi / period
    decay, nu = np.exp(-2 * k * LAYER), POISSON
    above = (3 - 4 * nu) * (1 - decay**2) / 2 - 2 * k * LAYER * decay
    below = (3 - 4 * nu) * (1 + decay**2) / 2
    below += (2 * (k * LAYER) ** 2 + 5 - 12 * nu + 8 * nu**2) * decay
    compliance = 2 * (1 - nu**2) / (MODULUS * k) * above / below
    load_of_cell = np.sin(k * step / 2) / (k * step / 2) * step
    away = np.arange(count)[:, None] * step
    found = 2 / period * (np.cos(away * k) * (compliance * load_of_cell)).sum(axis=1)
    found += LAYER * (1 + nu) * (1 - 2 * nu) / (MODULUS * (1 - nu)) * step / period
    return found[np.abs(np.arange(count)[:, None] - np.arange(count))]


def pressed(matrix, overlap, inside):
    """MPa >= 0 with which cells give way to their overlap: by the active set."""
    for _ in range(200):
        pressure = np.zeros(len(overlap))
        chosen = np.flatnonzero(inside)
        pressure[chosen] = np.linalg.solve(matrix[np.ix_(chosen, chosen)], overlap[chosen])
        wrong = np.where(inside, pressure < 0, matrix @ pressure < overlap - 1e-9)
        if not wrong.any():
            return pressure
        inside = inside ^ wrong
    raise AssertionError("no end")


def reference(radius, step=0.01, times=160):
    """(points (n, 2), heights (n,), N/mm on the mean) of the edge's section after grinding."""
    angle = np.linspace(-TURN, TURN, 2 * int(radius * TURN / step) + 1)
    nose = radius * np.stack([np.sin(angle), np.cos(angle) - 1], axis=1)
    way = np.arange(step, FLANK, step)[:, None] * [math.cos(TURN), -math.sin(TURN)]
    points = np.concatenate([(nose[0] + way * [-1, 1])[::-1], nose, nose[-1] + way])
    sides = np.concatenate([np.full(len(way), -TURN), angle, np.full(len(way), TURN)])
    normals = np.stack([np.sin(sides), np.cos(sides)], axis=1)
    share = np.gradient(
        np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    )
    middles = np.arange(-60, 61) * step if radius < 0.5 else np.arange(-120, 121) * step
    matrix, heights, forces = influence(len(middles), step), np.zeros(len(points)), []
    inside = np.abs(middles) < radius
    for _ in range(times):
        top = points + heights[:, None] * normals
        x, z = top[:, 0], RADIUS - top[:, 1]
        along = RADIUS * np.arctan2(x, z)
        order = np.argsort(along)
        gap = np.interp(middles, along[order], (np.hypot(x, z) - RADIUS)[order])
        pressure = pressed(matrix, DEPTH - gap, inside)
        inside = pressure > 0
        assert not inside[[0, -1]].any()
        forces.append(pressure.sum() * step)
        lowered = np.interp(along, middles, pressure)
        # The volume is K V_b times the force: what flanks take is not the wheel's to give twice.
        heights -= REMOVAL / times * forces[-1] * lowered / (lowered * share).sum()
    return points, heights, float(np.mean(forces))


def edge_of(points, heights):
    """The edge that a section of the design's points (x, z) and heights has."""
    flat = np.insert(points, 1, 0.0, axis=1)
    step = np.diff(points, axis=0)
    way = np.gradient(points, axis=0)
    normals = np.stack([-way[:, 1], 0 * way[:, 0], way[:, 0]], axis=1)
    piece = {
        "face": 0,
        "closed": False,
        "s": np.concatenate([[0.0], np.cumsum(np.linalg.norm(step, axis=1))]),
        "point": flat,
        "normal": normals / np.linalg.norm(normals, axis=1)[:, None],
        "ray": normals / np.linalg.norm(normals, axis=1)[:, None],
        "height": heights,
        "stock_height": heights,
    }
    (edge,) = edge_profile.edges({"normal": [0.0, 1.0, 0.0], "pieces": [piece]})
    return edge


@pytest.fixture(scope="module")
def wedges(freecad, tmp_path_factory):
    """{radius: the file of a wedge, its edge along y}."""
    folder = tmp_path_factory.mktemp("wedges")
    freecad.call(make_wedges, folder)
    return {radius: folder / f"{radius}.brep" for radius in (0.2, 1.0)}


def ground(path, spacing, cell, middle=0.0, **sampling):
    """The result of the same: half a millimetre along the edge in a second; ``middle`` of the wheel along the
    edge, mm."""
    poses = [
        {"x_mm": 0, "y_mm": y, "z_mm": -DEPTH, "feed_mm_s": 0.5}
        for y in (middle - 0.25, middle + 0.25)
    ]
    return held(path, [1, 2, 3], cell, poses, {"spacing_mm": spacing, **sampling})


def held(design, faces, cell, poses, sampling, stock=0.0, coefficient=COEFFICIENT):
    """The result of grinding in position control, the wheel's axis along y."""
    job = {
        "schema": 1,
        "design": {"file": str(design), "faces": faces},
        "sampling": sampling,
        "stock": {"kind": "allowance", "allowance_mm": stock},
        "belt_machine": {
            "wheel": {"radius_mm": RADIUS, "width_mm": WIDTH},
            "compliance": {
                "model": "bonded_layer",
                "youngs_modulus_MPa": MODULUS,
                "poissons_ratio": POISSON,
                "rim_thickness_mm": LAYER,
            },
            "belt_speed_m_s": BELT_SPEED,
            "control": "position",
            "contact_spacing_mm": cell,
        },
        "law": {"model": "local_linear", "coefficient_mm2_per_N": coefficient},
        "simulation": {"max_travel_mm": 0.05},
        "programs": [{"poses": [{**pose, "qw": 0, "qx": 1, "qy": 0, "qz": 0} for pose in poses]}],
    }
    return runs.run(load.validate(job))


def difference(result, points, heights):
    """L1 of the heights' difference in the middle of the wheel, over that of the heights."""
    pieces = section.section(result, (0, 0.01, 0), (0, 1, 0))["pieces"]
    at = np.concatenate([piece["point"][:, 0] for piece in pieces])
    found = np.concatenate([piece["height"] for piece in pieces])
    order = np.argsort(at)
    x = np.linspace(points[0, 0], points[-1, 0], 2000)
    wanted = np.interp(x, points[:, 0], heights)
    return np.abs(np.interp(x, at[order], found[order]) - wanted).sum() / np.abs(wanted).sum()


@pytest.mark.parametrize(
    "radius, spacing, cell, loss, left, volume, profile",
    (
        # share of the chord loss, of the radius left, of the volume a mm of edge, L1 of the profile
        (1.0, 0.1, 0.15, 0.03, 0.03, 0.04, 0.07),
        (1.0, 0.05, 0.08, 0.01, 0.01, 0.01, 0.025),
        (0.2, 0.05, 0.08, 0.07, 0.01, 0.04, 0.17),  # all but a thousandth of it the cells'
    ),
)
def test_an_edge_is_ground_round_as_in_plane_strain(
    wedges, radius, spacing, cell, loss, left, volume, profile
):
    points, heights, force = reference(radius)
    wanted = edge_of(points, heights)
    assert wanted["chord_loss_mm"] > 0.03 * radius and wanted["radius_mm"] > 1.15 * radius
    result = ground(wedges[radius], spacing, cell)
    (found,) = edge_profile.edges(section.section(result, (0, 0.01, 0), (0, 1, 0)))
    assert found["chord_loss_mm"] == pytest.approx(wanted["chord_loss_mm"], rel=loss)
    assert found["radius_mm"] == pytest.approx(wanted["radius_mm"], rel=left)
    field = result.field
    middle = np.abs(field.points[:, 1]) < 1.0 + spacing / 4
    length = np.ptp(field.points[middle, 1]) + spacing
    removed = -(field.height * field.areas)[middle].sum() / length
    assert removed == pytest.approx(REMOVAL * force, rel=volume)
    assert difference(result, points, heights) < profile


def test_the_reference_has_converged(wedges):
    coarse, fine = (reference(0.2, step, times) for step, times in ((0.01, 160), (0.005, 320)))
    assert coarse[2] == pytest.approx(fine[2], rel=2e-3)
    assert coarse[1].min() == pytest.approx(fine[1].min(), rel=3e-3)


@pytest.mark.parametrize("middle", (5.3, 5.4, 5.5))
def test_dense_samples_cover_cells_at_the_parts_end_as_even_ones_do(wedges, middle):
    """The wheel overhangs the end of the edge; samples lie closely across the edge, not along it."""
    even = ground(wedges[1.0], 0.1, 0.75, middle)
    dense = ground(wedges[1.0], 0.5, 0.75, middle, precision_mm=0.0005)
    assert dense.field.size < 0.3 * even.field.size
    force = [float(result.steps["force"].mean()) for result in (even, dense)]
    assert force[1] == pytest.approx(force[0], rel=0.005)


def test_samples_of_several_densities_lose_what_the_law_takes(wedges):
    """Cells of 0.75 mm, but for the edge, where they follow it."""
    result = ground(wedges[0.2], 0.5, 0.75, precision_mm=0.002)
    assert len(np.unique(np.round(np.asarray(result.field.areas), 4))) > 3
    law = REMOVAL * float(result.steps["force"].mean())
    assert result.summary["removed_volume_mm3"] == pytest.approx(law, rel=0.01)
    assert abs(result.summary["lost_volume_mm3"]) < 1e-3 * law


def make_wedges(folder):
    for radius in (0.2, 1.0):
        turn = TURN
        at = lambda side: Vector(side * radius * math.sin(turn), 0, radius * (math.cos(turn) - 1))
        way = lambda side: Vector(side * math.cos(turn), 0, -math.sin(turn)) * FLANK
        left, right = at(-1) + way(-1), at(1) + way(1)
        wire = Part.Wire(
            [
                Part.makeLine(left, at(-1)),
                Part.Arc(at(-1), Vector(), at(1)).toShape(),
                Part.makeLine(at(1), right),
                Part.makeLine(right, left),
            ]
        )
        solid = Part.Face(wire).extrude(Vector(0, LENGTH, 0))
        solid.translate(Vector(0, -LENGTH / 2, 0))
        solid.exportBrep(str(folder) + f"/{radius}.brep")
