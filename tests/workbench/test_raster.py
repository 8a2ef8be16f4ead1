"""Raster paths: the passes as plain arrays, the command line, and the document object."""

import json
import math
import os
import re
import subprocess
import sys

import numpy as np
import pytest
import FreeCAD

import beltgrinding
from beltgrinding import contact
from beltgrinding.base import frames
from beltgrinding.cell import tool_path as tool_paths
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, poses, workpiece
from beltgrinding.programs.program import powers, through_with
from beltgrinding.programs.registry import read_program
from beltgrinding.raster import raster_path as raster
from beltgrinding.simulation import run as runs
from support.freecad import ROOT, SHARED

LENGTH, WIDTH = 100.0, 60.0  # mm
WHEEL = {"radius_mm": 40, "width_mm": 16, "crown_radius_mm": 60}
X = {"along": "direction", "direction": [1, 0, 0]}
ALONG_X = {**X, "entry": "direct"}  # passes that are as long as the plate, under one force


def plate(hole=None, bend=None):
    """A plate of LENGTH x WIDTH, its normal up, in squares of 2 mm. hole: x0, x1, y0, y1 mm that are
    left out; bend: z as a function of x.
    """
    x, y = np.arange(0, LENGTH + 1, 2.0), np.arange(0, WIDTH + 1, 2.0)
    points = np.array([[a, b, bend(a) if bend else 0.0] for b in y for a in x], np.float32)
    triangles = []
    for j in range(len(y) - 1):
        for i in range(len(x) - 1):
            middle = (x[i] + 1, y[j] + 1)
            if hole and hole[0] < middle[0] < hole[1] and hole[2] < middle[1] < hole[3]:
                continue
            a = j * len(x) + i
            b, c, d = a + 1, a + len(x) + 1, a + len(x)
            triangles += [[a, b, c], [a, c, d]]
    mesh = core.TriangleMesh(points, np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def job_of(brep, **parts):
    return jobs.validate(
        {
            "design": {"brep": brep},
            "belt_machine": {"wheel": WHEEL, "force_N": 30},
            "programs": [{"poses": []}],
            **parts,
        }
    )


def on_pass(result, k):
    one = result["passes"][k]
    return slice(one["first"], one["last"] + 1)


def test_passes_lie_at_the_step_over_and_look_into_the_work():
    for spacing in ("lines", "even"):
        found = raster.raster(
            job_of(plate()), {**ALONG_X, "spacing": spacing, "step_over_mm": 10, "feed_mm_s": 40}
        )
        assert len(found["passes"]) == 6 and found["contact_width_mm"] is None
        for k, one in enumerate(found["passes"]):
            contacts = found["contacts"][on_pass(found, k)]
            assert one["length_mm"] == pytest.approx(LENGTH, abs=1e-3)
            assert contacts[:, 1, 3] == pytest.approx(
                np.full(len(contacts), 5.0 + 10 * k), abs=0.05
            )
            assert contacts[:, :3, 2] == pytest.approx(np.tile([0, 0, -1], (len(contacts), 1)))
            # The belt keeps its travel, whichever way the pass goes.
            assert contacts[:, :3, 0] == pytest.approx(np.tile([1, 0, 0], (len(contacts), 1)))
            assert np.sign(contacts[-1, 0, 3] - contacts[0, 0, 3]) == (1 if k % 2 == 0 else -1)
            assert np.diff(contacts[:, 0, 3]).__abs__().max() <= 10.0 + 1e-9
            assert found["feeds"][one["first"] + 1 : one["last"] + 1] == pytest.approx(40.0)
            # Rapid to the clearance, rapid down to the approach, then at its feed; and back.
            before, after = one["first"] - 2, one["last"] + 2
            heights = found["contacts"][before : after + 1, 2, 3]
            assert heights[:3] == pytest.approx([30, 6, 0], abs=1e-6)
            assert heights[-3:] == pytest.approx([0, 6, 30], abs=1e-6)
            assert found["rapid"][before : one["first"] + 1].tolist() == [True, True, False]
            assert found["rapid"][one["last"] : after + 1].tolist() == [False, False, True]
        assert (found["forces"] == -1).all()


def test_the_settings_shape_the_path():
    job = job_of(plate())

    def laid(**settings):
        return raster.raster(job, {**ALONG_X, "step_over_mm": 10, **settings})

    one_way = laid(order="one_way", force_N=25)
    ends = [one_way["contacts"][p["last"], 0, 3] for p in one_way["passes"]]
    assert ends == pytest.approx([LENGTH] * 6, abs=1e-6) and (one_way["forces"] == 25).all()
    out = laid(run_out_mm=7)
    assert [p["length_mm"] for p in out["passes"]] == pytest.approx([LENGTH + 14] * 6, abs=1e-3)
    short = laid(run_out_mm=-7)
    assert [p["length_mm"] for p in short["passes"]] == pytest.approx([LENGTH - 14] * 6, abs=1e-3)
    turned = laid(belt_angle_deg=90)
    assert turned["contacts"][0, :3, 0] == pytest.approx([0, -1, 0], abs=1e-9)
    assert laid(offset_mm=0.3)["contacts"][2, 2, 3] == pytest.approx(0.3)
    arc = laid(approach="arc", approach_mm=10)
    first = arc["contacts"][: arc["passes"][0]["first"] + 1, :3, 3]
    centre = first[-1] + [0, 0, 10]
    assert np.linalg.norm(first[1:] - centre, axis=1) == pytest.approx(10.0)
    assert first[1] == pytest.approx(first[-1] + [-10, 0, 10])  # comes from behind the pass
    assert not arc["rapid"][2 : len(first)].any()
    across = laid(along="direction", direction=[0, 1, 0])
    assert len(across["passes"]) == 10


def test_a_gap_is_bridged_or_jumped():
    job = job_of(plate(hole=(46, 54, 20, 40)))
    settings = {**ALONG_X, "spacing": "lines", "step_over_mm": 10, "bridge_mm": 5}
    assert [p["level"] for p in raster.raster(job, settings)["passes"]] == [0, 1, 2, 2, 3, 3, 4, 5]
    bridged = raster.raster(job, {**settings, "bridge_mm": 9})
    assert [p["level"] for p in bridged["passes"]] == [0, 1, 2, 3, 4, 5]
    assert [p["length_mm"] for p in bridged["passes"]] == pytest.approx([LENGTH] * 6, abs=0.01)
    few = raster.raster(job, {**settings, "min_length_mm": 60})
    assert [p["level"] for p in few["passes"]] == [0, 1, 4, 5]


def test_both_holdings_bring_the_contact_to_the_same_places():
    generator = np.random.default_rng(1)

    def frame():
        q = generator.normal(size=4)
        return frames.from_quaternion(generator.uniform(-200, 200, 3), q / np.linalg.norm(q))

    def data(matrix):
        q = frames.to_quaternions(matrix[None, :3, :3])[0]
        return {"position_mm": matrix[:3, 3].tolist(), "quaternion_wxyz": q.tolist()}

    a, b = frame(), frame()
    tool = {"base_from_work": data(a), "tcp_from_contact": data(b)}
    part = {"holding": "part_in_hand", "tcp_from_work": data(a), "base_from_contact": data(b)}
    for cell in (tool, part):
        job = job_of(plate(bend=lambda x: 0.002 * (x - 50) ** 2), cell=cell)
        found = raster.raster(job, {**ALONG_X, "step_over_mm": 10})
        if cell is tool:
            work = np.linalg.inv(a) @ found["frames"] @ b
        else:
            work = np.linalg.inv(found["frames"] @ a) @ b
        assert work == pytest.approx(found["contacts"], abs=1e-9)
        job["programs"] = [{"poses": poses.list_poses(found)}]
        path = tool_paths.tool_path(job, 0, [])
        assert path.work_from_contact() == pytest.approx(found["contacts"], abs=1e-9)
        # The contact keeps its feed over the work, whatever the tool centre point does for it.
        grinding = np.flatnonzero(found["contact"][1:] & found["contact"][:-1]) + 1
        way = np.linalg.norm(np.diff(found["contacts"][:, :3, 3], axis=0), axis=1)[grinding - 1]
        tcp = np.linalg.norm(np.diff(found["frames"][:, :3, 3], axis=0), axis=1)[grinding - 1]
        assert way / (tcp / found["feeds"][grinding]) == pytest.approx(50.0)
        # Halfway between poses, which the robot joins by straight lines and slerp, too: the lever
        # of the part in the hand asks for more of them.
        for one in found["passes"]:
            for k in range(one["first"], one["last"]):
                p, q = found["frames"][k : k + 2]
                half = through_with(
                    p, p @ _rotation(powers(p[:3, :3].T @ q[:3, :3], np.array([0.5]))[0])
                )
                half[:3, 3] = 0.5 * (p[:3, 3] + q[:3, 3])
                at = np.linalg.inv(a) @ half @ b if cell is tool else np.linalg.inv(half @ a) @ b
                assert abs(at[2, 3] - 0.002 * (at[0, 3] - 50) ** 2) < 0.08


def _rotation(matrix):
    frame = np.eye(4)
    frame[:3, :3] = matrix
    return frame


@pytest.mark.slow
def test_the_step_over_comes_from_the_contact():
    job = job_of(plate(), belt_machine={"wheel": {"radius_mm": 60, "width_mm": 15}})
    found = raster.raster(job, {**ALONG_X, "step_over_share": 0.5})
    assert found["contact_width_mm"] == pytest.approx(15.0, abs=0.1)  # a flat wheel, all of it
    assert found["step_over_mm"] == pytest.approx(0.5 * found["contact_width_mm"])
    crowned = raster.raster(job_of(plate()), ALONG_X)["contact_width_mm"]
    assert 5 < crowned < 16
    more = raster.raster(job_of(plate()), {**ALONG_X, "force_N": 90})["contact_width_mm"]
    assert more >= crowned
    # The wheel's axis along the pass: the contact's length counts, which is shorter.
    assert raster.raster(job, {**ALONG_X, "belt_angle_deg": 90})["contact_width_mm"] < 15
    rigid = job_of(plate(), law={"model": "geometric"})
    rigid["belt_machine"]["control"] = "position"
    with pytest.raises(InputError, match="step_over_mm"):
        raster.raster(rigid, ALONG_X)


def test_a_wheel_that_cannot_be_is_refused_on_a_plane_too():
    job = job_of(plate())
    job["belt_machine"]["wheel"] = {"radius_mm": 10, "width_mm": 5}
    with pytest.raises(InputError, match="leave no core in a wheel of 10 mm radius"):
        raster.raster(job, ALONG_X)


def test_an_even_raster_grinds_evenly():
    job = job_of(plate())
    found = raster.raster(job, {**ALONG_X, "step_over_share": 0.35})
    length = sum(p["length_mm"] for p in found["passes"])
    coefficient = 0.2 * 50 * LENGTH * WIDTH / (length * 20000 * 30)  # 0.2 mm on the mean
    job["stock"] = {"kind": "allowance", "allowance_mm": 0.2}
    job["law"]["coefficient_mm2_per_N"] = coefficient
    job["programs"] = [{"poses": poses.list_poses(found)}]
    job["inspection"]["tolerance_mm"] = [-0.03, 0.03]
    result = runs.run(jobs.validate(job))
    assert result.summary["in_tolerance_area_share"] > 0.75
    points = result.field.points
    middle = (abs(points[:, 0] - LENGTH / 2) < 30) & (abs(points[:, 1] - WIDTH / 2) < 20)
    assert np.ptp(result.field.height[middle]) < 0.06


def groove():
    """A block of 120 x 80 x 20 mm with a groove of 12 mm width and 8 mm depth along y, its floor's number last."""
    x = [0.0, 54.0, 54.0, 66.0, 66.0, 120.0]
    z = [0.0, 0.0, -8.0, -8.0, 0.0, 0.0]
    points = np.array([[a, b, c] for b in (0.0, 80.0) for a, c in zip(x, z)], np.float32)
    triangles = []
    for k in range(5):
        triangles += [[k, k + 1, k + 7], [k, k + 7, k + 6]]
    mesh = core.TriangleMesh(points, np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh).write_brep()


def test_a_law_that_takes_nothing_off_has_no_best_way():
    brep = groove()
    law = {"model": "local", "coefficient_mm2_per_N": 1e-6, "pressure_threshold_MPa": 1000.0}
    job = job_of(brep, design={"brep": brep, "faces": [1]}, law=law)
    with pytest.raises(InputError, match="takes nothing off") as caught:
        raster.raster(job, {"along": "auto", "step_over_mm": 8.0})
    assert caught.value.code == "raster.takes_nothing_off"


@pytest.mark.slow
def test_the_best_way_goes_where_the_wheel_fits_in():
    brep = groove()
    shape = core.Shape.from_brep(brep, "groove")
    floors = [
        k + 1
        for k in range(shape.face_count)
        if (core.sample_faces(shape, [k], 3.0)[0].points[:, 2] < -7.9).all()
    ]
    machine = {"wheel": {"radius_mm": 20, "width_mm": 10}, "force_N": 20}
    job = job_of(brep, design={"brep": brep, "faces": floors}, belt_machine=machine)
    found = raster.raster(job, {"along": "auto", "step_over_mm": 1.5})
    assert found["along"] != "auto" and not found["no_room"]
    steps = np.diff(found["contacts"][on_pass(found, 0), :3, 3], axis=0)
    assert np.abs(steps[:, 1]).sum() > 10 * np.abs(steps[:, 0]).sum()  # along the groove
    (chosen,) = [one for one in found["tried"] if one["chosen"]]
    across = [one for one in found["tried"] if one.get("no_room")]
    assert across and not chosen["no_room"] and chosen["untouched"] < 0.35
    least = min(one["residual"] for one in found["tried"] if not one.get("no_room", True))
    assert chosen["residual"] <= 1.1 * least + 1e-12
    # The same as when it is asked for by name.
    named = raster.raster(
        job, {"along": found["along"], "direction": found["direction"], "step_over_mm": 1.5}
    )
    assert named["contacts"] == pytest.approx(found["contacts"])
    assert json.loads(json.dumps(raster.summary({**found, "warnings": []})))["tried"]


def test_the_best_way_of_a_rigid_tool_goes_by_the_stock():
    job = job_of(
        plate(),
        stock={"kind": "allowance", "allowance_mm": 0.2},
        law={"model": "geometric"},
    )
    job["belt_machine"]["control"] = "position"
    found = raster.raster(job, {"along": "auto", "step_over_mm": 4.0})
    residuals = [one["residual"] for one in found["tried"]]
    assert all(math.isfinite(value) and 0 < value < 2 for value in residuals), residuals
    assert found["along"] != "auto"


@pytest.mark.slow
def test_the_solved_width_is_that_of_the_contact_there():
    """On a cylinder both ways to the width agree; on a part of two curvatures the solved one keeps to the narrow."""
    radius = 50.0
    round_ = plate(
        bend=lambda x: math.sqrt(radius**2 - (x - 50.0) ** 2) if abs(x - 50) < 40 else 30.0
    )
    settings = {"along": "direction", "direction": [0, 1, 0], "smoothing_mm": 3.0}
    solved = raster.raster(job_of(round_), settings)
    plain = raster.raster(job_of(round_), {**settings, "footprint": "cylinder"})
    assert plain["footprint"]["plain_mm"] == plain["contact_width_mm"]
    assert solved["contact_width_mm"] <= np.median(solved["footprint"]["widths"])
    flat = raster.raster(job_of(plate()), ALONG_X)
    assert flat["contact_width_mm"] == pytest.approx(flat["footprint"]["plain_mm"], rel=0.12)
    assert np.ptp(flat["footprint"]["widths"]) < 1.0
    assert flat["contact_length_mm"] == pytest.approx(
        np.median(flat["footprint"]["lengths"]), abs=1
    )


def test_a_wheel_that_does_not_fit_is_warned_of():
    def bend(x):
        return 30.0 - math.sqrt(30.0**2 - min(abs(x - 50.0), 25.0) ** 2)

    settings = {**X, "step_over_mm": 10, "where_it_collides": "warn"}
    tight = raster.raster(job_of(plate(bend=bend)), settings)
    assert any("does not fit" in text for text in tight["warnings"])
    assert tight["fit"].max() > 1.0 and (tight["fit"][~tight["contact"]] == 0).all()
    small = {"wheel": {"radius_mm": 20, "width_mm": 10}}
    assert not raster.raster(job_of(plate(bend=bend), belt_machine=small), settings)["warnings"]


@pytest.mark.parametrize(
    "settings, words",
    [
        ({"allong": "u"}, "did you mean 'along'"),
        ({"along": "w"}, "along"),
        ({"faces": [1_000_000]}, "there is no face 1000000"),
        ({"along": "direction", "direction": [0, 0, 0]}, "not 0, 0, 0"),
        ({"along": "direction", "direction": [0, 0, 1]}, "look in this very direction"),
        ({**ALONG_X, "step_over_mm": 10, "min_length_mm": 500}, "min_length_mm"),
        ({**ALONG_X, "step_over_mm": 1e-4}, "step-over"),
    ],
)
def test_mistakes_are_named(settings, words):
    with pytest.raises(InputError, match=re.escape(words)):
        raster.raster(job_of(plate()), settings)


def command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=ROOT / "Mod" / "BeltGrinding",
        check=False,
    )


@pytest.mark.slow
def test_the_command_line_writes_a_program(tmp_path):
    job = {"design": {"brep": plate()}, "belt_machine": {"wheel": WHEEL}}
    (tmp_path / "job.json").write_text(json.dumps(job))
    (tmp_path / "raster.json").write_text(json.dumps({**ALONG_X, "step_over_mm": 12}))
    done = command(
        "raster", tmp_path / "job.json", "-o", tmp_path / "path.csv",
        "--settings", tmp_path / "raster.json", "--set", "step_over_mm=15", "--set", "force_N=20",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["passes"] == 4 and figures["step_over_mm"] == 15
    arrays = read_program(tmp_path / "path.csv").path_arrays(100.0)
    expected = raster.raster(
        raster.load_job(tmp_path / "job.json"), {**ALONG_X, "step_over_mm": 15, "force_N": 20}
    )
    assert arrays["frames"] == pytest.approx(expected["frames"], abs=1e-6)
    assert arrays["feeds"] == pytest.approx(expected["feeds"])
    assert arrays["rapid"].tolist() == expected["rapid"].tolist()
    assert (arrays["forces"] == 20).all()
    done = command("raster", tmp_path / "job.json", "-o", tmp_path / "path.src", "--set", "force_N=20",
                   "--settings", tmp_path / "raster.json", "--set", "step_over_mm=15")  # fmt: skip
    assert done.returncode == 0, done.stderr
    krl = read_program(tmp_path / "path.src").path_arrays(100.0)
    assert krl["frames"] == pytest.approx(expected["frames"], abs=1e-3)
    assert krl["rapid"].tolist() == expected["rapid"].tolist()
    text = (tmp_path / "path.src").read_text()
    assert "$TOOL=" not in text and "$BASE=" not in text and done.stderr.count("note: ") == 2
    # The cell's numbers are told, and set where they are asked for.
    job["robot"] = {
        "preset": "kuka_kr16_2",
        "base_from_robot": {"position_mm": [-900, 0, -500]},
        "flange_from_tcp": {"position_mm": [0, 0, 120.5]},
    }
    (tmp_path / "job.json").write_text(json.dumps(job))
    again = ["raster", tmp_path / "job.json", "-o", tmp_path / "path.src", "--force",
             "--settings", tmp_path / "raster.json"]  # fmt: skip
    done = command(*again, "--base", "5")
    assert done.returncode == 0 and done.stderr.count("note: ") == 1, done.stderr
    text = (tmp_path / "path.src").read_text()
    assert "BAS (#BASE,5 )" in text and ";   $TOOL={FRAME: X 0.000000,Y 0.000000,Z 120.5" in text
    done = command(*again, "--base", "as-known", "--tool", "as-known")
    # Under full force from the first moment, as this raster is asked for, plunges grind.
    assert done.returncode == 0 and done.stderr.startswith("warning: about 9 %"), done.stderr
    assert done.stderr.count("\n") == 1
    first = read_program(tmp_path / "path.src").motions[0]
    assert first.base.startswith("X 900 Y 0 Z 500 ") and first.tool.startswith("X 0 Y 0 Z 120.5 ")
    for bad in (["--set", "feed_mm_s=-1"], ["--set", "along"], ["-o", tmp_path / "path.xyz"]):
        done = command("raster", tmp_path / "job.json", "-o", tmp_path / "no.csv", *bad)
        assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, done.stderr
        assert not (tmp_path / "no.csv").exists()


def test_the_page_has_every_setting_with_its_default():
    page = (ROOT / "docs" / "raster-settings.md").read_text()
    rows = dict(re.findall(r"^\| (\w+) \| `(.*?)` \|", page, re.M))
    rules = raster.schema()["properties"]
    assert rows == {name: json.dumps(rule["default"]) for name, rule in rules.items()}


BLADE = SHARED / "data" / "cad" / "blade_marine_solid_derived.step"


@pytest.mark.slow
@pytest.mark.skipif(not BLADE.exists(), reason=f"no shared data at {SHARED}")
@pytest.mark.parametrize("along", ["u", "v", "direction"])
def test_a_real_blade_is_covered(along):
    wheel = {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}
    job = jobs.validate(
        {
            "design": {"file": str(BLADE), "faces": [1]},
            "belt_machine": {"wheel": wheel, "force_N": 30},
            "programs": [{"poses": []}],
        }
    )
    settings = {"along": along, "direction": [0, 0, 1], "step_over_mm": 6, "entry": "direct"}
    found = raster.raster(job, settings)
    # Plunges grind under full force; the leading edge is too sharp for some passes to go round.
    told = {fact.code for fact in found["warnings"]}
    sharp = {"raster.passes_end", "raster.turns_too_fast"}
    assert told <= {"raster.plunges", *sharp} and found["cuts"] <= 5
    field = core.sample_faces(workpiece.read_design(job["design"]), [0], 2.0)[0]
    ways = []
    for k in range(len(found["passes"])):
        places = found["contacts"][on_pass(found, k), :3, 3]
        share = np.linspace(0, 1, 20)[:, None]
        ways += [a + share * (b - a) for a, b in zip(places[:-1], places[1:])]
    ways = np.vstack(ways)
    nearest = np.array([np.linalg.norm(ways - p, axis=1).min() for p in field.points])
    # Of the area: round the leading edge samples are many and small.
    far = field.areas[nearest >= 3.3].sum() / field.areas.sum()
    assert far < 0.005 and nearest.max() < 5.5
    # Poses lie on the surface and look into it.
    at = found["contacts"][found["contact"]]
    samples = core.sample_faces(workpiece.read_design(job["design"]), [0], 0.15)[0]
    angles, off = [], []
    # Evenly along the way: round the leading edge the poses are many.
    gone = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(at[:, :3, 3], axis=0), axis=1))])
    for pose in at[np.unique(np.searchsorted(gone, np.linspace(0, gone[-1], 200)))]:
        k = np.argmin(np.linalg.norm(samples.points - pose[:3, 3], axis=1))
        off.append(abs((samples.points[k] - pose[:3, 3]) @ samples.normals[k]))
        angles.append(np.degrees(np.arccos(np.clip(-pose[:3, 2] @ samples.normals[k], -1, 1))))
    # Samples 0.15 mm apart see the leading edge, of some 0.2 mm radius, no better than 0.06 mm.
    assert np.percentile(off, 98) < 0.05 and max(off) < 0.08
    # Round the sharp leading edge a turn is spread: by half of edge_turn_deg, and samples see its radius of some 0.2 mm.
    assert np.percentile(angles, 90) < 3 and max(angles) < 20 + 5


def make(doc):
    part = doc.addObject("Part::Box", "Block")
    part.Length, part.Width, part.Height = 60, 40, 20
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="0.8 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    beltgrinding.make_belt_machine(job, WheelRadius=60, WheelWidth="15 mm", Force="30 N")
    return job


@pytest.mark.freecad
def test_a_raster_path_in_the_document():
    doc = FreeCAD.newDocument("raster")
    doc.UndoMode = 1
    job = make(doc)
    doc.openTransaction("raster")
    path = beltgrinding.make_raster(
        job, Along="direction", Direction=(1, 0, 0), StepOver="8 mm", Entry="direct"
    )
    doc.commitTransaction()
    assert path in job.Group and path.PassCount == 5, path.PassCount
    assert abs(path.GroundLength.Value - 300) < 0.1 and abs(path.StepOverUsed.Value - 8) < 1e-6
    assert path.PoseCount == len(path.Poses) == path.Path.Size
    assert abs(path.Poses[2].Base.z - 20) < 1e-9

    # It follows its settings, its machine and its part.
    path.StepOver = "10 mm"
    doc.recompute()
    assert path.PassCount == 4
    doc.Block.Width = 60
    doc.recompute()
    assert path.PassCount == 6
    doc.BeltMachine.BaseFromWork = FreeCAD.Placement(FreeCAD.Vector(0, 0, 100), FreeCAD.Rotation())
    doc.recompute()
    assert abs(path.Poses[2].Base.z - 120) < 1e-9
    digest = path.Inputs
    path.Clearance = "40 mm"
    doc.recompute()
    assert path.Inputs != digest and abs(path.Poses[0].Base.z - 160) < 1e-9

    # Simulation, contact and export take it like any other path.
    simulation = beltgrinding.simulate(job)
    assert simulation.RemovedVolume.Value > 10 and not simulation.OutOfDate
    beltgrinding.export_job(job, "job.json")
    pressed = contact.at_pose(jobs.load("job.json"), 5)
    assert abs(pressed["force"] - 30) < 1
    again = beltgrinding.open_job(FreeCAD.newDocument("again"), "job.json")
    assert len(again.Document.RobotPath.Poses) == path.PoseCount
    path.RunOut = "-2 mm"
    doc.recompute()
    assert simulation.OutOfDate

    # An error leaves the last poses and says so; the path recovers.
    before = [tuple(pose.Base) for pose in path.Poses]
    path.Direction = (0, 0, 1)
    doc.recompute()
    assert "Invalid" in path.State and [tuple(pose.Base) for pose in path.Poses] == before
    path.Direction = (0, 1, 0)
    doc.recompute()
    assert "Invalid" not in path.State and [tuple(pose.Base) for pose in path.Poses] != before

    doc.saveAs(os.path.abspath("raster.FCStd"))
    poses = [tuple(p.Base) for p in path.Poses]
    FreeCAD.closeDocument("raster")
    doc = FreeCAD.openDocument("raster.FCStd")
    path = doc.RasterPath
    assert type(path.Proxy).__name__ == "RasterPath" and path.PassCount > 0
    assert [tuple(p.Base) for p in path.Poses] == poses
    path.StepOver = "20 mm"
    doc.recompute()
    assert path.PassCount == 3


@pytest.mark.freecad
def test_mistakes_leave_the_document_and_undo_is_one_step():
    doc = FreeCAD.newDocument("mistakes")
    doc.UndoMode = 1
    job = make(doc)
    names = [o.Name for o in doc.Objects]
    for properties in (
        {"Along": "direction", "Direction": (0, 0, 1)},
        {"Along": "w"},
        {"StepOverr": 3},
        {"MinLength": 500},
    ):
        try:
            beltgrinding.make_raster(job, **properties)
            raise SystemExit(f"{properties} was taken")
        except InputError as error:
            assert str(error)
        assert [o.Name for o in doc.Objects] == names
    doc.openTransaction("raster")
    beltgrinding.make_raster(job, ["Face6"], StepOver=10)
    doc.commitTransaction()
    doc.undo()
    assert [o.Name for o in doc.Objects] == names
    doc.redo()
    assert doc.RasterPath.PassCount > 0 and doc.RasterPath in job.Group
    other = beltgrinding.make_job(doc.Block, ["Face1"])
    try:
        beltgrinding.make_raster(other)
        raise SystemExit("no machine was missed")
    except InputError as error:
        assert "belt machine" in str(error)
