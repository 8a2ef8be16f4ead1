"""What went wrong on a run's way, in a line for each kind: on the terminal, errors first, with the worst place."""

import json

import pytest

import beltgrinding
from beltgrinding.base.messages import sentence
from beltgrinding.cell import event_lines
from beltgrinding.job import load as jobs
from test_job import DOWN, cli, plate_job


def event(kind, **more):
    severity = {"collision": "error", "gouge": "error", "loss_of_contact": "warning"}[kind]
    code = more.pop("code", f"event.{kind}")
    fact = {"code": code, "text": more["message"], "arguments": {}}
    return {"kind": kind, "severity": severity, "facts": [fact], **more}


JOB = {"programs": [{"file": "/far/pass.src"}, {"name": "second"}]}


def test_errors_come_first_each_kind_once_with_its_worst_place():
    found = [
        event("loss_of_contact", value=2.0, message="off", line=4),
        event("gouge", value=-0.1, message="little", line=5),
        event("gouge", value=-0.4, message="most", line=7),
        event("collision", value=-3.0, message="clamp", program=1, pose=2),
        event("collision", value=0.0, message="through", line=9, code="event.collision_rapid"),
    ]
    lines = event_lines.lines(found, JOB)
    assert [severity for severity, _ in lines] == ["error"] * 3 + ["warning"]
    assert [str(fact) for _, fact in lines] == [
        "gouge, 2 times, the worst: pass.src, line 7: most",
        "collision: pass.src, line 9: through",
        "collision: second, pose 3: clamp",
        "loss_of_contact: pass.src, line 4: off",
    ]
    assert event_lines.lines([], JOB) == []


def through_the_part():
    """A job whose rapid motion goes through the part."""
    job = plate_job()
    pose = {"z_mm": -30.0, **DOWN, "y_mm": 20}
    job["programs"][0]["poses"] += [
        {**pose, "x_mm": 50, "rapid": True, "line": 12},
        {**pose, "x_mm": 10, "rapid": True, "line": 13},
    ]
    return job


@pytest.mark.slow
def test_a_rapid_through_the_part_is_told_by_run_and_plan(tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(through_the_part()))
    done = cli("run", "job.json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0
    (line,) = [one for one in done.stderr.splitlines() if "rapid motion" in one]
    assert line.startswith("error: collision") and "line 12: " in line and "wheel" in line
    done = cli("run", "job.json", "-o", "out", "-q", cwd=tmp_path)
    assert "collision" not in done.stderr
    done = cli("--language", "de", "run", "job.json", "-o", "out", cwd=tmp_path)
    assert "Fehler: collision" in done.stderr and "Zeile 12" in done.stderr
    done = cli("plan", "job.json", "-o", "plan", "--set", "rounds=1", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert any(one.startswith("error: collision") for one in done.stderr.splitlines())


def test_gouges_are_told_with_their_depth():
    job = plate_job()
    job["belt_machine"]["force_N"] = 900
    job["inspection"] = {"tolerance_mm": [-0.01, 0.05]}
    result = beltgrinding.run(job)
    lines = event_lines.lines(result.events, jobs.validate(job))
    (told,) = [fact for severity, fact in lines if str(fact).startswith("gouge")]
    assert "mm" in str(told) and "pose 2" in str(told)
    assert "Pose 2" in sentence(told, "de")


def test_a_result_of_another_version_is_told_too():
    old = {"kind": "new_kind", "message": "something", "value": 1.0}
    ((severity, fact),) = event_lines.lines([old], JOB)
    assert severity == "warning" and str(fact) == "new_kind: pass.src, pose 1: something"
    with pytest.raises(KeyError):
        event_lines.lines([{"message": "no kind"}], JOB)
