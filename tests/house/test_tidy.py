"""tools/tidy looks at what changed, the newest first, and fails on a warning; clang-tidy is played."""

import os
import subprocess

import pytest

from support.freecad import ROOT

TIDY = """#!/usr/bin/env bash
file=${!#}
echo "${file#"$PWD/"}" >>seen
! grep -q BAD "$file"
"""


@pytest.fixture
def tidy(tmp_path):
    """Runs tools/tidy in a repository of its own: (status, the files that were looked at)."""

    def git(*arguments):
        who = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
        subprocess.run(["git", *who, *arguments], cwd=tmp_path, check=True, capture_output=True)

    def write(path, text):
        path = tmp_path / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)

    def commit(**files):
        for name, text in files.items():
            write("src/room/" + name.replace("_", "."), text)
        git("add", "src")
        git("commit", "-m", "a change")

    def run(*arguments):
        names = [path.relative_to(tmp_path) for path in tmp_path.glob("src/**/*.cpp")]
        entries = ",\n".join(f'{{\n  "file": "{tmp_path / name}"\n}}' for name in names)
        write("build/release/compile_commands.json", f"[{entries}]\n")
        seen = tmp_path / "seen"
        seen.unlink(missing_ok=True)
        path = f"{tmp_path / 'bin'}:{os.environ['PATH']}"
        done = subprocess.run(
            ["bash", "-c", 'nproc() { echo 1; }; export -f nproc; exec tools/tidy "$@"', "x"]
            + list(arguments),
            cwd=tmp_path,
            env={**os.environ, "PATH": path},
            capture_output=True,
        )
        files = seen.read_text().splitlines() if seen.exists() else []
        return done.returncode, [os.path.basename(name) for name in files]

    for path in ("tools/tidy", "tools/setup.sh"):
        write(path, (ROOT / path).read_text("utf-8"))
    write("bin/clang-tidy", TIDY)
    write("bin/dpkg-query", '#!/bin/sh\nshift 3\nfor name; do echo "$name installed"; done\n')
    git("init", "-q")
    commit(old_cpp="1")
    run.commit, run.write, run.git = commit, write, git
    return run


def test_the_newest_changes_come_first(tidy):
    tidy.git("tag", "-a", "v1", "-m", "v1")
    tidy.commit(a_cpp="1")
    tidy.commit(b_cpp="1", note_txt="no source")
    tidy.write("src/room/c.cpp", "1")
    tidy.git("add", "src")
    assert tidy() == (0, ["c.cpp", "b.cpp", "a.cpp"])
    assert tidy("HEAD~1") == (0, ["c.cpp", "b.cpp"])
    assert tidy("--all") == (0, ["a.cpp", "b.cpp", "c.cpp", "old.cpp"])


def test_a_changed_header_asks_for_its_source(tidy):
    tidy.commit(a_cpp="1", a_h="1", b_h="1")
    tidy.git("tag", "-a", "v1", "-m", "v1")
    tidy.commit(a_h="2", b_h="2")
    assert tidy() == (0, ["a.cpp"])


def test_a_warning_fails_and_what_is_gone_is_let_be(tidy):
    tidy.commit(a_cpp="1", bad_cpp="BAD")
    status, files = tidy("HEAD~1")
    assert status != 0 and "bad.cpp" in files
    tidy.git("rm", "-q", "src/room/bad.cpp")
    tidy.git("commit", "-m", "gone")
    assert tidy("HEAD~2") == (0, ["a.cpp"])


def test_what_is_no_commit_is_refused(tidy):
    assert tidy("nothing") == (2, [])


def test_nothing_changed_is_nothing_to_do(tidy):
    assert tidy("HEAD") == (0, [])
