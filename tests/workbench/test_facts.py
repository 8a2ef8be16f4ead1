"""Facts: errors of the core and of Python are of one class and carry code and arguments."""

import copy
import json
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

import beltgrinding
from beltgrinding import InputError, core


def arm(**changed):
    joints = [{"a": 100.0, "alpha": 0.0, "d": 0.0, "offset": 0.0} for _ in range(6)]
    limits = {"lower": -1.0, "upper": 1.0, "max_speed": 1.0}
    return core.RobotArm("standard_dh", [{**joint, **limits, **changed} for joint in joints])


def test_python_raises_what_the_core_raises():
    assert InputError is core.InputError is beltgrinding.InputError
    assert issubclass(InputError, ValueError)
    with pytest.raises(InputError) as caught:
        arm(direction=3)
    assert type(caught.value) is InputError


def test_an_error_is_its_sentence_and_what_it_was_made_of():
    error = InputError(
        "job.range", "{file}: {key} is {value:.3g}", file="a.json", key="law", value=0.12345
    )
    assert str(error) == "a.json: law is 0.123"
    assert (error.code, error.text) == ("job.range", "{file}: {key} is {value:.3g}")
    assert error.arguments == {"file": "a.json", "key": "law", "value": 0.12345}
    assert error.culprit == {"file": "a.json", "key": "law"} and error.context == []


def test_an_error_without_a_code_is_its_text():
    error = InputError("a {brace} and 100 %")
    assert str(error) == error.text == "a {brace} and 100 %"
    assert (error.code, error.arguments, error.culprit) == ("", {}, {})
    assert str(InputError(ValueError("inner"))) == "inner"


def test_a_form_that_does_not_fit_is_told_as_it_is():
    assert str(InputError("a.b", "no {what}")) == "no {what}"
    assert str(InputError("a.b", "no {what:.3g}", what="words")) == "no {what:.3g}"


def test_a_context_comes_before():
    inner = InputError("job.feed", "no feed", line=3, file="inner")
    outer = inner.within("job.at", "{file}:{line}: ", file="outer", line=7).within(
        "job.in", "job: "
    )
    assert str(outer) == "job: outer:7: no feed" and str(inner) == "no feed"
    assert (outer.code, outer.arguments) == ("job.feed", {"line": 3, "file": "inner"})
    assert [code for code, _, _ in outer.context] == ["job.in", "job.at"]
    assert outer.culprit == {"file": "inner", "line": 3}
    assert inner.context == []


@pytest.mark.parametrize(
    "through", [copy.copy, copy.deepcopy, lambda error: pickle.loads(pickle.dumps(error))]
)
def test_errors_are_copied_whole(through):
    error = InputError("job.feed", "no feed", line=3).within("job.at", "{file}: ", file="f")
    again = through(error)
    assert type(again) is InputError and str(again) == str(error) == "f: no feed"
    assert (again.code, again.arguments, again.context, again.culprit) == (
        error.code,
        error.arguments,
        error.context,
        {"file": "f", "line": 3},
    )


def test_a_fact_is_its_sentence():
    fact = core.Fact("brep.without_area", "face {face} has no area: {area:.2g}", face=2, area=0.123)
    assert fact == "face 2 has no area: 0.12" and json.dumps([fact]) == f'["{fact}"]'
    assert fact.arguments == {"face": 2, "area": 0.123}
    again = pickle.loads(pickle.dumps(fact))
    assert (again, again.code, again.text) == (fact, fact.code, fact.text)


def test_the_core_loads_without_the_package(tmp_path):
    place = Path(core.__file__).parent
    done = subprocess.run(
        [sys.executable, "-c", "import beltgrinding_core as c; c.set_threads(-1)"],
        env={"PYTHONPATH": str(place)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert "beltgrinding_core.InputError: the number of threads" in done.stderr, done.stderr


def test_text_that_is_no_utf_8_is_told():
    with pytest.raises(InputError) as caught:
        core.Shape.read(b"/no\xff/such.step")
    assert "there is no such file" in str(caught.value)
