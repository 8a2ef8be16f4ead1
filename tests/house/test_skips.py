"""A skip that is not on the list fails, in pytest and in ctest's report."""

import os
import subprocess
import sys

import pytest

from support import skips
from support.freecad import ROOT

NEW = skips.Allowed("tests/a.py::test_*", "no \\w+ here", "why")
ABSENT = skips.Allowed("*", "shared data", "why", without="data")

SUITE = """
import pytest

def test_passes():
    pass

def test_skips():
    pytest.skip("no such thing here")

@pytest.mark.skipif(True, reason="no other thing")
def test_marked():
    raise AssertionError

@pytest.mark.xfail(reason="known")
def test_known():
    raise AssertionError
"""
WHOLE = 'import pytest\npytest.skip("the file is not wanted", allow_module_level=True)\n'

CTEST = """<testsuite>
<testcase name="core.Runs" status="run"><system-out>fine</system-out></testcase>
<testcase name="core.Skips" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
<system-out>plate_test.cpp:9: Skipped
no %s here
[  SKIPPED ] Core.Skips</system-out></testcase>
</testsuite>
"""


@pytest.mark.parametrize(
    "value, expected", [("true", True), ("1", True), ("", False), ("0", False), ("false", False)]
)
def test_when_it_is_strict(value, expected):
    assert skips.strict({"CI": value}) is expected
    assert skips.strict({"BELTGRINDING_STRICT": value}) is expected
    assert skips.strict({}) is False


def test_the_list_is_sound():
    entries = skips.allowed()
    assert entries and all(len(entry.why) > 20 for entry in entries)
    for entry in entries:
        path = entry.test.partition("::")[0]
        assert path == "*" or (ROOT / path).is_file(), f"{path} is gone; its entry may go"


def test_what_is_on_the_list_may_skip(tmp_path):
    assert skips.unexpected("tests/a.py::test_one", "no wheel here", [NEW]) == ""
    assert "no belt" in skips.unexpected("tests/a.py::test_one", "no belt", [NEW])
    assert "test_one" in skips.unexpected("tests/b.py::test_one", "no wheel here", [NEW])
    assert skips.unexpected("b", "no shared data at /x", [ABSENT], tmp_path) == ""
    (tmp_path / "data").mkdir()
    assert skips.unexpected("b", "no shared data at /x", [ABSENT], tmp_path)


@pytest.mark.parametrize("strict", ["1", ""])
def test_pytest_fails_where_it_is_strict(tmp_path, strict):
    """The suite's own conftest on a small suite in a folder of its own."""
    (tmp_path / "test_small.py").write_text(SUITE)
    (tmp_path / "test_whole.py").write_text(WHOLE)
    (tmp_path / "conftest.py").write_text(
        "import importlib.util\n"
        f"path = {str(ROOT / 'tests' / 'conftest.py')!r}\n"
        "spec = importlib.util.spec_from_file_location('shared', path)\n"
        "shared = importlib.util.module_from_spec(spec)\nspec.loader.exec_module(shared)\n"
        "pytest_runtest_makereport = shared.pytest_runtest_makereport\n"
        "pytest_make_collect_report = shared.pytest_make_collect_report\n"
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)]
    environment = {**os.environ, "BELTGRINDING_STRICT": strict, "CI": ""}
    environment["PYTHONPATH"] = os.pathsep.join([str(ROOT / "tests"), *sys.path])
    command += ["--continue-on-collection-errors", "--rootdir", str(tmp_path)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=tmp_path)
    last = done.stdout.splitlines()[-1]
    if strict:
        assert done.returncode == 1 and "1 failed, 1 passed, 1 xfailed, 2 errors" in last, last
        for reason in ("no such thing here", "no other thing", "the file is not wanted"):
            assert reason in done.stdout
    else:
        assert done.returncode == 0 and "1 passed, 3 skipped, 1 xfailed" in last, last


def test_a_skip_in_ctests_report(tmp_path):
    report = tmp_path / "core.xml"
    report.write_text(CTEST % "wheel")
    entry = skips.Allowed("core.*", "no wheel here", "why")
    assert skips.in_report(report, [entry]) == []
    (sentence,) = skips.in_report(report, [NEW])
    assert sentence.startswith("core.Skips skipped") and "no wheel here" in sentence
    tool = [sys.executable, str(ROOT / "tests" / "support" / "skips.py"), str(report)]

    def run(strict):
        environment = {**os.environ, "BELTGRINDING_STRICT": strict, "CI": ""}
        return subprocess.run(tool, env=environment, capture_output=True, text=True)

    assert (run("1").returncode, run("1").stdout) == (1, sentence + "\n")
    assert run("").returncode == 0
    report.write_text('<testsuite><testcase name="a" status="run"/></testsuite>')
    assert run("1").returncode == 0
