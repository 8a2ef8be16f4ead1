"""New programs for controllers with taught positions: Fanuc TP and Yaskawa INFORM, and read back."""

import numpy as np
import pytest

from beltgrinding.base.frames import from_abc
from beltgrinding.engine import InputError
from beltgrinding.programs import Motion, read_program, write_program


def path_of(kinds, **frames):
    rng = np.random.default_rng(len(kinds))
    for k, kind in enumerate(kinds):
        pose = from_abc(rng.uniform(-500, 500, 3), rng.uniform(-80, 80, 3))
        speed = None if kind == "PTP" else round(float(rng.uniform(1, 200)), 1)
        zone = (0.0, None)[k % 2]
        yield Motion(kind, pose, 0, "", speed, 10.0 + k, zone_mm=zone, **frames)


@pytest.mark.parametrize("suffix", [".ls", ".jbi"])
@pytest.mark.parametrize("digits, mm, degrees", [("fine", 1e-6, 1e-6), ("robot", 6e-4, 2e-3)])
def test_poses_and_speeds_go_round(tmp_path, suffix, digits, mm, degrees):
    motions = list(path_of(["PTP", "LIN", "LIN", "SPL", "LIN", "PTP", "LIN", "LIN"]))
    path = tmp_path / f"part{suffix}"
    notes = write_program(path, None, motions, tools="3", bases="5", digits=digits)
    program = read_program(path)
    assert not program.problems and len(program.motions) == len(motions)
    words = ("UFRAME 5", "UTOOL 3") if suffix == ".ls" else ("USER 5", "TOOL 3")
    for k, (a, b) in enumerate(zip(motions, program.motions)):
        assert b.kind == ("LIN" if a.kind == "SPL" else a.kind)
        assert (b.base, b.tool) == words
        assert b.speed_mm_s == a.speed_mm_s
        assert np.abs(a.pose[:3, 3] - b.pose[:3, 3]).max() <= mm
        assert np.degrees(np.abs(a.pose[:3, :3] - b.pose[:3, :3]).max()) <= degrees
        stops = a.zone_mm == 0.0 or k + 1 == len(motions) or a.kind == "PTP"
        assert b.zone_mm == (0.0 if stops else None)  # CNT100 and PL=1 are no lengths
    assert any("configuration" in str(note) for note in notes)
    again = tmp_path / "again" / path.name
    again.parent.mkdir()
    write_program(again, None, program, tools="3", bases="5", digits=digits)
    statements = [
        [row for row in file.read_text().splitlines() if "!" not in row and "'" not in row]
        for file in (path, again)
    ]
    assert [row.partition(":")[2] for row in statements[0] if "LINE" not in row] == [
        row.partition(":")[2] for row in statements[1] if "LINE" not in row
    ]


def test_a_fanuc_program_by_hand(tmp_path):
    poses = [from_abc((10.0 * k, 0.0, 5.0), (90.0, 0.0, 180.0)) for k in range(4)]
    kinds = ("PTP", "LIN", "CIRC", "CIRC")
    motions = [Motion(kind, pose, 0, "", 50.0, 30.0) for kind, pose in zip(kinds, poses)]
    poses[2][1, 3] = 4.0
    motions[2].aux = True
    device = {"kind": "analog", "output": 3, "scale_per_N": 2}
    path = tmp_path / "arc.ls"
    write_program(path, None, motions, bases=5, tools=3, digits="robot", force_device=device)
    text = path.read_text()
    rows = text[text.index("/MN") : text.index("/POS")].split("\n")[1:-1]
    assert [row.partition(":")[2].strip() for row in rows if "!" not in row] == [
        "UFRAME_NUM=5 ;",
        "UTOOL_NUM=3 ;",
        "J P[1] 10% FINE ;",
        "AO[3]=60 ;",
        "L P[2] 50mm/sec CNT100 ;",
        "C P[3]",
        "P[4] 50mm/sec FINE ;",
    ]
    assert "X = 10.000  mm,  Y = 0.000  mm,  Z = 5.000  mm," in text
    assert "W = 180.000 deg,  P = 0.000 deg,  R = 90.000 deg" in text
    found = read_program(path, force_device=device).motions
    assert [m.kind for m in found] == list(kinds) and found[2].aux
    assert [m.force_N for m in found if not m.aux] == [None, 30.0, 30.0]


def test_an_inform_job_by_hand(tmp_path):
    poses = [from_abc((10.0 * k, 0.0, 5.0), (90.0, 0.0, 180.0)) for k in range(3)]
    motions = [
        Motion("PTP" if k == 0 else "LIN", pose, 0, "", 50.0, 30.0) for k, pose in enumerate(poses)
    ]
    device = {"kind": "analog", "output": 2, "scale_per_N": 0.1}
    path = tmp_path / "pass.jbi"
    write_program(path, None, motions, bases=5, tools=3, digits="robot", force_device=device)
    rows = [row for row in path.read_text().splitlines() if not row.startswith("'")]
    assert rows[rows.index("NOP") :] == [
        "NOP",
        "MOVJ C00000 VJ=10.00 PL=0",
        "AOUT AO#(2) 3.00",
        "MOVL C00001 V=50.0 PL=1",
        "MOVL C00002 V=50.0 PL=0",
        "END",
    ]
    assert rows[3:8] == [
        "///NPOS 3,0,0,0,0,0",
        "///USER 5",
        "///TOOL 3",
        "///POSTYPE USER",
        "///RECTAN",
    ]
    assert "C00001=10.000,0.000,5.000,180.000,0.000,90.000" in rows
    assert [m.force_N for m in read_program(path, force_device=device).motions] == [None, 30, 30]


def test_frames_that_nobody_named_are_told(tmp_path):
    motions = list(path_of(["PTP", "LIN", "LIN"]))
    notes = write_program(tmp_path / "p.ls", None, motions)
    assert "UF : F, UT : F" in (tmp_path / "p.ls").read_text()
    assert sum("the program sets no" in str(note) for note in notes) == 2
    notes = write_program(tmp_path / "p.jbi", None, motions)
    assert sum("which it does not declare" in str(note) for note in notes) == 2
    assert all(
        len(row) < 60 for row in (tmp_path / "p.jbi").read_text().splitlines() if row[0] == "'"
    )


@pytest.mark.parametrize("suffix", [".ls", ".jbi"])
def test_what_these_controllers_cannot_is_refused(tmp_path, suffix):
    path = tmp_path / f"p{suffix}"
    motions = list(path_of(["PTP", "LIN", "LIN"]))
    for frames in ({"bases": np.eye(4)}, {"tools": "tGrind"}):
        with pytest.raises(InputError, match="by number"):
            write_program(path, None, motions, **frames)
    with pytest.raises(InputError, match="robhold"):
        write_program(path, None, motions, part_in_hand=True)
    if suffix == ".jbi":
        motions[1].kind = motions[2].kind = "CIRC"
        motions[1].aux = True
        with pytest.raises(InputError, match="arcs are not written as Yaskawa INFORM"):
            write_program(path, None, motions)
    assert not path.exists()
