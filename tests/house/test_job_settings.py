"""The job's dataclasses say what its schema says, which stays the only home of defaults and texts."""

import ast
import dataclasses
import importlib.util
import json
import re
import typing
from pathlib import Path

import pytest

from beltgrinding.base import records
from beltgrinding.job import settings

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "Resources" / "schema" / "job.schema.json").read_text("utf-8"))


def tool():
    place = ROOT / "tools" / "job_settings.py"
    spec = importlib.util.spec_from_file_location("job_settings", place)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def tree(text):
    return ast.dump(ast.parse(text))


def test_they_are_made_from_the_schema():
    made = tool()
    same = tree(made.text()) == tree(made.SETTINGS.read_text(encoding="utf-8"))
    assert same, "the schema has changed: run tools/job_settings.py, then tools/format"


def test_what_a_job_may_leave_out_is_none_and_nothing_else_has_a_default():
    """Read from the classes themselves, not from the tool's text."""

    def look(kind, rule):
        assert [field.name for field in dataclasses.fields(kind)] == list(rule["properties"])
        hints = typing.get_type_hints(kind)
        for field in dataclasses.fields(kind):
            sub = rule["properties"][field.name]
            known = "default" in sub or field.name in rule.get("required", ())
            assert field.default is (dataclasses.MISSING if known else None), (kind, field.name)
            assert (type(None) in typing.get_args(hints[field.name])) == (not known)
            sub = sub["items"] if sub.get("type") == "array" else sub
            for one in _classes(hints[field.name]):
                look(one, SCHEMA["definitions"]["frame"] if "$ref" in sub else sub)
        with pytest.raises(dataclasses.FrozenInstanceError):
            object.__new__(kind).some = 1

    look(settings.Job, SCHEMA)


def _classes(hint):
    if dataclasses.is_dataclass(hint):
        return [hint]
    return [found for one in typing.get_args(hint) for found in _classes(one)]


def test_a_job_becomes_records_and_plain_data_again():
    from beltgrinding.job import load

    layers = [{"thickness_mm": 5, "youngs_modulus_MPa": 3.5, "poissons_ratio": 0.3}]
    job = {
        "design": {"file": "part.stp", "faces": [2]},
        "belt_machine": {
            "kind": "platen",
            "platen": {"layers": layers},
            "wheel": {"profile_mm": [[-1, 0], [1, 0.5]]},
        },
        "law": {"calibration": {"parameters": ["coefficient"], "covariance": [[0.01]]}},
        "inspection": {"zones": [{"name": "edge", "tolerance_mm": [-0.1, 0]}]},
        "cell": {"tcp_from_contact": {"position_mm": [1, 2, 3]}},
        "programs": [{"poses": [], "force_N": 3}],
    }
    plain = load.validate(job)
    made = load.typed(plain)
    assert isinstance(made, settings.Job) and load.typed(made) is made
    assert json.dumps(records.plain(made), sort_keys=True) == json.dumps(plain, sort_keys=True)
    assert made.belt_machine.platen.layers[0].youngs_modulus_MPa == 3.5
    assert made.heat is None and made.belt_machine.fork is None
    assert made.programs[0].poses is plain["programs"][0]["poses"]  # rows stay what they are
    with pytest.raises(TypeError, match="unknown"):
        load.typed({**plain, "unknown": 1})


# How often a room asks a job's dict by a string; rooms that read records do not, but where they change a job as data.
# Lower it where it has fallen.
MOST_SUBSCRIPTS = {
    "geometry": 0,
    "cell": 0,
    "raster": 0,
    "inspection": 2,
    "planning": 16,  # its search hands wheels from job to job, as data
    "simulation": 7,
    "reporting": 10,
    "job": 27,
    "studies": 30,
}


@pytest.mark.parametrize("room", MOST_SUBSCRIPTS)
def test_rooms_read_records(room):
    folder = ROOT / "Mod" / "BeltGrinding" / "beltgrinding" / room
    found = [
        f"{path.relative_to(ROOT)}: {match[0]}"
        for path in sorted(folder.rglob("*.py"))
        for match in re.finditer(r'\b(job|machine)\["\w+', path.read_text(encoding="utf-8"))
    ]
    assert len(found) <= MOST_SUBSCRIPTS[room], "\n".join(found)
