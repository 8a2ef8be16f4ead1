"""The job as plain data and the command line, without FreeCAD."""

import copy
import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.job import poses

ROOT = Path(__file__).resolve().parents[2]


SHARED = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared"))
DOWN = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}  # half a turn about x: the wheel presses down


def plate(length=60.0, width=40.0):
    """A faceted plate in the x-y plane, its normal up."""
    corners = np.array([[0, 0, 0], [length, 0, 0], [length, width, 0], [0, width, 0]])
    return core.shape_from_mesh(
        core.TriangleMesh(corners.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    )


def plate_job():
    return {
        "design": {"brep": plate().write_brep()},
        "sampling": {"spacing_mm": 0.6},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "programs": [
            {
                "poses": [
                    {"x_mm": 10, "y_mm": 20, "z_mm": 0.2, **DOWN, "feed_mm_s": 30},
                    {"x_mm": 50, "y_mm": 20, "z_mm": 0.2, **DOWN, "feed_mm_s": 30},
                ]
            }
        ],
    }


def test_every_sample_knows_its_motions_through_all_programs(tmp_path):
    job = plate_job()
    beside = copy.deepcopy(job["programs"][0])
    for pose in beside["poses"]:
        pose["y_mm"] = 32
    job["programs"].append(beside)
    result = beltgrinding.run(job)
    result.write(tmp_path)
    field = core.HeightField.from_hdf5(str(tmp_path / "heightfield.h5"))[0]
    trace, y = field.trace, field.points[:, 1]
    middle = abs(field.points[:, 0] - 30) < 15
    only_first, only_second, none = (
        middle & band for band in (abs(y - 16) < 3, abs(y - 35) < 3, y < 10)
    )
    for name in ("first", "last", "dominant"):
        assert (trace[name][only_first] == 1).all()
        assert (trace[name][only_second] == 3).all()  # two poses of the program before
        assert (trace[name][none] == core.NEVER).all()
    both = middle & (abs(y - 26) < 1)
    assert (trace["first"][both] == 1).all() and (trace["last"][both] == 3).all()
    assert (trace["dominant_depth"] <= 0.2 - field.height + 1e-6).all()
    assert (trace["peak_pressure"][only_first] > 0).all() and not trace["peak_pressure"][none].any()
    assert trace["first"].dtype == np.uint32 and not trace["first"].flags.writeable


def test_a_recording_follows_all_programs_of_a_job(tmp_path):
    job = plate_job()
    job["programs"] *= 2
    recording = core.Recording()
    result = beltgrinding.run(job, recording=recording)
    assert result.recording is recording
    assert recording.last == recording.steps()[-1] == len(result.steps["time"])
    assert recording.duration == pytest.approx(result.summary["process_time_s"])
    # A step's time is its middle; its frame is reached at its end.
    ends = result.steps["time"] + 0.5 * result.steps["duration"]
    np.testing.assert_allclose(recording.times()[1:], ends, rtol=1e-6)
    np.testing.assert_array_equal(recording.heights_at(0), np.float32(0.2))
    final = result.field.height.astype(np.float32)
    np.testing.assert_array_equal(recording.heights_at(recording.last), final)

    recording.write_hdf5(str(tmp_path / "recording.h5"), "text")
    read, attributes = core.Recording.from_hdf5(str(tmp_path / "recording.h5"))
    assert attributes == "text" and read.bytes == recording.bytes
    heights, at = read.heights_at(read.last), read.last
    for frame in (5, 30, 7, 0, read.last):
        samples, changed = read.advance(at, frame)
        heights[samples] = changed
        np.testing.assert_array_equal(heights, recording.heights_at(frame))
        at = frame

    # Before format 2 runs were samples, and there was no order: what is told of position p is of sample p then.
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        order = file["order"][()]
        del file["order"]
        file.attrs.modify("recording_format", np.int32(1))
    older, _ = core.Recording.from_hdf5(str(tmp_path / "recording.h5"))
    for frame in (5, read.last):
        np.testing.assert_array_equal(older.heights_at(frame), read.heights_at(frame)[order])
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file.attrs.modify("recording_format", np.int32(3))
    with pytest.raises(InputError, match="format 3"):
        core.Recording.from_hdf5(str(tmp_path / "recording.h5"))

    small = core.Recording(recording.changes)  # bytes: a quarter of the heights'
    assert beltgrinding.run(job, recording=small).summary["samples"] == small.samples
    assert small.steps_per_frame > 1 and small.bytes < recording.bytes
    np.testing.assert_array_equal(small.heights_at(small.last), final)
    with pytest.raises(InputError, match="no frame"):
        small.heights_at(small.last + 1)


def test_a_job_grinds_what_the_law_says():
    result = beltgrinding.run(plate_job())
    summary = result.summary
    expected = 1.25e-4 * 20000.0 * 30.0 * 40.0 / 30.0  # K V_b F t
    assert summary["removed_volume_mm3"] == pytest.approx(expected, rel=0.01)
    assert summary["design_area_mm2"] == pytest.approx(2400.0, rel=1e-3)
    assert summary["stock_volume_mm3"] == pytest.approx(480.0, rel=1e-3)
    assert summary["process_time_s"] == pytest.approx(40.0 / 30.0)
    assert summary["deviation_mm"]["max"] == pytest.approx(0.2)
    assert summary["missed_rays"] == summary["defective_samples"] == 0


def test_tool_in_hand_and_part_in_hand_agree():
    tool = plate_job()
    part = copy.deepcopy(tool)
    part["cell"] = {
        "holding": "part_in_hand",
        "base_from_contact": {"position_mm": [0, 0, 0], "abc_deg": [0, 0, 0]},
    }
    # The part's pose is the inverse of the wheel's; half a turn about x is its own inverse.
    for pose in part["programs"][0]["poses"]:
        pose["x_mm"] *= -1
    results = [beltgrinding.run(job) for job in (tool, part)]
    np.testing.assert_allclose(results[0].field.height, results[1].field.height, atol=1e-9)


def test_results_are_the_same_bit_for_bit():
    a, b = (beltgrinding.run(plate_job()).field.height for _ in range(2))
    assert (a == b).all()


def test_everything_is_written_and_can_be_read(tmp_path):
    result = beltgrinding.run(plate_job())
    result.write(tmp_path / "out")
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["samples"] == result.field.size
    assert json.loads((tmp_path / "out" / "events.json").read_text()) == result.events
    field, attributes = core.HeightField.from_hdf5(str(tmp_path / "out" / "heightfield.h5"))
    np.testing.assert_array_equal(field.height, result.field.height)
    assert json.loads(attributes)["belt_machine"]["force_N"] == 30
    with open(tmp_path / "out" / "steps.csv") as file:
        names = file.readline().strip().split(",")
    rows = np.loadtxt(tmp_path / "out" / "steps.csv", delimiter=",", skiprows=1)
    assert rows.shape == (result.summary["steps"], len(names))
    for name in ("time_s", "feed_mm_s", "removal_rate_mm3_s"):
        values = result.steps[name.split("_mm")[0].removesuffix("_s")]
        np.testing.assert_allclose(rows[:, names.index(name)], values, rtol=1e-6)
    assert (tmp_path / "out" / "deviation.ply").read_bytes().startswith(b"ply\n")
    assert not list((tmp_path / "out").glob("*.part"))


def test_a_robot_that_accelerates_takes_longer_and_removes_more():
    job = plate_job()
    constant = beltgrinding.run(job)
    job["simulation"] = {"timing": "trapezoidal", "path_acceleration_mm_s2": 100}
    result = beltgrinding.run(job)
    longer = 30.0 / 100.0  # v / a: from rest to rest
    assert result.summary["process_time_s"] == pytest.approx(40.0 / 30.0 + longer)
    more = result.summary["removed_volume_mm3"] - constant.summary["removed_volume_mm3"]
    assert more == pytest.approx(1.25e-4 * 20000.0 * 30.0 * longer, rel=0.02)  # K V_b F t
    steps = result.steps
    assert steps["duration"].sum() == pytest.approx(result.summary["process_time_s"], rel=1e-6)
    np.testing.assert_allclose(steps["feed"] * steps["duration"], 1.0, rtol=1e-5)  # steps of 1 mm
    assert steps["feed"].max() == pytest.approx(30.0) and steps["feed"][0] < 10.0
    np.testing.assert_allclose(constant.steps["feed"], 30.0, rtol=1e-5)


def corner_job(**corner):
    job = plate_job()
    job["programs"][0]["poses"].append(
        {"x_mm": 50, "y_mm": 35, "z_mm": 0.2, **DOWN, "feed_mm_s": 30}
    )
    job["programs"][0]["poses"][1].update(corner)
    job["simulation"] = {"timing": "trapezoidal", "path_acceleration_mm_s2": 500}
    return job


def test_the_zone_of_a_pose_or_the_default_rounds_the_corner():
    def times(default, **corner):
        job = corner_job(**corner)
        job["simulation"]["default_zone_mm"] = default
        return beltgrinding.run(job).summary["process_time_s"]

    stop = 55.0 / 30.0 + 4 * 0.5 * 30.0 / 500.0  # half a ramp's time more at each end
    assert times(0) == pytest.approx(stop)
    assert times(4, zone_mm=0) == pytest.approx(stop)
    assert times(0, zone_mm=4) == times(4) == pytest.approx(55.0 / 30.0 + 30.0 / 500.0)


def test_zones_come_back_from_a_list_of_poses():
    arrays = poses.program_arrays(corner_job(zone_mm=2.5)["programs"][0], "p", [])
    assert arrays["zones"].tolist() == [-1, 2.5, -1]
    again = poses.listed_poses(poses.list_poses(arrays), "p")
    for name, values in arrays.items():
        np.testing.assert_array_equal(again[name], values)


def test_a_cancelled_run_raises():
    context = core.RunContext()
    context.cancel()
    with pytest.raises(beltgrinding.Cancelled):
        beltgrinding.run(plate_job(), context)


def bad(change):
    job = plate_job()
    change(job)
    with pytest.raises(InputError) as error:
        beltgrinding.run(job)
    return str(error.value)


@pytest.mark.parametrize(
    "change, culprit",
    [
        (lambda j: j.update(stok={}), "unknown key 'stok'; did you mean 'stock'"),
        (lambda j: j.pop("design"), "'design' is missing"),
        (lambda j: j["sampling"].update(spacing_mm=-1), "sampling.spacing_mm"),
        (lambda j: j["sampling"].update(spacing_mm=1e-6), "spacing"),
        (lambda j: j["sampling"].update(spacing_mm=float("nan")), "finite"),
        (lambda j: j["design"].update(faces=[99]), "no face 99"),
        (lambda j: j["design"].update(brep="rubbish"), "design"),
        (lambda j: j.update(design={"file": "absent.step"}), "absent.step"),
        (lambda j: j["programs"][0].update(poses=[]), "0 Cartesian targets"),
        (lambda j: j["programs"][0]["poses"][1].update(qw=1.0), "pose 2: the quaternion"),
        (lambda j: [p.update(z_mm=500) for p in j["programs"][0]["poses"]], "never touches"),
        (lambda j: j["programs"][0].update(file="x.src"), "exactly one"),
        (lambda j: j.update(stock={"kind": "mesh"}), "needs the key 'file'"),
        (lambda j: j.update(inspection={"tolerance_mm": [1, -1]}), "tolerance_mm"),
    ],
)
def test_bad_jobs_name_the_culprit(change, culprit):
    assert culprit in bad(change)


@pytest.mark.parametrize("scale, words", [(1000.0, "more than 10 m"), (0.001, "less than 0.1 mm")])
def test_a_part_in_the_wrong_unit_is_warned_of(scale, words):
    job = plate_job()
    job["design"]["brep"] = plate(60.0 * scale, 40.0 * scale).write_brep()
    job["sampling"]["spacing_mm"] *= scale
    with pytest.raises(InputError, match=f"Note: .*{words}"):
        beltgrinding.run(job)


def cli(*arguments, cwd):
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "Mod" / "BeltGrinding")}
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", *map(str, arguments)],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
    )


def test_command_line_runs_a_job_with_paths_relative_to_it(tmp_path):
    job = plate_job()
    (tmp_path / "plate.brep").write_text(job["design"].pop("brep"))
    job["design"]["file"] = "plate.brep"
    (tmp_path / "job.json").write_text(json.dumps(job))
    (tmp_path / "elsewhere").mkdir()
    done = cli("run", "../job.json", "-o", "out", cwd=tmp_path / "elsewhere")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "elsewhere" / "out" / "summary.json").is_file()
    assert "mm3 removed" in done.stdout


def test_command_line_says_a_users_mistake_in_one_line(tmp_path):
    (tmp_path / "job.json").write_text('{"design": {"file": "x.step"}, "programms": []}')
    for job in ("job.json", "absent.json"):
        done = cli("run", job, "-o", "out", cwd=tmp_path)
        assert done.returncode == 2
        assert job in done.stderr
        assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(not (SHARED / "data").is_dir(), reason=f"no shared data at {SHARED}")
@pytest.mark.parametrize("file", ["reads_as_null_shape.stp"])
def test_nasty_files_are_refused_by_name(file):
    job = plate_job()
    job["design"] = {"file": str(SHARED / "data" / "cad_nasty" / file)}
    with pytest.raises(InputError, match=file):
        beltgrinding.run(job)


def test_a_profiled_wheel_grinds_where_it_stands_out():
    job = plate_job()
    job["belt_machine"]["wheel"]["profile_mm"] = [[-7.5, 1.0], [-0.5, 0.0], [0.5, 0.0], [7.5, 1.0]]
    result = beltgrinding.run(job)
    height, y = result.field.height, result.field.points[:, 1]
    lane = y[height < 0.19]
    assert 1.0 < np.ptp(lane) < 10.0
    assert np.mean(lane) == pytest.approx(np.mean([y.min(), y.max()]), abs=1.0)
    job["belt_machine"]["wheel"]["profile_mm"] = [[-5, 0.0], [5, 0.0]]
    with pytest.raises(InputError, match="profile needs points"):
        beltgrinding.run(job)


@pytest.mark.parametrize(
    "place, value, code",
    [
        (("law", "coefficient_mm2_per_N"), 0.0, "idle.coefficient"),
        (("belt_machine", "belt_wear"), 0.0, "idle.belt_wear"),
    ],
)
def test_settings_that_grind_nothing_are_told(place, value, code):
    job = plate_job()
    job.setdefault(place[0], {})[place[1]] = value
    summary = beltgrinding.run(job).summary
    assert abs(summary["removed_volume_mm3"]) < 1e-4  # float32 heights
    assert code in [fact["code"] for fact in summary["warning_facts"]]
    others = beltgrinding.run(plate_job()).summary["warning_facts"]
    assert not [fact for fact in others if fact["code"].startswith("idle.")]


def test_a_force_of_zero_is_told_with_its_program(tmp_path):
    """Also one that stands in a program's file: the error of a wheel that touches nothing names it."""
    table = tmp_path / "idle.csv"
    rows = [f"{x},20,0.2,0,1,0,0,30,0" for x in (10, 50)]
    head = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s,force_N"
    table.write_text("\n".join([head, *rows]) + "\n")
    for program in ({"file": str(table)}, {**plate_job()["programs"][0], "force_N": 0}):
        job = plate_job()
        job["programs"] = [program]
        with pytest.raises(InputError, match="the force is 0 at every pose"):
            beltgrinding.run(job)
