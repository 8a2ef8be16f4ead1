"""How programs set the pressing force: statements by hand, and what is written is what is read."""

import json

import numpy as np
import pytest

from beltgrinding.base.frames import from_abc
from beltgrinding.engine import InputError
from beltgrinding.programs import Motion, patch_program, read_program, write_program
from beltgrinding.programs.force_device import ForceDevice, device_of

KRL, RAPID, URSCRIPT = "KUKA KRL", "ABB RAPID", "URScript"
FANUC, INFORM = "Fanuc TP", "Yaskawa INFORM"
ANALOG = {"kind": "analog", "name": "aoForce", "output": 2, "scale_per_N": 0.005, "offset": 0.1}
CALL = {"kind": "call", "name": "SET_FORCE"}
TEMPLATE = {"kind": "template", "template": "FORCE({newton:.1f})"}


def moves(forces, start=0.0):
    """Motions along x, 10 mm each: PTP to the first, LIN to the others with a force each."""
    found = []
    for k, force in enumerate([None, *forces]):
        pose = from_abc((start + 10.0 * k, 0.5 * k, 100.0), (0.0, 1.0 * k, 180.0))
        found.append(
            Motion("PTP" if k == 0 else "LIN", pose, 0, "", None if k == 0 else 50.0, force)
        )
    return found


def pressed(path, device):
    return [m.force_N for m in read_program(path, force_device=device).motions if m.kind != "PTP"]


@pytest.mark.parametrize(
    "given, language, newton, statement",
    [
        # 0.1 + 0.005 / N * 30 N = 0.25
        (ANALOG, KRL, 30.0, "$ANOUT[2]=0.25"),
        (ANALOG, RAPID, 30.0, "SetAO aoForce,0.25;"),
        (ANALOG, URSCRIPT, 30.0, "set_standard_analog_out(2, 0.25)"),
        (ANALOG, FANUC, 30.0, "AO[2]=0.25"),
        (ANALOG, INFORM, 30.0, "AOUT AO#(2) 0.25"),
        ({**ANALOG, "scale_per_N": 0.1, "offset": 0}, INFORM, 50.0, "AOUT AO#(2) 5.00"),
        (CALL, KRL, 30.0, "SET_FORCE(30.0)"),
        (CALL, RAPID, 30.0, "SET_FORCE 30;"),
        (CALL, URSCRIPT, 12.5, "SET_FORCE(12.5)"),
        (CALL, FANUC, 30.0, "CALL SET_FORCE(30)"),
        (CALL, INFORM, 30.0, "CALL JOB:SET_FORCE ARGF30.0"),
        ({**CALL, "scale_per_N": 10}, FANUC, 30.4, "CALL SET_FORCE(304)"),
        (TEMPLATE, KRL, 30.0, "FORCE(30.0)"),
        ({**TEMPLATE, "template": "F{newton:05.1f};"}, RAPID, 7.5, "F007.5;"),
    ],
)
def test_a_force_is_one_statement_and_back(given, language, newton, statement):
    device = device_of(given)
    assert device.statement(language, newton) == statement
    assert device.force_of(language, statement) == pytest.approx(newton, abs=1e-3)


@pytest.mark.parametrize(
    "given, language, statement, newton",
    [
        (ANALOG, KRL, " $anout [ 2 ] = 0.35 ", 50.0),
        (ANALOG, KRL, "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $ANOUT[2]=0.35", 50.0),
        (ANALOG, KRL, "TRIGGER WHEN PATH=0 ONSTART DELAY=-20 DO $ANOUT[2]=0.35", 50.0),
        (ANALOG, KRL, "TRIGGER WHEN PATH=0 DELAY=0 DO $ANOUT[2]=0.35", None),  # at the way's end
        (ANALOG, KRL, "$ANOUT[1]=0.35", None),
        (ANALOG, KRL, "$ANOUT[22]=0.35", None),
        (ANALOG, KRL, "$ANOUT[2]=F1", None),  # no number: the reader asks for its value
        (CALL, KRL, "TRIGGER WHEN PATH=0 ONSTART DELAY=0 DO SET_FORCE(30.0) PRIO=-1", 30.0),
        (ANALOG, RAPID, "SetAO aoForce, 0.35", 50.0),
        (ANALOG, RAPID, "SetAO aoOther, 0.35", None),
        (ANALOG, FANUC, "AO[2:Force]=.35", 50.0),
        (ANALOG, INFORM, "AOUT AO#(2) 0.35", 50.0),
        (ANALOG, URSCRIPT, "set_standard_analog_out(2,0.05)", None),  # -10 N
    ],
)
def test_statements_of_other_hands(given, language, statement, newton):
    found = device_of(given).force_of(language, statement)
    assert found == (None if newton is None else pytest.approx(newton, abs=1e-3))


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".ls", ".jbi"])
@pytest.mark.parametrize("given", [ANALOG, CALL, TEMPLATE])
@pytest.mark.parametrize("form", ["", "spline", "zones"])
@pytest.mark.parametrize("digits", ["fine", "robot"])
def test_what_is_written_is_read(tmp_path, suffix, given, form, digits):
    forces = [5.0, 5.0, 30.2, 45.0, 45.0, 12.3, 60.0]
    motions = [*moves(forces), *moves([8.0, 40.0, 8.0], start=300.0)]
    path = tmp_path / f"p{suffix}"
    notes = write_program(path, None, motions, form=form, digits=digits, force_device=given)
    assert not any(note.code == "programs.writers.force_not_set" for note in notes)
    assert pressed(path, given) == [*forces, 8.0, 40.0, 8.0]
    assert set(pressed(path, None)) == {None}  # without the device nobody knows


@pytest.mark.parametrize("forces", [[30.0, 30.0, 45.5, 45.5], [10.0, 20.0, None, 30.0, 31.0]])
def test_urscript_presses_by_force_mode(tmp_path, forces):
    path = tmp_path / "p.script"
    write_program(path, None, moves(forces), force_device={"kind": "controller"})
    assert pressed(path, None) == forces  # the language's own
    assert path.read_text().count("end_force_mode()") == 1 + (None in forces)


def test_force_mode_presses_along_the_contact(tmp_path):
    """Tool in hand: z of the contact in the tool; part in hand: against z of the contact in the base."""
    contact = from_abc((0.0, 0.0, 50.0), (0.0, 90.0, 0.0))  # its z is the tool's x
    for held in (False, True):
        device = ForceDevice("controller", contact=contact, held=held)
        path = tmp_path / f"held{held}.script"
        write_program(path, None, moves([30.0, 30.0]), bases=np.eye(4), force_device=device)
        line = next(one for one in path.read_text().splitlines() if "  force_mode" in one)
        assert f"[0.0, 0.0, {-30.0 if held else 30.0}, 0.0, 0.0, 0.0], 2" in line
        assert pressed(path, device) == [30.0, 30.0]
    assert "p[0.000000000, 0.000000000, 0.050000000, 0.000000000, 1.570796327" in line


def test_force_mode_follows_a_tool_that_turns(tmp_path):
    """Each motion turns the tool by 1.5 degrees, beyond the 1 degree from which force_mode is called anew."""
    motions = moves([30.0] * 4)
    for k, motion in enumerate(motions):
        motion.pose = from_abc((10.0 * k, 0.0, 0.0), (0.0, 1.5 * k, 180.0))
    path = tmp_path / "p.script"
    write_program(path, None, motions, force_device={"kind": "controller"})
    assert path.read_text().count("  force_mode(") == 4


def test_rapid_presses_by_fcpress(tmp_path):
    path = tmp_path / "p.mod"
    device = {"kind": "controller"}
    write_program(path, None, moves([30.0, 35.0, 40.0, None]), force_device=device)
    words = [line.split()[0] for line in path.read_text().splitlines() if "robtarget" not in line]
    found = [word for word in words if word.startswith(("Move", "FC"))]
    assert found == ["MoveJ", "FCPress1LStart", "FCPressL", "FCPressL", "FCPressEnd"]
    assert "\\Fz:=30,50\\ForceFrameRef:=FC_REFFRAME_TOOL" in path.read_text()
    assert pressed(path, device) == [30.0, 35.0, 40.0, 0.0]


def test_rapid_leaves_the_part_on_a_pass_s_last_motion(tmp_path):
    path = tmp_path / "p.mod"
    device = {"kind": "controller"}
    write_program(
        path, None, [*moves([30.0, 35.0, 35.0]), *moves([20.0, 20.0])], force_device=device
    )
    assert pressed(path, device) == [30.0, 35.0, 0.0, 20.0, 0.0]
    with pytest.raises(InputError, match="FCPress begins and ends a pass"):
        write_program(tmp_path / "q.mod", None, moves([30.0]), force_device=device)
    assert not (tmp_path / "q.mod").exists()


@pytest.mark.parametrize(
    "template, why",
    [
        ("", "one statement in one line"),
        ("FORCE({newton:.1f})\nHALT", "one statement in one line"),
        ("KRAFT\u00e4({newton})", "one statement in one line"),
        ("FORCE({newton:.1f}", None),
        ("FORCE(30)", "the field newton once"),
        ("FORCE({force:.1f})", "the field newton once"),
        ("FORCE({newton:.1f},{newton:.1f})", "the field newton once"),
        ("FORCE({newton:.1f},{name})", "the field newton once"),
        ("FORCE({newton.real:.1f})", "the field newton once"),
        ("FORCE({newton:{width}})", "the field newton once"),
        ("FORCE({newton", "the field newton once"),
        ("{newton:.1f}", "the field newton once"),
        ("FORCE({newton:d})", "cannot be read back"),
        ("FORCE({newton:x})", "cannot be read back"),
        ("FORCE({newton:,.0f})", "cannot be read back"),
        ("FORCE({newton:.0e})", "cannot be read back"),
        ("FORCE({newton:.0%})", "cannot be read back"),
        ("FORCE({newton:.2})", "cannot be read back"),
        ("F1{newton:.1f}0", None),
        ("FORCE({newton:.0f})", None),
    ],
)
def test_templates_that_are_taken_or_refused(template, why):
    given = {"kind": "template", "template": template}
    if why is None:
        assert device_of(given).force_of("", device_of(given).statement("", 34.0)) == 34.0
        return
    with pytest.raises(InputError, match=why) as raised:
        device_of(given)
    assert "\n" not in str(raised.value) and "belt_machine.force_device.template" in str(
        raised.value
    )


@pytest.mark.parametrize(
    "given, why",
    [
        ({"kind": "call"}, "name: '' is no name of a subprogram"),
        ({"kind": "call", "name": "A B"}, "is no name of a subprogram"),
        ({"kind": "analog", "name": "a;b"}, "is no name of a signal"),
        ({"kind": "analog", "scale_per_N": 0}, "scale_per_N: it is 0"),
        (
            {"kind": "analog", "least_N": 50, "greatest_N": 20},
            "least_N: 50 N is more than greatest_N, 20 N",
        ),
        ({"kind": "analogue"}, "kind: 'analogue' is not one of"),
        ({"kind": "analog", "outptu": 1}, "outptu"),
        ({"kind": "analog", "ramp_N_s": -1}, "ramp_N_s: -1 is less than"),
    ],
)
def test_wrong_devices_are_refused_in_a_line(given, why):
    with pytest.raises(InputError, match=why) as raised:
        device_of(given)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    "suffix, given, why",
    [
        (
            ".src",
            {"kind": "controller"},
            "KUKA KRL has no 'controller'; take analog, call, template",
        ),
        (
            ".mod",
            {**ANALOG, "name": ""},
            "ABB RAPID sets its analog outputs by the name of the signal",
        ),
        (".src", {"kind": "analog"}, "30 N would be 30 on the output, and KUKA KRL takes -1 to 1"),
        (".script", {"kind": "analog", "scale_per_N": -0.01}, "URScript takes 0 to 1"),
        # What the language takes for a comment sets nothing.
        (
            ".src",
            {**TEMPLATE, "template": "; FORCE({newton:.1f})"},
            "is not read back from the KUKA KRL",
        ),
        (
            ".mod",
            {**TEMPLATE, "template": "! FORCE({newton:.1f})"},
            "is not read back from the ABB RAPID",
        ),
        (
            ".script",
            {**TEMPLATE, "template": "# FORCE({newton:.1f})"},
            "is not read back from the URScript",
        ),
        (".src", {**TEMPLATE, "template": "LIN {newton:.1f}"}, "re"),
    ],
)
def test_what_a_language_cannot_set_is_not_written(tmp_path, suffix, given, why):
    path = tmp_path / f"p{suffix}"
    with pytest.raises(InputError, match=why):
        write_program(path, None, moves([30.0, 30.0]), force_device=given)
    assert not path.exists()


def test_the_range_and_the_resolution_are_kept_and_told(tmp_path):
    given = {**CALL, "least_N": 10, "greatest_N": 40.1, "resolution_N": 0.5}
    path = tmp_path / "p.src"
    notes = write_program(path, None, moves([4.0, 20.2, 20.3, 39.9, 41.0]), force_device=given)
    told = [note for note in notes if note.code == "programs.writers.force_range"]
    assert str(told[0]).startswith("2 motions want 4 to 41 N") and "10 to 40 N" in str(told[0])
    assert pressed(path, given) == [10.0, 20.0, 20.5, 40.0, 40.0]


def test_motions_without_a_force_have_the_job_s(tmp_path):
    device = device_of(CALL, force_N=25.0)
    write_program(tmp_path / "p.src", None, moves([30.0, None, 30.0]), force_device=device)
    assert pressed(tmp_path / "p.src", device) == [30.0, 25.0, 30.0]


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script"])
def test_without_a_device_one_warning_names_the_forces(tmp_path, suffix):
    path = tmp_path / f"p{suffix}"
    notes = write_program(path, None, moves([12.5, 30.0, 12.5]))
    told = [note for note in notes if note.code == "programs.writers.force_not_set"]
    assert (
        len(told) == 1 and "12.5 to 30 N" in str(told[0]) and "docs/force-device.md" in str(told[0])
    )
    assert not write_program(tmp_path / "p.csv", None, moves([12.5]))  # which has a column
    assert "force 30 N" in path.read_text()
    assert pressed(path, ANALOG) == [None] * 3  # a program with comments only


KRL_TEXT = """DEF p ( )
F1=20.0
$ANOUT[1]=F1*0.01
PTP {{X 0,Y 0,Z 0,A 0,B 0,C 0}}
LIN {{X 1,Y 0,Z 0,A 0,B 0,C 0}}
{middle}
LIN {{X 2,Y 0,Z 0,A 0,B 0,C 0}}
END
"""
OUT = {"kind": "analog", "scale_per_N": 0.01}


@pytest.mark.parametrize(
    "middle, force, count",
    [
        ("$ANOUT[1]=0.3", 30.0, 0),
        ("$ANOUT[2]=0.3", 20.0, 0),
        ("$ANOUT[1]=$ANIN[1]", None, 1),
        ("$ANOUT[1]=-0.3", None, 1),
        ("IF $IN[1] THEN\n$ANOUT[1]=0.3\nENDIF", None, 1),
        ("IF TRUE THEN\n$ANOUT[1]=0.3\nENDIF", 30.0, 0),
        ("FOR I=1 TO 3\n$ANOUT[1]=0.1*I\nENDFOR", 30.0, 0),
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $ANOUT[1]=0.3", 30.0, 0),
    ],
)
def test_what_is_computed_or_decided_on_the_way(tmp_path, middle, force, count):
    path = tmp_path / "p.src"
    path.write_text(KRL_TEXT.format(middle=middle))
    program = read_program(path, force_device=OUT)
    assert [m.force_N for m in program.motions] == [None, 20.0, force]
    told = [p for p in program.problems if p.code.startswith("programs.force")]
    assert len(told) == count
    assert [m.force_N for m in read_program(path).motions] == [None] * 3


FANUC_TEXT = """/PROG P
/MN
   1:J P[1] 10% FINE ;
   2:AO[1:Force]=25 ;
   3:L P[2] 50mm/sec FINE ;
   4:CALL PRESS(R[3]) ;
   5:L P[1] 50mm/sec FINE ;
/POS
P[1]{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',
 X = 0 mm, Y = 0 mm, Z = 0 mm, W = 0 deg, P = 0 deg, R = 0 deg };
P[2]{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',
 X = 9 mm, Y = 0 mm, Z = 0 mm, W = 0 deg, P = 0 deg, R = 0 deg };
/END
"""


def test_fanuc_s_outputs_are_read(tmp_path):
    path = tmp_path / "P.LS"
    path.write_text(FANUC_TEXT)
    assert pressed(path, {"kind": "analog"}) == [25.0, None, 25.0]  # the call is a gap
    found = read_program(
        path, values={"variables": {"R[3]": 12}}, force_device={"kind": "call", "name": "PRESS"}
    )
    assert [m.force_N for m in found.motions] == [None, None, 12.0]


def test_rapid_s_short_if_and_loops(tmp_path):
    path = tmp_path / "p.mod"
    target = "CONST robtarget s:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    body = "MoveJ s,v10,fine,tool0;\nIF TRUE SetAO aoF,20;\nMoveL Offs(s,1,0,0),v10,fine,tool0;\n"
    body += "FOR i FROM 1 TO 2 DO\nSetAO aoF,10*i;\nMoveL Offs(s,i,1,0),v10,fine,tool0;\nENDFOR\n"
    body += "IF DInput(d)=1 SetAO aoF,5;\nMoveL s,v10,fine,tool0;"
    path.write_text(f"MODULE m\n{target}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n")
    assert pressed(path, {"kind": "analog", "name": "aoF"}) == [20.0, 10.0, 20.0, None]


def test_an_endless_loop_is_read_once_with_its_forces(tmp_path):
    path = tmp_path / "p.script"
    body = "def p():\n f(10)\n while True:\n  movel(p[0.1,0,0,0,0,0], v=0.1)\n  f(20)\n"
    path.write_text(body + "  movel(p[0.2,0,0,0,0,0], v=0.1)\n end\nend\n")
    assert pressed(path, {"kind": "call", "name": "f"}) == [10.0, 20.0]


def test_a_device_comes_from_a_file_or_a_job(tmp_path):
    file = tmp_path / "device.json"
    file.write_text(json.dumps(OUT))
    assert device_of(file) == device_of(OUT) == device_of(json.dumps(OUT))
    file.write_text(json.dumps({"belt_machine": {"force_device": OUT}, "programs": []}))
    assert device_of(str(file)) == device_of(OUT)
    assert device_of({"kind": "none"}) is device_of(None) is None
    file.write_text('{"kind": "call"}')
    with pytest.raises(InputError, match="device.json"):
        device_of(file)
    with pytest.raises(InputError, match="no JSON"):
        device_of("{kind}")


def changed(tmp_path, suffix, given, forces, changes, form=""):
    """(lines that are new, forces that are read) after a patch of a program that is written with ``forces``."""
    path, output = tmp_path / f"p{suffix}", tmp_path / "new" / f"p{suffix}"
    output.parent.mkdir()
    write_program(path, None, moves(forces), form=form, force_device=given)
    device = device_of(given)
    before = read_program(path, force_device=device).motions
    wanted = [{"line": before[k].line, "force_N": force} for k, force in changes.items()]
    patch_program(path, wanted, output, device)
    old, new = path.read_text().splitlines(), output.read_text().splitlines()
    return [line for line in new if line not in old], pressed(output, given)


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".ls", ".jbi"])
@pytest.mark.parametrize("given", [ANALOG, CALL, TEMPLATE])
@pytest.mark.parametrize("form", ["", "spline"])
def test_a_changed_force_goes_back_into_the_program(tmp_path, suffix, given, form):
    forces = [5.0, 5.0, 30.0, 30.0, 12.0]
    changes = {1: 7.5, 4: 33.5}  # motions from 0, a PTP
    lines, found = changed(tmp_path, suffix, given, forces, changes, form)
    assert found == [7.5, 5.0, 30.0, 33.5, 12.0]
    assert len(lines) >= 2


def test_a_force_that_governs_the_named_motions_only_is_replaced(tmp_path):
    lines, found = changed(tmp_path, ".src", OUT, [5.0, 5.0, 30.0], {1: 6.0, 2: 6.0})
    assert found == [6.0, 6.0, 30.0] and lines == ["$ANOUT[1]=0.06"]


def test_a_force_in_a_spline_is_triggered(tmp_path):
    lines, found = changed(tmp_path, ".src", OUT, [5.0, 5.0, 5.0], {2: 6.0}, "spline")
    start = "TRIGGER WHEN PATH=0 ONSTART DELAY=0 DO $ANOUT[1]="
    assert found == [5.0, 6.0, 5.0] and lines == [f"{start}0.06", f"{start}0.05"]


def test_fanuc_s_lines_are_numbered_and_counted_anew(tmp_path):
    changed(tmp_path, ".ls", OUT, [5.0, 5.0, 5.0, 5.0], {2: 6.0})
    text = (tmp_path / "new" / "p.ls").read_text()
    lines = text[text.index("/MN") + 4 : text.index("/POS")].splitlines()
    assert [int(line.partition(":")[0]) for line in lines] == list(range(1, len(lines) + 1))
    assert f"LINE_COUNT = {len(lines)};" in text
    motions = [line.partition(":")[2].split("%")[0][:6] for line in lines[-6:]]
    assert motions == ["L P[2]", "AO[1]=", "L P[3]", "AO[1]=", "L P[4]", "L P[5]"][-6:], lines


def test_a_force_without_a_device_is_refused_as_before(tmp_path):
    path = tmp_path / "p.src"
    write_program(path, None, moves([5.0, 5.0]), force_device=OUT)
    line = read_program(path).motions[1].line
    with pytest.raises(InputError, match="no pressing force"):
        patch_program(path, [{"line": line, "force_N": 9}], tmp_path / "q.src")
