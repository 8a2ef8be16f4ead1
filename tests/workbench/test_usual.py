"""Quantities outside of what exists are told by key, value and unit, however they come; what cannot be is refused."""

import json

import pytest

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.base.resources import resources
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs, usual
from test_job import cli, plate_job


def at(job, key, value):
    *path, last = key.split(".")
    for part in path:
        job = job.setdefault(part, {})
    job[last] = value


@pytest.mark.parametrize(
    "key, value, unit, usual_range",
    [
        ("belt_machine.belt_speed_m_s", 0.3, "m/s", "0.5 to 60"),
        ("belt_machine.belt_speed_m_s", 75.0, "m/s", "0.5 to 60"),
        ("belt_machine.wheel.radius_mm", 1.5, "mm", "2 to 1000"),
        ("belt_machine.wheel.radius_mm", 1200.0, "mm", "2 to 1000"),
        ("law.coefficient_mm2_per_N", 1e-8, "mm²/N", "1e-07 to 0.002"),
        ("law.coefficient_mm2_per_N", 0.1, "mm²/N", "1e-07 to 0.002"),
        ("belt_machine.force_N", 5e4, "N", "0.5 to 1000"),
        ("belt_machine.compliance.youngs_modulus_MPa", 5e6, "MPa", "0.05 to 3000"),
        ("stock.allowance_mm", 300.0, "mm", "-1 to 30"),
        ("sampling.spacing_mm", 50.0, "mm", "0.01 to 20"),
    ],
)
def test_what_is_unusual_is_told_with_its_unit(key, value, unit, usual_range):
    job = plate_job()
    assert usual.warnings(jobs.validate(job)) == []
    at(job, key, value)
    (told,) = usual.warnings(jobs.validate(job))
    assert told.code == "job.unusual"
    assert (
        str(told) == f"{key}: {value:g} {unit} is not usual ({usual_range} {unit}); check the unit"
    )


def test_feeds_and_forces_are_told_wherever_they_come_from(tmp_path):
    job = plate_job()
    for pose in job["programs"][0]["poses"]:
        pose["feed_mm_s"] = 3000.0
    told = [str(one) for one in beltgrinding.run(job).summary["warnings"]]
    assert any("feed_mm_s: 3000 mm/s is not usual (0.1 to 2000 mm/s), and" in one for one in told)
    program = tmp_path / "pass.src"
    program.write_text(
        "DEF pass()\n$VEL.CP = 5\nLIN {X 10,Y 20,Z 0.2,A 0,B 0,C 180}\nLIN {X 50,Y 20,Z 0.2,A 0,B 0,C 180}\nEND\n"
    )
    job["programs"] = [{"file": str(program)}]
    told = [str(one) for one in beltgrinding.run(job).summary["warnings"]]
    assert any("pass.src: feed_mm_s: 5000 mm/s" in one for one in told)


def test_the_command_line_tells_it(tmp_path):
    job = plate_job()
    at(job, "belt_machine.belt_speed_m_s", 0.2)
    (tmp_path / "job.json").write_text(json.dumps(job))
    done = cli("run", "job.json", "-o", "out", cwd=tmp_path)
    assert "warning: belt_machine.belt_speed_m_s: 0.2 m/s is not usual" in done.stderr


@pytest.mark.parametrize("speed", [0.02, 20_000.0])
def test_a_speed_that_no_belt_has_is_refused(speed):
    job = plate_job()
    at(job, "belt_machine.belt_speed_m_s", speed)
    with pytest.raises(InputError, match="belt.speed"):
        beltgrinding.run(job)


def rules(rule, path=()):
    """(key, rule) of all that have a usual range."""
    if "usual" in rule:
        yield path, rule
    for key, one in rule.get("properties", {}).items():
        yield from rules(one, (*path, key))
    if isinstance(rule.get("items"), dict):
        yield from rules(rule["items"], path)


def test_every_usual_range_has_a_unit_and_holds_the_default():
    found = list(rules(schemas.schema("job")))
    assert len(found) > 40
    for path, rule in found:
        low, high = rule["usual"]
        assert low < high
        assert rule.get("minimum", low) <= low and rule.get("maximum", high) >= high, path
        default = rule.get("default", 0)
        assert default == 0 or low <= default <= high, path
        plain = path[-1].endswith(("grit", "exponent"))
        assert plain or usual.unit_of(path[-1]), path


def test_a_preset_in_another_unit_is_refused_by_its_key():
    path = resources() / "presets" / "materials.json"
    own, rules_of_presets = json.loads(path.read_text(encoding="utf-8")), schemas.schema("presets")
    assert not schemas.problems(own, rules_of_presets, "presets")
    one = next(one for one in own["materials"] if "belt_speed" in one)
    one["belt_speed"] = {**one["belt_speed"], "range": [20_000, 30_000]}  # mm/s
    told = [str(error) for _, error in schemas.problems(own, rules_of_presets, "presets")]
    assert told and "belt_speed" in told[0] and "200" in told[0]
