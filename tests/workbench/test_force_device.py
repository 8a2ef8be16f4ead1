"""The force device of a job: programs read, laid, planned and exported with it, on the command line and in FreeCAD."""

import json

import numpy as np
import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding import cli
from beltgrinding.base.frames import from_abc
from beltgrinding.cell import tool_path as tool_paths
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.planning import limits, rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.programs import Motion, read_program, write_program
from beltgrinding.programs.force_device import of_job
from test_raster import plate

DEVICE = {"kind": "analog", "name": "aoForce", "scale_per_N": 0.01, "greatest_N": 60}
FORCES = [20.0, 20.0, 35.5, 50.0]


def motions(forces):
    for k, force in enumerate([None, *forces]):
        pose = from_abc((20.0 + 10.0 * k, 30.0, 0.0), (0.0, 0.0, 180.0))
        yield Motion("PTP" if k == 0 else "LIN", pose, 0, "", None if k == 0 else 50.0, force)


def job_with(program, **device):
    return {
        "design": {"brep": plate()},
        "belt_machine": {"force_N": 30, "force_device": {**DEVICE, **device}},
        "programs": [{"file": str(program)}],
    }


def forces_of(job):
    return tool_paths.motions(tool_paths.tool_path(job, 0, []))["forces"].tolist()


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script"])
def test_a_job_reads_its_program_s_forces(tmp_path, suffix):
    path = tmp_path / f"p{suffix}"
    write_program(path, None, motions(FORCES), force_device=DEVICE)
    assert forces_of(jobs.validate(job_with(path))) == [-1.0, *FORCES]
    assert forces_of(jobs.validate(job_with(path, kind="none"))) == [-1.0] * 5
    override = job_with(path)
    override["programs"][0]["force_N"] = 12.0
    assert forces_of(jobs.validate(override)) == [12.0] * 5


@pytest.mark.parametrize(
    "device, why",
    [
        ({"kind": "template", "template": "FORCE"}, "belt_machine.force_device.template"),
        ({"scale_per_N": 0}, "belt_machine.force_device.scale_per_N"),
        ({"kind": "call", "name": ""}, "belt_machine.force_device.name"),
        ({"kind": "pneumatic"}, "belt_machine.force_device.kind"),
    ],
)
def test_a_wrong_device_is_refused_with_the_job(tmp_path, device, why):
    with pytest.raises(InputError, match=why):
        jobs.validate(job_with("p.src", **device))
    file = tmp_path / "job.json"
    file.write_text(json.dumps(job_with("p.src", **device)))
    with pytest.raises(InputError, match=f"job.json.*{why}"):
        jobs.load(file)


def test_a_job_s_device_knows_its_cell():
    job = job_with("p.src")
    frame = {"position_mm": [1, 2, 3], "abc_deg": [0, 90, 0]}
    job["cell"] = {"holding": "part_in_hand", "base_from_contact": frame}
    device = of_job(jobs.validate(job))
    assert device.held and device.force_N == 30.0
    np.testing.assert_allclose(device.contact, from_abc((1, 2, 3), (0, 90, 0)), atol=1e-12)
    assert of_job(jobs.typed(jobs.validate(job))) == device


def test_the_command_line_takes_a_device(tmp_path, capsys):
    path, table = tmp_path / "p.src", tmp_path / "p.csv"
    write_program(table, None, motions(FORCES))
    device = tmp_path / "device.json"
    device.write_text(json.dumps(DEVICE))
    convert = ["program", "convert", str(table), "-o", str(path), "--form", "spline"]
    assert cli.main([*convert, "--force-device", str(device)]) == 0
    assert "force_not_set" not in capsys.readouterr().err
    again = tmp_path / "again.csv"
    job = tmp_path / "job.json"
    job.write_text(json.dumps(job_with(path)))
    for given in (device, job, json.dumps(DEVICE)):
        command = ["program", str(path), "--force-device", str(given), "-o", str(again), "--force"]
        assert cli.main(command) == 0
        head, *rows = [one.split(",") for one in again.read_text().splitlines() if one[0] != "#"]
        column = head.index("force_N")
        assert [float(row[column]) for row in rows[1:]] == FORCES
    assert cli.main(["program", str(path), "--force-device", '{"kind": "call"}']) == 2
    assert "is no name of a subprogram" in capsys.readouterr().err
    assert cli.main(["program", str(path), "--form", "zones"]) == 2
    assert "--form is convert's" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(
    "controller, form", [("krc4", "spline"), ("krc2", "zones"), ("", "spline")]
)
def test_passes_have_the_form_of_the_job_s_controller(tmp_path, capsys, controller, form):
    """raster, FreeCAD's options and convert; another form that is given is a warning, in KRL only."""
    job = {**job_with("p.src"), "programs": []}
    job["robot"] = {"controller": controller} if controller else {}
    file = tmp_path / "job.json"
    file.write_text(json.dumps(job))
    command = ["raster", str(file), "--set", 'along="direction"', "-o"]
    assert cli.main([*command, str(tmp_path / "r.src")]) == 0
    text = (tmp_path / "r.src").read_text()
    assert ("SPLINE" in text) == (form == "spline") and ("C_DIS" in text) == (form == "zones")
    assert "form" not in capsys.readouterr().err
    other = {"spline": "zones", "zones": "spline"}[form]
    assert cli.main([*command, str(tmp_path / "o.src"), "--form", other]) == 0
    assert ("SPLINE" in (tmp_path / "o.src").read_text()) == (other == "spline")
    why = "reaches the feeds in spline blocks" if other == "zones" else "knows no spline blocks"
    assert f"warning: form {other}: " in (told := capsys.readouterr().err) and why in told
    assert cli.main([*command, str(tmp_path / "o.mod"), "--form", other]) == 0
    assert "form" not in capsys.readouterr().err


def test_convert_takes_the_form_of_a_controller(tmp_path, capsys):
    table = tmp_path / "p.csv"
    write_program(table, None, motions(FORCES))
    convert = ["program", "convert", str(table), "--force", "-o"]
    found = {}
    for controller in ("krc4", "krc2", "irc5"):
        path = tmp_path / f"{controller}.src"
        assert cli.main([*convert, str(path), "--controller", controller]) == 0
        found[controller] = "SPLINE" in path.read_text()
    assert found == {"krc4": True, "krc2": False, "irc5": False}
    assert cli.main([*convert, str(tmp_path / "q.src"), "--controller", "krc3"]) == 2
    assert "no 'krc3' among the controllers" in capsys.readouterr().err
    assert cli.main(["program", str(table), "--controller", "krc2"]) == 2
    assert "--controller is convert's" in capsys.readouterr().err
    both = ["--controller", "krc2", "--form", "spline"]
    assert cli.main([*convert, str(tmp_path / "s.src"), *both]) == 0
    assert "KUKA KR C2 knows no spline blocks" in capsys.readouterr().err


def test_a_force_that_comes_late_is_told(tmp_path):
    device = {**DEVICE, "dead_time_s": 0.05}
    for name, form, late in (
        ("a.src", "spline", False),
        ("b.src", "zones", True),
        ("c.mod", "", True),
    ):
        notes = write_program(
            tmp_path / name, None, motions(FORCES), form=form, force_device=device
        )
        assert ("programs.writers.force_late" in [one.code for one in notes]) is late
    notes = write_program(tmp_path / "d.mod", None, motions(FORCES), force_device=DEVICE)
    assert "programs.writers.force_late" not in [one.code for one in notes]


def test_changes_go_back_through_the_device(tmp_path):
    path, changes = tmp_path / "p.src", tmp_path / "changes.csv"
    write_program(path, None, motions(FORCES), form="spline", force_device=DEVICE)
    changes.write_text("index,force_N\n2,25\n")
    command = ["program", "write", str(path), str(changes), "-o", str(tmp_path / "q.src")]
    assert cli.main(command) == 2
    assert cli.main([*command, "--force-device", json.dumps(DEVICE)]) == 0
    found = read_program(tmp_path / "q.src", force_device=DEVICE).motions
    assert [m.force_N for m in found] == [None, 20.0, 25.0, 35.5, 50.0]


def test_a_raster_is_written_with_the_job_s_device(tmp_path, capsys):
    job = {**job_with("p.src"), "programs": []}
    file = tmp_path / "job.json"
    file.write_text(json.dumps(job))
    command = ["raster", str(file), "-o", str(tmp_path / "r.src"), "--set", 'along="direction"']
    assert cli.main(command) == 0
    text = (tmp_path / "r.src").read_text()
    assert "SPLINE" in text and "$ANOUT[1]=0.3" in text and "force 30 N" not in text
    assert "does not set the pressing force" not in capsys.readouterr().err
    found = read_program(tmp_path / "r.src", force_device=job["belt_machine"]["force_device"])
    assert {m.force_N for m in found.motions if m.kind != "PTP"} >= {30.0}
    assert not [p for p in found.problems if p.code.startswith("programs.force")]
    del job["belt_machine"]["force_device"]
    file.write_text(json.dumps(job))
    assert cli.main([*command, "--force"]) == 0
    assert "does not set the pressing force" in capsys.readouterr().err


def test_plans_keep_to_the_device(tmp_path):
    path = tmp_path / "p.src"
    write_program(path, None, motions(FORCES), force_device=DEVICE)
    job = jobs.validate(job_with(path, least_N=10, ramp_N_s=200, resolution_N=0.5))
    settings = rounds.validate({"force_min_N": 5, "force_max_N": 80})
    kept = limits.within_device(jobs.typed(job), settings)
    assert (kept["force_min_N"], kept["force_max_N"], kept["force_change_N_s"]) == (10, 60, 200)
    slower = {**settings, "force_change_N_s": 50.0}
    assert limits.within_device(jobs.typed(job), slower)["force_change_N_s"] == 50.0
    for wrong in ({"force_min_N": 70.0, "force_max_N": 80.0}, {"force_max_N": 8.0}):
        with pytest.raises(InputError, match="beyond the force device's"):
            limits.within_device(jobs.typed(job), rounds.validate(wrong))
    commands = Commands(job, kept)
    planned = commands.with_feeds(commands.feeds, np.full(len(commands), 0.41))
    found = [pose.get("force_N") for pose in planned["programs"][0]["poses"]]
    # 8.2 and 8.2 are below the least, 14.555 and 20.5 multiples of 0.5 N
    assert found[1:] == [10.0, 10.0, 14.5, 20.5]


@pytest.mark.freecad
def test_a_document_s_programs_are_read_and_written_with_the_device(tmp_path):
    path = tmp_path / "p.src"
    write_program(path, None, motions(FORCES), force_device=DEVICE)
    part = FreeCAD.newDocument().addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    job = beltgrinding.make_job(part, ["Face6"], Spacing=0.6)
    machine = beltgrinding.make_belt_machine(job, Force="30 N", ForceDevice="analog")
    machine.DeviceName, machine.DeviceScale, machine.DeviceGreatest = "aoForce", 0.01, "60 N"
    given = machine.Proxy.to_job(machine)["belt_machine"]["force_device"]
    assert {key: given[key] for key in DEVICE} == DEVICE
    robot = beltgrinding.import_program(job, path)
    assert robot.Forces == [-1.0, *FORCES]
    output = tmp_path / "q.mod"
    beltgrinding.export_program(robot, output)
    read = read_program(output, force_device=DEVICE).motions
    assert [m.force_N for m in read] == [None, *FORCES]
    machine.ForceDevice = "none"
    notes = beltgrinding.export_program(robot, output)
    assert "20 to 50 N" in " ".join(map(str, notes))


def test_a_device_that_the_language_has_not_is_told_before_planning(tmp_path, capsys):
    file = tmp_path / "job.json"
    file.write_text(json.dumps({**job_with("p.src", kind="controller"), "programs": []}))
    assert cli.main(["grind", str(file), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert "KUKA KRL has no 'controller'; take analog" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
