"""What lies beside a program and decides its poses is an input of the result."""

import os
import sys

import numpy as np
import pytest

from beltgrinding.job import inputs
from beltgrinding.job.load import validate
from beltgrinding.programs.registry import read_program

TARGET = "[[{x},0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
MODULE = f"""MODULE Main
PROC main()
MoveL {TARGET.format(x=0)},v100,fine,tool0;
MoveL pShared,v100,fine,tool0;
ENDPROC
ENDMODULE
"""
DATA = f"MODULE Data\nCONST robtarget pShared:={TARGET};\nENDMODULE\n"
KRL = "DEF p()\nLIN {{X 0,Y 0,Z 0,A 0,B 0,C 0}}\nLIN {}\nEND\n"
POINT = "{{X {x},Y 0,Z 0,A 0,B 0,C 0}}"
PROGRAMS = '<?xml version="1.0"?>\n<Programs><Program name="{name}"><Code><![CDATA[begin\n{code}\nend]]></Code></Program></Programs>\n'
VAL3_DATA = (
    '<?xml version="1.0"?>\n<Database><Datas>\n'
    '<Data name="p" access="private" xsi:type="array" type="pointRx" size="1" xmlns:xsi="x">'
    '<Value key="0" x="{x}" y="0" z="0" rx="0" ry="0" rz="0"/></Data>\n'
    '<Data name="t" access="private" xsi:type="array" type="tool" size="1" xmlns:xsi="x"><Value key="0"/></Data>\n'
    '<Data name="m" access="private" xsi:type="array" type="mdesc" size="1" xmlns:xsi="x">'
    '<Value key="0" tmax="100"/></Data>\n</Datas></Database>\n'
)
# The program, what lies beside it and decides its second pose (with {x}), and what does not.
CASES = {
    "rapid": ("a.mod", MODULE, "other.sys", DATA, {"note.txt": "x"}),
    "rapid listed": (
        "a.mod",
        MODULE,
        "b.mod",
        DATA,
        {"c.mod": DATA.replace("Data", "Old").format(x=9)},
    ),
    "krl config": (
        "p.src",
        KRL.format("XHOME9"),
        "$config.dat",
        f"DEFDAT $CONFIG\nDECL E6POS XHOME9={POINT}\nENDDAT\n",
        {"q.dat": "DEFDAT Q\nDECL E6POS XOWN={X 1,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n"},
    ),
    "krl public": (
        "p.src",
        KRL.format("XGLOBAL"),
        "points.dat",
        f"DEFDAT POINTS PUBLIC\nDECL GLOBAL E6POS XGLOBAL={POINT}\nENDDAT\n",
        {"q.src": KRL.format("XELSE")},
    ),
    "krl another file name": (
        "p.src",
        KRL.format("XP1"),
        "copy_of_p.dat",
        f"DEFDAT P\nDECL E6POS XP1={POINT}\nENDDAT\n",
        {"q.dat": "DEFDAT Q\nDECL E6POS XP1={X 1,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n"},
    ),
    "val3 data": (
        "start.pgx",
        PROGRAMS.format(name="start", code="movel(p,t,m)\nmovel(appro(p,{1,0,0,0,0,0}),t,m)"),
        "points.dtx",
        VAL3_DATA,
        {"note.txt": "x"},
    ),
}
OPENED = None


def _audit(event, arguments):
    if event == "open" and OPENED is not None and isinstance(arguments[0], (str, os.PathLike)):
        OPENED.append(os.fspath(arguments[0]))


sys.addaudithook(_audit)


def opened_in(folder, path):
    """The names of the files in ``folder`` that reading a program opens."""
    global OPENED
    OPENED = []
    try:
        read_program(path)
        return {os.path.basename(one) for one in OPENED if os.path.dirname(one) == str(folder)}
    finally:
        OPENED = None


def job_of(folder, name):
    job = {"schema": 1, "design": {"file": "a.step"}, "programs": [{"file": name}]}
    return validate(job, folder)


def sums(job):
    return {one["file"]: one["sha256"] for one in inputs.digests(job) if one["file"]}


@pytest.mark.parametrize("case", CASES)
def test_a_side_file_that_decides_a_pose_is_an_input(tmp_path, case):
    name, program, beside, content, idle = CASES[case]
    (tmp_path / name).write_text(program)
    for other, text in idle.items():
        (tmp_path / other).write_text(text)
    if case == "rapid listed":
        names = "".join(f"<Module>{one}</Module>" for one in (name, beside))
        (tmp_path / "p.pgf").write_text(f"<Program>{names}</Program>")
    (tmp_path / beside).write_text(content.format(x=5))
    job = job_of(tmp_path, name)
    before, poses = sums(job), read_program(tmp_path / name).path_arrays(9.0)["frames"]
    assert len(poses) == 2 and str(tmp_path / beside) in before
    (tmp_path / beside).write_text(content.format(x=6))
    after, moved = sums(job), read_program(tmp_path / name).path_arrays(9.0)["frames"]
    assert not np.array_equal(poses, moved)  # it decides
    assert {file for file in before if before[file] != after[file]} == {str(tmp_path / beside)}
    assert not {str(tmp_path / other) for other in idle} & set(after)
    assert ("p.pgf" in {os.path.basename(file) for file in after}) == (case == "rapid listed")
    assert set(map(str, inputs.files(job))) == set(after)


@pytest.mark.parametrize("case", CASES)
def test_nothing_is_read_that_is_no_input(tmp_path, case):
    """Lists of other modules are looked at, to see that they are none of this one's."""
    name, program, beside, content, idle = CASES[case]
    (tmp_path / name).write_text(program)
    (tmp_path / beside).write_text(content.format(x=5))
    looked_at = opened_in(tmp_path, tmp_path / name)
    assert {name, beside} <= looked_at
    assert looked_at <= {path.name for path in inputs.files(job_of(tmp_path, name))}


def test_a_module_that_joins_the_folder_is_a_new_input(tmp_path):
    (tmp_path / "a.mod").write_text(MODULE)
    job = job_of(tmp_path, "a.mod")
    assert str(tmp_path / "b.mod") not in sums(job)
    (tmp_path / "b.mod").write_text(DATA.format(x=5))
    assert sums(job)[str(tmp_path / "b.mod")]


def test_what_is_no_program_has_no_side_files(tmp_path):
    from beltgrinding.programs.registry import side_files

    for name in ("a.mod", "p.src", "s.pgx", "x.nc", "nothing"):
        assert side_files(tmp_path / name) == []
        assert side_files(tmp_path / "no" / "folder" / name) == []
    os.mkfifo(tmp_path / "b.mod")  # opening it would never end
    (tmp_path / "c.dat").mkdir()
    assert side_files(tmp_path / "p.src") == []
    assert sums(job_of(tmp_path, "a.mod"))[str(tmp_path / "b.mod")] is None
