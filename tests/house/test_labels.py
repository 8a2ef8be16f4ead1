"""The labels by which messages call a job's keys are those of the panels."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_labels_are_those_of_the_panels():
    done = subprocess.run(
        [sys.executable, str(ROOT / "tools" / "labels"), "check"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
