"""The one strict door: every number of a job has a range, and what lies outside is one line that names the key,
whichever way it comes in."""

import json
import math
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import schemas
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.planning import rounds
from beltgrinding.simulation import finish
from beltgrinding.studies.keys import Key
from support.freecad import ROOT, SHARED

POSE = {"x_mm": 5, "y_mm": 10, "z_mm": 10, "qw": 0, "qx": 1, "qy": 0, "qz": 0, "feed_mm_s": 50}
PART = ROOT / "tests" / "robustness" / "parts" / "box.brep"


def job(way=(), value=None):
    """A job that is right, with a value at a place of its own."""
    made = {
        "design": {"file": str(PART), "faces": [6]},
        "sampling": {"spacing_mm": 2.0},
        "belt_machine": {"wheel": {"radius_mm": 40, "width_mm": 10}, "force_N": 20},
        "programs": [{"poses": [dict(POSE), {**POSE, "x_mm": 35}]}],
    }
    holder = made
    for name, after in zip(way, way[1:]):
        if isinstance(holder, list):
            holder = holder[name]
        else:
            holder = holder.setdefault(name, [] if after == 0 else {})
    if way:
        holder[way[-1]] = value
    return made


def walk(rule, way=""):
    yield way, rule
    for name, inner in rule.get("properties", {}).items():
        yield from walk(inner, f"{way}.{name}")
    if isinstance(rule.get("items"), dict):
        yield from walk(rule["items"], f"{way}[]")


def rules():
    whole = jobs.schema()
    yield from walk(whole)
    for name, rule in whole["definitions"].items():
        yield from walk(rule, f"#{name}")


def test_every_number_has_a_range_and_every_text_and_list_a_length():
    without = []
    for way, rule in rules():
        kinds = rule.get("type", ())
        kinds = {kinds} if isinstance(kinds, str) else set(kinds)
        if (
            "enum" in rule or "const" in rule or way.startswith(".heat")
        ):  # whose ranges are materials'
            continue
        if kinds & {"number", "integer"}:
            ends = [rule.get("minimum", rule.get("exclusiveMinimum"))]
            ends.append(rule.get("maximum", rule.get("exclusiveMaximum")))
            if None in ends or not all(map(math.isfinite, ends)):
                without.append(way)
        if (
            "array" in kinds
            and "maxItems" not in rule
            or "string" in kinds
            and "maxLength" not in rule
        ):
            without.append(way)
    assert not without


@pytest.mark.parametrize("way, rule", [(way, rule) for way, rule in rules() if "default" in rule])
def test_defaults_pass_the_door(way, rule):
    assert not schemas.problems(
        rule["default"], {**rule, "definitions": jobs.schema()["definitions"]}, way
    )


WRONG = [
    (("programs", 0, "poses", 0, "line"), 2**70),
    (("sampling", "spacing_mm"), 5e-324),
    (("belt_machine", "wheel", "radius_mm"), 1e9),
    (("belt_machine", "force_N"), 10**400),
    (("belt_machine", "force_N"), 10**5000),
    (("belt_machine", "force_N"), -(10**400)),
    (("belt_machine", "force_N"), math.nan),
    (("belt_machine", "force_N"), math.inf),
    (("belt_machine", "force_N"), True),
    (("belt_machine", "force_N"), "20"),
    (("belt_machine", "force_N"), None),
    (("belt_machine", "force_N"), [20]),
    (("belt_machine", "force_N"), np.float64(math.nan)),
    (("belt_machine", "force_N"), np.array([1.0, 2.0])),
    (("belt_machine", "force_N"), object()),
    (("belt_machine", "force_N"), 1 + 0j),
    (("belt_machine", "contact_spacing_mm"), -0.0),
    (("design", "faces"), [1, 1]),
    (("design", "faces"), [1e12]),
    (("design", "file"), "x" * 5000),
    (("law", "pressure_exponent"), 1e308),
    (("law", "calibration", "scatter"), math.nan),
    (("inspection", "zones"), [{"name": "a" * 10_000}]),
    (("inspection", "tolerance_mm"), [0.0, math.inf]),
]


@pytest.mark.parametrize("way, value", WRONG, ids=range(len(WRONG)))
def test_what_cannot_be_is_one_line_that_names_the_key(way, value):
    with pytest.raises(InputError) as caught:
        beltgrinding.run(job(way, value))
    text = str(caught.value)
    key = ".".join(map(str, way))
    assert key in text and "\n" not in text and len(text) < 600, text


@pytest.mark.parametrize(
    "text", ["NaN", "Infinity", "-Infinity", "1e400", "1" + 400 * "0", "5e-324"]
)
def test_in_a_file_likewise(tmp_path, text):
    path = tmp_path / "job.json"
    path.write_text(json.dumps(job(("sampling", "spacing_mm"), 12345.0)).replace("12345.0", text))
    command = [sys.executable, "-m", "beltgrinding", "run", str(path), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e400", "1" + 400 * "0", "5e-324"])
def test_numbers_of_the_command_line_likewise(number):
    command = [sys.executable, "-m", "beltgrinding", "faces", str(PART), f"--unit={number}"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (
        done.returncode == 2 and f"argument --unit: invalid float value: '{number}'" in done.stderr
    )


def test_a_study_a_plan_and_a_stray_value_pass_the_same_door():
    for value in (math.nan, 1e9, 10**400, True, 5e-324):
        with pytest.raises(InputError, match="belt_machine.force_N"):
            Key("belt_machine.force_N").check(value)
        with pytest.raises(InputError, match="feed_max_mm_s"):
            rounds.validate({"feed_max_mm_s": value})


def test_numbers_of_numpy_are_taken():
    made = job(("belt_machine", "force_N"), np.float32(20.0))
    made["design"]["faces"] = np.array([6])
    made["inspection"] = {"tolerance_mm": np.array([-0.1, 0.1])}
    found = jobs.validate(made)
    assert found["belt_machine"]["force_N"] == 20.0 and found["design"]["faces"] == [6]
    assert json.dumps(found)


def test_a_structure_without_end_is_refused():
    made = job()
    made["inspection"] = {"zones": [made]}
    with pytest.raises(InputError):
        jobs.validate(made)
    with pytest.raises(InputError, match="a key is a text"):
        jobs.validate({**job(), "law": {1: 2}})


TWO = ["coefficient", "pressure_exponent"]


@pytest.mark.parametrize(
    "parameters, covariance, words",
    [
        (TWO, [[1e-14, 0.0], [0.0]], "3 numbers in 2 rows"),
        (TWO, [[1e-14, 0.0, 0.0, 0.0]], "4 numbers in 1 rows"),
        (TWO, [], "0 numbers in 0 rows"),
        ([], [[1.0]], "1 numbers in 1 rows"),
        (TWO, [[0.01, 0.005], [0.0, 0.01]], "not symmetric"),
        (TWO, [[0.01, 0.02], [0.02, 0.01]], "not positive definite"),
        (TWO, [[-0.01, 0.0], [0.0, 0.01]], "not positive definite"),
        (TWO, [[0.0, 1e-3], [1e-3, 0.01]], "not positive definite"),
        (TWO, [[1e4, 0.0], [0.0, 0.01]], "standard deviation of coefficient is 100"),
    ],
)
def test_covariances_that_are_none(parameters, covariance, words):
    calibration = {"parameters": parameters, "covariance": covariance}
    with pytest.raises(InputError, match=words) as caught:
        jobs.validate(job(("law", "calibration"), calibration))
    assert "law.calibration.covariance" in str(caught.value)


@pytest.mark.parametrize(
    "parameters, words",
    [
        (
            ["coefficient", "wear"],
            r"parameters\[1\]: a calibration knows nothing of wear; use",
        ),
        (["pressure_exponent", "pressure_exponent"], "pressure_exponent is given twice"),
    ],
)
def test_parameters_that_no_law_has(parameters, words):
    calibration = {"parameters": parameters, "covariance": [[0.01, 0.0], [0.0, 0.01]]}
    with pytest.raises(InputError, match=words):
        jobs.validate(job(("law", "calibration"), calibration))


def test_the_covariance_that_was_sent(tmp_path):
    path = SHARED / "faults" / "covariance_ragged.json"
    if not path.is_file():
        pytest.skip(f"no {path}")
    command = [sys.executable, "-m", "beltgrinding", "run", str(path), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "law.calibration.covariance" in done.stderr


def test_exponents_that_overflow_are_told():
    model = {
        "coefficient_um": 0.7,
        **{f"{name}_exponent": 10 for name in ("grit", "pressure", "belt_speed", "feed", "wear")},
        "reference_grit": 0.001,
        "reference_pressure_MPa": 1e-6,
        "reference_belt_speed_m_s": 1e-3,
        "reference_feed_mm_s": 1e-4,
        "ranges": {
            "grit": [100, 1e5],
            "pressure_MPa": [0.1, 1e4],
            "belt_speed_m_s": [1, 1e3],
            "feed_mm_s": [1, 1e5],
            "remaining_cut": [0.1, 1e6],
        },
    }
    made = jobs.validate(job(("finish",), {"grit": 120, "model": model}))
    with pytest.raises(InputError, match="finish.model"):
        finish.options(made, [])


@pytest.mark.parametrize("megabytes", [100, 150, 200, 300])
def test_a_plan_without_memory_ends_in_a_line(tmp_path, megabytes):
    (tmp_path / "job.json").write_text(json.dumps(job()))
    limit = (
        f"ulimit -v {megabytes * 1000}; exec {sys.executable} -m beltgrinding plan job.json -o out"
    )
    done = subprocess.run(
        ["bash", "-c", limit],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )
    told = done.stdout + done.stderr
    assert done.returncode in (0, 2) and "Traceback" not in told, told
    assert done.returncode == 0 or re.search("memory", told), told
