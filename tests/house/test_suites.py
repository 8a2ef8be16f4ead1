"""tools/test --all passes all suites, two at a time, and adds up their figures; ctest and pytest are played."""

import ast
import os
import re
import signal
import subprocess
import sys
import time

import pytest

from support.freecad import ROOT

SETUP = f"""root=$(cd "$(dirname "${{BASH_SOURCE[0]}}")/.." && pwd)
build=$root/build/release
python=$root/bin/python
packages_build=() packages_run=() packages_test=() BELTGRINDING_SHARED=$root
say() {{ printf '%s\\n' "$*" >&2; }}
install_missing() {{ :; }}
build_all() {{ :; }}
"""
# The report's path follows its option; a file PLAYED/SUITE is what the suite does in place of passing one test.
PLAY = f"""#!/usr/bin/env bash
case $1 in
*.py) exec {sys.executable} "$@" ;;
esac
echo "$@" >>"$PLAYED/asked"
while (($# > 1)); do
    case $1 in
    --junitxml | --output-junit) report=$2 ;;
    esac
    shift
done
name=$(basename "$report" .xml)
echo "begin $name" >>"$PLAYED/order"
echo "said by $name"
echo '<t><testcase name="a"/></t>' >"$report"
status=0
[ ! -e "$PLAYED/$name" ] || source "$PLAYED/$name" || status=$?
echo "end $name" >>"$PLAYED/order"
exit "$status"
"""


@pytest.fixture
def checkout(tmp_path):
    """Starts a copy of tools/test whose suites are given here, {name: bash}."""
    checkout = tmp_path / "checkout"
    for path in ("tools/test", "tests/support/count.py", "tests/support/skips.py"):
        (checkout / path).parent.mkdir(parents=True, exist_ok=True)
        (checkout / path).write_text((ROOT / path).read_text("utf-8"))
    (checkout / "tests" / "allowed_skips.toml").write_text("skip = []\n")
    (checkout / "tools" / "setup.sh").write_text(SETUP)
    (checkout / "bin").mkdir()
    for name in ("python", "ctest"):
        (checkout / "bin" / name).write_text(PLAY)
        (checkout / "bin" / name).chmod(0o755)
    for folder in ROOT.glob("tests/*/"):
        if any(folder.glob("test_*.py")):
            (checkout / "tests" / folder.name).mkdir(exist_ok=True)

    def start(*options, **suites):
        for name, text in suites.items():
            (tmp_path / name).write_text(text)
        path = f"{checkout / 'bin'}:{os.environ['PATH']}"
        return subprocess.Popen(
            ["bash", checkout / "tools" / "test", *options],
            env={**os.environ, "PATH": path, "PLAYED": str(tmp_path)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(*options, **suites):
        """(status, lines of stdout, what was said besides)."""
        process = start(*options or ["--all"], **suites)
        told, besides = process.communicate(timeout=60)
        return process.returncode, told.splitlines(), besides

    run.start, run.folder = start, tmp_path
    return run


def suites_of():
    """The suites that there are: folders of tests for pytest, and the C++ tests."""
    return {path.parent.name for path in ROOT.glob("tests/*/test_*.py")} | {"core"}


def test_every_suite_is_passed_two_at_a_time(checkout):
    status, lines, _ = checkout(gui="sleep 1", workbench="sleep 1")
    assert status == 0
    assert lines[-1] == f"{len(suites_of())} passed, 0 failed, 0 skipped"
    order = (checkout.folder / "order").read_text().splitlines()
    assert {line.removeprefix("end ") for line in order if line.startswith("end")} == suites_of()
    assert set(order[:2]) == {"begin gui", "begin workbench"}
    for name in suites_of():
        at = next(k for k, line in enumerate(lines) if line.startswith(f"== {name}: "))
        assert re.search(r": \d+ s, of processors \d+ s", lines[at])
        assert f"said by {name}" in lines[at + 1 : at + 3]


def test_what_takes_long_is_left_to_all(checkout):
    process = checkout.start()
    told, besides = process.communicate(timeout=60)
    passed = {line.split()[1] for line in (checkout.folder / "order").read_text().splitlines()}
    assert passed < suites_of() and {"gui", "workbench", "core"} <= passed
    assert told.splitlines()[-1] == f"{len(passed)} passed, 0 failed, 0 skipped"
    for name in suites_of() - passed:
        assert re.search(rf"Not run, .*\b{name}\b.*tools/test --all", besides)


# What leaves tests of a suite out, or takes some alone.
CHOOSES = re.compile(
    r"(?:^| )(-[km] .*?|--(?:deselect|ignore|last-failed|lf|maxfail)\S*|-x)(?= -|$)"
)


@pytest.mark.parametrize("options, left_out", [([], "-m not slow"), (["--all"], None)])
def test_what_is_marked_slow_is_left_to_all_and_nothing_else(checkout, options, left_out):
    """Nothing is left out by another way: not here, nor by the settings of pytest."""
    process = checkout.start(
        *options, gui="echo '7 tests left out'", house="echo '5 tests left out'"
    )
    _, besides = process.communicate(timeout=60)
    lines = (checkout.folder / "asked").read_text().splitlines()
    begin = "-m pytest "
    asked = [line.removeprefix(begin) for line in lines if line.startswith(begin)]
    assert len(asked) >= 4
    for line in asked:
        assert CHOOSES.findall(line) == ([left_out] if left_out else []), line
        assert re.search(r" tests/\w+$", line), line
    assert ("and 12 tests marked slow" in besides) == (not options)
    settings = (ROOT / "pyproject.toml").read_text("utf-8").partition("[tool.pytest")[2]
    assert "addopts" not in settings.partition("\n[")[0]


def collected(*folders, share=""):
    """Ids of the tests that pytest would pass."""
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "--collect-only",
            "-q",
            "-p",
            "no:cacheprovider",
            *folders,
        ],
        env={**os.environ, "BELTGRINDING_SHARE": share},
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return [line for line in done.stdout.splitlines() if "::" in line]


def test_the_shares_together_are_all_and_each_holds_what_is_quick():
    quick, some = "tests/programs/test_apt.py", "tests/validation/test_noses.py"
    shares = [f"{k}/5" for k in (1, 2, 3, 4, 5)]
    for suite in ("tests/library", some):
        whole = collected(suite)
        parts = [collected(suite, share=share) for share in shares]
        assert sorted(sum(parts, [])) == sorted(whole)
        assert all(parts) or suite == some  # a suite without a test has failed
    assert all(collected(quick, share=share) == collected(quick) for share in shares)


@pytest.mark.parametrize("share", ["1/5", "5/5"])
def test_a_share_is_passed_by_all_suites(checkout, share):
    status, lines, besides = checkout("--share", share, gui="echo '7 tests left out'")
    assert status == 0 and lines[-1] == f"{len(suites_of())} passed, 0 failed, 0 skipped"
    assert f"{share} was passed, not the other 7 tests" in besides


@pytest.mark.parametrize("share", ["0/5", "6/5", "5", ""])
def test_no_share_is_taken_for_another(checkout, share):
    status, _, besides = checkout("--share", share)
    assert status == 2 and "usage: tools/test" in besides


# Files all of whose tests are slow: the file whose quick tests are of the same kind.
WHOLLY_SLOW = {
    "gui/test_german_figures.py": "gui/test_translations.py",
    "gui/test_language.py": "gui/test_translations.py",
    "gui/test_panel_width.py": "gui/test_translations.py",
    "gui/test_small_screen.py": "gui/test_looks.py",
    "gui/test_tutorial.py": "gui/test_work.py",
    "workbench/test_robot_program_document.py": "workbench/test_robot_walk.py",
    "workbench/test_study_slurm.py": "workbench/test_study_cluster.py",
}


def slow(tests):
    """Whether functions (nodes) are marked slow, not by some parameters alone."""
    return [any(ast.unparse(one) == "pytest.mark.slow" for one in t.decorator_list) for t in tests]


def test_each_file_has_a_quick_test_or_a_quick_neighbour():
    wholly = set()
    for path in ROOT.glob("tests/*/test_*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        tests = [
            node
            for node in tree.body
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
        ]
        of_file = [one for one in tree.body if ast.unparse(one).startswith("pytestmark")]
        assert not any("mark.slow" in ast.unparse(one) for one in of_file), path
        if tests and all(slow(tests)):
            wholly.add(f"{path.parent.name}/{path.name}")
    assert wholly == set(WHOLLY_SLOW)
    assert not wholly & set(WHOLLY_SLOW.values())


def test_another_option_is_refused(checkout):
    process = checkout.start("--fast")
    assert "usage: tools/test" in process.communicate(timeout=60)[1] and process.returncode == 2


def test_failures_and_skips_are_counted(checkout):
    cases = '<testcase name="a"/><testcase name="b"><failure/></testcase>'
    cases += '<testcase name="c"><skipped/></testcase>'
    status, lines, _ = checkout(fuzz=f"echo '<t>{cases}</t>' >\"$report\"; false")
    assert status == 1
    assert lines[-1] == f"{len(suites_of())} passed, 1 failed, 1 skipped"


@pytest.mark.parametrize(
    "ends, passed",
    [('rm "$report"', 0), ('rm "$report"; exit 3', 0), ("kill -9 $$", 1), ("exit 5", 1)],
)
def test_a_suite_that_ends_badly_is_a_failure(checkout, ends, passed):
    status, lines, besides = checkout(house=ends)
    assert status == 1 and "The suite house ended" in besides
    assert lines[-1] == f"{len(suites_of()) - 1 + passed} passed, 1 failed, 0 skipped"


def test_a_skip_of_the_cpp_tests_that_may_not_be_is_a_failure(checkout, monkeypatch):
    monkeypatch.setenv("BELTGRINDING_STRICT", "1")
    skipped = '<t><testcase name="a"/><testcase name="b"><skipped/></testcase></t>'
    status, lines, besides = checkout(core=f"echo '{skipped}' >\"$report\"")
    assert status == 1 and "b skipped, and that is not in" in besides
    assert lines[-1] == f"{len(suites_of())} passed, 1 failed, 0 skipped"


def test_an_interrupt_reaches_the_suites(checkout):
    """As Ctrl-C does: to all processes of the terminal's group, none of which ignores it."""
    process = checkout.start(
        gui='trap "echo $name >>$PLAYED/interrupted; exit 130" INT; sleep 60 & wait',
        workbench='trap "echo $name >>$PLAYED/interrupted; exit 130" INT; sleep 60 & wait',
    )
    order, end = checkout.folder / "order", time.monotonic() + 30
    while not order.exists() or len(order.read_text().splitlines()) < 2:
        assert time.monotonic() < end
        time.sleep(0.02)
    time.sleep(0.3)  # until both wait
    os.killpg(process.pid, signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode != 0
    told = (checkout.folder / "interrupted").read_text().split()
    assert sorted(told) == ["gui", "workbench"]
