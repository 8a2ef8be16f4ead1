"""Programs that change between bases and tools: every pose lies where the robot makes it, or is left out and
named."""

import json
import math

import numpy as np
import pytest

from beltgrinding.base import frames
from beltgrinding.programs.program import Motion
from beltgrinding.programs.registry import read_program

TOP = (500.0, 100.0, 300.0), (0.0, 0.0, 0.0)  # x, y, z in mm; a, b, c in degrees
SIDE = (620.0, 40.0, 180.0), (90.0, 0.0, 30.0)
SHORT = (10.0, 0.0, 120.0), (0.0, 90.0, 0.0)
LONG = (0.0, -25.0, 260.0), (45.0, 20.0, 0.0)
POINTS = [(k * 12.0, 5.0, 2.0 - k) for k in range(4)]  # in the base, turned as they stand
TURN = (15.0, 10.0, 180.0)


def matrix(frame):
    return frames.from_abc(*frame)


def expected():
    """Poses of the tool SHORT in the base TOP: three points, two in SIDE, two by LONG, one in both."""
    top, side, short, long = map(matrix, (TOP, SIDE, SHORT, LONG))
    into, onto = np.linalg.inv(top) @ side, np.linalg.inv(long) @ short
    pose = [frames.from_abc(point, TURN) for point in POINTS]
    return np.array(
        [*pose[:3], into @ pose[0], into @ pose[1], pose[1] @ onto, pose[2] @ onto,
         into @ pose[3] @ onto]
    )  # fmt: skip


PLAN = [  # base, tool, number of the point
    *(("TOP", "SHORT", k) for k in range(3)),
    *(("SIDE", "SHORT", k) for k in range(2)),
    *(("TOP", "LONG", k) for k in (1, 2)),
    ("SIDE", "LONG", 3),
]
FRAMES = {"TOP": TOP, "SIDE": SIDE, "SHORT": SHORT, "LONG": LONG}


def krl(frame):
    (x, y, z), (a, b, c) = frame
    return f"{{X {x},Y {y},Z {z},A {a},B {b},C {c}}}"


def krl_program(assign):
    rows = ["DEF p()", "$VEL.CP=0.1"]
    for base, tool, k in PLAN:
        rows += [*assign(base, tool), f"LIN {krl((POINTS[k], TURN))}"]
    return "\n".join([*rows, "END", ""])


def quaternion(frame):
    return frames.to_quaternions(matrix(frame)[None, :3, :3])[0]


def rapid(frame):
    return f"[{list(frame[0])},[{','.join(repr(float(v)) for v in quaternion(frame))}]]"


def rotation_vector(frame):
    w, *axis = quaternion(frame)
    sine = math.sqrt(sum(v * v for v in axis))
    return [float(v * (2 * math.atan2(sine, w) / sine if sine else 2.0)) for v in axis]


def metres(frame):
    return (
        "p["
        + ",".join(repr(float(v)) for v in [*np.array(frame[0]) / 1000, *rotation_vector(frame)])
        + "]"
    )


def rapid_program(held=False):
    robot, room = ("FALSE", "TRUE") if held else ("TRUE", "FALSE")
    rows = ["MODULE m"]
    for name in ("SHORT", "LONG"):
        rows.append(
            f"PERS tooldata {name}:=[{robot},{rapid(FRAMES[name])},[1,[0,0,1],[1,0,0,0],0,0,0]];"
        )
    for name in ("TOP", "SIDE"):
        rows.append(
            f'PERS wobjdata {name}:=[{room},TRUE,"",{rapid(FRAMES[name])},[[0,0,0],[1,0,0,0]]];'
        )
    rows.append("PROC main()")
    for base, tool, k in PLAN:
        target = rapid((POINTS[k], TURN))[:-1] + ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
        rows.append(f"MoveL {target},v100,fine,{tool}\\WObj:={base};")
    return "\n".join([*rows, "ENDPROC", "ENDMODULE", ""])


def read(folder, name, text):
    path = folder / name
    path.write_text(text)
    return read_program(path)


def krl_by_number(base, tool):
    number = {"TOP": 1, "SIDE": 2, "SHORT": 3, "LONG": 4}
    return [f"BAS(#BASE,{number[base]})", f"BAS(#TOOL,{number[tool]})"]


DATA = (
    "DEFDAT p\n"
    + "".join(
        f"{what}_DATA[{n}]={krl(FRAMES[name])}\n"
        for what, n, name in (
            ("BASE", 1, "TOP"),
            ("BASE", 2, "SIDE"),
            ("TOOL", 3, "SHORT"),
            ("TOOL", 4, "LONG"),
        )
    )
    + "ENDDAT\n"
)


def test_krl_frames_that_are_assigned(tmp_path):
    program = read(
        tmp_path,
        "p.src",
        krl_program(
            lambda base, tool: [f"$BASE={krl(FRAMES[base])}", f"$TOOL={krl(FRAMES[tool])}"]
        ),
    )
    path = program.path_arrays(50.0)
    assert not program.problems and not path["gaps"].any()
    np.testing.assert_allclose(path["frames"], expected(), atol=1e-9)
    assert path["rapid"].tolist() == [True] + [False] * 7


def test_krl_frames_by_number_and_inline_forms(tmp_path):
    (tmp_path / "p.dat").write_text(DATA)
    program = read(tmp_path, "p.src", krl_program(krl_by_number))
    np.testing.assert_allclose(program.path_arrays(50.0)["frames"], expected(), atol=1e-9)

    numbers = {"TOP": 1, "SIDE": 2, "SHORT": 3, "LONG": 4}
    points = "".join(
        f'DECL FDAT FP{i}={{TOOL_NO {numbers[tool]},BASE_NO {numbers[base]},IPO_FRAME #BASE,POINT2[] " "}}\n'
        f"DECL E6POS XP{i}={krl((POINTS[k], TURN))}\n"
        for i, (base, tool, k) in enumerate(PLAN)
    )
    (tmp_path / "q.dat").write_text(DATA.replace("ENDDAT\n", points + "ENDDAT\n"))
    rows = "".join(
        f"FDAT_ACT=FP{i}\nBAS(#CP_PARAMS,0.1)\nLIN XP{i} C_DIS\n" for i in range(len(PLAN))
    )
    program = read(tmp_path, "q.src", f"DEF q()\n{rows}END\n")
    np.testing.assert_allclose(program.path_arrays(50.0)["frames"], expected(), atol=1e-9)
    # The same numbers with the tool in the room: BASE_DATA are tools there, TOOL_DATA the part on the flange.
    (tmp_path / "r.dat").write_text((tmp_path / "q.dat").read_text().replace("#BASE", "#TCP"))
    program = read(tmp_path, "r.src", f"DEF r()\n{rows}END\n")
    assert all("held by the robot" in m.base for m in program.motions)
    short, top = matrix(SHORT), matrix(TOP)
    wanted = [
        np.linalg.inv(short) @ matrix(FRAMES[tool]) @ frames.from_abc(POINTS[k], TURN)
        @ np.linalg.inv(matrix(FRAMES[base])) @ top
        for base, tool, k in PLAN
    ]  # fmt: skip
    np.testing.assert_allclose(program.path_arrays(50.0)["frames"], wanted, atol=1e-9)


def test_krl_frames_that_only_the_controller_knows_are_left_out_and_named(tmp_path):
    program = read(tmp_path, "p.src", krl_program(krl_by_number))
    path = program.path_arrays(50.0)
    np.testing.assert_allclose(path["frames"], expected()[:3], atol=1e-9)
    told = [problem for problem in program.problems if problem.code == "programs.other_frame"]
    assert [fact.arguments["frame"] for fact in told] == [
        "BASE_DATA[2]",
        "TOOL_DATA[4]",
        "BASE_DATA[2]",
    ]
    assert [fact.arguments["count"] for fact in told] == [2, 2, 1]
    assert [fact.line for fact in told] == [14, 20, 26]
    program.path_arrays(50.0)
    assert len(program.problems) == 3  # told once


def test_what_comes_behind_a_gap_is_reached_without_grinding(tmp_path):
    rows = [krl((point, TURN)) for point in POINTS]
    text = (
        f"DEF p()\n$BASE={krl(TOP)}\nLIN {rows[0]}\nLIN {rows[1]}\n$BASE=BASE_DATA[7]\nLIN {rows[2]}\n"
        f"$BASE={krl(TOP)}\nLIN {rows[3]}\nLIN {rows[0]}\nWHILE $IN[3]\nLIN {rows[1]}\nENDWHILE\n"
        f"LIN {rows[2]}\nother()\nLIN {rows[3]}\nEND\n"
    )
    program = read(tmp_path, "p.src", text)
    path = program.path_arrays(50.0)
    assert path["lines"].tolist() == [3, 4, 8, 9, 13, 15]
    assert path["rapid"].tolist() == [True, False, True, False, True, True]
    assert path["gaps"].tolist() == [0, 0, 6, 0, 10, 14]
    assert [m.kind for m in program.motions].count("PTP") == 0


@pytest.mark.parametrize("held", [False, True])
def test_rapid_work_objects_and_tools(tmp_path, held):
    program = read(tmp_path, "p.mod", rapid_program(held))
    path = program.path_arrays(50.0)
    assert not program.problems
    np.testing.assert_allclose(path["frames"], expected(), atol=1e-6)


def test_rapid_a_work_object_of_a_mechanical_unit_is_left_out(tmp_path):
    text = rapid_program().replace(
        "PERS wobjdata SIDE:=[FALSE,TRUE", "PERS wobjdata SIDE:=[FALSE,FALSE"
    )
    program = read(tmp_path, "p.mod", text)
    path = program.path_arrays(50.0)
    assert len(path["frames"]) == 5 and path["gaps"].tolist()[3] > 0
    assert [
        p.arguments["frame"].split()[0]
        for p in program.problems
        if p.code == "programs.other_frame"
    ] == ["SIDE"] * 2


def test_urscript_tools(tmp_path):
    rows = []
    for base, tool, k in PLAN:
        if base == "TOP":
            rows += [
                f"set_tcp({metres(SHORT if tool == 'SHORT' else LONG)})",
                f"movel({metres((POINTS[k], TURN))}, v=0.1)",
            ]
    program = read(tmp_path, "p.script", "\n".join(rows) + "\n")
    want = [pose for pose, (base, _, _) in zip(expected(), PLAN) if base == "TOP"]
    np.testing.assert_allclose(program.path_arrays(50.0)["frames"], want, atol=1e-6)


def test_g_code_offsets_and_tools_are_named(tmp_path):
    text = (
        "T1 M6\nG90 G21 G54\nG1 X0 Y0 Z0 F600\nX10\nX20 T2\nG55\nX0\nX5\nG54\nX30\nM6\nX40\nM30\n"
    )
    program = read(tmp_path, "p.nc", text)
    path = program.path_arrays(50.0)
    assert path["frames"][:, 0, 3].tolist() == [0, 10, 20, 30]
    assert path["rapid"].tolist()[-1] and path["gaps"].tolist() == [0, 0, 0, 7]
    told = [p.arguments for p in program.problems if p.code == "programs.other_frame"]
    assert [(one["frame"], one["count"]) for one in told] == [("G55", 2), ("T2", 1)]


def test_apt_coordinate_systems_are_applied_and_shifts_named(tmp_path):
    rows = ["UNITS/MM", "MSYS/100,0,0,1,0,0,0,1,0", "FEDRAT/600,MMPM"]
    rows += [f"GOTO/{x},0,0,0,0,1" for x in (0, 1, 2)]
    rows += ["MSYS/0,50,0,0,1,0,-1,0,0", "GOTO/7,0,0,0,0,1"]  # x along the part's y
    rows += ["MSYS/100,0,0,1,0,0,0,1,0", "GOTO/3,0,0,0,0,1", "ORIGIN/5,0,0", "GOTO/4,0,0,0,0,1"]
    rows += ["ORIGIN/0,0,0", "GOTO/5,0,0,0,0,1", "FINI"]
    program = read(tmp_path, "p.apt", "\n".join(rows) + "\n")
    path = program.path_arrays(50.0)
    points = path["frames"][:, :3, 3]
    np.testing.assert_allclose(points[:, 0], [0, 1, 2, -100, 3, 5], atol=1e-9)
    np.testing.assert_allclose(points[3], [-100, 57, 0], atol=1e-9)
    assert path["gaps"].tolist() == [0, 0, 0, 0, 0, 12]
    (told,) = [p for p in program.problems if p.code == "programs.other_frame"]
    assert told.arguments["frame"].endswith("ORIGIN 5,0,0") and told.line == 12


def test_where_most_is_ground_is_the_reference(tmp_path):
    far = krl(((0.0, 0.0, 900.0), TURN))
    text = f"DEF p()\n$BASE=BASE_DATA[9]\nPTP {far}\n$BASE={krl(TOP)}\n" + "".join(
        f"LIN {krl((point, TURN))}\n" for point in POINTS
    )
    program = read(tmp_path, "p.src", text + "END\n")
    assert len(program.path_arrays(50.0)["frames"]) == 4
    told = next(p for p in program.problems if p.code == "programs.other_frame")
    assert "BASE_DATA[9]" in str(told) and told.line == 3


def test_a_program_in_one_frame_is_as_it_was(tmp_path):
    motions = [Motion("LIN", matrix((point, TURN)), k, "p") for k, point in enumerate(POINTS)]
    from beltgrinding.programs.program import Program

    program = Program("x", "p", motions)
    frames_ = program.path_arrays(50.0)["frames"]
    assert all((a == m.pose).all() for a, m in zip(frames_, motions)) and not program.problems


def test_a_part_in_the_hand_is_told_where_the_cell_holds_the_tool(tmp_path):
    from beltgrinding.job.poses import program_arrays

    for held in (True, False):
        (tmp_path / "p.mod").write_text(rapid_program(held))
        for holding in ("tool_in_hand", "part_in_hand", None):
            told = []
            program_arrays({"file": str(tmp_path / "p.mod")}, "p", told, None, holding)
            expected = ["programs.part_in_hand"] if held and holding == "tool_in_hand" else []
            assert [fact.code for fact in told] == expected


def test_the_summary_tells_of_frames_that_are_not_known(tmp_path):
    from beltgrinding.programs import table

    program = read(tmp_path, "p.src", krl_program(krl_by_number))
    told = table.summary(program)
    assert told["problems"] == 3 and told["read_in"]["poses"] == 3
    assert sum("BASE_DATA[2]" in line for line in told["first_problems"]) >= 1
    program.path_arrays(50.0)
    assert table.summary(program)["problems"] == 3  # once


def given(frame):
    (x, y, z), (a, b, c) = frame
    return dict(zip(("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg"), (x, y, z, a, b, c)))


def values_file(path, bases, tools):
    kept = {"bases": {n: given(FRAMES[k]) for n, k in bases.items()}}
    kept["tools"] = {n: given(FRAMES[k]) for n, k in tools.items()}
    path.write_text(json.dumps(kept))


USERS = {"TOP": 4, "SIDE": 5, "SHORT": 2, "LONG": 3}


def fanuc_program():
    rows, points = [], []
    for n, (base, tool, k) in enumerate(PLAN, 1):
        x, y, z = POINTS[k]
        a, b, c = TURN  # R about Z, P about Y, W about X
        rows += [f"UFRAME_NUM={USERS[base]}", f"UTOOL_NUM={USERS[tool]}", f"L P[{n}] 50mm/sec FINE"]
        points.append(
            f"P[{n}]{{\n GP1:\n UF : {USERS[base]}, UT : {USERS[tool]},\n X = {x} mm, Y = {y} mm, Z = {z} mm,\n"
            f" W = {c} deg, P = {b} deg, R = {a} deg\n}};"
        )
    body = "\n".join(f"  {i}:{row} ;" for i, row in enumerate(rows, 1))
    return "/PROG P\n/MN\n" + body + "\n/POS\n" + "\n".join(points) + "\n/END\n"


def inform_program():
    points, rows = [], []
    for n, (base, tool, k) in enumerate(PLAN):
        a, b, c = TURN
        values = ",".join(str(v) for v in (*POINTS[k], c, b, a))
        points.append(
            f"///USER {USERS[base]}\n///TOOL {USERS[tool]}\n///POSTYPE USER\n///RECTAN\nC{n:05d}={values}\n"
        )
        rows.append(f"MOVL C{n:05d} V=50.0 PL=0\n")
    return (
        f"/JOB\n//NAME P\n//POS\n///NPOS {len(PLAN)},0,0,0,0,0\n{''.join(points)}//INST\n///DATE 2026/01/01 00:00\n"
        f"///ATTR SC,RW\n///GROUP1 RB1\nNOP\n{''.join(rows)}END\n"
    )


@pytest.mark.parametrize(
    "name, text, base, tool",
    [("P.LS", fanuc_program(), "UFRAME", "UTOOL"), ("P.JBI", inform_program(), "USER", "TOOL")],
)
def test_frames_of_the_controller_that_a_person_gives(tmp_path, name, text, base, tool):
    program = read(tmp_path, name, text)
    assert len(program.path_arrays(50.0)["frames"]) == 3  # those of the first base and tool
    left = {p.arguments["frame"] for p in program.problems if p.code == "programs.other_frame"}
    assert left == {f"{base} 5", f"{tool} 3"}
    values_file(
        tmp_path / "P.values.json",
        {f"{base} 4": "TOP", f"{base} 5": "SIDE"},
        {f"{tool} 2": "SHORT", f"{tool} 3": "LONG"},
    )
    program = read_program(tmp_path / name)
    assert not program.problems, program.problems
    np.testing.assert_allclose(program.path_arrays(50.0)["frames"], expected(), atol=1e-6)


def test_a_fixed_roll_is_fixed_in_the_part_through_all_systems(tmp_path):
    rows = ["UNITS/MM", "MSYS/0,0,0,1,0,0,0,1,0", "FEDRAT/600,MMPM"]
    rows += [f"GOTO/{x},0,0,0,0,1" for x in (0, 5, 9)]
    rows += ["MSYS/0,50,0,0,1,0,-1,0,0", "GOTO/7,0,0,0,0,1", "GOTO/9,0,0,0,0,1", "FINI"]
    path = tmp_path / "p.apt"
    path.write_text("\n".join(rows) + "\n")
    turned = read_program(path, "fixed", (1.0, 1.0, 0.0)).path_arrays(50.0)["frames"]
    along = np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0)
    np.testing.assert_allclose(turned[:, :3, 0], np.tile(along, (5, 1)), atol=1e-9)
