"""Arcs of KRL: how the tool turns on them, and where they end."""

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.writer import write_program

START = "LIN {X 100,Y 0,Z 0,A 0,B 0,C 180}"
ARC = "CIRC {X 0,Y 100,Z 0,A 77,B 5,C 3},{X -100,Y 0,Z 0,A %s,B 0,C 180}"  # half a circle


def read(folder, *rows, name="p.src"):
    path = folder / name
    path.write_text("\n".join(["DEF p()", "$VEL.CP=0.1", *rows, "END", ""]))
    return read_program(path)


def a_of(pose):
    """Degrees about the base's z of a pose that has B 0, C 180."""
    return np.degrees(np.arctan2(pose[1, 0], pose[0, 0]))


def path(program):
    return program.path_arrays(50.0)["frames"]


def top(poses):
    """The pose half-way on the arc."""
    return poses[np.argmax(poses[:, 1, 3])]


@pytest.mark.parametrize(
    "rows, middle, end",
    [
        ((), 20.0, 40.0),
        (("$ORI_TYPE=#VAR", "$CIRC_TYPE=#BASE"), 20.0, 40.0),
        (("$CIRC_TYPE=#PATH",), 20.0 - 0.0, 40.0),  # half of 40 - 180, and 90 of the tangent
        (("$ORI_TYPE=#CONSTANT",), 0.0, 0.0),
        (("$ORI_TYPE=#CONSTANT", "$CIRC_TYPE=#PATH"), 90.0, 180.0),
        (("$ORI_TYPE=#CONSTANT", "BAS(#INITMOV,0)"), 20.0, 40.0),
        (("LDAT_ACT={VEL 2,ORI_TYP #CONSTANT,CIRC_TYP #BASE}", "BAS(#CP_PARAMS,0.1)"), 0.0, 0.0),
    ],
)
def test_the_tool_turns_as_the_controller_turns_it(tmp_path, rows, middle, end):
    program = read(tmp_path, *rows, START, ARC % "40")
    poses = path(program)
    assert not program.problems
    np.testing.assert_allclose(poses[:, :3, 2], [[0, 0, -1]] * len(poses), atol=1e-9)
    assert a_of(top(poses)) == pytest.approx(middle, abs=1.0)
    assert abs(a_of(poses[-1])) == pytest.approx(end, abs=1e-6)
    np.testing.assert_allclose(np.hypot(poses[:, 0, 3], poses[:, 1, 3]), 100.0, atol=1e-9)
    # The orientation at the auxiliary point has no meaning.
    other = path(read(tmp_path, *rows, START, (ARC % "40").replace("A 77", "A -120")))
    np.testing.assert_array_equal(poses, other)


def test_against_the_path_it_turns_with_the_tangent(tmp_path):
    # A 100 at the end are 80 less than the tangent's 180: a quarter of the way has 45 - 20.
    poses = path(read(tmp_path, "$CIRC_TYPE=#PATH", START, ARC % "100"))
    angles = np.degrees(np.arctan2(poses[:, 1, 3], poses[:, 0, 3]))
    np.testing.assert_allclose([a_of(p) for p in poses], angles * 100.0 / 180.0, atol=1e-6)
    quarter = "CIRC {X 70.71067812,Y 70.71067812,Z 0,A 0,B 0,C 0},{X 0,Y 100,Z 0,A 10,B 0,C 180}"
    poses = path(read(tmp_path, "$CIRC_TYPE=#PATH", START, quarter))
    assert a_of(poses[len(poses) // 2]) == pytest.approx(5.0, abs=1.0)
    tilted = "CIRC {X 0,Y 100,Z 0,A 0,B 0,C 0},{X -100,Y 0,Z 0,A 180,B 30,C 180}"
    begin = "LIN {X 100,Y 0,Z 0,A 0,B 30,C 180}"  # leans outwards all the way
    poses = path(read(tmp_path, "$CIRC_TYPE=#PATH", begin, tilted))
    outward = poses[:, :3, 3] / 100.0
    lean = np.einsum("ij,ij->i", poses[:, :3, 2], outward)
    np.testing.assert_allclose(lean, lean[0], atol=1e-9)


def test_what_is_held_is_held_on_lines_too(tmp_path):
    program = read(
        tmp_path,
        START,
        "LIN {X 50,Y 0,Z 0,A 90,B 0,C 180} WITH $ORI_TYPE=#CONSTANT",
        "SLIN {X 0,Y 0,Z 0,A 60,B 0,C 180}",
    )
    assert [round(a_of(pose)) for pose in path(program)] == [0, 0, 60]
    program = read(tmp_path, START, "$ORI_TYPE=#JOINT", ARC % "40", ARC % "10")
    (told,) = program.problems
    assert told.line == 5 and "#JOINT" in str(told)


@pytest.mark.parametrize("angle, ends", [(90, 90), (360, 0), (-90, -90), (540, 180), (200, -160)])
def test_a_circle_ends_at_its_angle(tmp_path, angle, ends):
    program = read(tmp_path, START, ARC % "0" + f", CA {angle} C_DIS", "LIN {Z 50}")
    poses = path(program)
    assert not program.problems
    places = poses[:-1, :3, 3]
    travelled = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    assert travelled == pytest.approx(np.pi * 100 * abs(angle) / 180, rel=1e-3)
    at = np.radians(ends)
    np.testing.assert_allclose(places[-1], [100 * np.cos(at), 100 * np.sin(at), 0], atol=1e-9)
    np.testing.assert_allclose(poses[-1, :3, 3], places[-1] + [0, 0, 50], atol=1e-9)
    assert np.sign(places[1, 1]) == np.sign(angle)


def test_circles_that_cannot_be_known_are_left_out(tmp_path):
    for arc, word in (
        (ARC % "0" + ", CA 0", "0 degrees"),
        (ARC % "0" + ", CA R_A", "R_A"),
        ("CIRC {X 50,Y 0,Z 0},{X 0,Y 0,Z 0}, CA 90", "no circle"),
    ):
        program = read(tmp_path, START, arc, "LIN {X 0}")
        assert word in str(program.problems[0]) and program.problems[0].line == 4
        assert [m.kind for m in program.motions][:2] == ["LIN", "GAP"]
    program = read(tmp_path, ARC % "0" + ", CA 90")
    assert [m.kind for m in program.motions] == ["GAP"] and "pose before" in str(
        program.problems[0]
    )
    told = read(tmp_path, START, ARC % "40" + ", CA 270").problems
    assert len(told) == 1 and "extrapolate" in str(told[0])


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".csv"])
@pytest.mark.parametrize("rows", [("$ORI_TYPE=#CONSTANT",), ("$CIRC_TYPE=#PATH",)])
def test_other_languages_get_what_the_robot_does(tmp_path, suffix, rows):
    program = read(tmp_path, *rows, START, ARC % "-100", "LIN {X 0,Y -100,Z 0,A 30,B 0,C 180}")
    write_program(tmp_path / f"w{suffix}", None, program)
    again, wanted = path(read_program(tmp_path / f"w{suffix}")), path(program)
    for pose in wanted[:: max(1, len(wanted) // 20)]:
        near = again[np.argmin(np.linalg.norm(again[:, :3, 3] - pose[:3, 3], axis=1))]
        turn = frames.to_quaternions((near[:3, :3].T @ pose[:3, :3])[None])[0]
        assert np.degrees(2 * np.arccos(min(1.0, abs(turn[0])))) < 2.5
    np.testing.assert_allclose(again[-1], wanted[-1], atol=1e-3)


def test_the_external_tool_is_set_by_ipo_mode(tmp_path):
    program = read(tmp_path, "$IPO_MODE=#TCP", START, "$IPO_MODE=#BASE", "LIN {X 5}")
    assert "held by the robot" in program.motions[0].base
    assert "held" not in program.motions[1].base


def test_a_component_that_is_set_is_its_own_variables_only(tmp_path):
    point = "{X 1,Y 2,Z 3,A 0,B 0,C 180}"
    program = read(tmp_path, f"P1={point}", "P2=P1", "P2.Z=50", "LIN P1", "LIN P2")
    assert [m.pose[2, 3] for m in program.motions] == [3, 50]
    base = "{X 10,Y 0,Z 0,A 0,B 0,C 0}"
    program = read(
        tmp_path, f"BASE_DATA[1]={base}", "$BASE=BASE_DATA[1]", f"LIN {point}", "$BASE.X=30",
        f"LIN {point}", "BAS(#BASE,1)", f"LIN {point}",
    )  # fmt: skip
    assert [pose[0, 3] for pose in path(program)] == [1, 21, 1]
    program = read(tmp_path, "BAS(#BASE,7)", f"LIN {point}", "$BASE.X=30", f"LIN {point}")
    assert program.motions[0].base != program.motions[1].base
    assert len(path(program)) == 1 and program.problems


def test_a_setting_that_may_be_made_is_told(tmp_path):
    rows = ["$ORI_TYPE=#CONSTANT", START, "IF $IN[4] THEN", "$ORI_TYPE=#VAR", "ENDIF", ARC % "40"]
    program = read(tmp_path, *rows)
    (told,) = program.problems
    assert told.line == 6 and "$ORI_TYPE" in str(told)
    assert abs(a_of(path(program)[-1])) < 1e-6  # as before
