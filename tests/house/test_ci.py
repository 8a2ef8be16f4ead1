""".ci/run adds up the figures of all that it runs, and says at its end what was not tested."""

import os
import subprocess

import pytest

from support.freecad import ROOT

CASE = '<testcase name="{}">{}</testcase>'


@pytest.fixture
def ci(tmp_path):
    """Runs a copy of .ci/run whose tools are scripts given here; (status, lines)."""
    checkout, compat = tmp_path / "checkout", tmp_path / "compat"
    report = compat / "trixie" / "work" / "checkout" / "build" / "reports" / "compat.xml"
    report.parent.mkdir(parents=True)

    def write(path, text):
        path = checkout / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/usr/bin/env bash\n" + text + "\n")
        path.chmod(0o755)

    def run(test="echo 10 passed, 0 failed, 2 skipped", other="true", tidy="true", **variables):
        cases = CASE.format("a", "") + CASE.format("b", "<skipped/>")
        write("tools/test", test)
        write("tools/tidy", tidy)
        write("tests/compat/run", f"echo '<t>{cases}</t>' >{report}\n{other}")
        environment = {
            **os.environ,
            "PATH": f"{checkout / 'bin'}:{os.environ['PATH']}",
            "BELTGRINDING_COMPAT": str(compat),
            "CI_SHARE": "3/5",
            **variables,
        }
        done = subprocess.run(
            [checkout / ".ci" / "run"], env=environment, capture_output=True, text=True, timeout=60
        )
        return done.returncode, done.stdout.splitlines()

    if os.geteuid() != 0:
        pytest.skip("a chroot needs root")
    for path in (".ci/run", "tools/setup.sh", "tests/support/count.py"):
        write(path, "")
        (checkout / path).write_text((ROOT / path).read_text("utf-8"))
    write("bin/dpkg-query", 'echo "debootstrap installed"')
    return run


def test_figures_add_up(ci):
    status, lines = ci()
    assert status == 0
    assert lines[-1] == "12 passed, 0 failed, 3 skipped"  # one more of FreeCAD 1.0, one of tidy


def test_a_share_of_what_takes_long_is_passed_as_the_commit_says(ci):
    told = 'echo "asked $*"; echo 1 passed, 0 failed, 0 skipped'
    status, lines = ci(test=told)
    assert status == 0 and "asked --share 3/5" in lines
    assert "3/5 was passed" in lines[-2]
    _, lines = ci(test=told, CI_SHARE="")  # no commit: a folder without git
    assert "asked --share 1/5" in lines


def test_strictness_reaches_the_tests(ci):
    status, lines = ci(
        test='echo "strict $BELTGRINDING_STRICT"; echo 1 passed, 0 failed, 0 skipped'
    )
    assert status == 0 and "strict 1" in lines


def test_failures_of_the_suite_fail(ci):
    status, lines = ci(test="echo 10 passed, 3 failed, 2 skipped; exit 1")
    assert status == 1 and lines[-1] == "12 passed, 3 failed, 3 skipped"


@pytest.mark.parametrize("test", ["exit 1", "echo it died; exit 3", "sleep 30"])
def test_a_suite_without_its_last_line_is_a_failure(ci, test):
    status, lines = ci(test=test, CI_HARD="2")
    assert status == 1 and lines[-1] == "2 passed, 1 failed, 1 skipped"
    assert "without its last line" in lines[-3]


def test_a_suite_that_fails_after_its_last_line_is_a_failure(ci):
    status, lines = ci(test="echo 10 passed, 0 failed, 2 skipped; exit 7")
    assert status == 1 and lines[-1] == "12 passed, 1 failed, 3 skipped"
    assert lines[-3] == "tools/test --share 3/5 ended with status 7."


def test_a_freecad_whose_tests_fail_is_a_failure(ci):
    cases = CASE.format("a", "<failure/>") + CASE.format("b", "")
    write = "echo '<t>%s</t>' >$BELTGRINDING_COMPAT/trixie/work/checkout/build/reports/compat.xml"
    status, lines = ci(other=write % cases + "; exit 1")
    assert status == 1 and lines[-2:] == [
        "FreeCAD 1.0: tests fail.",
        "12 passed, 1 failed, 2 skipped",
    ]


def test_a_freecad_that_cannot_be_set_up_is_a_failure(ci):
    gone = "rm $BELTGRINDING_COMPAT/trixie/work/checkout/build/reports/compat.xml"
    status, lines = ci(other=f"{gone}; exit 1")
    assert status == 1 and lines[-1] == "11 passed, 1 failed, 2 skipped"
    assert lines[-2] == "FreeCAD 1.0: it could not be set up or tested (status 1)."


def test_a_freecad_that_takes_too_long_is_said_last(ci):
    gone = "rm $BELTGRINDING_COMPAT/trixie/work/checkout/build/reports/compat.xml"
    limits = {"CI_LIMIT": "12", "CI_LEAST": "1", "CI_TIDY": "8"}
    status, lines = ci(other=f"{gone}; sleep 30", **limits)
    assert status == 0 and lines[-1] == "11 passed, 0 failed, 2 skipped"
    assert lines[-2].startswith("FreeCAD 1.0: NOT tested to the end")
    status, lines = ci(CI_LIMIT="500", CI_LEAST="400")
    assert status == 0 and lines[-1] == "11 passed, 0 failed, 2 skipped"
    assert lines[-2].startswith("FreeCAD 1.0: NOT tested;") and "too few" in lines[-2]


def test_clang_tidy(ci):
    status, lines = ci(tidy="exit 1")
    assert status == 1 and lines[-2:] == [
        "clang-tidy: see above.",
        "11 passed, 1 failed, 3 skipped",
    ]
    status, lines = ci(tidy="sleep 30", CI_TIDY="2")
    assert status == 0 and lines[-1] == "11 passed, 0 failed, 3 skipped"
    assert lines[-2].startswith("clang-tidy: NOT to the end")
