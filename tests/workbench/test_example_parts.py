"""The examples, made by FreeCAD and ground without it: sound parts, mostly good, each with its fault."""

import importlib
import json
import os
from pathlib import Path

import numpy as np
import pytest
import FreeCAD

import beltgrinding
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]


EXAMPLES = ("tap", "tap_belt", "vane", "edges", "knife")


@pytest.fixture(scope="module")
def made(freecad, tmp_path_factory):
    """The folder in which each example has one of its own."""
    out = tmp_path_factory.mktemp("examples")
    freecad.call(make_examples, out)
    return out


def make_examples(out):
    for name in EXAMPLES:
        example = importlib.import_module("beltgrinding.examples." + name)
        if hasattr(example, "shape"):  # else another one's
            solid = example.shape()[0]
            assert solid.isValid() and solid.isClosed() and solid.ShapeType == "Solid", name
            assert solid.Volume > 0, name
        example.make(os.path.join(out, name))


def ground(folder):
    """(summary, {kind: events}, verdict) of an example; its program leaves nothing open."""
    job = json.loads((folder / "job.json").read_text())
    for program in job["programs"]:
        assert not read_program(folder / program["file"]).problems
    result = beltgrinding.run(folder / "job.json")
    result.write(folder / "out")
    verdict = json.loads((folder / "out" / "verdict.json").read_text())
    kinds = {}
    for event in result.events:
        kinds.setdefault(event["kind"], []).append(event)
    return result.summary, kinds, verdict


@pytest.mark.slow
def test_the_taps_wheel_is_too_large_for_the_hollow_of_its_spout(made):
    summary, kinds, verdict = ground(made / "tap")
    assert 0.85 < summary["in_tolerance_area_share"] < 0.95
    # The robot gets everywhere without a complaint of its joints.
    assert summary["robot"]["reached_poses"] == summary["robot"]["poses"]
    assert set(kinds) == {"gouge", "wheel_too_large", "tilted_contact", "edge_contact"}
    left, *deep = verdict["clusters"][:3]
    assert left["side"] == "above" and left["worst"]["value_mm"] > 0.19
    assert all(one["side"] == "below" for one in deep)
    # In the middle of the hollow, where the wheel rests on both its ends and cuts them twice.
    assert abs(left["centroid_mm"][1]) < 2.0
    heights = sorted(one["centroid_mm"][2] for one in deep)
    assert heights[0] < left["centroid_mm"][2] < heights[1]


@pytest.mark.slow
def test_the_belts_edge_cuts_the_hollow_that_it_spans(made):
    summary, kinds, verdict = ground(made / "tap_belt")
    assert summary["models"]["compliance"].startswith("free belt, 40 mm wide")
    assert 0.65 < summary["in_tolerance_area_share"] < 0.85
    assert summary["robot"]["reached_poses"] == summary["robot"]["poses"]
    assert not {"collision", "not_converged", "unreached"} & set(kinds)
    deep = [one for one in verdict["clusters"] if one["side"] == "below"]
    worst = min(deep, key=lambda one: one["worst"]["value_mm"])
    # Above the hollow between body and spout, whose middle lies at (25, 0, 73).
    assert np.linalg.norm(np.array(worst["worst"]["point_mm"]) - [25, 0, 75]) < 12.0


@pytest.mark.slow
def test_the_wheel_wraps_round_the_blades_leading_edge(made):
    summary, kinds, verdict = ground(made / "vane")
    assert 0.85 < summary["in_tolerance_area_share"] < 0.95
    assert "collision" not in kinds and "gouge" in kinds
    deep = verdict["clusters"][0]  # a strip along the edge
    assert deep["side"] == "below"
    assert deep["worst"]["point_mm"][0] < -15.0 and deep["worst"]["value_mm"] < -0.2
    # Between both flanks of the nose stock stays, +0.19 mm at most. A few samples join the strips with passes beside them.
    below = [one for one in verdict["clusters"] if one["side"] == "below"]
    strip = [one for one in below if one["worst"]["point_mm"][0] < -15.0]
    assert sum(one["area_mm2"] for one in strip) > 1000
    *_, side, other = sorted(verdict["faces"], key=lambda one: one["in_share"])
    assert min(side["in_share"], other["in_share"]) > 0.88  # pressure and suction side
    edge = min(verdict["faces"], key=lambda one: one["in_share"])  # the leading one
    assert edge["in_share"] < 0.12
    assert edge["area_mm2"] * edge["below_share"] == pytest.approx(598, abs=12)


@pytest.mark.slow
def test_both_edges_of_a_blade_are_ground_to_their_profile(made):
    _, kinds, verdict = ground(made / "edges")
    assert not {"collision", "unreached", "not_converged"} & set(kinds)
    (noses,) = [zone for zone in verdict["zones"] if zone["name"] == "noses"]
    assert 0.7 < noses["in_share"] < 0.9  # but for the root, which is left, and the tip
    (told,) = verdict["sections"]
    design, stock, left = (told[name] for name in ("design", "stock", "ground"))
    for edge, radius, thickness in (("leading", 0.2, 0.685), ("trailing", 0.15, 0.611)):
        assert design[edge]["radius_mm"] == pytest.approx(radius, abs=2e-3)
        assert stock[edge]["radius_mm"] == pytest.approx(radius + 0.1, abs=2e-3)
        # By samples and cells of 0.05 mm; a sharper edge has these distances further in.
        assert left[edge]["thicknesses_mm"][0] == pytest.approx(thickness, abs=0.045)
    assert design["chord_mm"] == pytest.approx(40.0, abs=2e-3)
    assert stock["chord_mm"] == pytest.approx(40.2, abs=2e-3)
    assert left["chord_mm"] == pytest.approx(39.911, abs=0.045)
    assert left["thickness_mm"] == pytest.approx(stock["thickness_mm"], abs=1e-5)  # untouched
    worst = min(verdict["clusters"], key=lambda one: one["worst"]["value_mm"])
    assert worst["side"] == "below" and worst["centroid_mm"][2] > 27.0  # at the tip


@pytest.mark.slow
def test_the_robot_slows_down_at_the_knifes_tip(made):
    summary, kinds, verdict = ground(made / "knife")
    assert 0.9 < summary["in_tolerance_area_share"] < 0.98
    assert summary["robot"]["reached_poses"] == summary["robot"]["poses"]
    assert set(kinds) <= {"gouge", "edge_contact"}
    tip = min(verdict["clusters"], key=lambda one: one["worst"]["value_mm"])
    assert tip["worst"]["point_mm"][0] > 175.0 and tip["worst"]["value_mm"] < -0.25

    # At a constant feed the tip would get off lightly.
    job = json.loads((made / "knife" / "job.json").read_text())
    job["simulation"]["timing"] = "constant_feed"
    (made / "knife" / "steady.json").write_text(json.dumps(job))
    steady = beltgrinding.run(made / "knife" / "steady.json").summary
    assert steady["deviation_mm"]["min"] > 0.7 * tip["worst"]["value_mm"]
    assert steady["below_tolerance_area_share"] < 0.7 * summary["below_tolerance_area_share"]


@pytest.mark.freecad
def test_an_example_that_there_is_not_is_refused_and_leaves_no_document():
    try:
        beltgrinding.open_example("spoon", "spoon")
        raise AssertionError
    except beltgrinding.InputError as error:
        assert error.code == "objects.no_example" and "tap" in str(error), error
    assert not FreeCAD.listDocuments()
    job = beltgrinding.open_example("knife", "knife")
    assert job.Document.Label == "Knife" and job.Timing == "trapezoidal"
