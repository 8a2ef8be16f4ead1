"""The sources are as tools/format writes them."""

import subprocess

from support.freecad import ROOT


def sources(*patterns):
    listed = ["git", "ls-files", *patterns]
    return subprocess.run(
        listed, cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()


def unchanged(*command):
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, f"{done.stdout}{done.stderr}\nrun tools/format"


def test_of_cpp_by_clang_format():
    unchanged(
        "clang-format",
        "--dry-run",
        "-Werror",
        *sources("*.cpp", "*.h", ":!tests/fuzz/programs"),
    )


def test_of_python_by_black():
    unchanged("black", "-q", "--check", *sources("*.py"))
