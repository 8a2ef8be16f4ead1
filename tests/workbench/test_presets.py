"""Presets: every number has a unit, a source, and a value or a range; the user's own are read too."""

import json
import subprocess
import sys

import pytest
from support.freecad import MOD, ROOT

from beltgrinding.engine import InputError
from beltgrinding.contact import single_contact as contact
from beltgrinding.presets import library as presets, rubber
from beltgrinding.base import schemas
from beltgrinding.job import load as jobs

FILES = sorted((ROOT / "Resources" / "presets").glob("*.json"))
# A robot has one source for all its numbers: tests/workbench/test_robot.py
WITH_NUMBERS = [path for path in FILES if path.stem != "robots"]
SOURCE = {"author": "Somebody", "title": "A book", "year": 2001}
WHEEL = {
    "id": "mine",
    "name": "My wheel",
    "diameter": {"value": 200, "unit": "mm", "source": "book", "where": "p. 3"},
    "width": {"range": [40, 60], "unit": "mm", "source": "book"},
    "rim_thickness": {"value": 12, "unit": "mm", "source": "book"},
    "poissons_ratio": {"value": 0.49, "unit": "1", "source": "book"},
    "shore_a": {"value": 60, "unit": "Shore A", "source": "book"},
}


@pytest.fixture
def user(tmp_path, monkeypatch):
    """The user's folder; a function that writes a file into it."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.delitem(sys.modules, "FreeCAD", raising=False)
    folder = tmp_path / "beltgrinding" / "presets"
    folder.mkdir(parents=True)

    def write(name, **content):
        data = {"schema": 1, "sources": {"book": SOURCE}, **content}
        (folder / name).write_text(json.dumps(data), encoding="utf-8")

    return write


def every_number(value):
    """All JSON objects below ``value`` that hold a number directly, sources apart."""
    if isinstance(value, dict):
        if any(isinstance(v, (int, float, list)) and k != "schema" for k, v in value.items()):
            if not any(
                isinstance(v, list) and v and isinstance(v[0], dict) for v in value.values()
            ):
                yield value
                return
        for key, one in value.items():
            if key != "sources":
                yield from every_number(one)
    elif isinstance(value, list):
        for one in value:
            yield from every_number(one)


@pytest.mark.parametrize("path", WITH_NUMBERS, ids=lambda path: path.stem)
def test_every_number_has_a_unit_a_source_and_a_value_or_range(path):
    data = json.loads(path.read_text(encoding="utf-8"))
    assert schemas.problems(data, schemas.schema("presets"), "the file") == []
    found = list(every_number(data))
    assert len(found) >= 4
    for number in found:
        assert number["unit"] and number["source"] in data["sources"], number
        assert ("value" in number) != ("range" in number), number
        assert sorted(number.get("range", [])) == number.get("range", []), number
    used = {number["source"] for number in found}
    used |= {one["source"] for one in data.get("formulas", [])}
    assert used == set(data["sources"])  # no source that nothing stands on


def test_the_files_are_read_without_complaint(user):
    assert presets.problems() == []
    assert len(presets.wheels()) > 5 and len(presets.belts()) > 5
    names = {preset["id"] for preset in presets.materials()}
    assert {"steel", "stainless", "titanium", "nickel_alloy", "brass", "aluminium"} <= names
    assert rubber.formulas().keys() == rubber.EQUATIONS.keys()


def test_a_force_control_sets_what_it_knows_and_nothing_of_the_one_before(user):
    ids = {preset["id"] for preset in presets.actuators()}
    assert {"pneumatic_flange", "electric_flange", "robot_admittance"} <= ids
    job = presets.apply({}, actuator="pneumatic_flange")
    first = job["belt_machine"]["force_dynamics"]
    assert first["model"] == "actuator" and first["lag_s"] == pytest.approx(0.065)
    second = presets.apply(job, actuator="robot_admittance")["belt_machine"]["force_dynamics"]
    assert second["lag_s"] == 0.0 and second["moving_mass_kg"] == 5.0
    assert second["damping_N_s_per_mm"] == 5.0 and second["speed_limit_mm_s"] == 60.0


def test_shore_a_by_all_formulas():
    found = presets.shore_to_modulus(60)
    assert next(iter(found)) == "gent"
    for name, expected in (("gent", 3.61), ("bs903", 3.49), ("qi", 5.88), ("mix_giacomin", 4.79)):
        modulus, source = found[name]
        assert modulus == pytest.approx(expected, abs=0.01) and len(source) > 20
    assert rubber.spread_text(60) == "60 Shore A: 3.6 MPa (3.5 to 5.9 by the formula)"
    assert "qi" not in presets.shore_to_modulus(85)


@pytest.mark.parametrize("shore_a", [0, 19.9, 90.1, 100])
def test_hardness_beyond_the_formulas_is_refused(shore_a):
    with pytest.raises(InputError, match="from 20 to 90 Shore A"):
        presets.shore_to_modulus(shore_a)
    if 0 < shore_a < 100:
        with pytest.raises(InputError, match="from 20 to 90 Shore A"):
            contact.validate(
                {"wheel": {"shore_a": shore_a}, "workpiece": {"shape": "plane"}, "force_N": 9}
            )


def test_apply_puts_into_a_job_what_the_presets_say(user):
    user("mine.json", wheels=[WHEEL])
    job = {"design": {"file": "part.step"}, "programs": [{"file": "path.csv"}]}
    done = presets.apply(job, wheel="mine", belt="p80", material="titanium")
    assert "belt_machine" not in job
    machine = done["belt_machine"]
    assert machine["wheel"] == {"radius_mm": 100.0, "width_mm": 50.0}
    assert machine["belt_speed_m_s"] == pytest.approx(11.5)
    rim = machine["compliance"]
    assert rim["youngs_modulus_MPa"] == pytest.approx(3.605, abs=0.001)
    assert rim["poissons_ratio"] == 0.49 and rim["rim_thickness_mm"] == 12
    jobs.validate(done)


def test_a_modulus_of_its_own_counts_more_than_the_hardness(user):
    own = {"value": 7, "unit": "MPa", "source": "book"}
    user("mine.json", wheels=[{**WHEEL, "youngs_modulus": own}])
    assert presets.settings(wheel="mine")["belt_machine.compliance.youngs_modulus_MPa"] == 7


def test_only_keys_that_jobs_have_are_set(user):
    keys = presets.settings(wheel="serrated_1_1_80")
    known = schemas.schema("job")["properties"]["law"]["properties"]
    assert ("law.land_share" in keys) == ("land_share" in known)


def test_an_unknown_preset_is_named(user):
    with pytest.raises(InputError, match="did you mean 'titanium'"):
        presets.apply({}, material="titan")


def changed(**change):
    return {**WHEEL, **change}


@pytest.mark.parametrize(
    "record, key",
    [
        (changed(width={"value": 5, "unit": "mm"}), "wheels.1.width: the key 'source' is missing"),
        (changed(width={"value": 5, "unit": "in", "source": "book"}), "wheels.1.width.unit"),
        (changed(width={"value": 5, "unit": "mm", "source": "rumour"}), "wheels.1.width.source"),
        (changed(width={"unit": "mm", "source": "book"}), "wheels.1.width: give exactly one of"),
        (changed(width={"range": [9, 5], "unit": "mm", "source": "book"}), "wheels.1.width.range"),
        (changed(width=5), "wheels.1.width"),
        (changed(diametre=WHEEL["diameter"]), "did you mean 'diameter'"),
        (
            changed(shore_a={"value": 95, "unit": "Shore A", "source": "book"}),
            "wheels.1.shore_a: 95",
        ),
        (changed(id="plain_80"), "wheels.1.id: there is a preset 'plain_80'"),
    ],
)
def test_a_wrong_preset_is_named_and_hides_no_good_one(user, record, key):
    user("mine.json", wheels=[{**WHEEL, "id": "good"}, {"id": "other", **record}])
    (problem,) = presets.problems()
    assert "mine.json" in str(problem) and key in str(problem)
    names = [preset["id"] for preset in presets.wheels()]
    assert "good" in names and "mine" not in names and "plain_80" in names


def test_a_file_that_is_none_hides_no_other(user, tmp_path):
    user("good.json", wheels=[WHEEL])
    (tmp_path / "beltgrinding" / "presets" / "bad.json").write_text("{")
    user("formulas.json", formulas=[])
    first, second = (str(problem) for problem in presets.problems())
    assert "bad.json: line 1" in first and "formulas.json: formulas" in second
    assert presets.find("wheels", "mine")["name"] == "My wheel"


def run(tmp_path, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "beltgrinding", "presets", *arguments],
        cwd=MOD,
        env={"PATH": "/usr/bin:/bin", "XDG_CONFIG_HOME": str(tmp_path), "LANG": "C.UTF-8"},
        capture_output=True,
        text=True,
        encoding="utf-8",
    )


def test_the_command_line_lists_them_with_sources(user, tmp_path):
    listed = run(tmp_path)
    assert listed.returncode == 0, listed.stderr
    for text in (
        "WHEELS",
        "BELTS",
        "MATERIALS",
        "ROBOTS",
        "8 to 15 m/s",
        "Saint-Gobain",
        "FEPA",
        "201 µm",
    ):
        assert text in listed.stdout, text
    only = json.loads(run(tmp_path, "materials", "--json").stdout)
    assert list(only) == ["materials"]
    assert only["materials"][0]["belt_speed"]["source"]["author"] == "Saint-Gobain Abrasives"
    user("bad.json", wheels=[changed(width=5)])
    wrong = run(tmp_path, "wheels")
    assert wrong.returncode == 2 and "bad.json: wheels.0.width" in wrong.stderr
    assert "plain_80" in wrong.stdout


def test_the_documentation_has_the_spread_that_the_formulas_give():
    page = (ROOT / "docs" / "presets.md").read_text(encoding="utf-8")
    for shore_a in range(20, 91, 10):
        found = presets.shore_to_modulus(shore_a)
        cells = [f"{found[name][0]:.2g}" if name in found else "" for name in rubber.formulas()]
        assert f"| {shore_a} | " + " | ".join(cells).rstrip() in page, (shore_a, cells)
    page = " ".join(page.split())
    for path in FILES:
        for source in json.loads(path.read_text(encoding="utf-8"))["sources"].values():
            assert source["title"].split(",")[0] in page, source


def test_a_platens_preset_makes_it_flat():
    found = presets.settings(machine="platen_50")
    assert found["belt_machine.kind"] == "platen" and found["belt_machine.platen.radius_mm"] == 0.0
    free = next(one["id"] for one in presets.machines() if one["kind"] == "free_belt")
    assert not any(key.startswith("belt_machine.platen") for key in presets.settings(machine=free))
