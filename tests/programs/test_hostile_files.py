"""Files that are no programs, whatever their names say: one error at once, never a wait or a traceback."""

import errno
import gzip
import os
from pathlib import Path

import pytest

from beltgrinding.base import regular_files
from beltgrinding.job import inputs
from beltgrinding.programs.patch.patch import patch, read_changes
from beltgrinding.programs.program import ProgramError, Program, Motion, Unknown
from beltgrinding.programs.languages.rapid import data as rapid_data
from beltgrinding.programs.registry import READERS, read_program

ROOT = Path(__file__).resolve().parents[2]

SUFFIXES = sorted(READERS)
HUGE = 300 << 20  # bytes, of a file without a block on the disk
KRL = "DEF a()\nLIN {{X 1,Y 2,Z 3,A 4,B 5,C 6}}\n{}\nLIN {{X 2}}\nEND\n"


def make(kind, path):
    if kind == "FIFO":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path.name)
    elif kind == "huge":
        with path.open("wb") as file:
            file.truncate(HUGE)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(
    "kind, code",
    [
        ("FIFO", "files.not_regular"),
        ("device", "files.not_regular"),
        ("folder", "files.cannot_be_read"),
        ("loop", "files.cannot_be_read"),
        ("missing", "files.cannot_be_read"),
        ("huge", "files.too_large"),
    ],
)
def test_what_is_no_file_is_said_at_once(tmp_path, suffix, kind, code):
    path = tmp_path / f"a{suffix}"
    make(kind, path)
    with pytest.raises(ProgramError) as found:
        read_program(path)
    assert found.value.code == code and f"a{suffix}" in str(found.value)


def test_no_permission_is_said(tmp_path, monkeypatch):
    path = tmp_path / "a.src"
    path.write_text("END")

    def forbidden(*_, **__):  # root may read everything
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(regular_files.os, "open", forbidden)
    with pytest.raises(ProgramError, match="a.src: cannot be read"):
        read_program(path)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("stem", ["x" * 300, "a\0b", "a\0/b", "\ud800"])
def test_what_is_no_name_is_said(tmp_path, suffix, stem):
    with pytest.raises(ProgramError) as found:
        read_program(f"{tmp_path}/{stem}{suffix}")
    assert found.value.code in ("files.no_name", "files.cannot_be_read")
    str(found.value).encode()  # it can be shown


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_name_that_is_no_utf8_can_be_shown(tmp_path, suffix):
    path = os.fsencode(str(tmp_path)) + b"/\xff\xe9" + suffix.encode()
    try:
        Path(os.fsdecode(path)).write_bytes(b"hello\n")
    except OSError:
        pytest.skip("the file system has no such names")
    try:
        told = str(read_program(os.fsdecode(path)).problems[0])
    except ProgramError as error:
        told = str(error)
    assert "udcff" in told
    told.encode()


@pytest.mark.parametrize(
    "name, beside", [("a.src", "a.dat"), ("a.pgx", "a.dtx"), ("a.pgx", "a.pjx")]
)
def test_what_lies_beside_may_be_no_file_either(tmp_path, name, beside):
    text = '<Programs><Program name="a"><Code>begin\nend</Code></Program></Programs>'
    (tmp_path / name).write_text(KRL.format("") if name == "a.src" else text)
    os.mkfifo(tmp_path / beside)
    with pytest.raises(ProgramError, match=f"{beside}: is a FIFO"):
        read_program(tmp_path / name)


def test_what_a_job_names_is_hashed_only_where_it_is_a_file(tmp_path):
    os.mkfifo(tmp_path / "fifo.src")
    (tmp_path / "a.src").write_text("END")
    for path, bytes_ in (
        ("/dev/zero", None),
        (tmp_path / "fifo.src", None),
        (tmp_path / "a.src", 3),
    ):
        found = inputs.file_digest("programs[0]", Path(path))
        assert found["bytes"] == bytes_ and (found["sha256"] is None) == (bytes_ is None)
    assert inputs.file_digest("programs[0]", Path("a\0b"))["sha256"] is None


def test_changes_may_be_no_file(tmp_path):
    os.mkfifo(tmp_path / "changes.csv")
    with pytest.raises(ProgramError, match="changes.csv: is a FIFO"):
        read_changes(tmp_path / "changes.csv")


def test_what_cannot_be_written_is_said(tmp_path):
    (tmp_path / "a.src").write_text(KRL.format(""))
    changes = [{"index": 0, "dx_mm": 1.0}]
    (tmp_path / "no").write_text("a file, in which no other can be")
    with pytest.raises(ProgramError, match="cannot be written"):
        patch(tmp_path / "a.src", changes, tmp_path / "no" / "b.src")


@pytest.mark.parametrize(
    "text",
    [
        "LDAT_ACT=1\nBAS(#CP_PARAMS,0.1)",
        "$APO=1\n$VEL=2",
        "V[1e300]=1",
        "FOR I=1E308 TO 1E308\nENDFOR",
        "IF {X 1}=={X 1} THEN\nENDIF",
    ],
)
def test_krl_that_makes_no_sense_is_followed_on(tmp_path, text):
    (tmp_path / "a.src").write_text(KRL.format(text))
    assert len([m for m in read_program(tmp_path / "a.src").motions if m.pose is not None]) == 2


@pytest.mark.parametrize("text", ["7" * 5000, "{" + ",".join(f"C{k} 1" for k in range(200)) + "}"])
def test_krl_s_target_behind_a_tool_that_makes_no_sense_depends_on_it(tmp_path, text):
    (tmp_path / "a.src").write_text(KRL.format(f"$TOOL={text}"))
    program = read_program(tmp_path / "a.src")
    assert [m.pose is None for m in program.motions] == [False, True]
    assert [p.line for p in program.problems] == [3, 4] and "$TOOL" in str(program.problems[0])
    (tmp_path / "a.src").write_text(KRL.format(f"$TOOL={text}\nLIN {{X 1,Y 2,Z 3,A 4,B 5,C 6}}"))
    assert len([m for m in read_program(tmp_path / "a.src").motions if m.pose is not None]) == 3


@pytest.mark.parametrize("size", ["", "-1", "x", "9" * 5000, "9999999," * 999 + "9", "\u0663"])
def test_a_dtx_with_a_size_that_makes_none(tmp_path, size):
    data = f'<Data name="p" type="pointRx" size="{size}"><Value key="0" x="1"/></Data>'
    (tmp_path / "a.dtx").write_text(f"<Database><Datas>{data}</Datas></Database>")
    program = read_program(tmp_path / "a.dtx")
    assert any("not sensible" in str(problem) for problem in program.problems)


def test_data_that_double_are_not_made(tmp_path):
    """Each constant, type or aggregate holds the one before twice."""
    n = 60
    constants = "".join(f"CONST c c{k}:=[c{k - 1},c{k - 1}];\n" for k in range(1, n))
    records = "".join(f"RECORD r{k}\nr{k - 1} a;\nr{k - 1} b;\nENDRECORD\n" for k in range(1, n))
    move = "MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
    text = (
        f"MODULE a\nCONST c c0:=[1,2];\n{constants}RECORD r0\nnum a;\nENDRECORD\n{records}"
        f"VAR r9 x;\nVAR r{n - 1} y;\nPROC main()\n{move}ENDPROC\nENDMODULE\n"
    )
    (tmp_path / "a.mod").write_text(text)
    with pytest.raises(ProgramError, match=r"a.mod:\d+: the program is too long"):
        read_program(tmp_path / "a.mod")
    with pytest.raises(Unknown, match="size is not sensible"):
        rapid_data.initial(
            "a",
            {
                "a": {f"f{k}": "b" for k in range(99)},
                "b": dict.fromkeys((f"f{k}" for k in range(99)), "c"),
                "c": dict.fromkeys((f"f{k}" for k in range(999)), "num"),
            },
        )


def test_many_large_arrays_are_refused(tmp_path):
    arrays = "".join(f"VAR num a{k}{{100,100,100}};\n" for k in range(200))
    (tmp_path / "a.mod").write_text(f"MODULE a\n{arrays}PROC main()\nENDPROC\nENDMODULE\n")
    with pytest.raises(ProgramError, match=r"a.mod:\d+: the program is too long"):
        read_program(tmp_path / "a.mod")


def test_defaults_that_call_their_own_routine_end(tmp_path):
    text = "def a():\n  b()\nend\ndef b(x=b(), y=b()):\n  movel(p[0,0,0,0,0,0])\nend\na()\n"
    (tmp_path / "a.script").write_text(text)
    with pytest.raises(ProgramError, match=r"a.script:\d+: .*too (long|deeply)"):
        read_program(tmp_path / "a.script")


@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".ls", ".nc", ".apt", ".as"])
def test_a_line_without_end_is_refused(tmp_path, suffix):
    head = "/JOB\n" if suffix == ".jbi" else ""
    (tmp_path / f"a{suffix}").write_text(head + "x" * 1_000_001 + "\n")
    with pytest.raises(ProgramError, match=f"a{suffix}:1: the line has more than"):
        read_program(tmp_path / f"a{suffix}")


@pytest.mark.parametrize(
    "xml, code",
    [
        (b'<URProgram a="' + b"x" * (9 << 20) + b'"/>', "programs.xml.token"),
        (b"<URProgram><!--" + b"x" * (9 << 20), "programs.xml.token"),
        (b"<URProgram><cachedContents>" + b"x" * (70 << 20), "programs.xml.too_large"),
    ],
    ids=["attribute", "comment", "contents"],  # else the bytes name the test, in every report
)
def test_a_packed_program_that_swells_is_refused(tmp_path, xml, code):
    (tmp_path / "a.urp").write_bytes(gzip.compress(xml, 6))
    with pytest.raises(ProgramError) as found:
        read_program(tmp_path / "a.urp")
    assert found.value.code == code


def test_arcs_beyond_all_bounds_are_no_endless_path(monkeypatch):
    import numpy as np

    from beltgrinding.programs import program as programs

    monkeypatch.setattr(programs, "MAX_POSES", 100)
    program = Program("KRL", "a.src")
    for k, (x, y) in enumerate([(0.0, 0.0), (1e6, 1e6), (2e6, 0.0)]):
        pose = np.eye(4)
        pose[:2, 3] = x, y
        program.motions.append(Motion("CIRC" if k else "PTP", pose, k + 1, "a.src", aux=k == 1))
    with pytest.raises(ProgramError, match="a.src:3: the path has more than 100 poses"):
        program.path_arrays(100.0)
