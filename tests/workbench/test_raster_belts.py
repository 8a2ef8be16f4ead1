"""Raster paths for a free belt and a platen: as wide as their contact, where they fit."""

import math
from dataclasses import replace

import numpy as np
import pytest
import FreeCAD
import Part
from test_raster import plate

from beltgrinding.engine import InputError, core
from beltgrinding.job import load, poses
from beltgrinding.raster import footprint, raster_path, tool
from beltgrinding.simulation import run as runs
from test_clearing import floor_of, parts  # noqa: F401

X = {"along": "direction", "direction": [1, 0, 0], "entry": "direct"}
LAYER = {"thickness_mm": 5, "youngs_modulus_MPa": 2, "poissons_ratio": 0.4}


def job_of(design, kind="free_belt", run=(), **parts):
    machine = {
        "kind": kind,
        "force_N": 15,
        "force_travel_mm": 30,
        "free_run": {"width_mm": 20, "length_mm": 200, "tension_N_per_mm": 4, **dict(run)},
    }
    if kind == "platen":
        machine["platen"] = {"length_mm": 60, "layers": [LAYER]}
    data = {"design": design, "belt_machine": machine, "programs": [{"poses": []}], **parts}
    return load.validate(data)


@pytest.fixture(scope="module")
def bent(freecad, tmp_path_factory):
    """The design of 100 x 60 mm of a cylinder's side, R 80 about y, that looks up."""
    file = tmp_path_factory.mktemp("bent") / "bent.brep"
    freecad.call(make_bent, file)
    return {"file": str(file)}


def test_passes_along_the_belt_are_as_far_apart_as_it_is_wide(bent):
    for kind in ("free_belt", "platen"):
        found = raster_path.raster(job_of(bent, kind), {**X, "step_over_share": 0.5})
        # Along the travel it is convex: the belt bears on all its width.
        assert found["contact_width_mm"] == pytest.approx(20.0, abs=2.1), kind
        assert found["step_over_mm"] == pytest.approx(0.5 * found["contact_width_mm"])
        assert len(found["passes"]) == round(60.0 / found["step_over_mm"]), kind
        assert found["reachable"]["share"] > 0.99
    # Across it the contact is short: the belt wraps what its pull turns by, F / W = 2 H tan(alpha), less what its
    # bending takes at both ends, sqrt(D / N).
    across = raster_path.raster(job_of(bent), {**X, "belt_angle_deg": 90.0})
    straight = raster_path.raster(job_of(bent), X)
    assert across["contact_length_mm"] == pytest.approx(20.0, abs=2.1)
    wrap = 2.0 * 80.0 * math.atan(15.0 / 20.0 / (2.0 * 4.0))
    bending = math.sqrt(300.0 / (12.0 * (1.0 - 0.3**2)) / 4.0)
    assert wrap - 2.0 * bending - 1.0 < straight["contact_length_mm"] < wrap


def test_the_contact_of_a_curved_platen_is_shorter_along_it(bent):
    job = job_of(bent, "platen")
    flat = raster_path.raster(job, X)
    job["belt_machine"]["platen"]["radius_mm"] = 40.0
    curved = raster_path.raster(load.validate(job), X)
    assert curved["contact_length_mm"] < 0.8 * flat["contact_length_mm"]
    assert curved["contact_width_mm"] == pytest.approx(20.0, abs=2.1)
    assert curved["reachable"]["share"] > 0.99


def test_a_belt_grinds_evenly_by_its_passes(bent):
    job = job_of(bent, sampling={"spacing_mm": 0.8})
    laid = raster_path.raster(job, {**X, "step_over_share": 0.5})
    job["programs"] = [{"poses": poses.list_poses(laid)}]
    field = runs.run(load.validate(job)).field
    removed, at = field.stock_height - field.height, field.points
    middle = (abs(at[:, 0]) < 25) & (abs(at[:, 1] - 30) < 15)
    assert removed[middle].mean() > 0
    assert removed[middle].std() < 0.25 * removed[middle].mean()


def test_beside_a_wall_there_is_no_room_for_a_belt(parts):  # noqa: F811
    path = parts / "wall.brep"
    job = job_of({"file": str(path), "faces": [floor_of(path)]})
    found = raster_path.raster(job, {**X, "step_over_mm": 5.0})
    y = found["contacts"][found["contact"]][:, 1, 3]
    # The wall begins at 60; half of the belt is 10 wide, and may stand fit_mm in it.
    assert y.max() < 50.6 and y.max() > 44.0
    assert any("the belt gets to" in str(one) for one in found["warnings"])
    # With the belt across the passes its run, 200 long, would go through the wall everywhere.
    turned = raster_path.raster(job, {**X, "step_over_mm": 5.0, "belt_angle_deg": 90.0})
    assert turned["no_room"]
    assert any(one.code == "raster.no_room" for one in turned["warnings"])


def test_rollers_have_no_room_in_the_part(parts):  # noqa: F811
    path = parts / "wall.brep"
    face = floor_of(path)
    job = job_of({"file": str(path), "faces": [face]}, run={"roller_radius_mm": 15.0})
    pressing = tool.of(job)
    frame = np.diag([1.0, -1.0, -1.0, 1.0])[None]  # at the origin, pressing down
    point = lambda x, z: np.array([[x, 0.0, z]])
    # The belt at rest is the plane; the rollers' axes lie 15 mm and its thickness above.
    assert pressing.depth(frame, point(0, -0.1))[0] == 0.0
    assert pressing.depth(frame, point(0, 0.2))[0] == pytest.approx(0.2)
    assert pressing.depth(frame, point(100 + 14.0, 16.0))[0] == pytest.approx(1.0, abs=0.01)
    assert pressing.depth(frame, point(100 + 16.0, 16.0))[0] == 0.0
    # As the belt gives way they come nearer, and reach below its plane.
    deep = tool.of(job, 6.0)
    assert deep.depth(frame, point(100.0, -4.0))[0] == pytest.approx(1.0, abs=0.01)
    assert pressing.depth(frame, point(100.0, -4.0))[0] == 0.0


def test_a_leaned_belt_stands_on_its_edge(bent):
    pressing = tool.of(job_of(bent))
    assert pressing.shift(0.0) == pytest.approx([0, 0, 0])
    assert pressing.shift(0.1) == pytest.approx([0, 10, 0])
    assert pressing.shift(-0.1) == pytest.approx([0, -10, 0])


@pytest.mark.slow
def test_the_best_way_of_a_belt_goes_along_what_is_convex(bent):
    found = raster_path.raster(job_of(bent), {"along": "auto"})
    ways = [one for one in found["tried"] if "residual" in one]
    assert len(ways) > 2 and sum(one["chosen"] for one in ways) == 1
    chosen = next(one for one in ways if one["chosen"])
    assert chosen["residual"] <= 1.1 * min(one["residual"] for one in ways) + 1e-9


def test_position_control_lays_passes_by_the_allowance(bent):
    job = job_of(bent, stock={"allowance_mm": 0.3})
    job["belt_machine"]["control"] = "position"
    thin = raster_path.raster(job, {**X, "footprint": "cylinder"})
    job["stock"]["allowance_mm"] = 2.0
    thick = raster_path.raster(job, {**X, "footprint": "cylinder"})
    assert thick["contact_length_mm"] > 1.5 * thin["contact_length_mm"] > 0
    assert thick["contact_width_mm"] == pytest.approx(20.0, abs=1.3)


def test_a_contact_that_goes_on_over_the_faces_border_is_told():
    found = raster_path.raster(job_of({"brep": plate()}, run={"width_mm": 90}), X)
    assert any(one.code == "raster.belt_beyond_faces" for one in found["warnings"])
    assert len(found["passes"]) >= 1 and found["contact_width_mm"] < 80.0  # whole cells of 9 mm


def test_the_core_refuses_what_is_no_belt():
    belt = load.typed(job_of({"brep": plate()})).belt_machine
    narrow = replace(belt, free_run=replace(belt.free_run, width_mm=-1.0))
    with pytest.raises(ValueError, match="width"):
        core.run_fit(narrow, 10.0, np.eye(4)[None], np.zeros((1, 3)))
    with pytest.raises(ValueError, match="room behind"):
        core.run_fit(belt, -1.0, np.eye(4)[None], np.zeros((1, 3)))
    with pytest.raises(ValueError):
        core.press_belt(belt, math.nan, 0.0, force=10.0)
    with pytest.raises(ValueError):
        core.press_belt(belt, 0.0, 0.0)
    with pytest.raises(InputError) as raised:
        core.press_belt(replace(belt, kind="belt"), 0.0, 0.0, force=10.0)
    assert raised.value.code == "call.belt_machine"
    with pytest.raises(InputError) as raised:
        core.press_belt(replace(belt, free_run=replace(belt.free_run, width_mm="wide")), 0, 0, 0, 1)
    assert raised.value.code == "call.wrong_type" and "width_mm" in str(raised.value)


def test_contacts_that_have_not_converged_do_not_count_and_that_is_told(bent, monkeypatch):
    class Unsolved:
        def __getattr__(self, name):
            return getattr(core, name)

        def contacts_at(self, *arguments):
            return [
                found and {**found, "converged": False} for found in core.contacts_at(*arguments)
            ]

    solved = raster_path.raster(job_of(bent), X)
    monkeypatch.setattr(footprint, "core", Unsolved())
    unsolved = raster_path.raster(job_of(bent), X)
    assert not any(one.code == "raster.belt_not_solved" for one in solved["warnings"])
    assert any(one.code == "raster.belt_not_solved" for one in unsolved["warnings"])
    assert unsolved["contact_width_mm"] == unsolved["footprint"]["plain_mm"]


def make_bent(file):
    V = FreeCAD.Vector
    half = math.degrees(50 / 80)
    arc = Part.makeCircle(80, V(0, 0, -80), V(0, -1, 0), 90 - half, 90 + half)
    arc.extrude(V(0, 60, 0)).exportBrep(str(file))
