"""The table that the engine's heat is compared with (tests/core/heat/plate_test.cpp) is what CalculiX gives."""

import shutil

import pytest

import heat_plate


@pytest.mark.skipif(shutil.which("ccx") is None, reason="calculix-ccx is not installed")
def test_the_table_of_the_heated_plate_is_what_calculix_gives():
    kept = heat_plate.TABLE.read_text().splitlines()
    found = heat_plate.table().splitlines()
    assert len(kept) == len(found) > 100
    for old, new in zip(kept[1:], found[1:]):
        before = [float(word) for word in old.strip("{},").split(", ")]
        now = [float(word) for word in new.strip("{},").split(", ")]
        assert now == pytest.approx(before, abs=0.05)
