"""PASS or FAIL: the line that says whether a ground part is as wanted, and the exit status by it."""

import copy
import json

import pytest

from beltgrinding import cli
from beltgrinding.base.messages import sentence
from beltgrinding.inspection.outcome import outcome
from test_job import plate

REGION = {
    "worst": {"value_mm": 0.0612, "point_mm": [1.0, 2.04, -3.0]},
    "above_share": 0.0,
    "below_share": 0.0,
    "missed_rays": 0,
    "thickness": None,
}
GOOD = {
    "overall": "pass",
    "resolution": "full",
    "in_share": 1.0,
    **REGION,
    "zones": [{**REGION, "verdict": "pass"}],
}


def verdict(**changes):
    return {**copy.deepcopy(GOOD), **changes}


def some(kind, count=1, severity="error"):
    return [{"kind": kind, "severity": severity}] * count


def test_the_line_of_a_good_part():
    found = outcome(GOOD, [])
    assert found.passed
    assert str(found.told) == (
        "PASS: 100.0 % in tolerance (all wanted), worst +0.061 mm at 1.0 2.0 -3.0; 0 gouges, 0 collisions"
    )


def test_errors_fail_what_the_verdict_passes_and_warnings_do_not():
    assert outcome(GOOD, some("edge_contact", 3, "warning")).passed
    found = outcome(GOOD, some("gouge") + some("collision", 2) + some("burn_risk", 4))
    assert not found.passed
    assert str(found.told).endswith("; 1 gouge, 2 collisions, 4 times burn_risk")
    # Of an older result, whose events have no severity: that of their kind.
    assert not outcome(GOOD, [{"kind": "collision"}]).passed


def test_a_share_may_be_wanted_in_place_of_all():
    most = verdict(overall="fail", in_share=0.973, above_share=0.027)
    assert not outcome(most, []).passed
    found = outcome(most, [], 0.95)
    assert found.passed and "97.3 % in tolerance (at least 95 wanted)" in str(found.told)
    assert not outcome(most, [], 0.98).passed
    assert outcome(most, [], 0.973).passed


def test_a_share_is_never_rounded_to_all():
    nearly = verdict(overall="fail", in_share=0.99996, above_share=0.00004)
    assert str(outcome(nearly, []).told).startswith("FAIL: 99.9 % in tolerance (all wanted)")


@pytest.mark.parametrize(
    "changes, words",
    [
        ({"resolution": "coarse"}, "coarse resolution, no verdict"),
        ({"missed_rays": 3, "overall": "unknown"}, "not everything could be inspected"),
        ({"worst": None, "zones": [{**REGION, "worst": None}], "overall": "unknown"}, "inspected"),
        (
            {"zones": [{**REGION, "thickness": {"verdict": "fail"}}], "overall": "fail"},
            "the thickness not in tolerance",
        ),
        (
            {"zones": [{**REGION, "finish": {"Ra": {"verdict": "fail"}}}], "overall": "fail"},
            "the finish not as called for",
        ),
    ],
)
def test_what_a_share_does_not_tell_fails_and_is_told(changes, words):
    for wanted in (1.0, 0.5):
        found = outcome(verdict(**changes), [], wanted)
        assert not found.passed and words in str(found.told)


def test_it_is_told_in_german():
    told = sentence(outcome(GOOD, some("gouge", 2)).told, "de")
    assert told.startswith("NICHT BESTANDEN: 100,0 % in der Toleranz (alles verlangt)")
    assert "2 zu tiefe Stellen, 0 Kollisionen" in told


POSES = [
    {"x_mm": x, "y_mm": y, "z_mm": z, "qw": 0, "qx": 1, "qy": 0, "qz": 0, "rapid": rapid}
    for x, y, z, rapid in ((0, 10, 10, True), (0, 10, 0, False), (60, 10, 0, False))
]


@pytest.fixture
def job(tmp_path):
    """One pass on a plate whose tolerance is as wide as its stock: nothing is out of it."""
    job = {
        "design": {"brep": plate().write_brep()},
        "sampling": {"spacing_mm": 2.0},
        "stock": {"allowance_mm": 0.1},
        "belt_machine": {"wheel": {"radius_mm": 30, "width_mm": 15}, "force_N": 10},
        "inspection": {"tolerance_mm": [-1.0, 1.0]},
        "cell": {"check_collisions": False},
        "programs": [{"poses": POSES}],
    }
    return job


def run(folder, job, *options):
    (folder / "job.json").write_text(json.dumps(job))
    out = folder / "out"
    return cli.main(["run", str(folder / "job.json"), "-o", str(out), *options])


def test_run_ends_with_the_line_and_status_1_where_it_is_checked(job, tmp_path, capsys):
    assert run(tmp_path, job, "--check") == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("PASS: 100.0 % in tolerance")
    tight = {**job, "inspection": {"tolerance_mm": [-0.01, 0.01]}}
    assert run(tmp_path, tight) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("FAIL: ")
    assert run(tmp_path, tight, "--check") == 1
    capsys.readouterr()
    assert run(tmp_path, tight, "--check", "-q") == 1
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err == ""
    assert run(tmp_path, tight, "--wanted", "101") == 2
    assert "--wanted 101: give a share" in capsys.readouterr().err


def test_the_outcome_as_json_for_programs(job, tmp_path, capsys):
    tight = {**job, "inspection": {"tolerance_mm": [-0.01, 0.01]}}
    assert run(tmp_path, tight, "--check", "--json") == 1
    printed = capsys.readouterr()
    told = json.loads(printed.out)
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert printed.err == "" and not told["pass"] and told["message"].startswith("FAIL: ")
    assert told["in_tolerance"] == pytest.approx(summary["in_tolerance_area_share"])
    assert told["in_tolerance"] + told["above"] + told["below"] == pytest.approx(1.0)
    assert told["process_time_s"] == summary["process_time_s"]
    assert told["errors"]["gouge"] == 0 and len(told["worst"]["point_mm"]) == 3
