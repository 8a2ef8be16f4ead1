"""What a person says of a program that only its controller knows: NAME.values.json."""

import json

import numpy as np
import pytest

from beltgrinding.base import frames, schemas
from beltgrinding.engine import InputError
from beltgrinding.job.inputs import digests, files
from beltgrinding.job.load import validate
from beltgrinding.job.poses import program_arrays
from beltgrinding.programs import given
from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import READERS, read_program

KEYS = ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg")
TOP, SIDE = (500, 100, 300, 0, 0, 0), (620, 40, 180, 90, 0, 30)


def frame(*six):
    return dict(zip(KEYS, six))


def matrix(six):
    return frames.from_abc(six[:3], six[3:])


def write(folder, name, text, **values):
    path = folder / name
    path.write_text(text)
    if values:
        (folder / f"{path.stem}.values.json").write_text(json.dumps(values))
    return path


def tp(*statements):
    rows = [f"{k:4}:{text} ;" for k, text in enumerate(statements, 1)]
    points = "".join(
        f"P[{n}]{{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {10 * n}.0 mm, Y = 5.0 mm, "
        "Z = 7.0 mm,\n\tW = 180.0 deg, P = 0.0 deg, R = 30.0 deg\n};\n"
        for n in (1, 2, 3)
    )
    return "\n".join(["/PROG P", "/MN", *rows, "/POS", points + "/END", ""])


def test_frames_that_are_given_bring_motions_into_one(tmp_path):
    text = tp(
        "UFRAME_NUM=1",
        "L P[1] 9mm/sec FINE",
        "L P[2] 9mm/sec FINE",
        "UFRAME_NUM=2",
        "L P[3] 9mm/sec FINE",
    )
    path = write(tmp_path, "p.ls", text)
    program = read_program(path)
    assert len(program.path_arrays(9.0)["frames"]) == 2 and program.problems
    path = write(tmp_path, "p.ls", text, bases={"UFRAME 1": frame(*TOP), "UFRAME 2": frame(*SIDE)})
    program = read_program(path)
    found = program.path_arrays(9.0)["frames"]
    assert not program.problems
    wanted = np.linalg.inv(matrix(TOP)) @ matrix(SIDE) @ program.motions[2].pose
    np.testing.assert_allclose(found[2], wanted, atol=1e-9)


def test_registers_and_offsets(tmp_path):
    text = tp(
        "L P[1] R[5]mm/sec FINE",
        "L P[1] 9mm/sec FINE Offset,PR[15]",
        "L P[1] 9mm/sec FINE Tool_Offset,PR[15:name]",
        "L PR[2] 9mm/sec FINE",
        "FOR R[1]=1 TO R[7]",
        "L P[2] 9mm/sec FINE",
        "ENDFOR",
    )
    offset = (0, 3, 4, 90, 0, 0)
    path = write(
        tmp_path,
        "p.ls",
        text,
        variables={"R[5]": 12.5, "pr[15]": frame(*offset), "PR[2]": frame(*SIDE), "R[7]": 3},
    )
    program = read_program(path)
    assert not program.problems
    first, base, tool, own = (m.pose for m in program.motions[:4])
    assert program.motions[0].speed_mm_s == 12.5
    np.testing.assert_allclose(base, matrix(offset) @ first, atol=1e-9)
    np.testing.assert_allclose(tool, first @ matrix(offset), atol=1e-9)
    np.testing.assert_allclose(own, matrix(SIDE), atol=1e-9)
    assert len(program.motions) == 7
    program = read_program(write(tmp_path, "q.ls", text))
    assert [m.kind for m in program.motions] == ["LIN", "GAP"]
    assert {"R[5]", "PR[15]", "PR[2]", "R[7]"} == set(program.asked)


def test_what_the_program_sets_is_not_taken_from_the_file(tmp_path):
    values = {"PR[15]": frame(1, 2, 3, 0, 0, 0), "R[5]": 50}
    text = tp("PR[15]=VR[5]", "L P[1] 9mm/sec FINE Offset,PR[15]", "L P[2] 9mm/sec FINE")
    program = read_program(write(tmp_path, "p.ls", text, variables=values))
    assert program.motions[0].pose is None
    assert any("set by the program" in str(p) and p.line == 4 for p in program.problems)
    text = tp("R[5]=8", "L P[1] R[5]mm/sec FINE")
    program = read_program(write(tmp_path, "q.ls", text, variables={"R[5]": 50}))
    assert program.motions[0].speed_mm_s == 8
    assert any("R[5]" in str(p) and p.file == "q.values.json" for p in program.problems)
    for text in (
        "C P[2] :P[3] 9mm/sec FINE Offset,PR[15]",
        "L P[1] 9mm/sec FINE INC Offset,PR[15]",
    ):
        program = read_program(write(tmp_path, "r.ls", tp(text), variables=values))
        assert program.motions[0].pose is None


def test_krl_variables_inputs_and_numbered_frames(tmp_path):
    text = (
        "DEF p()\n$VEL.CP=SPEED\nBAS(#BASE,1)\nLIN XP1\nLIN XP2\nBAS(#BASE,2)\nIF $IN[3] THEN\n"
        "LIN XP1\nENDIF\n$BASE=BASE_DATA[1]\nLIN {X HEIGHT,Y 0,Z 0}\nEND\n"
    )
    point = (1, 2, 3, 0, 0, 180)
    values = {
        "SPEED": 0.2, "xp1": frame(*point), "XP2": frame(*point), "Base_Data[1]": frame(*TOP),
        "BASE_DATA[2]": frame(*SIDE), "$IN[3]": True, "HEIGHT": 44,
    }  # fmt: skip
    program = read_program(write(tmp_path, "p.src", text, variables=values))
    poses = program.path_arrays(9.0)["frames"]
    assert not program.problems and len(poses) == 4
    np.testing.assert_allclose(poses[0], matrix(point), atol=1e-9)
    np.testing.assert_allclose(
        poses[2], np.linalg.inv(matrix(TOP)) @ matrix(SIDE) @ matrix(point), atol=1e-9
    )
    assert poses[3][0, 3] == 44 and program.motions[0].speed_mm_s == 200
    assert read_program(write(tmp_path, "q.src", text)).problems


def test_the_template_asks_for_what_is_missing_and_keeps_what_is_there(tmp_path):
    text = tp(
        "UFRAME_NUM=1",
        "L P[1] R[5]mm/sec FINE",
        "UFRAME_NUM=2",
        "L P[3] 9mm/sec FINE Offset,PR[4]",
        "L P[3] 9mm/sec FINE",
    )
    path = write(tmp_path, "p.ls", text)
    file, count = given.write_template(read_program(path), path)
    data = json.loads(file.read_text())
    assert count == 4 and set(data["bases"]) == {"UFRAME 1", "UFRAME 2"}
    assert data["variables"] == {"R[5]": None, "PR[4]": dict.fromkeys(KEYS)}
    before = [str(p) for p in read_program(path).problems]  # null gives nothing
    file.unlink()
    assert before == [str(p) for p in read_program(path).problems]
    file.write_text(json.dumps({"variables": {"r[5]": 20}}))
    given.write_template(read_program(path), path)
    data = json.loads(file.read_text())
    assert data["variables"] == {"r[5]": 20, "PR[4]": dict.fromkeys(KEYS)}


@pytest.mark.parametrize(
    "text, word",
    [
        ("{", "no JSON"),
        ("[]", "values"),
        ('{"base": {}}', "base"),
        ('{"bases": {"UFRAME 1": {"x_mm": 1}}}', "y_mm"),
        ('{"variables": {"R[5]": "12"}}', "R[5]"),
        ('{"variables": {"R[5]": 1, "r[5]": 2}}', "twice"),
        ('{"variables": {"R[5]": 1e300}}', "R[5]"),
        ('{"variables": {"R[5]": NaN}}', "NaN"),
        ("\xff\x00", ""),
    ],
)
def test_a_bad_file_is_refused_by_its_name_and_key(tmp_path, text, word):
    path = write(tmp_path, "p.ls", tp("L P[1] R[5]mm/sec FINE"))
    (tmp_path / "p.values.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(ProgramError) as error:
        read_program(path)
    assert "p.values.json" in str(error.value) and word in str(error.value)


def test_names_that_the_program_does_not_ask_for_are_told(tmp_path):
    path = write(
        tmp_path,
        "p.ls",
        tp("L P[1] 9mm/sec FINE"),
        bases={"UFRAME 9": frame(*TOP)},
        variables={"R[3]": 1},
    )
    (told,) = read_program(path).problems
    assert "UFRAME 9, R[3]" in str(told) and told.file == "p.values.json"


@pytest.mark.parametrize("suffix", sorted(READERS))
def test_every_language_takes_a_values_file(tmp_path, suffix):
    """Whatever the program: no crash, and names that it does not ask for are told."""
    path = write(tmp_path, f"p{suffix}", "nothing\n", tools={"T 77": frame(*TOP)})
    try:
        program = read_program(path)
    except ProgramError:
        return
    assert any("T 77" in str(problem) for problem in program.problems)


def test_changes_go_back_with_the_values_beside(tmp_path):
    text = tp("L P[1] 9mm/sec FINE Offset,PR[1]", "L P[2] 20mm/sec FINE")
    path = write(tmp_path, "p.ls", text, variables={"PR[1]": frame(0, 0, 9, 0, 0, 0)})
    assert patch(path, [{"index": 0, "speed_mm_s": 30.0}], tmp_path / "new.ls")
    assert "30" in (tmp_path / "new.ls").read_text()


def test_a_job_names_its_values_and_hashes_them(tmp_path):
    path = write(tmp_path, "p.src", "DEF p()\nLIN XP1\nEND\n")
    (tmp_path / "known.json").write_text(json.dumps({"variables": {"XP1": frame(*TOP)}}))
    job = {
        "schema": 1,
        "design": {"file": "a.step"},
        "programs": [{"file": "p.src", "values": "known.json"}],
    }
    job = validate(job, tmp_path)
    assert tmp_path / "known.json" in files(job)
    assert len(read_program(path, values=job["programs"][0]["values"]).motions) == 1
    with pytest.raises(ProgramError, match="elsewhere"):
        read_program(path, values=tmp_path / "elsewhere.json")


RAPID = """MODULE M
  VAR robtarget known := [[100,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num height;
  PROC main()
    height := AInput(ai1);
    MoveL known, vGrind, zGrind, tool0;
    MoveL pTaught, v100, fine, tool0;
    MoveL Offs(pTaught, 1, stepover, height), v100, zNone, tool0;
    MoveL RelTool(known, 0, 0, height), vmax, z10, tool0;
  ENDPROC
ENDMODULE
"""


def test_rapid_targets_numbers_speeds_and_zones(tmp_path):
    path = write(tmp_path, "p.mod", RAPID)
    program = read_program(path)
    asked = {
        "VGRIND": "number", "ZGRIND": "number", "ZNONE": "number", "VMAX": "number",
        "PTAUGHT": "frame", "HEIGHT": "number", "STEPOVER": "number",
    }  # fmt: skip
    assert [m.kind for m in program.motions] == ["LIN", "GAP"] and program.problems
    known = {
        "vGrind": 35, "zgrind": 2.5, "zNone": 0, "vmax": 1500,
        "pTaught": frame(10, 20, 30, 90, 0, 180), "height": 7, "stepover": -4,
    }  # fmt: skip
    program = read_program(write(tmp_path, "p.mod", RAPID, variables=known))
    assert program.asked == asked and not program.problems
    taught = matrix((10, 20, 30, 90, 0, 180))
    offset = taught.copy()
    offset[:3, 3] += (1, -4, 7)
    wanted = [matrix((100, 0, 0, 0, 0, 0)), taught, offset, matrix((100, 0, 7, 0, 0, 0))]
    np.testing.assert_allclose([m.pose for m in program.motions], wanted, atol=1e-9)
    assert [m.speed_mm_s for m in program.motions] == [35, 100, 100, 1500]
    assert [m.zone_mm for m in program.motions] == [2.5, 0, 0, 10]


def test_what_a_rapid_program_tells_is_not_taken_from_the_file(tmp_path):
    text = RAPID.replace("AInput(ai1)", "3").replace("pTaught", "known").replace("stepover", "2")
    path = write(tmp_path, "p.mod", text, variables={"height": 50, "known": frame(*TOP)})
    program = read_program(path)
    heights = [m.pose[2, 3] for m in program.motions]
    assert heights == [0, 0, 3, 3]
    assert any("HEIGHT, KNOWN" in str(p) and p.file == "p.values.json" for p in program.problems)


@pytest.mark.parametrize(
    "values, word",
    [
        ({"pTaught": 5}, "PTAUGHT"),
        ({"vGrind": frame(*TOP)}, "VGRIND"),
        ({"height": True}, "HEIGHT"),
    ],
)
def test_values_of_a_wrong_kind_are_refused(tmp_path, values, word):
    path = write(tmp_path, "p.mod", RAPID, variables=values)
    with pytest.raises(ProgramError) as error:
        read_program(path)
    assert "p.values.json" in str(error.value) and word in str(error.value)


def test_a_damaged_rapid_program_with_values_is_read_or_refused(tmp_path):
    known = {"vGrind": 35, "pTaught": frame(*TOP), "height": 7, "stepover": -4}
    write(tmp_path, "p.mod", RAPID, variables=known)
    draw = np.random.default_rng(18)
    for _ in range(200):
        damaged = bytearray(RAPID.encode())
        for _ in range(draw.integers(1, 4)):
            at = int(draw.integers(len(damaged)))
            damaged[at : at + int(draw.integers(0, 9))] = draw.bytes(int(draw.integers(0, 5)))
        (tmp_path / "p.mod").write_bytes(bytes(damaged))
        try:
            poses = read_program(tmp_path / "p.mod").path_arrays(9.0)["frames"]
        except ProgramError as error:
            assert "p." in str(error)
            continue
        assert np.isfinite(poses).all()


def inline(values):
    return {
        "schema": 1,
        "design": {"file": "a.step"},
        "programs": [{"file": "p.src", "values": values}],
    }


def test_a_job_may_hold_the_values_itself(tmp_path):
    beside = {"XP1": frame(*SIDE)}  # is not looked at then
    write(tmp_path, "p.src", "DEF p()\nLIN XP1\nLIN {X H}\nEND\n", variables=beside)
    job = validate(inline({"variables": {"xp1": frame(*TOP), "H": 7, "NONE": 1}}), tmp_path)
    assert files(job)[1:] == [tmp_path / "p.src"]  # the values are part of the job's own digest
    told = []
    arrays = program_arrays(job["programs"][0], "p", told)
    np.testing.assert_allclose(arrays["frames"][0], matrix(TOP), atol=1e-9)
    np.testing.assert_allclose(arrays["frames"][1][:3, 3], (7, *TOP[1:3]), atol=1e-9)
    assert [one for one in map(str, told) if "NONE" in one and one.startswith("p.src: values")]
    other = validate(inline({"variables": {"XP1": frame(*SIDE), "H": 7}}), tmp_path)
    assert digests(job)[0]["sha256"] != digests(other)[0]["sha256"]


@pytest.mark.parametrize(
    "values, word",
    [
        ({"base": {}}, "base"),
        ({"bases": {"UFRAME 1": {"x_mm": 1}}}, "bases.UFRAME 1"),
        ({"tools": {"T": frame(1e308, 0, 0, 0, 0, 0)}}, "tools.T.x_mm"),
        ({"variables": {"R[5]": "12"}}, "variables.R[5]"),
        ({"variables": {"R[5]": 1e300}}, "R[5]"),
        ({"variables": {"R[5]": 1, "r[5]": 2}}, "twice"),
    ],
)
def test_bad_values_in_a_job_are_refused_by_their_key(tmp_path, values, word):
    with pytest.raises(InputError) as error:
        validate(inline(values), tmp_path)
    assert "programs.0.values" in str(error.value) and word in str(error.value)


def test_values_of_a_wrong_kind_in_a_job_are_refused_by_their_program(tmp_path):
    write(tmp_path, "p.mod", RAPID)
    job = inline({"variables": {"height": True}})
    job["programs"][0]["file"] = "p.mod"
    with pytest.raises(InputError, match="p.mod: values: variables: HEIGHT"):
        program_arrays(validate(job, tmp_path)["programs"][0], "p", [])


def test_values_of_a_job_are_a_file_or_an_object(tmp_path):
    with pytest.raises(InputError, match="programs.0.values"):
        validate(inline([1]), tmp_path)


def test_the_schema_is_published():
    assert set(schemas.schema("values")["properties"]) == {"units", "bases", "tools", "variables"}


def test_a_damaged_file_is_refused_or_read_whatever_its_bytes(tmp_path):
    text = tp(
        "UFRAME_NUM=1", "L P[1] R[5]mm/sec FINE", "UFRAME_NUM=2", "L P[3] 9mm/sec FINE Offset,PR[4]"
    )
    path = write(tmp_path, "p.ls", text)
    whole = json.dumps(
        {"bases": {"UFRAME 1": frame(*TOP)}, "variables": {"R[5]": 2, "PR[4]": frame(*SIDE)}}
    ).encode()
    draw = np.random.default_rng(18)
    refused = 0
    for _ in range(300):
        damaged = bytearray(whole)
        for _ in range(draw.integers(1, 4)):
            at = int(draw.integers(len(damaged)))
            damaged[at : at + int(draw.integers(0, 9))] = draw.bytes(int(draw.integers(0, 5)))
        (tmp_path / "p.values.json").write_bytes(bytes(damaged))
        try:
            frames_ = read_program(path).path_arrays(9.0)["frames"]
            assert np.isfinite(frames_).all()
        except ProgramError as error:
            refused += 1
            assert "p.values.json" in str(error)
    assert refused > 100
