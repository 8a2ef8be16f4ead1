"""A contact solved again by CalculiX, from an analytic workpiece and from a pose of a job."""

import json
import shutil
import subprocess
import sys

import pytest
from support.freecad import MOD

from beltgrinding.engine import InputError
from beltgrinding.contact import single_contact as contact, finite_elements as reference

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="calculix-ccx is not installed")
CONTACT = {
    "wheel": {"outer_radius_mm": 100, "width_mm": 16, "rim_thickness_mm": 15},
    "workpiece": {"shape": "cylinder", "radius_mm": 50},
    "force_N": 40,
    "spacing_mm": 1.0,
}


@needs_ccx
@pytest.mark.parametrize(
    "workpiece",
    [
        {"shape": "cylinder", "radius_mm": 50},
        {"shape": "plane"},
        {"shape": "sphere", "radius_mm": 80},
    ],
)
def test_calculix_agrees(workpiece):
    given = contact.validate({**CONTACT, "workpiece": workpiece})
    result = contact.run(given)
    truth = reference.solve(result, contact.rim(given))
    figures = reference.compare(result, truth)
    assert abs(figures["force_difference"]) < 0.05
    assert figures["pressure_difference_L1"] < 0.08
    assert truth["pressure"].shape == result["pressure"].shape


@needs_ccx
def test_a_pose_of_a_job_from_the_command_line(tmp_path, freecad):
    freecad.call(make_blade)
    arguments = ["contact", str(freecad.folder / "blade" / "job.json"), "--pose", "100"]
    done = subprocess.run(
        [sys.executable, "-m", "beltgrinding", *arguments, "--reference", "ccx", "-o", "p.csv"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(MOD), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["force_N"] == pytest.approx(30.0)
    assert abs(figures["force_difference"]) < 0.05
    assert (tmp_path / "p.csv").read_text().startswith("x_mm,y_mm,p_MPa,p_reference_MPa\n")


def test_without_calculix_the_package_is_named(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    given = contact.validate(CONTACT)
    with pytest.raises(InputError, match="calculix-ccx"):
        reference.solve(contact.run(given), contact.rim(given))


def test_a_pose_that_is_not_there_is_named(tmp_path, freecad):
    freecad.call(make_blade)
    for arguments, culprit in (
        (["--pose", "1"], "pose 1"),
        (["--pose", "9999"], "no pose 9999"),
        (["--pose", "5", "--program", "2"], "no program 2"),
    ):
        done = subprocess.run(
            [sys.executable, "-m", "beltgrinding", "contact", "blade/job.json", *arguments],
            cwd=freecad.folder,
            env={"PYTHONPATH": str(MOD), "PATH": "/usr/bin:/bin"},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 2 and culprit in done.stderr, done.stderr


def make_blade():
    from beltgrinding.examples import blade

    blade.make("blade")
