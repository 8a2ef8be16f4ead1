"""The verdict on a ground part: zones, clusters with their source lines, thickness, what is in doubt."""

import copy
import json
import os
import subprocess
import sys
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.cell import motions
from beltgrinding.base import messages, schemas
from beltgrinding.inspection import verdict
from beltgrinding.job import workpiece, load as jobs
from beltgrinding.simulation.result import Result
from support.results import unseal

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))

# Two passes along x over a plate of 60 x 40 mm. In the second, the robot creeps over 10 mm.
PROGRAM = """&ACCESS RVP
DEF two_passes( )
$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
$TOOL={X 0,Y 0,Z 0,A 0,B 0,C 0}
$VEL.CP=0.1
PTP {X 5,Y 12,Z 0.1,A 0,B 0,C 180}
LIN {X 55,Y 12,Z 0.1,A 0,B 0,C 180}
PTP {X 5,Y 28,Z 0.1,A 0,B 0,C 180}
LIN {X 25,Y 28,Z 0.1,A 0,B 0,C 180}
$VEL.CP=0.005
LIN {X 35,Y 28,Z 0.1,A 0,B 0,C 180}
$VEL.CP=0.1
LIN {X 55,Y 28,Z 0.1,A 0,B 0,C 180}
END
"""
GOUGE_LINE = 11


def box(length, width, height):
    """A faceted box; its faces are known by their normals."""
    corners = [(x, y, z) for x in (0, length) for y in (0, width) for z in (-height, 0)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return core.shape_from_mesh(
        core.TriangleMesh(np.array(corners, np.float32), np.array(triangles, np.uint32))
    )


def top_face(shape):
    """Number of the face whose normal is +z, from 1."""
    for face in range(shape.face_count):
        field, _ = core.sample_faces(shape, [face], 5.0)
        if field.normals[0, 2] > 0.9:
            return face + 1


@pytest.fixture(scope="module")
def plate():
    return box(60.0, 40.0, 4.0)


@pytest.fixture
def job(plate, tmp_path):
    (tmp_path / "two_passes.src").write_text(PROGRAM)
    return {
        "design": {"brep": plate.write_brep(), "faces": [top_face(plate)]},
        "sampling": {"spacing_mm": 0.5},
        "stock": {"allowance_mm": 0.1},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "programs": [{"file": str(tmp_path / "two_passes.src")}],
        "inspection": {"tolerance_mm": [-0.05, 0.11]},
    }


def check_form(found):
    json.dumps(found, allow_nan=False)
    jsonschema.Draft7Validator(schemas.schema("verdict")).validate(found)


def test_a_gouge_leads_back_to_its_line_of_the_program(job):
    result = beltgrinding.run(job)
    check_form(result.verdict)
    assert result.verdict["overall"] == "fail"
    (gouge,) = [c for c in result.verdict["clusters"] if c["side"] == "below"]
    assert gouge["motions"][0]["line"] == GOUGE_LINE
    assert gouge["motions"][0]["share"] > 0.9 and gouge["motions"][0]["pose"] == 4
    assert gouge["motions"][0]["depth_mm"] > 0.15
    x, y, _ = gouge["worst"]["point_mm"]
    assert 25 <= x <= 35 and abs(y - 28) < 7.5
    # the wheel's contact reaches beyond the ends of the motion
    assert gouge["box_mm"][0][0] > 15 and gouge["box_mm"][1][0] < 45
    assert 12 < min(gouge["extent_mm"], gouge["width_mm"]) < 17
    text = verdict.text(result.verdict)
    assert "FAIL" in text and f"two_passes.src, line {GOUGE_LINE}" in text
    # With the tool and the part changed over the outcome is the same.
    turned = copy.deepcopy(job)
    turned["cell"] = {"holding": "part_in_hand"}
    poses = result.motions["point"]
    program = turned["programs"][0] = {"poses": []}
    for k, (px, py, pz) in enumerate(poses):
        # base_from_tcp = base_from_contact work_from_contact^-1, of half a turn about x
        one = {"x_mm": -px, "y_mm": py, "z_mm": pz, "qw": 0, "qx": 1, "qy": 0, "qz": 0}
        one.update(feed_mm_s=5 if k == 4 else 100, line=100 + k, rapid=k in (0, 2))
        program["poses"].append(one)
    held = beltgrinding.run(turned).verdict
    (deep,) = [c for c in held["clusters"] if c["side"] == "below"]
    assert deep["motions"][0]["line"] == 104
    np.testing.assert_allclose(deep["area_mm2"], gouge["area_mm2"], rtol=0.02)


def test_what_was_never_touched_is_told_from_what_was_missed(job):
    job["inspection"]["tolerance_mm"] = [-1.0, 0.0999]
    found = beltgrinding.run(job).verdict
    check_form(found)
    assert found["missed_rays"] == 0 and found["untouched_area_mm2"] > 300
    high = [c for c in found["clusters"] if c["side"] == "above"]
    assert high and max(c["untouched_share"] for c in high) > 0.5
    assert "never touched" in verdict.text(found)
    # the passes' own strips are no part of them
    assert all(abs(c["worst"]["point_mm"][1] - 12) > 7 for c in high)
    assert found["excess_volume_mm3"] + found["removed_volume_mm3"] == pytest.approx(
        found["stock_volume_mm3"] + found["gouge_volume_mm3"], rel=1e-6
    )


def test_zones_have_limits_of_their_own_and_later_ones_win(job):
    face = job["design"]["faces"][0]
    zones = [
        {"name": "wide", "tolerance_mm": [-1, 1]},
        {"name": "narrow", "faces": [face], "tolerance_mm": [-0.001, 0.001]},
    ]
    job["inspection"]["zones"] = zones
    result = beltgrinding.run(job)
    check_form(result.verdict)
    assert [(z["name"], z["verdict"]) for z in result.verdict["zones"]] == [
        ("wide", "unknown"),
        ("narrow", "fail"),
    ]
    assert "holds no sample" in result.verdict["notes"][0]
    stored = json.loads(json.dumps(result.verdict))
    assert messages.notes(stored, "en") == stored["notes"] == result.verdict["notes"]
    assert all(de != en for de, en in zip(messages.notes(stored, "de"), stored["notes"]))
    del stored["note_facts"]  # of a version before 0.2
    assert messages.notes(stored, "de") == stored["notes"]
    turned = verdict.of_result(
        result, inspection={**result.job["inspection"], "zones": zones[::-1]}
    )
    assert turned["zones"][1]["verdict"] == "pass" and turned["faces"][0]["verdict"] == "pass"
    assert turned["clusters"] == []
    alone = verdict.of_result(result, inspection={**result.job["inspection"], "zones": zones[:1]})
    assert alone["overall"] == "pass" and len(alone["zones"]) == 1
    assert "PASS" in verdict.text(alone)
    none = verdict.of_result(result, inspection={**result.job["inspection"], "zones": []})
    assert [z["name"] for z in none["zones"]] == [None] and none["overall"] == "fail"
    plain = {**result.job, "inspection": {**result.job["inspection"], "zones": []}}
    samples = verdict.cluster_samples(plain, result.field, 1)
    assert len(samples) == none["clusters"][0]["samples"]
    assert result.field.areas[samples].sum() == pytest.approx(none["clusters"][0]["area_mm2"])


def test_thickness_against_a_face_that_is_not_ground_and_one_that_is(job, plate):
    job["inspection"]["zones"] = [{"name": "plate", "thickness_mm": [-0.05, 0.105]}]
    result = beltgrinding.run(job)
    check_form(result.verdict)
    (zone,) = result.verdict["zones"]
    thick = zone["thickness"]
    assert thick["unmeasured"] == 0 and thick["verdict"] == "fail" == zone["verdict"]
    assert thick["design_mm"]["min"] == pytest.approx(4.0, abs=1e-4)
    # the other side stays as designed, so the thickness deviates as the surface does
    assert thick["deviation_mm"]["min"] == pytest.approx(result.field.height.min(), abs=1e-5)
    assert thick["deviation_mm"]["max"] == pytest.approx(result.field.height.max(), abs=1e-5)
    beyond = (result.field.height < -0.05) | (result.field.height > 0.105)
    area = result.field.areas
    assert thick["out_share"] == pytest.approx(area[beyond].sum() / area.sum(), abs=1e-6)
    # Both sides with stock: twice the allowance where nothing was ground.
    job["design"]["faces"] = []
    both = beltgrinding.run(job).verdict
    assert both["zones"][0]["thickness"]["deviation_mm"]["max"] == pytest.approx(0.2, abs=1e-5)
    assert "thickness out of tolerance" in verdict.text(both)
    # Without the design only ground faces count.
    field = result.field
    gone = {**result.job, "design": {"file": "/nowhere.step", "faces": [], "flip_normals": False}}
    alone = verdict.verdict(gone, field, (), result.motions, 0)
    assert alone["zones"][0]["thickness"]["verdict"] == "unknown"
    assert "nowhere.step" in alone["notes"][0]


@pytest.mark.parametrize(
    "zone, word",
    [
        ({"tolerance_mm": [0, 1]}, "'name' is missing"),
        ({"name": "a"}, "'tolerance_mm', 'thickness_mm' or 'finish'"),
        ({"name": "a", "tolerance_mm": [1, 0]}, "tolerance_mm: the lower limit"),
        ({"name": "a", "thickness_mm": [1, 0]}, "thickness_mm: the lower limit"),
        ({"name": "a", "tolerance_mm": [0, 1], "faces": [999]}, "face 999 is not ground"),
        ({"name": "a", "tolerance_mm": [0, 1], "edge_radius_mm": 0}, "edge_radius_mm"),
        ({"name": "a", "tolerance_mm": [0, 1], "edge_radius": 1}, "did you mean 'edge_radius_mm'"),
        ({"name": "taken", "tolerance_mm": [0, 1]}, "another zone has this name"),
    ],
)
def test_a_wrong_zone_is_named(job, zone, word):
    job["inspection"]["zones"] = [{"name": "taken", "tolerance_mm": [0, 1]}, zone]
    with pytest.raises(InputError, match="zones") as caught:
        jobs.validate(job)
    assert word in str(caught.value)


def test_the_command_line_tells_and_recomputes_the_verdict(job, tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(job))
    out = tmp_path / "out"

    def call(*arguments):
        done = subprocess.run(
            [sys.executable, "-m", "beltgrinding", *map(str, arguments)],
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "verdict: FAIL" in call("run", tmp_path / "job.json", "-o", out)
    first = (out / "verdict.json").read_text()
    check_form(json.loads(first))
    call("verdict", out)
    assert (out / "verdict.json").read_text() == first
    (tmp_path / "two_passes.src").unlink()  # the motions are kept with the result
    lenient = {**job, "inspection": {"tolerance_mm": [-1, 1]}}
    (tmp_path / "other.json").write_text(json.dumps(lenient))
    told = call("verdict", out, "--job", tmp_path / "other.json", "-o", tmp_path / "v.json")
    assert told.startswith("verdict: PASS")
    assert (out / "verdict.json").read_text() == first
    assert json.loads((tmp_path / "v.json").read_text())["overall"] == "pass"
    assert Result.read(out).verdict == json.loads(first)
    assert json.loads(call("schema", "verdict"))["title"].startswith("Verdict")


def test_an_older_result_without_trace_and_motions_is_judged_as_far_as_it_goes(job, tmp_path):
    result = beltgrinding.run(job)
    result.write(tmp_path / "out")
    unseal(tmp_path / "out")
    # What an older version wrote: no trace, no motions.csv, no verdict.json, no zones in the job.
    old = json.loads(json.dumps(result.job))
    del old["inspection"]["zones"], old["programs"][0]["unresolved"]
    bare = workpiece.make_field(
        result.job, workpiece.read_design(job["design"]), [], core.RunContext()
    )
    bare.set_height(result.field.height)
    bare.write_hdf5(str(tmp_path / "out" / "heightfield.h5"), json.dumps(old))
    (tmp_path / "out" / motions.FILE).unlink()
    (tmp_path / "out" / "verdict.json").unlink()
    read = Result.read(tmp_path / "out")
    assert read.motions is None and read.verdict is None and read.field.trace is None
    found = verdict.of_result(read)
    check_form(found)
    assert found["untouched_area_mm2"] is None and found["clusters"][0]["motions"] == []
    assert found["faces"][0]["waviness"]["reason"] == "no_trace"
    (tmp_path / "two_passes.src").unlink()
    found = verdict.of_result(read)
    check_form(found)
    assert "motions are not known" in found["notes"][0]


def test_what_was_not_inspected_has_not_passed(job, tmp_path):
    """A stock that covers half of the face: elsewhere nothing is known."""
    half = box(30.0, 40.0, 4.0)
    job["stock"] = {"kind": "solid", "brep": half.write_brep()}
    job["inspection"]["tolerance_mm"] = [-9, 9]
    found = beltgrinding.run(job).verdict
    check_form(found)
    assert found["missed_rays"] > 1000 and found["clusters"] == []
    assert found["overall"] == found["faces"][0]["verdict"] == "unknown"
    assert found["missed_area_mm2"] == pytest.approx(1200, rel=0.05)
    assert found["inspected_area_mm2"] + found["missed_area_mm2"] == pytest.approx(2400, rel=1e-5)
    text = verdict.text(found)
    assert "UNKNOWN" in text and "rays that met no stock" in text and "not everything" in text


def test_what_is_doubtful_is_counted(job, tmp_path):
    path = tmp_path / "two_passes.src"
    path.write_text(PROGRAM.replace("$VEL.CP=0.005\n", "LIN XNOWHERE\n$VEL.CP=0.005\n"))
    job["programs"][0]["unresolved"] = 2
    result = beltgrinding.run(job)
    assert result.summary["unresolved_motions"] == result.verdict["unresolved_motions"] == 3
    events = [
        {"kind": "law_out_of_range"},
        {"kind": "not_converged"},
        {"kind": "belt_out_of_range"},
    ]
    found = verdict.verdict(result.job, result.field, events)
    check_form(found)
    assert found["unresolved_motions"] == 3
    assert found["extrapolated_law_events"] == 2 and found["not_converged_events"] == 1
    text = verdict.text(found)
    assert "3 places of the programs not resolved" in text and "law's range" in text


def test_the_motions_come_back_from_their_file(job, tmp_path):
    result = beltgrinding.run(job)
    (tmp_path / motions.FILE).write_text(motions.csv_text(result.motions))
    back = motions.read(tmp_path / motions.FILE)
    for name in ("program", "pose", "line"):
        np.testing.assert_array_equal(back[name], result.motions[name])
    np.testing.assert_allclose(back["point"], result.motions["point"], atol=1e-6)
    for text in ("", "program,pose\n1,2\n", motions.csv_text(back).replace("28", "x")):
        (tmp_path / motions.FILE).write_text(text)
        with pytest.raises(InputError, match="motions"):
            motions.read(tmp_path / motions.FILE)


@pytest.mark.slow
def test_a_real_blades_edges_are_a_zone_of_their_own():
    """The marine propeller blade: two sides that meet in sharp leading and trailing edges."""
    path = SHARED / "data" / "cad" / "blade_marine_solid_derived.step"
    if not path.is_file():
        pytest.skip(f"no shared data: {path}")
    shape = core.Shape.read(str(path))
    areas = [shape.face_area(face) for face in range(shape.face_count)]
    sides = sorted(np.argsort(areas)[-2:].tolist())
    field, _ = core.sample_faces(shape, sides, 0.6)
    core.apply_allowance(field, 0.2)
    zone = np.asarray(core.zone_of_samples(field, [{"edge_radius": 2.0, "tolerance": (0, 1)}]))
    share = field.areas[zone == 0].sum() / field.areas.sum()
    assert 0.02 < share < 0.2
    # What is at an edge is thin, the rest is thick.
    design, deviation = core.measure_thickness(
        field, np.arange(field.size), core.TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    )
    known = np.isfinite(design)
    assert known[zone == 1].mean() > 0.95
    assert np.median(design[(zone == 0) & known]) < 0.5 * np.median(design[(zone == 1) & known])
    # stock of 0.2 mm on both sides
    inner = known & (zone == 1)
    assert np.median(deviation[inner]) == pytest.approx(0.4, abs=0.02)
    assert deviation[inner].min() > 0.39
