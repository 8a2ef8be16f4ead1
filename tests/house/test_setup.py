"""tools/setup.sh starts no build where nothing changed, and never two at once; CMake is played."""

import os
import subprocess
import time

import pytest

from support.freecad import ROOT

CMAKE = """#!/usr/bin/env bash
echo "$*" >>"$PWD/calls"
case $1 in
--preset)
    mkdir -p build/release/python
    touch build/release/build.ninja build/release/CMakeCache.txt
    echo configured ;;
--build)
    [ ! -e busy ] || echo "two at once" >>"$PWD/calls"
    touch busy
    sleep "${SLOW:-0}"
    rm -f busy
    if [ -e broken ]; then echo "error: it is broken"; exit 1; fi
    touch build/release/python/beltgrinding_core.so
    echo built ;;
esac
"""
CONFIGURE, ALL, CORE = (
    "--preset release",
    "--build --preset release --target all",
    "--build --preset release --target beltgrinding_core",
)


class Checkout:
    """A checkout with setup.sh and one source, in which CMake only says that it was called."""

    def __init__(self, folder):
        self.folder = folder
        for path in ("tools/setup.sh", "src/plate.cpp", "src/old.cpp", "CMakeLists.txt"):
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).touch()
        (folder / "tools" / "setup.sh").write_text((ROOT / "tools" / "setup.sh").read_text())
        (folder / "bin").mkdir()
        (folder / "bin" / "cmake").write_text(CMAKE)
        (folder / "bin" / "cmake").chmod(0o755)

    def start(self, command="build_all", **variables):
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        return subprocess.Popen(
            ["bash", "-c", f"set -euo pipefail; source tools/setup.sh; {command}"],
            cwd=self.folder,
            env={**os.environ, **variables, "PATH": path},
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, command="build_all", **variables):
        """(status, what it said, the calls of CMake)."""
        process = self.start(command, **variables)
        told = process.communicate()[1]
        return process.returncode, told, self.calls()

    def calls(self):
        path = self.folder / "calls"
        lines = path.read_text().splitlines() if path.exists() else []
        path.unlink(missing_ok=True)
        return lines


@pytest.fixture
def checkout(tmp_path):
    made = Checkout(tmp_path)
    assert made.run()[2] == [CONFIGURE, ALL]
    return made


def test_nothing_is_started_where_nothing_changed(checkout):
    assert checkout.run() == (0, "", [])
    assert checkout.run("build_all beltgrinding_core") == (0, "", [])  # the whole holds it


def _changed(folder):
    (folder / "src" / "plate.cpp").write_text("// another")


def _new(folder):
    (folder / "src" / "new.cpp").touch()


def _gone(folder):
    (folder / "src" / "old.cpp").unlink()


def _older(folder):
    """Replaced by a file that was written long ago, as a restored one is."""
    path = folder / "restored"
    path.write_text("// another")
    os.utime(path, (1e9, 1e9))
    path.rename(folder / "src" / "plate.cpp")


def _no_product(folder):
    (folder / "build" / "release" / "python" / "beltgrinding_core.so").unlink()


@pytest.mark.parametrize("change", [_changed, _new, _gone, _older, _no_product])
def test_a_change_is_built_once(checkout, change):
    time.sleep(0.02)
    change(checkout.folder)
    assert checkout.run()[2] == [ALL]
    assert checkout.run()[2] == []


def test_a_target_is_not_the_whole(checkout):
    time.sleep(0.02)
    _changed(checkout.folder)
    assert checkout.run("build_all beltgrinding_core")[2] == [CORE]
    assert checkout.run("build_all beltgrinding_core")[2] == []
    assert checkout.run()[2] == [ALL]


def test_a_failed_build_is_tried_again_and_its_log_stays(checkout):
    time.sleep(0.02)
    _changed(checkout.folder)
    (checkout.folder / "broken").touch()
    for _ in range(2):
        status, told, calls = checkout.run()
        assert (status, calls) == (1, [ALL]) and "it is broken" in told
    (checkout.folder / "broken").unlink()
    assert checkout.run()[::2] == (0, [ALL])
    logs = sorted((checkout.folder / "build" / "logs").iterdir())
    broken = [log for log in logs if "it is broken" in log.read_text()]
    assert len(logs) == 4 and len(broken) == 2
    assert (checkout.folder / "build" / "build.log").read_text() == "built\n"


def test_what_changes_during_a_build_is_built_after_it(checkout):
    time.sleep(0.02)
    _changed(checkout.folder)
    process = checkout.start(SLOW="0.5")
    end = time.monotonic() + 20
    while not (checkout.folder / "busy").exists():
        assert time.monotonic() < end
        time.sleep(0.01)
    _changed(checkout.folder)
    process.communicate()
    assert checkout.calls() == [ALL]
    assert checkout.run()[2] == [ALL]


def test_of_several_at_once_one_builds(checkout):
    time.sleep(0.02)
    _changed(checkout.folder)
    several = [checkout.start(SLOW="0.5") for _ in range(4)]
    assert [process.communicate() and process.returncode for process in several] == [0] * 4
    assert checkout.calls() == [ALL]


def test_installed_packages_are_asked_for_once(checkout):
    """A second call asks dpkg nothing; another set of packages does."""
    query = checkout.folder / "bin" / "dpkg-query"
    query.write_text('#!/bin/sh\necho asked >>calls\necho "one installed"\necho "two installed"\n')
    query.chmod(0o755)
    assert checkout.run("install_missing one two")[::2] == (0, ["asked"])
    assert checkout.run("install_missing one two")[::2] == (0, [])
    assert checkout.run("install_missing two")[::2] == (0, ["asked"])
    ours = "apt_install() { echo $* >>calls; }; install_missing one three"
    assert checkout.run(ours)[::2] == (0, ["asked", "three"])
    fails = "apt_install() { return 1; }; install_missing one four"
    assert checkout.run(fails)[::2] == (1, ["asked"])
    assert checkout.run(ours.replace("three", "four"))[::2] == (0, ["asked", "four"])
