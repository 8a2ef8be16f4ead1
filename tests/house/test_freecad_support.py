"""What tests start of FreeCAD ends with them; its programs are played."""

import os
import time
from pathlib import Path

import pytest

from support import freecad as support

PLAYED = """#!/usr/bin/env bash
sleep 300 &
echo $! >child
wait
"""


def alive(pid):
    """Whether a process runs: one that is dead may wait for who took it over."""
    try:
        return ") Z " not in Path("/proc", str(pid), "stat").read_text()
    except OSError:
        return False


def test_a_run_that_takes_too_long_leaves_no_process(tmp_path, monkeypatch):
    programs = tmp_path / "bin"
    programs.mkdir()
    for name in ("xvfb-run", "freecad"):
        (programs / name).write_text(PLAYED)
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setattr(support, "TIME_LIMIT", 3)
    made = support.FreeCad(tmp_path / "home")
    with pytest.warns(UserWarning, match="hung"), pytest.raises(
        pytest.fail.Exception, match="hangs"
    ):
        made.run("pass", window=True, fresh=True)
    child = int((tmp_path / "home" / "child").read_text())
    end = time.monotonic() + 20
    while alive(child):
        assert time.monotonic() < end, "it outlives the test"
        time.sleep(0.02)
