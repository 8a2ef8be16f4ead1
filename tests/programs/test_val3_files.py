"""VAL3's files of s6 and before, and user types, by applications of our own in the form that public ones have."""

import random
import re

import numpy as np
import pytest

from beltgrinding.programs.languages.side_files import side_files
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import read_program

PROGRAM = """<?xml version="1.0" encoding="iso-8859-1" ?>
<programList xmlns="ProgramNameSpace" >
  <program name="{name}" public="false" >
    <description />
    <paramSection>{parameters}</paramSection>
    <localSection>
      <local name="k" type="num" size="1" />
    </localSection>
    <source>
      <code>begin
{code}
end
      </code>
    </source>
  </program>
</programList>"""
DATA = """<?xml version="1.0" encoding="iso-8859-1" ?>
<dataList xmlns="DataNameSpace" >
  <aioSection />
  <boolSection><bool name="go" public="false"><valueBool index="0" value="true" /></bool></boolSection>
  <frameSection>
    <frame name="world" public="false" privilege="0" >
      <fFather alias="" name="" fatherIndex="0" />
      <valueFrame index="0" ><tfValue x="0" y="0" z="0" rx="0" ry="0" rz="0" /></valueFrame>
    </frame>
    <frame name="table" public="false" privilege="0" >
      <fFather alias="" name="world" fatherIndex="0" />
      <valueFrame index="0" ><tfValue x="100" y="0" z="0" rx="0" ry="0" rz="90" /></valueFrame>
    </frame>
  </frameSection>
  <jointSection>
    <joint name="home" public="false"><valueJoint index="0" >
      <jointValue j1="1" j2="2" j3="3" j4="4" j5="5" j6="6" /></valueJoint></joint>
  </jointSection>
  <mdescSection>
    <mdesc name="slow" public="true"><valueMdesc index="0" >
      <mdescValue accel="100" vel="100" decel="100" tmax="20" rmax="99" blend="off" leave="50" reach="50" />
    </valueMdesc></mdesc>
  </mdescSection>
  <numSection><num name="step" size="2"><valueNum index="0" value="7"/><valueNum index="1" value="8"/></num></numSection>
  <pointSection>
    <point name="p" public="false" privilege="0" >
      <pFather alias="" name="table" fatherIndex="0" />
      <valuePoint index="0" ><tpValue x="10" y="20" z="30" rx="0" ry="0" rz="0" />
        <cpValue shoulder="ssame" elbow="esame" wrist="wsame"/></valuePoint>
      <valuePoint index="1" ><tpValue x="11" y="20" z="30" rx="90" ry="0" rz="0" /></valuePoint>
    </point>
    <point name="far" public="false"><pFather alias="lib" name="part" fatherIndex="0" />
      <valuePoint index="0" ><tpValue x="1" y="2" z="3" rx="0" ry="0" rz="0" /></valuePoint></point>
  </pointSection>
  <toolSection>
    <tool name="flange" public="false" privilege="0" >
      <tFather alias="" name="" fatherIndex="0" />
      <valueTool index="0" ><ttValue x="0" y="0" z="0" rx="0" ry="0" rz="0" />
        <io alias="io" name="valve1" ioIndex="0" open="0" close="0" /></valueTool>
    </tool>
    <tool name="belt" public="false" privilege="0" >
      <tFather alias="" name="flange" fatherIndex="0" />
      <valueTool index="0" ><ttValue x="0" y="0" z="150" rx="0" ry="0" rz="0" />
        <io alias="io" name="valve1" ioIndex="0" open="0" close="0" /></valueTool>
    </tool>
  </toolSection>
</dataList>"""
PROJECT = """<?xml version="1.0" encoding="iso-8859-1" ?>
<project xmlns="ProjectNameSpace" >
  <parameters version="s6.4.2" stackSize="5000" millimeterUnit="true" />
  <programSection><program file="start.pgx" /></programSection>
  <dataSection><data file="blade.dtx" /></dataSection>
  <aliasSection><alias name="io" interface="io" autoload="true" /></aliasSection>
</project>"""


def s6(folder, code, more=(), unit="true"):
    (folder / "start.pgx").write_text(PROGRAM.format(name="start", parameters="", code=code))
    for name, parameters, text in more:
        text = PROGRAM.format(name=name, parameters=parameters, code=text)
        (folder / f"{name}.pgx").write_text(text)
    (folder / "blade.dtx").write_text(DATA)
    (folder / "blade.pjx").write_text(PROJECT.replace('Unit="true"', f'Unit="{unit}"'))
    return read_program(folder / "start.pgx")


def places(program):
    return [m.pose[:3, 3].round(6).tolist() for m in program.motions if m.pose is not None]


def test_an_application_of_s6(tmp_path):
    program = s6(
        tmp_path,
        "movej(home, belt, slow)\nmovel(p[0], belt, slow)\nmovel(p[1], belt, slow)\nif go and step[1]&gt;step[0]\n"
        "  movel(appro(p[0], {0,0,-step[0],0,0,0}), flange, slow)\nendIf",
    )
    assert not program.problems
    assert [(m.kind, m.line) for m in program.motions] == [
        ("PTP", 11),
        ("LIN", 12),
        ("LIN", 13),
        ("LIN", 15),
    ]
    assert places(program) == [[10, 20, 30], [11, 20, 30], [10, 20, 23]]
    turn = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # Rx(90)
    np.testing.assert_allclose(program.motions[2].pose[:3, :3], turn, atol=1e-9)
    assert program.motions[1].base.startswith("table ") and program.motions[1].speed_mm_s == 20
    base = program.base_frames[program.motions[1].base]
    np.testing.assert_allclose(base[:3], [[0, -1, 0, 100], [1, 0, 0, 0], [0, 0, 1, 0]], atol=1e-9)
    tool = program.tool_frames[program.motions[1].tool]
    np.testing.assert_allclose(tool[:3, 3], [0, 0, 150])
    assert program.motions[0].pose is None


def test_s6_calls_with_parameters_by_value_and_by_reference(tmp_path):
    head = '<param name="x" type="num" byVal="true" /><param name="y" type="num" byVal="false" />'
    program = s6(
        tmp_path,
        "k=1\ncall add(5, k)\nmovel(appro(p[0], {k,0,0,0,0,0}), belt, slow)",
        [("add", head, "y=y+x\nx=99")],
    )
    assert not program.problems and places(program) == [[16, 20, 30]]


def test_s6_in_inches(tmp_path):
    program = s6(tmp_path, "movel(p[0], belt, slow)", unit="false")
    np.testing.assert_allclose(places(program), [[254, 508, 762]])


@pytest.mark.parametrize(
    "code, culprit",
    [
        ("movel(far, belt, slow)", "frame"),
        ("movel(nowhere, belt, slow)", "nowhere"),
        ("movel(p[2], belt, slow)", "no element 2"),
        ("movec(p[0], step[0], belt, slow)", "no point"),
        ("movec(step[0], p[0], belt, slow)", "no point"),
    ],
)
def test_what_s6_does_not_tell_is_left_out(tmp_path, code, culprit):
    program = s6(tmp_path, code)
    assert program.lost == 1 and any(culprit in str(problem) for problem in program.problems)


def test_points_of_s6_data_without_a_program(tmp_path):
    (tmp_path / "blade.dtx").write_text(DATA)
    program = read_program(tmp_path / "blade.dtx")
    assert places(program) == [[10, 20, 30], [11, 20, 30]] and program.lost == 1


# User types: a type is a project whose public data are its fields.
APPLICATION = """<Database xmlns:xsi="x"><Datas>
  <Data name="pass" access="public" xsi:type="array" type="Pass" size="2">
    <Value key="0">
      <Field name="at" xsi:type="array" type="pointRx" size="2">
        <Value key="0" x="1" fatherId="table[0]"/><Value key="1" x="2" fatherId="table[0]"/></Field>
      <Field name="how" xsi:type="array" type="Speed" size="1">
        <Value key="0"><Field name="m" xsi:type="array" type="mdesc" size="1"><Value key="0" tmax="30"/></Field>
        </Value></Field>
      <Field name="count" xsi:type="array" type="num" size="1"><Value key="0" value="2"/></Field>
    </Value>
    <Value key="1">
      <Field name="at" xsi:type="array" type="pointRx" size="2">
        <Value key="0" x="5" fatherId="table[0]"/></Field>
    </Value>
  </Data>
  <Data name="table" xsi:type="array" type="frame" size="1"><Value key="0" z="100" fatherId="world[0]"/></Data>
  <Data name="slow" xsi:type="array" type="mdesc" size="1"><Value key="0" tmax="20"/></Data>
</Datas></Database>"""
TYPES = {
    "Pass": """<Datas><Data name="at" access="public" xsi:type="array" type="pointRx" size="2"/>
      <Data name="how" access="public" xsi:type="array" type="Speed" size="1"/>
      <Data name="hidden" access="private" xsi:type="array" type="num" size="1"/>
      <Data name="count" access="public" xsi:type="array" type="num" size="1"><Value key="0" value="4"/></Data>
    </Datas>""",
    "Speed": """<Datas><Data name="m" access="public" xsi:type="array" type="mdesc" size="1">
      <Value key="0" tmax="45"/></Data></Datas>""",
}


def typed(folder, code, types=("Pass", "Speed")):
    home = folder / "app"
    home.mkdir(exist_ok=True)
    listed = '<Types><Type name="Pass" path="Disk://types/Pass/Pass.pjx"/></Types>'
    (home / "app.pjx").write_text(
        f'<Project><Database><Data file="app.dtx"/></Database>{listed}</Project>'
    )
    (home / "app.dtx").write_text(APPLICATION)
    (home / "start.pgx").write_text(
        f'<Programs><Program name="start"><Locals><Local name="k" type="num" size="1"/>'
        f'<Local name="own" type="Pass" size="1"/></Locals><Code><![CDATA[begin\n{code}\nend]]></Code></Program>'
        f"</Programs>"
    )
    for name in types:
        (folder / "types" / name).mkdir(parents=True, exist_ok=True)
        other = '<Types><Type name="Speed" path="Disk://types/Speed/Speed.pjx"/></Types>'
        (folder / "types" / name / f"{name}.pjx").write_text(f"<Project>{other}</Project>")
        (folder / "types" / name / f"{name}.dtx").write_text(
            f'<Database xmlns:xsi="x">{TYPES[name]}</Database>'
        )
    return read_program(home / "start.pgx")


def test_fields_of_user_types_are_read_and_assigned(tmp_path):
    program = typed(
        tmp_path,
        "for k=0 to pass[0].count-1\n  movel(pass[0].at[k], flange, pass[0].how.m)\nendFor\n"
        "movel(pass[1].at, flange, pass[1].how.m)\n"
        "pass[1].at[1]=pass[0].at[0]\npass[1].at[1].trsf.y=9\nmovel(pass[1].at[1], flange, slow)\n"
        "movel(pass[0].at[0], flange, slow)\n",
    )
    assert not program.problems
    assert places(program) == [[1, 0, 0], [2, 0, 0], [5, 0, 0], [1, 9, 0], [1, 0, 0]]
    # The second has no Field of it: the type's own value.
    assert [m.speed_mm_s for m in program.motions] == [30, 30, 45, 20, 20]
    assert all(m.base.startswith("table X 0 Y 0 Z 100") for m in program.motions)


def test_a_user_types_own_values_and_copies(tmp_path):
    program = typed(
        tmp_path,
        "k=own.count\nown.at[0]=pass[0].at[1]\nown.at[0].trsf.z=k\nmovel(own.at[0], flange, own.how.m)\n"
        "pass[1]=pass[0]\npass[1].at[0].trsf.x=50\n"
        "movel(pass[1].at[0], flange, slow)\nmovel(pass[0].at[0], flange, slow)",
    )
    assert not program.problems
    assert places(program) == [[2, 0, 4], [50, 0, 0], [1, 0, 0]]


def test_a_type_that_is_not_here_has_what_the_data_say(tmp_path):
    program = typed(
        tmp_path,
        "movel(pass[0].at[0], flange, pass[0].how.m)\nmovel(own.at[0], flange, slow)",
        types=(),
    )
    assert places(program) == [[1, 0, 0]] and program.lost == 1
    assert "Pass" in str(program.problems[0])


@pytest.mark.parametrize(
    "code, culprit",
    [
        ("movel(pass[0].at[2], flange, slow)", "no element 2"),
        ("movel(pass[0].nothing, flange, slow)", "no field nothing"),
        ("movel(pass[0].at.trsf[1], flange, slow)", "index"),
        ("pass[0].count=dioGet(x)\nmovel(pass[0].at[pass[0].count], flange, slow)", "controller"),
        ("foreign(pass[0].at[0])\nmovel(pass[0].at[0], flange, slow)", "not known"),
        ("pass[0].nothing=1\nmovel(pass[0].at[0], flange, slow)", None),
    ],
)
def test_what_is_wrong_with_a_field_is_told(tmp_path, code, culprit):
    program = typed(tmp_path, code)
    if culprit is None:
        assert program.motions
        return
    assert program.lost == 1
    assert any(culprit in str(problem) for problem in program.problems), program.problems


@pytest.mark.parametrize("data", [APPLICATION, None])
def test_what_is_wrong_in_a_types_file_names_that_file(tmp_path, data):
    files = tmp_path / "types" / "Pass" / "Pass.dtx", tmp_path / "app" / "app.dtx"
    typed(tmp_path, "movel(own.at[0], flange, own.how.m)")
    point = 'type="pointRx" size="2">\n<Value key="0" x="damaged"/></Data>'
    files[0].write_text(files[0].read_text().replace('type="pointRx" size="2"/>', point))
    if data is None:
        files[1].unlink()
    program = read_program(tmp_path / "app" / "start.pgx")
    told = [str(problem) for problem in program.problems]
    assert any("Pass.dtx:2: x='damaged' is no number" in text for text in told), told


def test_arrays_in_user_types_go_to_programs_by_reference(tmp_path):
    home = tmp_path / "app"
    home.mkdir()
    (home / "shift.pgx").write_text(
        '<Programs><Program name="shift"><Parameters><Parameter name="x" type="pointRx" use="reference"/>'
        "</Parameters><Code><![CDATA[begin\nx[0].trsf.y=3\nx[1].trsf.y=4\nend]]></Code></Program></Programs>"
    )
    code = "call shift(pass[0].at)\nmovel(pass[0].at[0], flange, slow)\nmovel(pass[0].at[1], flange, slow)"
    program = typed(tmp_path, code)
    assert not program.problems and places(program) == [[1, 3, 0], [2, 4, 0]]


def test_the_files_of_types_belong_to_the_program(tmp_path):
    typed(tmp_path, "k=1")
    names = [path.name for path in side_files(tmp_path / "app" / "start.pgx")]
    assert {"Pass.dtx", "Pass.pjx", "Speed.dtx", "app.dtx", "app.pjx"} <= set(names)


def test_a_type_of_itself_and_one_without_end_are_refused(tmp_path, monkeypatch):
    own = '<Datas><Data name="at" access="public" xsi:type="array" type="Pass" size="900000"/></Datas>'
    monkeypatch.setitem(TYPES, "Pass", own)
    program = typed(tmp_path, "own.at[1].at[2].at[0]=1\nmovel(own.at[3].at[0].at[1], flange, slow)")
    assert program.lost == 1 and program.problems


def test_damaged_files_of_s6_and_types_never_crash(tmp_path):
    s6(tmp_path, "movel(p[0], belt, slow)")
    typed(tmp_path, "movel(pass[0].at[0], flange, pass[0].how.m)")
    dice = random.Random(3)
    files = [tmp_path / "blade.dtx", tmp_path / "start.pgx", tmp_path / "app" / "app.dtx"]
    files += [tmp_path / "types" / "Pass" / "Pass.dtx", tmp_path / "blade.pjx"]
    for file in files:
        whole = file.read_text()
        for _ in range(60):
            at = dice.randrange(len(whole))
            word = dice.choice(re.findall(r"[\w\"<>/=]+", whole))
            file.write_text(whole[:at] + word + whole[at + dice.randrange(9) :])
            for start in (tmp_path / "start.pgx", tmp_path / "app" / "start.pgx"):
                try:
                    read_program(start)
                except ProgramError:
                    pass
        file.write_text(whole)
