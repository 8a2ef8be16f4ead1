"""KRL data lists of other names: what a module sees of them."""

from pathlib import Path

import pytest

from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.languages.krl import data_lists
from beltgrinding.programs.registry import read_program

ROOT = Path(__file__).resolve().parents[2]

POSE = "{{X {0}, Y 0, Z 0, A 0, B 0, C 180}}"


def module(tmp_path, body="LIN XP1\nLIN XP2\n", **lists):
    """A module p.src that goes to XP1, XP2, and lists by file name."""
    (tmp_path / "p.src").write_text(f"DEF P()\n$VEL.CP = 0.1\n{body}END\n")
    for name, text in lists.items():
        (tmp_path / f"{name.replace('config', '$config')}.DAT").write_text(text)
    return read_program(tmp_path / "p.src")


def xs(program):
    return [m.pose[0, 3] for m in program.motions if m.pose is not None]


def points(declare="DECL E6POS ", names=("XP1", "XP2"), values=(1, 2)):
    return "".join(f"{declare}{n}={POSE.format(v)}\n" for n, v in zip(names, values))


def test_a_list_whose_defdat_has_the_module_s_name(tmp_path):
    program = module(tmp_path, points=f"DEFDAT p\n{points()}ENDDAT\n")
    assert xs(program) == [1, 2] and not program.problems


@pytest.mark.parametrize("declare", ["DECL GLOBAL E6POS ", "GLOBAL E6POS ", "GLOBAL DECL E6POS "])
def test_global_values_of_a_public_list(tmp_path, declare):
    program = module(tmp_path, points=f"DEFDAT POINTS PUBLIC\n{points(declare)}ENDDAT\n")
    assert xs(program) == [1, 2] and not program.problems


def test_global_arrays_are_declared_before_their_values(tmp_path):
    rows = "DECL GLOBAL FRAME GP[2]\n" + "".join(f"GP[{k}]={POSE.format(10 * k)}\n" for k in (1, 2))
    program = module(
        tmp_path, "FOR I = 1 TO 2\nLIN GP[I]\nENDFOR\n", points=f"DEFDAT G PUBLIC\n{rows}ENDDAT\n"
    )
    assert xs(program) == [10, 20]


@pytest.mark.parametrize("head", ["DEFDAT POINTS", "DEFDAT POINTS PUBLIC"])
def test_what_is_not_global_is_not_seen(tmp_path, head):
    declare = "DECL E6POS " if "PUBLIC" in head else "DECL GLOBAL E6POS "
    program = module(tmp_path, points=f"{head}\n{points(declare)}ENDDAT\n")
    assert xs(program) == [] and [p.line for p in program.problems] == [3, 4]


def test_config_is_everyones_but_its_system_variables(tmp_path):
    config = f"DEFDAT $CONFIG\n$VEL.CP=3.0\n{points()}$BASE={POSE.format(7)}\nENDDAT\n"
    program = module(tmp_path, config=config)
    assert xs(program) == [1, 2] and program.motions[0].speed_mm_s == 100.0


def test_a_module_s_own_list_comes_first(tmp_path):
    shared = f"DEFDAT POINTS PUBLIC\n{points('DECL GLOBAL E6POS ', values=(8, 9))}ENDDAT\n"
    program = module(tmp_path, p=f"DEFDAT P\n{points(names=('XP1',))}ENDDAT\n", zz=shared)
    assert xs(program) == [1, 9]


def test_two_lists_that_differ_are_told(tmp_path):
    one, two = (
        f"DEFDAT {n} PUBLIC\n{points('GLOBAL E6POS ', values=v)}ENDDAT\n"
        for n, v in (("A", (1, 2)), ("B", (1, 3)))
    )
    program = module(tmp_path, a=one, b=two)
    assert xs(program) == [1]
    assert [p.code for p in program.problems][0] == "programs.krl.defined_twice"
    assert "XP2" in program.problems[0]


def test_other_lists_that_are_damaged_stop_nothing(tmp_path):
    good = f"DEFDAT G PUBLIC\n{points('GLOBAL E6POS ')}ENDDAT\n"
    (tmp_path / "a.dat").write_bytes(b"DEFDAT A PUBLIC\0\1\2")
    (tmp_path / "b.dat").mkdir()
    (tmp_path / "c.dat").write_bytes(b"\xff" * 5000)
    (tmp_path / "d.dat").write_text("DEFDAT D PUBLIC\nGLOBAL INT N=((((\nGLOBAL E6POS Q={X 1\n")
    program = module(tmp_path, g=good)
    assert xs(program) == [1, 2] and not program.problems


def test_a_folder_with_too_many_lists_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(data_lists, "MAX_LISTS", 2)
    for k in range(4):
        (tmp_path / f"m{k}.dat").write_text(f"DEFDAT M{k}\nENDDAT\n")
    assert "programs.krl.many_lists" in [p.code for p in module(tmp_path, "").problems]


def test_changes_go_back_into_a_module_with_points_elsewhere(tmp_path):
    module(tmp_path, points=f"DEFDAT POINTS PUBLIC\n{points('GLOBAL E6POS ')}ENDDAT\n")
    patch(tmp_path / "p.src", [{"index": 1, "speed_mm_s": 40.0}], tmp_path / "q.src")
    (tmp_path / "p.src").unlink()
    assert [m.speed_mm_s for m in read_program(tmp_path / "q.src").motions] == [100.0, 40.0]
