"""KRL's other modules: one DEF a file, with its own data list."""

import pytest

from beltgrinding.programs.registry import read_program, side_files

PTP = "PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
UP = "DEF up(h:IN)\nREAL h\nLIN XP1\nhelper(h)\nEND\nDEF helper(z:IN)\nREAL z\n$VEL.CP=0.05\nLIN {Z z}\nEND\n"
UP_DAT = "DEFDAT up\nDECL E6POS XP1={X 10,Y 0,Z 0,A 0,B 0,C 0}\nDECL INT count=3\nENDDAT\n"


def read(tmp_path, body, more="", **files):
    (tmp_path / "main.src").write_text(f"DEF main()\n$VEL.CP=0.1\n{PTP}{body}\nEND\n{more}")
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        (tmp_path / f"{stem}.{suffix}").write_text(text)
    return read_program(tmp_path / "main.src")


def points(program):
    return [
        tuple(round(float(v), 6) for v in m.pose[:3, 3])
        for m in program.motions
        if m.kind == "LIN" and m.pose is not None
    ]


def test_a_routine_of_its_own_file_is_followed_with_its_data(tmp_path):
    program = read(tmp_path, "up(5)\nUP(2.5)\nLIN XP1", Up_src=UP, up_dat=UP_DAT)
    assert points(program) == [(10, 0, 0), (10, 0, 5), (10, 0, 0), (10, 0, 2.5)]
    assert [m.speed_mm_s for m in program.motions[1:4]] == [100, 50, 50]
    assert [(m.line, m.file) for m in program.motions[1:3]] == [(4, "main.src")] * 2
    assert program.lost == 1 and "XP1 has no value" in str(program.problems[0])


def test_modules_do_not_see_each_others_data_but_what_is_global(tmp_path):
    config = "DEFDAT $CONFIG\nREAL shared=4\nENDDAT\n"
    main = "DEFDAT main\nDECL INT mine=8\nENDDAT\n"
    sub = "DEF sub()\nshared=shared+1\nLIN {X shared}\nLIN {X mine}\nLIN {X count}\nEND\n"
    body = "sub()\nLIN {X shared,Y 0,Z 0,A 0,B 0,C 0}"
    files = {"$config_dat": config, "main_dat": main, "sub_src": sub, "up_dat": UP_DAT}
    program = read(tmp_path, body, **files)
    assert points(program) == [(5, 0, 0), (5, 0, 0)]
    assert program.lost == 2
    assert [p.file for p in program.problems] == ["sub.src", "sub.src"]


def test_modules_call_each_other_and_themselves(tmp_path):
    first = "DEF first(n:IN)\nINT n\nLIN {X n}\nIF n>0 THEN\nsecond(n-1)\nENDIF\nEND\n"
    second = "DEF second(n:IN)\nINT n\nLIN {Y n}\nfirst(n)\nEND\n"
    program = read(tmp_path, "first(2)", first_src=first, second_src=second)
    assert points(program)[:3] == [(2, 0, 0), (2, 1, 0), (1, 1, 0)] and len(points(program)) == 5
    endless = "DEF again()\nagain()\nEND\n"
    assert "calls itself too deeply" in str(read(tmp_path, "again()", again_src=endless).problems)


def test_the_files_own_routine_comes_before_that_of_another_file(tmp_path):
    own = "DEF up(h:IN)\nREAL h\nLIN {X h}\nEND\n"
    program = read(tmp_path, "up(7)", own, Up_src=UP, up_dat=UP_DAT)
    assert points(program) == [(7, 0, 0)]


def test_a_function_of_its_own_file_gives_its_value(tmp_path):
    twice = "DEFFCT REAL twice(v:IN)\nREAL v\nRETURN 2*v\nENDFCT\n"
    program = read(tmp_path, "LIN {X twice(4)}", twice_src=twice)
    assert points(program) == [(8, 0, 0)] and not program.problems


def test_a_local_routine_of_another_file_is_not_seen(tmp_path):
    program = read(tmp_path, "helper(3)", Up_src=UP, up_dat=UP_DAT)
    assert program.lost == 1 and "helper() is not in this file" in str(program.problems[0])


@pytest.mark.parametrize("damage", [b"\0", b"DEF up(h", b"DEF up(h:IN)\nFOR\nLIN {X 1}\n", b""])
def test_a_damaged_module_is_told_and_nothing_is_ground_over_it(tmp_path, damage):
    (tmp_path / "up.src").write_bytes(damage)
    program = read(tmp_path, "LIN {X 1}\nup(1)\nLIN {X 2,Y 0,Z 0,A 0,B 0,C 0}")
    assert program.lost and program.problems
    arrays = program.path_arrays(50.0)
    assert arrays["rapid"].tolist()[-1]


def test_a_reading_depends_on_the_modules_that_are_called(tmp_path):
    read(tmp_path, "up(1)", Up_src=UP, up_dat=UP_DAT, other_src="DEF other()\nEND\n")
    names = {path.name for path in side_files(tmp_path / "main.src")}
    assert names == {"Up.src", "up.dat"}
