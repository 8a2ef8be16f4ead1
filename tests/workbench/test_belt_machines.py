"""Jobs whose belt is pressed without a wheel: a free belt, a platen; and what refuses them."""

import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.calibration import contacts
from beltgrinding.contact import single_contact
from beltgrinding.engine import InputError
from beltgrinding.geometry import fork
from beltgrinding.job import load as jobs
from beltgrinding.simulation.result import Result
from test_job import plate_job

LAYER = {"thickness_mm": 5, "youngs_modulus_MPa": 2, "poissons_ratio": 0.4}


def belt_job(kind="free_belt", **machine):
    """The plate of 60 x 40 mm, ground across by a belt that is 15 mm wide."""
    job = plate_job()
    job["belt_machine"] = {
        "kind": kind,
        "force_N": 20,
        "force_travel_mm": 30,
        "free_run": {"width_mm": 15, "tension_N_per_mm": 6},
        **machine,
    }
    if kind == "platen":
        job["belt_machine"].setdefault("platen", {"layers": [LAYER]})
    return job


@pytest.fixture(scope="module", params=["free_belt", "platen"])
def ground(request):
    return beltgrinding.run(belt_job(request.param))


def test_the_force_is_held_and_only_what_lies_under_the_belt_is_ground(ground):
    steps = ground.steps
    assert np.allclose(steps["force"], 20.0, rtol=2e-3)
    field = ground.field
    removed = field.stock_height - field.height
    beside = np.abs(field.points[:, 1] - 20.0) > 0.5 * 15 + 0.61
    assert removed[beside].max() < 1e-7 and removed.max() > 1e-4
    assert "not_converged" not in ground.summary["events"]
    assert ground.job["belt_machine"]["kind"] in ground.summary["models"]["compliance"].replace(
        " ", "_"
    )


def test_defaults_of_what_the_kind_needs_are_filled_in_and_no_others(ground):
    machine = ground.job["belt_machine"]
    assert machine["free_run"]["length_mm"] == 200.0
    assert ("platen" in machine) == (machine["kind"] == "platen")
    wheel = jobs.validate(plate_job())["belt_machine"]
    assert not {"kind", "free_run", "platen"} & set(wheel)


def test_a_job_that_names_the_contact_wheel_is_ground_as_one_that_does_not():
    plain, named = plate_job(), plate_job()
    named["belt_machine"]["kind"] = "contact_wheel"
    plain, named = beltgrinding.run(plain), beltgrinding.run(named)
    assert np.array_equal(plain.field.height, named.field.height)
    assert plain.events == named.events


def test_rollers_and_plate_are_among_the_bodies_that_may_collide(ground):
    bodies = {name for pair in ground.summary["clearances"] for name in pair["bodies"]}
    assert {"roller_before", "roller_behind"} <= bodies and "wheel" not in bodies
    assert ("platen" in bodies) == (ground.job["belt_machine"]["kind"] == "platen")


def test_a_small_wheel_is_a_wheel_whose_belt_and_fork_may_collide():
    job = plate_job()
    job["belt_machine"]["kind"] = "small_wheel"
    small, plain = beltgrinding.run(job), beltgrinding.run(plate_job())
    assert np.array_equal(small.field.height, plain.field.height)
    names = {name for pair in small.summary["clearances"] for name in pair["bodies"]}
    assert {"wheel", "belt_before", "belt_behind", "fork"} <= names
    # Without arms; the pulleys far apart, so that the runs come down on the plate as it is tilted under them.
    wheel = small.job["belt_machine"]["wheel"]
    flat = {"arm_thickness_mm": 0, "spread_mm": 2000, "length_mm": wheel["radius_mm"] + 1}
    job["belt_machine"]["fork"] = flat
    for pose in job["programs"][0]["poses"]:
        turn = np.deg2rad(20.0) / 2.0  # about y, from the wheel that looks straight down
        lifted = wheel["radius_mm"] * (1.0 - np.cos(2.0 * turn))  # so that it rests on the plate
        pose.update(qw=0.0, qx=float(np.cos(turn)), qy=0.0, qz=float(np.sin(turn)), z_mm=lifted)
    found = beltgrinding.run(job)
    hit = {name for e in found.events if e["kind"] == "collision" for name in e["bodies"]}
    assert hit & {"belt_before", "belt_behind"} and "fork" not in hit, hit
    job["belt_machine"]["fork"] = {**flat, "spread_mm": 80, "length_mm": 150}
    free = beltgrinding.run(job)
    hit = {name for e in free.events if e["kind"] == "collision" for name in e["bodies"]}
    assert not hit & {"belt_before", "belt_behind"}
    assert np.array_equal(found.field.height, free.field.height)
    for change, code in (
        ({"length_mm": wheel["radius_mm"]}, "job.short_fork"),
        ({"spread_mm": -1}, "base.below_minimum"),
    ):
        job["belt_machine"]["fork"] = change
        with pytest.raises(InputError) as error:
            jobs.validate(job)
        assert error.value.code == code, error.value


def test_the_runs_of_a_small_wheel_are_tangents_of_its_rim():
    wheel = {"radius_mm": 20.0, "width_mm": 10.0}
    for spread in (0.0, 40.0, 200.0):
        part = {"length_mm": 100.0, "spread_mm": spread, "belt_thickness_mm": 1.0}
        before, faces = fork.run({"wheel": wheel, "fork": part}, -1.0)
        behind, others = fork.run({"wheel": wheel, "fork": part}, 1.0)
        assert np.allclose(before * [-1, 1, 1], behind)
        touch, far = behind[0, [0, 2]] + [0, 20], behind[1, [0, 2]] + [0, 20]
        assert np.isclose(np.hypot(*touch), 20.0) and np.isclose(touch @ (far - touch), 0.0)
        assert np.allclose(far, [0.5 * spread, -100.0])
        for points, triangles in ((before, faces), (behind, others)):  # outwards: a positive volume
            a, b, c = points[triangles].transpose(1, 0, 2)
            assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0


def test_a_part_that_reaches_into_a_roller_collides_with_it():
    job = belt_job()
    job["belt_machine"]["free_run"].update(length_mm=50, roller_radius_mm=10)
    for pose in job["programs"][0]["poses"]:
        pose["z_mm"] = -3.0  # deeper than the belt's own inner face lies, which the rollers touch
    kinds = beltgrinding.run(job).summary["events"]
    assert "collision" in kinds


def test_a_result_is_written_and_reported_with_its_machine(ground, tmp_path):
    ground.write(tmp_path)
    again = Result.read(tmp_path)
    assert np.array_equal(again.field.height, ground.field.height)
    assert again.job["belt_machine"] == ground.job["belt_machine"]
    text = beltgrinding.report(tmp_path).read_text(encoding="utf-8")
    assert "6 N/mm over 200 mm" in text and "Contact wheel" not in text


def test_the_command_line_runs_it_and_presses_at_a_pose(tmp_path, capsys):
    file = tmp_path / "job.json"
    file.write_text(json.dumps(belt_job()), encoding="utf-8")
    assert cli.main(["run", str(file), "-q", "-o", str(tmp_path / "out")]) == 0
    assert cli.main(["contact", str(file), "--pose", "2"]) == 0
    assert "free belt" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda m: m.update(kind="no_wheel"), None),
        (lambda m: m["free_run"].update(width_mm=0), None),
        (lambda m: m["free_run"].update(position_mm=100), "job.belt_position"),
        (lambda m: m["platen"].update(length_mm=201), "job.platen_length"),
        (lambda m: m["platen"].update(layers=[{"thickness_mm": 1}]), None),
    ],
)
def test_values_that_are_none_are_refused_by_their_key(change, code):
    job = belt_job("platen")
    change(job["belt_machine"])
    with pytest.raises(InputError, match="belt_machine") as error:
        jobs.validate(job)
    assert code is None or error.value.code == code


def test_a_belt_is_not_rigid():
    job = belt_job()
    job["law"] = {"model": "geometric"}
    with pytest.raises(InputError) as error:
        jobs.validate(job)
    assert error.value.code == "job.belt_is_not_rigid"


def test_what_knows_wheels_only_says_so():
    job = jobs.validate(belt_job())
    with pytest.raises(InputError, match="free_belt") as error:
        single_contact.rim(job)
    assert error.value.code == "job.needs_wheel"
    with pytest.raises(InputError) as error:
        contacts.of_machine(job["belt_machine"])
    assert error.value.code == "calibration.no_wheel"
