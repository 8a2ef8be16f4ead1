"""A part that the robot holds, in RAPID: robhold of tools and work objects, by a rotation reckoned apart."""

import numpy as np
import pytest

from beltgrinding.programs.registry import read_program

HALF = 2**-0.5
# The belt stands in the room, turned by 90 degrees about x; the part is held, turned by 90 degrees about z.
TOOL = f"PERS tooldata tBelt:=[FALSE,[[1000,0,500],[{HALF!r},{HALF!r},0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
PART = f'PERS wobjdata wPart:=[TRUE,TRUE,"",[[0,0,100],[{HALF!r},0,0,{HALF!r}]],[[10,0,0],[1,0,0,0]]];\n'
GRIP = "PERS tooldata tGrip:=[TRUE,[[0,0,200],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
TABLE = 'PERS wobjdata wTable:=[FALSE,TRUE,"",[[300,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n'
POINT = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def read(folder, body):
    path = folder / "p.mod"
    path.write_text(
        f"MODULE M\n{TOOL}{PART}{GRIP}{TABLE}CONST robtarget p:={POINT};\nPROC main()\n{body}\nENDPROC\nENDMODULE\n"
    )
    return read_program(path)


def test_the_flange_is_where_the_part_meets_the_tool(tmp_path):
    program = read(tmp_path, "MoveL p,v100,fine,tBelt\\WObj:=wPart;")
    (motion,) = program.motions
    assert not program.problems and program.held == {motion.base}
    assert motion.base.endswith("held by the robot") and motion.tool.endswith("fixed in the room")
    tool, part = program.tool_frames[motion.tool], program.base_frames[motion.base]
    np.testing.assert_allclose(
        tool[:3], [[1, 0, 0, 1000], [0, 0, -1, 0], [0, 1, 0, 500]], atol=1e-6
    )
    # uframe, then oframe: 10 mm along the turned x, which is the flange's y.
    np.testing.assert_allclose(part[:3], [[0, -1, 0, 0], [1, 0, 0, 10], [0, 0, 1, 100]], atol=1e-6)
    flange = tool @ np.linalg.inv(part @ motion.pose)
    # By hand: the point (1, 2, 3) of the part lies at (-2, 11, 103) of the flange, and in the room at the belt.
    np.testing.assert_allclose(flange @ [-2, 11, 103, 1], [1000, 0, 500, 1], atol=1e-6)
    # The part's x axis, the flange's y, points along the belt's x, the room's.
    np.testing.assert_allclose(flange[:3, 1], [1, 0, 0], atol=1e-6)


def test_offsets_are_in_the_part_and_along_the_tool(tmp_path):
    program = read(
        tmp_path,
        "MoveL Offs(p,1,0,0),v100,fine,tBelt\\WObj:=wPart;\nMoveL RelTool(p,0,0,5),v100,fine,tBelt\\WObj:=wPart;\n"
        "MoveL Offs(CRobT(\\Tool:=tBelt\\WObj:=wPart),0,1,0),v100,fine,tBelt\\WObj:=wPart;",
    )
    places = [motion.pose[:3, 3].round(9).tolist() for motion in program.motions]
    assert places == [[2, 2, 3], [1, 2, 8], [1, 3, 8]] and not program.problems


@pytest.mark.parametrize(
    "tool, wobj, code",
    [
        ("tBelt", "wTable", "neither_held"),
        ("tBelt", "wobj0", "neither_held"),
        ("tGrip", "wPart", "both_held"),
        ("tGrip", "wTable", None),
    ],
)
def test_who_holds_nothing_or_both_is_told(tmp_path, tool, wobj, code):
    program = read(tmp_path, f"MoveL p,v100,fine,{tool}\\WObj:={wobj};")
    assert [problem.code.split(".")[-1] for problem in program.problems] == ([code] if code else [])


@pytest.mark.parametrize("change", ["tGrip.robhold:=FALSE;", "tGrip:=tBelt;"])
def test_who_holds_may_change(tmp_path, change):
    move = "MoveL p,v100,fine,tGrip\\WObj:=wTable;"
    program = read(tmp_path, f"{move}\n{change}\n{move}")
    assert [(p.line, p.code) for p in program.problems] == [(10, "programs.rapid.neither_held")]
    assert "fixed in the room" in program.motions[1].tool
