"""Changes written back into programs: nothing else changes, or nothing is written."""

import csv
import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.engine import InputError
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.patch.text import plan

ROOT = Path(__file__).resolve().parents[2]

PROGRAMS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "programs"
needs_shared = pytest.mark.skipif(not PROGRAMS.is_dir(), reason=f"no shared data at {PROGRAMS}")
SAME_PATH = [
    "crs_part5.src",
    "CrsPart5.mod",
    "CRS_PART5.ls",
    "crs_part5.script",
    "CRSPART5.JBI",
    "crs_part5_AC.nc",
    "crs_part5.apt",
]


def write(tmp_path, name, text):
    file = tmp_path / name
    file.write_bytes(text.encode("latin-1"))
    return file


def patched(tmp_path, name, text, changes):
    """(text after, program after) of a patch."""
    file = write(tmp_path, name, text)
    out = tmp_path / "out" / name
    out.parent.mkdir(exist_ok=True)
    patch(file, changes, out)
    return out.read_bytes().decode("latin-1"), read_program(out)


def refused(tmp_path, name, text, changes, culprit):
    file, out = write(tmp_path, name, text), tmp_path / ("new" + Path(name).suffix)
    with pytest.raises(ProgramError, match=culprit):
        patch(file, changes, out)
    assert not out.exists()


def different(before, after):
    """Numbers (from 1) of lines that differ, where none was inserted."""
    a, b = before.splitlines(keepends=True), after.splitlines(keepends=True)
    assert len(a) == len(b)
    return [k for k, (x, y) in enumerate(zip(a, b), 1) if x != y]


def speeds(program):
    return [m.speed_mm_s for m in program.motions if m.pose is not None]


def places(program):
    return np.array([m.pose[:3, 3] for m in program.motions if m.pose is not None])


# Every language, real length: what is read back is what was asked, and no other byte differs


@needs_shared
@pytest.mark.parametrize("name", SAME_PATH)
def test_random_speeds_read_back_and_nothing_else_changes(tmp_path, name):
    file = PROGRAMS / "same_path_crs_part5" / name
    before = read_program(file)
    path = [
        i
        for i, m in enumerate(before.motions)
        if m.pose is not None and m.kind != "PTP" and not m.aux
    ]
    rng = np.random.default_rng(11)
    for count in (1, 7, 60, len(path)):
        chosen = sorted(rng.choice(path, count, replace=False).tolist())
        wanted = {i: float(rng.integers(5, 400)) for i in chosen}
        if count == len(path):
            wanted = dict.fromkeys(path, 42.0)
        report = patch(
            file, [{"index": i, "speed_mm_s": v} for i, v in wanted.items()], tmp_path / name
        )
        assert {row["index"] for row in report} >= wanted.keys()
        after = read_program(tmp_path / name)
        lines = {before.motions[i].line for i in chosen}
        for i, (a, b) in enumerate(zip(before.motions, after.motions)):
            if a.pose is None:
                assert b.pose is None
                continue
            assert (a.pose == b.pose).all()
            if i in wanted:
                assert b.speed_mm_s == pytest.approx(wanted[i], rel=1e-7)
            elif a.line not in lines:  # an arc's auxiliary point has its end's speed
                assert a.speed_mm_s == b.speed_mm_s
        _same_but_speeds(file, tmp_path / name, lines)


def _same_but_speeds(old, new, lines):
    """The files are the same byte for byte after all that says a speed is taken out; outside of
    the named lines only whole lines that set the speed differ."""
    modal = re.compile(
        rb"^[ \t]*(?:\$VEL\.CP\s*=[^\r\n]*|F[\d.]+|FEDRAT/[^\r\n]*)(?:\r\n|\n)", re.I | re.M
    )
    word = re.compile(
        rb" WITH \$VEL\.CP=[\d.]+|(?<=SPLINE WITH \$VEL\.CP=)[\d.]+|v\d+(?=[,\\\\])|\\V:=\d+"
        rb"|\d+(?=mm/sec)|(?<= V=)[\d.]+| F[\d.]+|(?<=v=)[\w.]+",
        re.IGNORECASE,
    )
    positional = re.compile(rb"(?<=\]\),)[\w.]+,[\w.]+(?=,0,)")  # URScript: a, v

    def bare(path):
        data = modal.sub(b"", path.read_bytes())
        return positional.sub(b"", word.sub(b"", data))

    assert bare(old) == bare(new)
    a, b = old.read_bytes().splitlines(keepends=True), new.read_bytes().splitlines(keepends=True)
    touched = {k for k, line in enumerate(a, 1) if line not in set(b)}
    others = [a[k - 1] for k in touched - lines]
    assert all(re.search(rb"VEL\.CP|FEDRAT|^\s+(vProc|:)", line) for line in others), others


@needs_shared
@pytest.mark.parametrize("name", SAME_PATH)
def test_offsets_move_the_named_poses_only(tmp_path, name):
    file = PROGRAMS / "same_path_crs_part5" / name
    before = read_program(file)
    chosen = [i for i, m in enumerate(before.motions) if m.kind in ("LIN", "SPL")][30:36]
    fine = 6e-4 if name.endswith(("ls", "JBI")) else 7e-5
    for change in ({"tool_dz_mm": 0.05}, {"dx_mm": 0.5, "dz_mm": -0.25}):
        patch(file, [{"index": i, **change} for i in chosen], tmp_path / name)
        after = read_program(tmp_path / name)
        for i, (a, b) in enumerate(zip(before.motions, after.motions)):
            if a.pose is None:
                continue
            step = np.zeros(3)
            if i in chosen:
                step = np.array([change.get(f"d{k}_mm", 0.0) for k in "xyz"])
                step += change.get("tool_dz_mm", 0.0) * a.pose[:3, 2]
            error = np.abs(b.pose[:3, 3] - a.pose[:3, 3] - step).max()
            assert error <= (fine if i in chosen else 0.0)
        old, new = (p.read_bytes().decode("latin-1") for p in (file, tmp_path / name))
        assert len(different(old, new)) == len(chosen)


@needs_shared
def test_a_position_of_a_relative_retract_is_not_moved_unseen(tmp_path):
    file = PROGRAMS / "same_path_crs_part5" / "crs_part5.src"
    motions = read_program(file).motions
    retract = next(
        i for i, m in enumerate(motions) if b"LIN_REL" in file.read_bytes().splitlines()[m.line - 1]
    )
    change = [{"index": retract - 1, "tool_dz_mm": 0.05}]
    with pytest.raises(ProgramError, match=f"motion {retract} otherwise.*relative"):
        patch(file, change, tmp_path / "new.src")
    patch(file, change + [{"index": retract, "tool_dz_mm": 0.05}], tmp_path / "new.src")
    old, new = (p.read_bytes().decode("latin-1") for p in (file, tmp_path / "new.src"))
    assert different(old, new) == [motions[retract - 1].line]
    with pytest.raises(ProgramError, match="LIN_REL is relative"):
        patch(file, [{"index": retract, "tool_dz_mm": 0.05}], tmp_path / "no.src")


@needs_shared
def test_an_inline_form_is_changed_with_its_text(tmp_path):
    file = PROGRAMS / "real" / "kuka_inline_forms_excerpt.src"
    motions = read_program(file).motions
    i = next(k for k, m in enumerate(motions) if m.kind == "LIN")
    patch(file, [{"index": i, "speed_mm_s": 250}], tmp_path / file.name)
    old, new = (p.read_bytes().decode("latin-1") for p in (file, tmp_path / file.name))
    line = motions[i].line
    assert different(old, new) == [line - 5, line - 1]
    rows = new.splitlines()
    assert "Vel= 0.25 m/s" in rows[line - 6] and ", 5:0.25," in rows[line - 6]
    assert rows[line - 2] == "BAS (#CP_PARAMS,0.25)"
    assert (tmp_path / file.name).with_suffix(".dat").exists()  # the poses come along


# KRL

KRL = (
    "DEF p()\r\n$VEL.CP=0.1 ; m/s\r\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\r\n"
    "  LIN {X 1,Y 0,Z 0,A 0,B 90,C 0} C_DIS\r\n  LIN {X 2} C_DIS ; two\r\n  LIN XP3 C_DIS\r\n"
    "$VEL.CP=0.2\r\n  LIN {X 4.0,Y 0,Z 0,A 0,B 90,C 0}\r\nEND"
)
DATA = "DEFDAT p\nDECL POS XP3={X 3,Y 0,Z 0,A 0,B 90,C 0,S 2,T 3}\nENDDAT\n"


def test_krl_speed_of_one_motion_is_set_and_put_back(tmp_path):
    write(tmp_path, "p.dat", DATA)
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 2, "speed_mm_s": 80}])
    line = "  LIN {X 2} C_DIS ; two\r\n"
    assert after == KRL.replace(line, "  $VEL.CP=0.08\r\n" + line + "  $VEL.CP=0.1\r\n")
    assert speeds(program) == [None, 100, 80, 100, 200]
    # Before an assignment there is nothing to put back; an assignment of theirs alone is changed.
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 3, "speed_mm_s": 80}])
    assert after == KRL.replace("  LIN XP3", "  $VEL.CP=0.08\r\n  LIN XP3")
    change = [{"line": k, "speed_mm_s": 80} for k in (4, 5, 6)]
    after, program = patched(tmp_path, "p.src", KRL, change)
    assert after == KRL.replace("=0.1 ;", "=0.08 ;")
    spaced = KRL.replace("=0.1 ;", "=\t0.1\t;")
    assert patched(tmp_path, "p.src", spaced, change)[0] == spaced.replace("0.1\t", "0.08\t")
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 4, "speed_mm_s": 1.5}])
    assert after == KRL.replace("=0.2", "=0.0015")


def test_what_is_so_already_changes_no_byte(tmp_path):
    write(tmp_path, "p.dat", DATA)
    changes = [{"index": k, "speed_mm_s": 100, "dx_mm": 0} for k in (1, 2, 3)]
    assert patched(tmp_path, "p.src", KRL, changes)[0] == KRL
    file = tmp_path / "p.src"
    patch(file, [{"index": 4, "speed_mm_s": 150}], file)  # in place
    assert file.read_bytes().decode() == KRL.replace("=0.2", "=0.15")


def test_krl_offsets(tmp_path):
    write(tmp_path, "p.dat", DATA)
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 3, "tool_dz_mm": 0.05}])
    assert after == KRL.replace("XP3", "XP3 : {FRAME: X 0,Y 0,Z 0.05,A 0,B 0,C 0}")
    np.testing.assert_allclose(places(program)[3], [3.05, 0, 0], atol=1e-9)
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 3, "dy_mm": -1.5}])
    assert after == KRL.replace("XP3", "{FRAME: X 0,Y -1.5,Z 0,A 0,B 0,C 0} : XP3")
    after, program = patched(tmp_path, "p.src", KRL, [{"index": 4, "dx_mm": 0.25}])
    assert after == KRL.replace("4.0", "4.25")
    # The next target names X only: what it does not name would come along.
    refused(tmp_path, "p.src", KRL, [{"index": 1, "dy_mm": 1}], "motion 2 otherwise than asked")
    both = [{"index": 1, "dy_mm": 1}, {"index": 2, "dy_mm": 1}]
    after, program = patched(tmp_path, "p.src", KRL, both)
    assert after == KRL.replace("{X 1,Y 0", "{X 1,Y 1")
    change = [{"index": 2, "dy_mm": 1}]
    after, program = patched(tmp_path, "p.src", KRL, change)
    assert after == KRL.replace("{X 2}", "{X 2,Y 1}")


LOOP = """DEF p()
$VEL.CP=0.1
PTP {X 0,Y 0,Z 0,A 0,B 0,C 0}
FOR i=1 TO 3
LIN pts[i] C_DIS
ENDFOR
pass()
$VEL.CP=0.3
pass()
END
DEF pass()
LIN {X 9,Y 0,Z 0,A 0,B 0,C 0}
END
"""
LOOP_DATA = "DEFDAT p\n" + "".join(
    f"pts[{k}]={{X {k},Y 0,Z 0,A 0,B {60 * k},C 0}}\n" for k in (1, 2, 3)
)


def test_a_line_of_several_motions_is_changed_as_a_whole(tmp_path):
    write(tmp_path, "p.dat", LOOP_DATA)
    one = [{"index": 2, "speed_mm_s": 50}]
    refused(tmp_path, "p.src", LOOP, one, r"p.src:5: .*motions 1, 2, 3")
    after, program = patched(tmp_path, "p.src", LOOP, [{"line": 5, "speed_mm_s": 50}])
    assert speeds(program) == [None, 50, 50, 50, 100, 300]
    after, program = patched(tmp_path, "p.src", LOOP, [{"line": 5, "tool_dz_mm": 0.5}])
    old = read_program(tmp_path / "p.src")
    z = np.array([m.pose[:3, 2] for m in old.motions[1:4]])
    np.testing.assert_allclose(places(program)[1:4], places(old)[1:4] + 0.5 * z, atol=1e-9)
    refused(tmp_path, "p.src", LOOP, [{"index": 1, "dx_mm": 1}], "name all with the same offset")
    # The routine is called at two speeds; neither could be put back after it.
    refused(tmp_path, "p.src", LOOP, [{"line": 12, "speed_mm_s": 50}], "cannot be put back")


def test_krl_what_may_run_or_not_keeps_its_speed(tmp_path):
    source = "DEF p()\n$VEL.CP=0.1\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\nIF $IN[1] THEN\nLIN {X 5}\nENDIF\nEND\n"
    after, _ = patched(tmp_path, "p.src", source, [{"index": 0, "speed_mm_s": 50}])
    assert after.splitlines()[1:5] == ["$VEL.CP=0.1", "$VEL.CP=0.05", source.splitlines()[2]] + [
        "$VEL.CP=0.1"
    ]
    source = "DEF p()\n$VEL.CP=0.1\nother()\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 1}\nEND\n"
    refused(tmp_path, "p.src", source, [{"index": 1, "speed_mm_s": 50}], "cannot be put back")


def test_krl_an_unknown_speed_is_made_known(tmp_path):
    pose = "LIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\n"
    source = f"DEF p()\n$VEL.CP=vel\n{pose}END\n"
    after, program = patched(tmp_path, "p.src", source, [{"index": 0, "speed_mm_s": 50}])
    assert after == source.replace("vel", "0.05") and not program.problems
    source = f"DEF p()\n$VEL.CP=vel\n{pose}{pose}END\n"
    refused(tmp_path, "p.src", source, [{"index": 0, "speed_mm_s": 50}], "cannot be put back")


def test_krl_splines_have_speeds_of_their_own(tmp_path):
    pose = "{X %d,Y 0,Z 0,A 0,B 0,C 0}"
    source = "DEF p()\n$VEL.CP=0.3\nPTP " + pose % 0 + "\nSPLINE WITH $VEL.CP=0.1\n"
    source += "".join(f"SPL {pose % k}\n" for k in (1, 2)) + "ENDSPLINE\nSLIN " + pose % 3
    source += " WITH $VEL.CP=0.2 C_SPL\nLIN " + pose % 4 + "\nEND\n"
    assert speeds(read_program(write(tmp_path, "p.src", source))) == [None, 100, 100, 200, 300]
    after, program = patched(tmp_path, "p.src", source, [{"index": 2, "speed_mm_s": 50}])
    assert speeds(program) == [None, 100, 50, 200, 300]
    assert "SPL " + pose % 2 + " WITH $VEL.CP=0.05\n" in after
    change = [{"line": k, "speed_mm_s": 50} for k in (5, 6, 8)]
    after, program = patched(tmp_path, "p.src", source, change)
    assert speeds(program) == [None, 50, 50, 50, 300]
    assert after == source.replace("=0.1\n", "=0.05\n").replace("=0.2 ", "=0.05 ")


# RAPID

RAPID = """MODULE m
  CONST speeddata vMine:=[70,400,5000,1000];
  CONST robtarget p1:=[[1,0,0],[0.5,0.5,0.5,0.5],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ p1,v200,fine,tool0; ! MoveL p1,v5,fine,tool0;
    MoveL p1,v100,z1,tool0;
    MoveL Offs(p1,5,0,0),vMine,
      z1,tool0\\WObj:=wobj0;
    MoveL p1,v100\\T:=2,z1,tool0;
    TriggL p1,vMine,tr1,z1,tool0;
    FOR i FROM 1 TO 2 DO
      MoveL RelTool(p1,0,0,-i),v100\\V:=90,z1,tool0;
    ENDFOR
    MoveL p1,v100,z1,tool0; MoveL p1,v50,z1,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    "change, old, new",
    [
        ({"line": 5, "speed_mm_s": 150}, "MoveJ p1,v200", "MoveJ p1,v150"),
        ({"line": 6, "speed_mm_s": 95.5}, "p1,v100,z1,tool0;\n    MoveL O", None),
        ({"line": 7, "speed_mm_s": 50}, "vMine,\n", "vMine\\V:=50,\n"),
        ({"line": 9, "speed_mm_s": 50}, "\\T:=2", "\\V:=50"),
        ({"line": 10, "speed_mm_s": 50}, "p1,vMine", "p1,[50,400,5000,1000]"),
        ({"line": 12, "speed_mm_s": 50}, "\\V:=90", "\\V:=50"),
        ({"line": 6, "tool_dz_mm": 0.05}, "MoveL p1,v100,z1,tool0;\n", None),
        ({"line": 7, "dy_mm": 0.2}, "Offs(p1,5,0,0)", "Offs(Offs(p1,5,0,0),0,0.2,0)"),
        ({"line": 12, "tool_dz_mm": 1}, "RelTool(p1,0,0,-i)", "RelTool(RelTool(p1,0,0,-i),0,0,1)"),
    ],
)
def test_rapid(tmp_path, change, old, new):
    if new is None:
        new = old.replace("v100", "v100\\V:=95.5") if "speed_mm_s" in change else None
        new = new or old.replace("p1", "RelTool(p1,0,0,0.05)")
    # With \\T a speed follows from the way: an offset of the motion before would change it.
    source = RAPID if "speed_mm_s" in change else RAPID.replace("\\T:=2", "")
    after, _ = patched(tmp_path, "m.mod", source, [change])
    assert after == source.replace(old, new, 1)


def test_rapid_refusals(tmp_path):
    refused(tmp_path, "m.mod", RAPID, [{"line": 14, "speed_mm_s": 9}], "one motion")
    refused(tmp_path, "m.mod", RAPID, [{"index": 5, "speed_mm_s": 9}], ":12: .*motions 5, 6")
    refused(tmp_path, "m.mod", RAPID, [{"line": 6, "force_N": 9}], "no pressing force")
    slow = RAPID.replace("MoveJ", "VelSet 50,5000; MoveJ", 1)
    refused(
        tmp_path, "m.mod", slow, [{"line": 6, "speed_mm_s": 30}], r"speed \(15 in place of 30\)"
    )


# URScript

SCRIPT = """def p():
  ref_frame = p[1.0, 0, 0, 0, 0, 1.570796]
  via = p[1.1, 0.2, 0.3, 0, 3.0, 0]
  movej(pose_trans(ref_frame, p[0, 0, 0, 0, 0, 0]), a=1.4, v=1.05)
  movel(pose_trans(ref_frame, p[0.010, 0, 0, 0, 0, 0]), 1.2, 0.1, 0, 0.001) # v=3
  movel(via)
  movel(via, a=1.2, t=2)
  movec(via, p[1.0, 0.0, 0.01, 0, 1.0, 0], a=1.2, v=0.1)
end
"""


@pytest.mark.parametrize(
    "change, old, new",
    [
        ({"line": 5, "speed_mm_s": 85}, "1.2, 0.1, 0", "1.2, 0.085, 0"),
        ({"line": 6, "speed_mm_s": 85}, "movel(via)", "movel(via, v=0.085)"),
        ({"line": 7, "speed_mm_s": 85}, "t=2", "t=0, v=0.085"),
        ({"line": 8, "speed_mm_s": 85}, "v=0.1)", "v=0.085)"),
        ({"line": 5, "dx_mm": 1.25}, "0.010", "0.01125"),
        ({"line": 6, "tool_dz_mm": 1}, "l(via)", "l(pose_trans(via, p[0.0, 0.0, 0.001, 0.0, 0.0, 0.0]))"),
    ],
)  # fmt: skip
def test_urscript(tmp_path, change, old, new):
    if "t=2" in SCRIPT and change["line"] in (6,) and "speed_mm_s" not in change:
        source = SCRIPT.replace(", t=2", "")  # its speed follows from the way to it
    else:
        source = SCRIPT
    after, program = patched(tmp_path, "p.script", source, [change])
    assert after == source.replace(old, new, 1)
    before = read_program(tmp_path / "p.script")
    moved = np.abs(places(program) - places(before)).max(axis=1) > 1e-9
    assert moved.sum() == (0 if "speed_mm_s" in change else 1)


def test_urscript_in_a_loop(tmp_path):
    source = "def p():\n  i = 0\n  while i < 3:\n    movel(p[0.1 * i, 0, 0, 0, 0, 0], v=0.1)\n"
    source += "    i = i + 1\n  end\nend\n"
    after, program = patched(tmp_path, "p.script", source, [{"line": 4, "dy_mm": 1}])
    assert "movel(pose_trans(p[0.1 * i, 0, 0, 0, 0, 0], p[0.0, 0.001, 0.0, 0.0" in after
    np.testing.assert_allclose(places(program)[:, 1], 1.0)
    refused(tmp_path, "p.script", source, [{"index": 1, "dy_mm": 1}], "motions 0, 1, 2")


def test_urscript_an_offset_in_another_frame(tmp_path):
    source = SCRIPT.replace(", t=2", "")
    after, program = patched(tmp_path, "p.script", source, [{"index": 5, "dx_mm": 1, "dz_mm": 2}])
    step = places(program) - places(read_program(tmp_path / "p.script"))
    np.testing.assert_allclose(step[5], [1, 0, 2], atol=1e-4)
    assert np.abs(np.delete(step, 5, axis=0)).max() < 1e-12
    change = [{"index": 2, "dx_mm": 1}]
    refused(tmp_path, "p.script", SCRIPT, change, "motion 3 otherwise than asked: its speed")


# Fanuc, INFORM

FANUC = """/PROG  A\r
/MN\r
   1:J P[1] 50% FINE ;\r
   2:L P[2:start] 100mm/sec CNT100 ;\r
   3:C P[3]\r
    :  P[4] 600cm/min FINE ;\r
   4:L P[2:start] R[1] mm/sec FINE ;\r
   5:L P[5] 2.0sec FINE ;\r
/POS\r
""" + "".join(
    f"P[{n}]{{\r\n   GP1:\r\n\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\r\n"
    f"\tX = {10 * n:9.3f}  mm,\tY =     {n * n}.000  mm,\tZ =    99.990  mm,\r\n"
    "\tW =     0.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\r\n};\r\n"
    for n in range(1, 6)
)
FANUC += "/END\r\n"


def test_fanuc(tmp_path):
    after, program = patched(tmp_path, "a.ls", FANUC, [{"index": 1, "speed_mm_s": 80}])
    assert after == FANUC.replace("100mm", "80mm")
    after, program = patched(tmp_path, "a.ls", FANUC, [{"line": 5, "speed_mm_s": 50.04}])
    assert after == FANUC.replace("600cm", "300cm")
    after, program = patched(tmp_path, "a.ls", FANUC, [{"line": 7, "speed_mm_s": 20}])
    assert after == FANUC.replace("R[1]", "20") and not program.problems
    after, program = patched(tmp_path, "a.ls", FANUC, [{"line": 8, "speed_mm_s": 20}])
    assert after == FANUC.replace("2.0sec", "20mm/sec")
    assert speeds(program)[-1] == 20


def test_fanuc_without_positions(tmp_path):
    text = "/PROG A\n/MN\n 1:L PR[1] 100mm/sec FINE ;\n 2:L PR[2] 100mm/sec FINE ;\n/END\n"
    where = {"x_mm": 1, "y_mm": 2, "z_mm": 3, "a_deg": 0, "b_deg": 0, "c_deg": 0}
    values = {"variables": {"PR[1]": where, "PR[2]": {**where, "x_mm": 9}}}
    (tmp_path / "a.values.json").write_text(json.dumps(values))
    after, _ = patched(tmp_path, "a.ls", text, [{"index": 1, "speed_mm_s": 80}])
    assert after == text.replace("2:L PR[2] 100mm", "2:L PR[2] 80mm")
    move = [{"index": 1, "dx_mm": 1}]
    refused(tmp_path, "a.ls", text, move, "its target is no position of this program")


def test_fanuc_positions(tmp_path):
    source = FANUC.replace("R[1] mm", "100mm").replace("2.0sec", "20mm/sec")
    refused(tmp_path, "a.ls", source, [{"index": 1, "dx_mm": 1}], r"P\[2\] is the target in line 7")
    both = [{"index": i, "dx_mm": -20, "dz_mm": 0.01} for i in (1, 4)]
    after, program = patched(tmp_path, "a.ls", source, both)
    assert "\tX =     0.000  mm,\tY =     4.000  mm,\tZ =   100.000  mm,\r\n" in after
    assert len(different(source, after)) == 1
    # The auxiliary point of an arc and its end are two positions; a line means both.
    after, program = patched(tmp_path, "a.ls", source, [{"index": 2, "dz_mm": 1}])
    assert np.flatnonzero(places(program)[:, 2] > 100).tolist() == [2]
    after, program = patched(tmp_path, "a.ls", source, [{"line": 5, "dz_mm": 1}])
    assert np.flatnonzero(places(program)[:, 2] > 100).tolist() == [2, 3]
    indirect = source.replace("J P[1]", "J P[R[1]]")
    refused(tmp_path, "a.ls", indirect, [{"index": 4, "dx_mm": 1}], "may be any position")
    refused(tmp_path, "a.ls", source, [{"index": 1, "speed_mm_s": 0.2}], "less than mm/sec can say")


JOB = (
    "/JOB\r\n//NAME T\r\n//POS\r\n///NPOS 4,0,0,1,0,0\r\n///USER 4\r\n///TOOL 2\r\n///POSTYPE USER\r\n"
    "///RECTAN\r\n///RCONF 0,0,0,0,0,0,0,0\r\n"
    + "".join(f"C{n:05}={10 * n}.000,{n * n}.000,0.500,0.0,0.0,0.0\r\n" for n in range(4))
    + "P0001=1.0,2.0,3.0,0.0,0.0,0.0\r\n//INST\r\n///DATE 2020/01/01 00:00\r\n///GROUP1 RB1\r\nNOP\r\n"
    "MOVJ C00000 VJ=20.00\r\nMOVL C00001 V=100.0 PL=3\r\nSPEED V=30.0\r\nMOVL C00002\r\n"
    "MOVL P0001 V=50.0\r\nMOVL C00003 V=50\r\nEND\r\n"
)


def test_inform(tmp_path):
    after, _ = patched(tmp_path, "t.jbi", JOB, [{"index": 1, "speed_mm_s": 85.55}])
    assert after == JOB.replace("V=100.0", "V=85.5") or after == JOB.replace("V=100.0", "V=85.6")
    after, _ = patched(tmp_path, "t.jbi", JOB, [{"index": 2, "speed_mm_s": 20}])
    assert after == JOB.replace("MOVL C00002", "MOVL C00002 V=20.0")
    after, _ = patched(tmp_path, "t.jbi", JOB, [{"index": 2, "dy_mm": 0.25}])
    assert after == JOB.replace("C00002=20.000,4.000", "C00002=20.000,4.250")
    refused(tmp_path, "t.jbi", JOB, [{"index": 3, "dy_mm": 1}], "no C position")
    refused(tmp_path, "t.jbi", JOB, [{"index": 4, "speed_mm_s": 9}], "mm/s or cm/min")
    shared = JOB.replace("MOVL P0001", "MOVL C00001")
    refused(tmp_path, "t.jbi", shared, [{"index": 1, "dx_mm": 1}], "C1 is the target in line 23")


# G-code, APT, CSV

GCODE = "%\nG21 G90 G54\nG0 X0 Y0 Z5\nG1 Z0 F600\nX10 (to ten)\nX20.5\nG0 Z5\nM30\n%\n"


def test_gcode(tmp_path):
    after, program = patched(tmp_path, "p.nc", GCODE, [{"index": 2, "speed_mm_s": 5}])
    assert after == GCODE.replace("X10 (to ten)\n", "X10 F300 (to ten)\nF600\n")
    after, program = patched(
        tmp_path, "p.nc", GCODE, [{"line": k, "speed_mm_s": 5} for k in (4, 5, 6)]
    )
    assert after == GCODE.replace("F600", "F300")
    both = [{"index": i, "dx_mm": 0.25} for i in (3, 4)]
    after, program = patched(tmp_path, "p.nc", GCODE, both)
    assert after == GCODE.replace("X20.5", "X20.75")
    refused(tmp_path, "p.nc", GCODE, [{"index": 2, "dy_mm": 1}], "motion 3 otherwise than asked")
    change = [{"index": i, "dz_mm": -0.1} for i in (1, 2, 3)]
    after, program = patched(tmp_path, "p.nc", GCODE, change)
    assert after == GCODE.replace("G1 Z0", "G1 Z-0.1")
    relative = GCODE.replace("Z5\nG1", "Z5\nG91\nG1")
    refused(tmp_path, "p.nc", relative, [{"index": 2, "dx_mm": 1}], "G91")


APT = """UNITS/INCHES
FROM/0,0,1,0,0,1
FEDRAT/60.0,IPM $$ slow
GOTO/1.0,0,0,0,0,1
GOTO/2.0,0,0,$
  0,0,1
RAPID
GOTO/3,0,0,0,0,1
FEDRAT/30,IPM
GOTO/4,0,0,0,0,1
FINI
"""


def test_apt(tmp_path):
    after, program = patched(tmp_path, "p.apt", APT, [{"index": 1, "speed_mm_s": 12.7}])
    begin = "GOTO/1.0,0,0,0,0,1\n"
    assert after == APT.replace(begin, "FEDRAT/30.0,IPM\n" + begin + "FEDRAT/60.0,IPM\n")
    after, program = patched(tmp_path, "p.apt", APT, [{"index": 2, "speed_mm_s": 12.7}])
    assert after == APT.replace("GOTO/2", "FEDRAT/30.0,IPM\nGOTO/2")
    after, program = patched(tmp_path, "p.apt", APT, [{"index": 4, "speed_mm_s": 25.4}])
    assert after == APT.replace("/30,", "/60,")
    after, program = patched(tmp_path, "p.apt", APT, [{"index": 2, "dx_mm": 2.54}])
    assert after == APT.replace("/2.0,", "/2.1,")


CSV = "# a comment\r\nx_mm;y_mm;z_mm;a_deg;b_deg;c_deg;feed_mm_s;force_N\r\n1;2;3;0;0;0;50;\r\n4;5;6.5;0;0;0;;30\r\n"


def test_csv(tmp_path):
    change = [{"index": 1, "speed_mm_s": 12.5, "force_N": 25, "dz_mm": -0.25}]
    after, program = patched(tmp_path, "p.csv", CSV, change)
    assert after == CSV.replace("6.5;0;0;0;;30", "6.25;0;0;0;12.5;25")
    after, program = patched(tmp_path, "p.csv", CSV, [{"line": 3, "force_N": 7.5}])
    assert after == CSV.replace("50;\r", "50;7.5\r")
    no_force = CSV.replace(";force_N", "").replace("50;", "50").replace(";30", "")
    refused(tmp_path, "p.csv", no_force, [{"index": 0, "force_N": 7.5}], "no column force_N")


# What is asked for


@pytest.mark.parametrize(
    "changes, culprit",
    [
        ([{"index": 99, "speed_mm_s": 1}], "no motion 99"),
        ([{"line": 99, "speed_mm_s": 1}], "no motion is in line 99"),
        ([{"index": 0, "speed_mm_s": 1}], "PTP without a path speed"),
        ([{"index": 2, "speed_mm_s": -1}], "speed_mm_s is -1"),
        ([{"index": 2, "dx_mm": 1e9}], "dx_mm is 1e"),
        ([{"index": 2, "speed_mm_s": float("nan")}], "speed_mm_s is nan"),
        ([{"index": 2, "speed_mm_s": 1}, {"line": 5, "speed_mm_s": 2}], "two values"),
        ([{"index": 2}], "no change"),
        ([{"index": 2, "force_N": 1}], "no pressing force"),
    ],
)
def test_changes_that_cannot_be(tmp_path, changes, culprit):
    write(tmp_path, "p.dat", DATA)
    refused(tmp_path, "p.src", KRL, changes, culprit)


@pytest.mark.parametrize(
    "text, culprit",
    [
        ("", "empty"),
        ("speed_mm_s\n1\n", "either index or line"),
        ("index,line,speed_mm_s\n", "either index or line"),
        ("index,speed\n", "unknown column 'speed'"),
        ("index,speed_mm_s\n1\n", ":2: 1 values in 2"),
        ("index,speed_mm_s\n1.5,2\n", ":2: "),
        ("index,speed_mm_s\n,2\n", ":2: it names no motion"),
    ],
)
def test_tables_of_changes_that_cannot_be(tmp_path, text, culprit):
    (tmp_path / "changes.csv").write_text(text)
    write(tmp_path, "p.dat", DATA)
    with pytest.raises(ProgramError, match=culprit):
        patch(write(tmp_path, "p.src", KRL), tmp_path / "changes.csv", tmp_path / "q.src")


def test_the_data_of_another_program_is_not_overwritten(tmp_path):
    write(tmp_path, "p.dat", DATA)
    write(tmp_path, "q.dat", "DEFDAT q\n")
    file = write(tmp_path, "p.src", KRL)
    with pytest.raises(ProgramError, match="q.dat: is there already"):
        patch(file, [{"index": 2, "speed_mm_s": 1}], tmp_path / "q.src")
    assert not (tmp_path / "q.src").exists()
    with pytest.raises(ProgramError, match="must end in .src"):
        patch(file, [{"index": 2, "speed_mm_s": 1}], tmp_path / "q.txt")


def test_languages_that_cannot_be_written_back(tmp_path, monkeypatch):
    from beltgrinding.programs.registry import READERS

    monkeypatch.setitem(READERS, ".urp", READERS[".script"])
    changes = [{"index": 1, "speed_mm_s": 9}]
    refused(tmp_path, "p.urp", SCRIPT, changes, r"URScript \(\.urp\) cannot be written back")


def test_from_the_command_line(tmp_path, capsys):
    write(tmp_path, "p.dat", DATA)
    file = write(tmp_path, "p.src", KRL)
    assert cli.main(["program", str(file), "-o", str(tmp_path / "poses.csv")]) == 0
    capsys.readouterr()
    rows = list(csv.DictReader((tmp_path / "poses.csv").open()))
    changes = [f"{row['index']},80" for row in rows if row["motion"] == "LIN"]
    (tmp_path / "c.csv").write_text("index;speed_mm_s\n".replace(";", ",") + "\n".join(changes))
    new = tmp_path / "new.src"
    command = ["program", "write", str(file), str(tmp_path / "c.csv"), "-o", str(new)]
    assert cli.main(command) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["changed"] == 4 and report["motions"][0]["speed_mm_s"] == 80
    assert speeds(read_program(new)) == [None, 80, 80, 80, 80]
    assert cli.main(["program", "write", str(file), "-o", str(new)]) == 2
    assert cli.main(command[:4]) == 2
    assert "beltgrind: program" in capsys.readouterr().err


def test_where_a_modal_speed_is_set():
    path = [(1, "speed"), (2, "path"), (3, "plain"), (4, "path"), (5, "end")]

    def refuse(line, message):
        return ProgramError(message)

    assert plan(path, {2: 5.0, 4: 5.0}, {2: 9, 4: 9}.get, refuse) == [("set", 1, 5.0)]
    found = plan(path, {2: 5.0, 4: 6.0}, {2: 9, 4: 9}.get, refuse)
    assert found == [("before", 2, 5.0), ("before", 4, 6.0)]
    assert plan(path, {2: 5.0}, {2: 9}.get, refuse) == [("before", 2, 5.0), ("after", 2, 9)]
    barrier = [*path[:3], (4, "barrier"), (5, "path")]
    assert plan(barrier, {2: 5.0}, {2: 9}.get, refuse) == [("before", 2, 5.0), ("after", 2, 9)]


def test_a_force_of_a_table_is_rounded_as_it_is_written(tmp_path):
    """6 decimals of a small force are no other force."""
    name = write(tmp_path, "p.csv", "x_mm,y_mm,z_mm,qw,qx,qy,qz,force_N\n0,0,0,1,0,0,0,5\n")
    told = patch(name, [{"index": 0, "force_N": 0.4948532}], tmp_path / "new.csv")
    assert told[0]["force_N"] == 0.494853
    assert (tmp_path / "new.csv").read_text().endswith(",0.494853\n")


TARGETS = """MODULE targets
CONST robtarget pa:=[[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pb:=[[10,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
ENDMODULE
"""
GRIND = """MODULE grind
{}PROC main()
MoveL pa,v20,fine,tool0;
MoveL pb,v20,fine,tool0;
ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("own", [False, True])
def test_other_modules_go_along_where_it_needs_them(tmp_path, own):
    constants = "".join(TARGETS.splitlines(True)[1:3]) if own else ""
    (tmp_path / "grind.mod").write_text(GRIND.format(constants))
    (tmp_path / "targets.mod").write_text(
        TARGETS.replace("pa", "pc").replace("pb", "pd") if own else TARGETS
    )
    output = tmp_path / "new" / "grind.mod"
    before = read_program(tmp_path / "grind.mod").motions
    patch(tmp_path / "grind.mod", [{"line": before[1].line, "speed_mm_s": 5.0}], output)
    after = read_program(output).motions
    assert [one.speed_mm_s for one in after] == [20.0, 5.0]
    assert [one.pose[0, 3] for one in after] == [0.0, 10.0]
    assert (output.parent / "targets.mod").exists() is not own


def test_values_go_along_under_the_output_s_name(tmp_path):
    text = "DEF p()\n$VEL.CP=0.02\n" + "".join(
        f"LIN {{X {x},Y 0,Z Z0,A 0,B 0,C 180}}\n" for x in (0, 10)
    )
    (tmp_path / "p.src").write_text(text + "END\n")
    (tmp_path / "p.values.json").write_text('{"variables": {"Z0": 7.0}}')
    output = tmp_path / "new" / "q.src"
    patch(tmp_path / "p.src", [{"index": 1, "speed_mm_s": 5.0}], output)
    assert (output.parent / "q.values.json").exists()
    assert [one.pose[2, 3] for one in read_program(output).motions] == [7.0, 7.0]
    (output.parent / "q.values.json").write_text("{}")
    with pytest.raises(InputError, match="is there already and differs"):
        patch(tmp_path / "p.src", [{"index": 1, "speed_mm_s": 6.0}], output)
