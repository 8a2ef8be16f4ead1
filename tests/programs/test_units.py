"""The unit of length of APT and G-code: said by the file, else asked for, never taken in silence."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.base.messages import sentence
from beltgrinding.engine import InputError
from beltgrinding.programs import given
from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]

FAULTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "faults"
needs_shared = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no shared data at {FAULTS}")


def read(folder, name, text, **options):
    (folder / name).write_text(text)
    return read_program(folder / name, **options)


def points(program):
    return [np.round(m.pose[:3, 3], 4).tolist() for m in program.motions if m.pose is not None]


@needs_shared
def test_unit_is_a_word_for_units():
    program = read_program(FAULTS / "units_unit.apt")
    assert points(program) == [[25.4, 0, 0], [50.8, 0, 0]] and not program.problems


@needs_shared
def test_feeds_in_inches_say_that_lengths_are():
    program = read_program(FAULTS / "nx_inch.cls")
    assert points(program)[0] == [0, 0, 1270] and points(program)[-1] == [254, 762, 0]
    assert [m.speed_mm_s for m in program.motions][-1] == pytest.approx(20 * 25.4 / 60)
    (note,) = program.problems
    assert "inches, as the feed in IPM says" in note and "Zoll" in sentence(note, "de")


@needs_shared
@pytest.mark.parametrize("name", ["arc6.apt", "arc7.apt"])
def test_arcs_in_inches(name):
    program = read_program(FAULTS / name)
    assert not program.problems
    expected = [[0, 0, 25.4], [0, 0, 0], [25.4, 0, 0], [43.3605, 7.4395, 0], [50.8, 25.4, 0]]
    assert points(program) == [*expected, [50.8, 50.8, 0]]
    assert program.motions[-1].speed_mm_s == pytest.approx(8.467, abs=1e-3)


@needs_shared
def test_an_identity_is_no_gap_and_another_system_is_told_once():
    program = read_program(FAULTS / "csys.apt")
    assert not program.problems and program.counted() == (2, 4)
    (problem,) = program.problems
    assert problem.line == 9 and "CSYS" in problem


@pytest.mark.parametrize(
    "head, scale",
    [
        ("UNITS/MM", 1.0),
        ("UNITS / MILLIMETERS", 1.0),
        ("UNIT/IN", 25.4),
        ("UNITS / CM", 10.0),
        ("units/inches", 25.4),
        ("FEDRAT/20.0,IPM", 25.4),
        ("FEDRAT/IPM,20.0", 25.4),
        ("FEDRAT/0.01,IPR", 25.4),
        ("FEDRAT/200,MMPM", 1.0),
        ("FEDRAT/MMPR,0.1", 1.0),
        ("UNITS/MM\nFEDRAT/20,IPM", 1.0),
        ("UNITS/INCHES\nFEDRAT/200,MMPM", 25.4),
        ("FEDRAT/20,IPM\nUNITS/MM", 1.0),
    ],
)
def test_words_that_say_the_unit_of_apt(tmp_path, head, scale):
    program = read(tmp_path, "p.apt", f"{head}\nGOTO/1,2,3\nGOTO/2,2,3\nFINI\n")
    np.testing.assert_allclose(
        points(program), [[scale, 2 * scale, 3 * scale], [2 * scale, 2 * scale, 3 * scale]]
    )
    assert not program.asks_units


@pytest.mark.parametrize(
    "feeds, speeds",
    [
        ("FEDRAT/20,IPM", [20 * 25.4 / 60]),  # legal in mm
        ("FEDRAT/IPM,40\nGOTO/5,0,0\nFEDRAT/20", [40 * 25.4 / 60, 20 * 25.4 / 60]),
        ("FEDRAT/0.1,MMPR\nGOTO/5,0,0\nFEDRAT/0.2", [None, None]),
        ("FEDRAT/600", [10.0]),
        ("FEDRAT/600,PERMIN", [10.0]),
        ("FEDRAT/0.1,PERREV", [None]),
        ("FEDRAT/5,FURLONGS", [None]),
    ],
)
def test_a_feed_without_unit_has_that_of_the_one_before(tmp_path, feeds, speeds):
    program = read(tmp_path, "p.apt", f"UNITS/MM\n{feeds}\nGOTO/9,2,3\nFINI\n")
    assert [m.speed_mm_s for m in program.motions] == [s and pytest.approx(s) for s in speeds]
    assert len(program.problems) == speeds.count(None)


def test_a_unit_that_changes_between_motions_holds_from_there(tmp_path):
    text = "UNITS/MM\nGOTO/1,0,0\nUNITS/INCHES\nGOTO/1,0,0\nGODLTA/1,0,0\nFINI\n"
    program = read(tmp_path, "p.apt", text)
    assert points(program) == [[1, 0, 0], [25.4, 0, 0], [50.8, 0, 0]] and not program.problems


@pytest.mark.parametrize(
    "name, text",
    [
        ("p.apt", "GOTO/1,2,3\nGOTO/2,2,3\nFINI\n"),
        ("p.cls", "FEDRAT/100\nGOTO/1,2,3\nGOTO/2,2,3\nEND-OF-PATH\n"),
        ("p.apt", "FEDRAT/9,IPM\nFEDRAT/200,MMPM\nGOTO/1,2,3\nGOTO/2,2,3\nFINI\n"),
        ("p.apt", "UNITS/MM\nUNITS/INCHES\nGOTO/1,2,3\nGOTO/2,2,3\nFINI\n"),
        ("p.nc", "G90 G1 X1 Y2 Z3 F100\nX2\nM30\n"),
        ("p.mpf", "G0 X1 Y2 Z3\nG1 X2 F100\nM30\n"),
    ],
)
def test_a_unit_that_is_not_sure_is_asked_for(tmp_path, name, text):
    program = read(tmp_path, name, text)
    assert not points(program) and program.counted() == (0, 2)
    (problem,) = program.problems
    assert "--units inch" in problem and "Wertedatei" in sentence(problem, "de")
    assert given.template(program)["units"] is None and given.missing(program) == ["units"]
    for units, scale in (("mm", 1.0), ("inch", 25.4)):
        program = read_program(tmp_path / name, values={"units": units})
        np.testing.assert_allclose(points(program)[-1], [2 * scale, 2 * scale, 3 * scale])
        assert not program.problems and not given.missing(program)
        assert points(read_program(tmp_path / name, units=units)) == points(program)


def test_a_unit_that_nobody_asks_for_is_told(tmp_path):
    program = read(tmp_path, "p.apt", "UNITS/MM\nGOTO/1,2,3\nFINI\n", values={"units": "inch"})
    assert points(program) == [[1, 2, 3]] and "units" in program.problems[0]
    with pytest.raises(InputError, match="units"):
        read_program(tmp_path / "p.apt", values={"units": "furlong"})


@pytest.mark.parametrize(
    "word, scale, feed",
    [("G20", 25.4, 25.4), ("G21", 1, 1), ("G71", 1, 1), ("G710", 1, 1), ("G700", 25.4, 25.4)],
)
def test_words_that_say_the_unit_of_g_code(tmp_path, word, scale, feed):
    program = read(tmp_path, "p.mpf", f"{word} G90\nG1 X1 Y0 Z0 F600\nM30\n")
    assert points(program) == [[scale, 0, 0]] and not program.problems
    assert program.motions[0].speed_mm_s == pytest.approx(10 * feed)


def test_g70_leaves_the_feed_to_the_control(tmp_path):
    program = read(tmp_path, "p.mpf", "G70 G90\nG1 X1 Y0 Z0 F600\nM30\n")
    assert points(program) == [[25.4, 0, 0]] and program.motions[0].speed_mm_s is None
    assert "G70" in program.problems[0]


def test_a_block_that_insert_hands_on_may_move(tmp_path):
    text = "UNITS/MM\nINSERT/M8\nGOTO/1,2,3\nINSERT/G0 X100\nGOTO/2,2,3\nFINI\n"
    program = read(tmp_path, "p.apt", text)
    assert [p.line for p in program.problems] == [4] and program.counted() == (2, 3)


@pytest.mark.parametrize(
    "name, text, after",
    [
        ("p.apt", "UNIT/INCHES\nGOTO/1.0,2.0,3.0\nGOTO/2.0,2.0,3.0\nFINI\n", "GOTO/2.5"),
        ("p.cls", "FEDRAT/IPM,9\nGOTO/1.0,2.0,3.0\nGOTO/2.0,2.0,3.0\nEND-OF-PATH\n", "GOTO/2.5"),
        ("p.mpf", "G700 G90\nG1 X1.0 Y2 Z3 F9\nX2.0\nM30\n", "X2.5"),
    ],
)
def test_offsets_are_written_in_the_unit_of_the_file(tmp_path, name, text, after):
    (tmp_path / name).write_text(text)
    patch(tmp_path / name, [{"line": 3, "dx_mm": 12.7}], tmp_path / f"new{name}")
    assert after in (tmp_path / f"new{name}").read_text()
