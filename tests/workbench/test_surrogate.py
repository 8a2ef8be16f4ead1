"""The surrogate of the contact: its database, its training, its files, its use in a job."""

import json

import numpy as np
import pytest

from beltgrinding.engine import InputError
from beltgrinding import cli
from beltgrinding.contact import single_contact as contact, surrogate
from beltgrinding.job import surrogate_file
from beltgrinding.simulation import run as runs
from beltgrinding.job import load as jobs
from test_job import plate_job

WHEEL = {"outer_radius_mm": 60, "width_mm": 15, "rim_thickness_mm": 10}


def of(shape, **more):
    return {"wheel": WHEEL, "workpiece": shape, "force_N": 30, "spacing_mm": 1, **more}


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """Files of a database and of a surrogate trained on it, and the printed report."""
    folder = tmp_path_factory.mktemp("surrogate")
    given = contact.validate(of({"shape": "plane"}))
    database = surrogate.make_database(given, 500)
    surrogate_file.save_database(database, folder / "database.npz")
    model, report = surrogate.train(surrogate_file.load_database(folder / "database.npz"))
    surrogate_file.save(model, folder / "wheel.npz")
    return folder, report


@pytest.mark.slow
def test_held_out_error_is_that_of_a_rough_surrogate(trained):
    _, report = trained
    assert report["held_out_contacts"] == 50
    assert report["held_out_L1_median"] < 0.2
    assert report["held_out_approach_rms"] < 0.1


@pytest.mark.slow
def test_single_contact_agrees_with_the_rim(trained):
    folder, _ = trained
    shape = {"shape": "cylinder", "radius_mm": 40}
    exact = contact.run(contact.validate(of(shape)))
    given = of(shape, model="surrogate", surrogate_file="wheel.npz")
    found = contact.run(contact.validate(given, folder))
    assert found["converged"] and found["model"].startswith("surrogate: support-vector")
    assert found["force"] == pytest.approx(30, rel=1e-6)
    assert found["approach"] == pytest.approx(exact["approach"], rel=0.06)
    assert np.abs(found["pressure"] - exact["pressure"]).sum() < 0.2 * exact["pressure"].sum()


def test_job_runs_with_it_and_names_it(trained):
    folder, _ = trained
    job = plate_job()
    compliance = {"rim_thickness_mm": 10, "model": "surrogate", "surrogate_file": "wheel.npz"}
    job["belt_machine"]["compliance"] = compliance
    result = runs.run(jobs.validate(job, folder))
    compliance["model"] = "wheel_rim"
    exact = runs.run(jobs.validate(job, folder))
    assert "held-out error" in result.summary["models"]["compliance"]
    volume = exact.summary["removed_volume_mm3"]
    assert result.summary["removed_volume_mm3"] == pytest.approx(volume, rel=0.02)


def test_another_wheel_is_refused(trained):
    folder, _ = trained
    job = plate_job()
    job["belt_machine"]["compliance"] = {"model": "surrogate", "surrogate_file": "wheel.npz"}
    with pytest.raises(InputError, match="rim_thickness_mm = 10, not 15"):
        runs.run(jobs.validate(job, folder))
    del job["belt_machine"]["compliance"]["surrogate_file"]
    with pytest.raises(InputError, match="needs the key 'surrogate_file'"):
        jobs.validate(job)


def test_damaged_files_are_refused(trained, tmp_path):
    folder, _ = trained
    whole = (folder / "wheel.npz").read_bytes()
    wheel = surrogate_file.load(folder / "wheel.npz")[0]["wheel"]
    random = np.random.default_rng(2)
    damaged = tmp_path / "damaged.npz"
    for _ in range(60):
        content = bytearray(whole[: random.integers(0, len(whole))])
        for place in random.integers(0, max(1, len(content)), 8):
            if content:
                content[place] = random.integers(0, 256)
        damaged.write_bytes(content)
        with pytest.raises(InputError, match="damaged.npz"):
            surrogate_file.arguments(damaged, wheel)
    with pytest.raises(InputError, match="gap is not"):
        surrogate_file.load_database(folder / "wheel.npz")
    with pytest.raises(InputError, match="cannot be read"):
        surrogate_file.load(tmp_path / "absent.npz")


def test_arrays_that_do_not_fit_are_refused(trained, tmp_path):
    folder, _ = trained
    database = surrogate_file.load_database(folder / "database.npz")
    for key, value in (
        ("force", database["force"][:-1]),
        ("coverage", database["coverage"][:, :-1]),
        ("pressure", np.full_like(database["pressure"], np.nan)),
    ):
        surrogate_file.save_database({**database, key: value}, tmp_path / "bad.npz")
        with pytest.raises(InputError, match=key):
            surrogate_file.load_database(tmp_path / "bad.npz")
    model, _ = surrogate_file.load(folder / "wheel.npz")
    surrogate_file.save({**model, "mean": model["mean"][:-1]}, tmp_path / "bad.npz")
    given = of({"shape": "plane"}, model="surrogate", surrogate_file="bad.npz")
    with pytest.raises(InputError, match="do not fit together"):
        contact.run(contact.validate(given, tmp_path))


def test_command_line(tmp_path, capsys):
    (tmp_path / "contact.json").write_text(json.dumps(of({"shape": "plane"})))
    output = str(tmp_path / "wheel.npz")
    arguments = [str(tmp_path / "contact.json"), "-o", output, "--contacts", "40"]
    assert cli.main(["surrogate", *arguments, "--database", str(tmp_path / "d.npz")]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["contacts"] == 40 and report["source"] == "wheel_rim"
    assert cli.main(["surrogate", "--train-on", str(tmp_path / "d.npz"), "-o", output]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["held_out_L1_mean"] == pytest.approx(report["held_out_L1_mean"], abs=0.02)
    assert cli.main(["surrogate", "-o", output]) == 2
    assert "either a contact.json" in capsys.readouterr().err
