"""A commit's subject is held to 72 characters, by the hooks of pre-commit."""

import subprocess

import pytest

from support.freecad import ROOT


@pytest.mark.parametrize(
    "subject, fits",
    [
        ("a" * 72, True),
        ("ä" * 72, True),
        ("a" * 73, False),
        ("Merge " + "a" * 90, True),
        ("", True),
    ],
)
@pytest.mark.parametrize("body", ["", "\n\n" + "b" * 200 + "\n"])
def test_only_a_short_subject_passes(tmp_path, subject, fits, body):
    message = tmp_path / "message"
    message.write_text(subject + body, "utf-8")
    done = subprocess.run([ROOT / "tools" / "subject", message], capture_output=True, text=True)
    assert (done.returncode == 0) == fits
    assert fits or "73 characters" in done.stderr


def test_pre_commit_asks_it():
    hooks = (ROOT / ".pre-commit-config.yaml").read_text("utf-8")
    assert "entry: tools/subject" in hooks and "stages: [commit-msg]" in hooks
