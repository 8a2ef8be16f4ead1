"""What the portable package carries along is found where Python has none of its own, and only there."""

import sys

import pytest

from beltgrinding.base import vendored


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(vendored, "FOLDER", tmp_path / "vendored")
    monkeypatch.setattr(sys, "path", list(sys.path))
    vendored.FOLDER.mkdir()
    return str(vendored.FOLDER)


def test_an_installed_package_goes_before(folder):
    vendored.offer()
    assert folder not in sys.path  # the tests run with an installed jsonschema


def test_without_one_the_copy_is_offered_last(folder, monkeypatch):
    monkeypatch.setattr(vendored.importlib.util, "find_spec", lambda name: None)
    vendored.offer()
    assert sys.path[-1] == folder


def test_without_a_copy_nothing_changes(folder, monkeypatch):
    vendored.FOLDER.rmdir()
    monkeypatch.setattr(vendored.importlib.util, "find_spec", lambda name: None)
    before = list(sys.path)
    vendored.offer()
    assert sys.path == before
