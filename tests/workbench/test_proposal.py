"""First settings chosen from the part, against the defaults that every part had before."""

import math
import os
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.job.poses import list_poses
from beltgrinding.raster import proposal, raster_path

ROOT = Path(__file__).resolve().parents[2]


SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
PLACES = ("frames", "contacts")
PARTS = [("crank_arm.brep", 5), ("pump_cover.brep", 1), ("blade_marine_upper.iges", 1)]
TOLERANCE = 0.05  # mm


def plate(length=60.0, width=40.0, **keys):
    """A validated job of a plate's top without programs; mm."""
    corners = [[x, y, z] for z in (0, 20) for y in (0, width) for x in (0, length)]
    corners = np.array(corners, np.float32)
    faces = [[4, 5, 6], [5, 7, 6], [0, 2, 1], [1, 2, 3], [0, 1, 4], [1, 5, 4]]
    faces += [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    mesh = core.TriangleMesh(corners, np.array(faces, np.uint32))
    shape = core.shape_from_mesh(mesh)
    top = next(
        face + 1
        for face in range(shape.face_count)
        if shape.face_area(face) == pytest.approx(length * width, rel=1e-4)
    )
    design = {"brep": shape.write_brep(), "faces": [top]}
    return jobs.validate(
        {
            "schema": 1,
            "design": design,
            "belt_machine": {},
            "stock": {},
            "programs": [{"poses": []}],
            **keys,
        }
    )


def longer(laid, feed):
    """How many times longer the passes last than at an even feed of the contact, where the robot keeps to its blocks."""
    on = laid["contact"][1:] & laid["contact"][:-1]
    ways = {k: np.linalg.norm(np.diff(laid[k][:, :3, 3], axis=0), axis=1)[on] for k in PLACES}
    return (ways["frames"] / laid["feeds"][1:][on]).sum() / (ways["contacts"].sum() / feed)


def ground(design, machine, settings, spacing, stock):
    """Share in tolerance and mean deviation of a raster with these settings, and how much ``longer`` it lasts."""
    job = {
        "schema": 1,
        "design": design,
        "belt_machine": machine,
        "stock": stock,
        "sampling": {"spacing_mm": spacing},
        "inspection": {"tolerance_mm": [-TOLERANCE, TOLERANCE]},
        "cell": {"check_collisions": False},
        "programs": [{"poses": []}],
    }
    laid = raster_path.raster(jobs.validate(job), settings)
    arrays = {key: laid[key] for key in ("frames", "feeds", "forces", "rapid", "lines")}
    arrays["zones"] = np.full(len(laid["feeds"]), -1.0)
    summary = beltgrinding.run({**job, "programs": [{"poses": list_poses(arrays)}]}).summary
    lasts = longer(laid, settings.get("feed_mm_s", raster_path.validate({})["feed_mm_s"]))
    return summary["in_tolerance_area_share"], summary["deviation_mm"]["mean"], lasts


@pytest.mark.slow
@pytest.mark.skipif(not SHARED.is_dir(), reason="the shared parts are not there")
@pytest.mark.parametrize("name, face", PARTS)
def test_a_proposal_takes_the_allowance_off_and_beats_the_defaults(name, face):
    design = {"file": str(SHARED / "data" / "cad" / name), "faces": [face]}
    stock = {"kind": "allowance", "allowance_mm": 0.3}
    job = {"schema": 1, "design": design, "stock": stock, "belt_machine": {}}
    job["inspection"] = {"tolerance_mm": [-TOLERANCE, TOLERANCE]}
    found = proposal.propose(jobs.validate({**job, "programs": [{"poses": []}]}))
    # No wheel fits the whole of the crank arm's face: a boss stands on it.
    assert {note.code for note in found["notes"]} <= {
        "raster.proposed_small",
        "raster.proposed_unfit",
    }
    machine = {
        "wheel": {"radius_mm": found["wheel_radius_mm"], "width_mm": found["wheel_width_mm"]},
        "compliance": {"rim_thickness_mm": found["rim_thickness_mm"]},
        "force_N": found["force_N"],
    }
    settings = {
        "along": "direction",
        **{
            key: found[key]
            for key in ("direction", "step_over_share", "feed_mm_s", "approach_feed_mm_s")
        },
    }
    spacing = max(found["spacing_mm"], math.sqrt(found["area_mm2"] / 30_000))
    share, mean, lasts = ground(design, machine, settings, spacing, stock)
    try:
        before, mean_before, _ = ground(design, {}, {}, spacing, stock)
    except InputError:  # the large wheel of before lays no pass at all
        before, mean_before = 0.0, 0.3
    print(
        f"{name}: proposed {share:.0%}, mean {mean:+.3f} mm, {lasts:.2f} times as long; "
        f"defaults {before:.0%}, {mean_before:+.3f}"
    )
    left = 0.3 * (1.0 - found["ground_share"])
    # At turns too sharp for the robot's blocks the passes are slower, and remove more: at most as they last longer.
    assert 0.3 * (1.0 - lasts) - 0.03 < mean - left < 0.03
    assert share > 0.65 * found["ground_share"] ** 2 and share > before + 0.3


def test_the_feed_follows_what_is_to_come_off_and_the_law():
    thin = proposal.propose(plate(stock={"allowance_mm": 0.2}))
    thick = proposal.propose(plate(stock={"allowance_mm": 0.4}))
    assert thick["feed_mm_s"] < 0.6 * thin["feed_mm_s"]
    assert thin["allowance_mm"] == pytest.approx(0.2, abs=1e-6)
    # To the middle of the tolerance.
    upper = proposal.propose(plate(inspection={"tolerance_mm": [0.0, 0.2]}))
    assert upper["allowance_mm"] == pytest.approx(0.2, abs=1e-6)
    # A calibrated belt cuts little: more force, and what cannot be is told.
    weak = proposal.propose(plate(law={"coefficient_mm2_per_N": 5e-6}))
    assert weak["force_N"] > thin["force_N"]
    assert [note.code for note in weak["notes"]] in ([], ["raster.proposed_feed"])
    hopeless = proposal.propose(plate(law={"coefficient_mm2_per_N": 1e-8}))
    assert [note.code for note in hopeless["notes"]] == ["raster.proposed_feed"]


def test_a_part_without_stock_gets_no_feed_and_is_told():
    found = proposal.propose(plate(stock={"allowance_mm": 0.0}))
    assert [note.code for note in found["notes"]] == ["raster.proposed_nothing"]
    assert found["feed_mm_s"] == 50.0  # the schema's


def test_a_missing_face_is_an_error():
    job = plate()
    job["design"]["faces"] = [99]
    with pytest.raises(InputError, match="99"):
        proposal.propose(job)


BELT = {
    "kind": "free_belt",
    "free_run": {"width_mm": 20, "tension_N_per_mm": 2.0, "length_mm": 150},
}
LAYER = {"thickness_mm": 5.0, "youngs_modulus_MPa": 2.0, "poissons_ratio": 0.45}
PLATEN = {"kind": "platen", "free_run": {"width_mm": 20}, "platen": {"layers": [LAYER]}}
CURVED = {**PLATEN, "platen": {"layers": [LAYER], "radius_mm": 120.0}}


@pytest.mark.parametrize(
    "machine",
    [
        pytest.param(BELT, id="free belt"),
        pytest.param(PLATEN, id="platen", marks=pytest.mark.slow),
        pytest.param(CURVED, id="curved platen", marks=pytest.mark.slow),
    ],
)
def test_a_belt_takes_the_allowance_off(machine):
    stock = {"kind": "allowance", "allowance_mm": 0.1}
    found = proposal.propose(plate(belt_machine=machine, stock=stock))
    assert found["notes"] == [] and "wheel_radius_mm" not in found
    given = {**machine, "force_N": found["force_N"]}
    given["contact_spacing_mm"] = found["contact_spacing_mm"]
    if machine is BELT:  # what it gives way is more than the default
        given["force_travel_mm"] = found["force_travel_mm"]
        assert found["force_travel_mm"] > 5.0
    settings = {"along": "direction"}
    for key in ("direction", "step_over_share", "feed_mm_s", "approach_feed_mm_s"):
        settings[key] = found[key]
    share, mean, _ = ground(plate()["design"], given, settings, 1.0, stock)
    print(f"proposed {share:.0%}, mean {mean:+.3f} mm")
    assert abs(mean - 0.1 * (1.0 - found["ground_share"])) < 0.015


@pytest.fixture(scope="module")
def parts(freecad, tmp_path_factory):
    """BREP files: a third of a cylinder of R 30, 60 mm long; a block with a slot 30 mm wide."""
    folder = tmp_path_factory.mktemp("belts")
    freecad.call(make_parts, folder)
    return folder


def largest(path, machine, like=lambda shape, face: True):
    """A validated job of the largest face of a file that is like that."""
    design = {"file": str(path)}
    shape = core.Shape.read(str(path))
    faces = [face for face in range(shape.face_count) if like(shape, face)]
    design["faces"] = [max(faces, key=shape.face_area) + 1]
    job = {"schema": 1, "design": design, "stock": {"allowance_mm": 0.1}, "belt_machine": machine}
    return jobs.validate({**job, "programs": [{"poses": []}]})


def test_a_belt_runs_round_what_is_bent_and_a_wheel_along_it(parts):
    def side(shape, face):
        return shape.surface_type(face) == "cylinder"

    wheel = proposal.propose(largest(parts / "third.brep", {}, side))
    assert abs(wheel["direction"][0]) < 0.5  # the chord is 52 mm, the length 60
    belt = proposal.propose(largest(parts / "third.brep", BELT, side))
    assert abs(np.dot(belt["direction"], wheel["direction"])) < 0.1
    assert abs(belt["direction"][1]) < 0.01


def test_a_belt_that_does_not_fit_is_told_with_one_that_does(parts):
    def bottom(shape, face):
        return abs(shape.face_area(face) - 120 * 30) < 1.0

    # On a belt of 50 mm the slot's walls stand.
    wide = {**BELT, "free_run": {**BELT["free_run"], "width_mm": 50}}
    found = proposal.propose(largest(parts / "slot.brep", wide, bottom))
    (note,) = found["notes"]
    assert note.code == "raster.proposed_narrower", str(note)
    assert 20 <= note.arguments["narrower"] <= 25
    assert proposal.propose(largest(parts / "slot.brep", BELT, bottom))["notes"] == []


def test_a_small_wheel_says_what_the_next_one_would_reach(parts):
    def domed(shape, face):
        return shape.surface_type(face) == "sphere"

    wheel = {"kind": "contact_wheel"}
    free = proposal.propose(largest(parts / "dome.brep", wheel, domed))
    assert free["wheel_radius_mm"] == 31.5 and not free["notes"]
    (note,) = proposal.propose(largest(parts / "rimmed.brep", wheel, domed))["notes"]
    assert note.code == "raster.proposed_small", str(note)
    told = note.arguments
    assert told["radius"] < told["larger"] == 31.5 and told["less"] < told["reached"] < 98.0


def make_parts(folder):
    V = FreeCAD.Vector
    Part.makeCylinder(30, 60, V(0, 0, 0), V(0, 1, 0), 120).exportBrep(str(folder / "third.brep"))
    slot = Part.makeBox(120, 30, 10, V(-60, -15, 0))
    Part.makeBox(120, 60, 20, V(-60, -30, -10)).cut(slot).exportBrep(str(folder / "slot.brep"))
    ball, knob = Part.makeSphere(110, V(0, 0, -90)), Part.makeCylinder(40, 30)
    dome, rim = ball.common(knob), Part.makeCylinder(44, 22).cut(knob)
    dome.exportBrep(str(folder / "dome.brep"))
    dome.fuse(rim).exportBrep(str(folder / "rimmed.brep"))


def test_a_face_shorter_than_the_shortest_pass_is_ground():
    job = plate(1.6, 1.2)
    with pytest.raises(InputError, match="min_length_mm"):
        raster_path.raster(job, raster_path.validate({"along": "u"}))
    found = proposal.propose(job)
    assert found["min_length_mm"] == 1.0 and found["ground_share"] > 0.9
    settings = {"along": "direction", **{name: found[name] for name in proposal.OF_PASSES}}
    assert raster_path.raster(job, raster_path.validate(settings))["passes"]
