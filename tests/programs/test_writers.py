"""New programs: what is written reads back the same, in every language."""

import dataclasses
import os
import re
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.base import frames
from beltgrinding.base.messages import sentence
from beltgrinding.programs.program import Motion, ProgramError
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.writer import write_program
from beltgrinding.programs.writers.frames import frame_in_words
from beltgrinding.programs.writers.text import identifier
from support.cost import growth

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
LANGUAGES = [".src", ".mod", ".script"]
# What reading tells of a program that leaves its frames to the controller.
LEFT_OUT = {
    ".src": [],
    ".mod": ["programs.rapid.kept_as_programmed"] * 2,
    ".script": ["programs.urscript.ref_frame_elsewhere"],
    ".csv": [],
}


def problem_codes(program):
    return [problem.code for problem in program.problems]


def angle_deg(a, b):
    """From the chord of the matrices, exact for small angles."""
    return np.degrees(np.linalg.norm(a[:3, :3] - b[:3, :3]) / np.sqrt(2.0))


def assert_same(before, after, kinds=True):
    before = [m for m in before if m.pose is not None]
    after = [m for m in after if m.pose is not None]
    assert len(before) == len(after)
    for a, b in zip(before, after):
        assert np.abs(a.pose[:3, 3] - b.pose[:3, 3]).max() <= 1e-6
        assert angle_deg(a.pose, b.pose) <= 1e-6
        assert a.aux == b.aux
        assert a.kind == b.kind or (not kinds and (a.kind, b.kind) == ("SPL", "LIN"))
        if a.speed_mm_s is not None and a.kind != "PTP":
            assert b.speed_mm_s == pytest.approx(a.speed_mm_s, rel=1e-6)


def some_motions(rng, count, kinds=("PTP", "LIN", "CIRC", "SPL")):
    """Random motions all over the rotations, gimbal lock and half turns among them."""
    special = [(0, 90, 0), (30, -90, 20), (180, 0, 0), (0, 180, 0), (0, 0, 180), (0, 0, 0)]

    def pose():
        place = rng.uniform(-2000, 2000, 3)
        if rng.random() < 0.3:
            return frames.from_abc(place, special[rng.integers(len(special))])
        q = rng.normal(size=4)
        return frames.from_quaternion(place, q / np.linalg.norm(q))

    motions = [Motion("PTP", pose(), 0, "")]
    while len(motions) < count:
        kind = kinds[rng.integers(len(kinds))]
        speed = None if kind == "PTP" else float(rng.choice([100.0, 33.3, 0.125, 2500.0]))
        if kind == "CIRC":
            motions.append(Motion(kind, pose(), 0, "", speed, aux=True))
        motions.append(Motion(kind, pose(), 0, "", speed))
    return motions


@needs_shared
@pytest.mark.parametrize("suffix", LANGUAGES)
@pytest.mark.parametrize("name", SAME_PATH)
def test_real_paths_go_round(tmp_path, name, suffix):
    before = read_program(PROGRAMS / "same_path_crs_part5" / name)
    file = tmp_path / f"path{suffix}"
    write_program(file, None, before)
    after = read_program(file)
    assert problem_codes(after) == LEFT_OUT[suffix]
    assert_same(before.motions, after.motions, kinds=suffix == ".src")
    # The second time round nothing changes any more.
    write_program(tmp_path / f"again{suffix}", None, after, name="path")
    again = read_program(tmp_path / f"again{suffix}")
    assert_same(after.motions, again.motions)
    assert {m.base for m in after.motions} == {m.base for m in again.motions} or suffix == ".mod"
    rapid = [b.path_arrays(9.0)["rapid"] for b in (before, after)]
    np.testing.assert_array_equal(*rapid)


@pytest.mark.parametrize("suffix", LANGUAGES)
def test_generated_motions_go_round(tmp_path, suffix):
    for seed in range(4):
        motions = some_motions(np.random.default_rng(seed), 200)
        write_program(tmp_path / f"p{suffix}", None, motions)
        after = read_program(tmp_path / f"p{suffix}")
        assert problem_codes(after) == LEFT_OUT[suffix]
        assert_same(motions, after.motions, kinds=suffix == ".src")
        write_program(tmp_path / f"p{suffix}", None, motions, tools=np.eye(4), bases=np.eye(4))
        after = read_program(tmp_path / f"p{suffix}")
        assert not after.problems
        assert_same(motions, after.motions, kinds=suffix == ".src")


def test_poses_go_round_in_csv_with_forces(tmp_path):
    motions = some_motions(np.random.default_rng(5), 100, ("PTP", "LIN"))
    for k, motion in enumerate(motions):
        motion.force_N = [None, 30.0, 12.5][k % 3]
    write_program(tmp_path / "p.csv", None, motions)
    after = read_program(tmp_path / "p.csv").motions
    assert_same(motions, after)
    assert [m.force_N for m in after] == [m.force_N for m in motions]
    assert [m.speed_mm_s for m in after] == [m.speed_mm_s for m in motions]


def test_arcs_become_chords_in_csv(tmp_path):
    def at(angle):
        turn = np.radians(angle)
        return frames.from_abc((50 * np.cos(turn), 50 * np.sin(turn), 0), (angle, 0, 0))

    motions = [Motion("PTP", at(0), 0, "")]
    motions += [Motion("CIRC", at(a), 0, "", 10.0, aux=a == 45) for a in (45, 90)]
    write_program(tmp_path / "p.csv", None, motions)
    poses = read_program(tmp_path / "p.csv").path_arrays(9.0)["frames"]
    np.testing.assert_allclose(np.linalg.norm(poses[:, :2, 3], axis=1), 50.0, atol=2e-6)
    assert len(poses) > 20


@pytest.mark.parametrize("suffix", LANGUAGES)
def test_forces_are_comments(tmp_path, suffix):
    motions = [Motion("LIN", frames.from_abc((k, 0, 0), (0, 0, 0)), 0, "", 50.0) for k in range(4)]
    motions[1].force_N = motions[2].force_N = 30.0
    write_program(tmp_path / f"p{suffix}", None, motions)
    text = (tmp_path / f"p{suffix}").read_text()
    assert text.count("force 30 N") == 1 and text.count("force as set") == 1
    assert all(m.force_N is None for m in read_program(tmp_path / f"p{suffix}").motions)


def test_tools_and_bases_by_their_matrices(tmp_path):
    tool = frames.from_abc((10, 20, 300.5), (0, 90, 0))
    base = frames.from_abc((1500, -250, 420), (30, 0, 0))
    other = frames.from_abc((0, 0, 99), (0, 0, 0))
    motions = some_motions(np.random.default_rng(1), 6, ("LIN",))
    motions[3].tool = motions[4].tool = "finger"
    options = {"tools": {"": tool, "finger": other}, "bases": base}
    for suffix in LANGUAGES:
        write_program(tmp_path / f"p{suffix}", None, motions, **options)
        after = read_program(tmp_path / f"p{suffix}")
        assert not after.problems
        assert_same(motions, after.motions)
        for k, expected in ((0, tool), (3, other), (5, tool)):
            found = frame_in_words(after.motions[k].tool)
            np.testing.assert_allclose(found, expected, atol=2e-3 if suffix == ".script" else 1e-6)
        np.testing.assert_allclose(frame_in_words(after.motions[0].base), base, atol=2e-3)


SETS = re.compile(  # active code that sets a frame
    r"^\s*(?:\$(?:BASE|TOOL)\s*=|BAS\s*\(#(?:BASE|TOOL)|(?:PERS|VAR|CONST)\s|set_tcp|ref_frame\s*=)",
    re.M,
)
TOOL = frames.from_abc((10, 20, 300.5), (0, 90, 0))
BASE = frames.from_abc((1500, -250, 420.125), (30, 0, 0))
TOLD = {"tool": f"gripper {frames.in_words(TOOL)}", "base": f"table {frames.in_words(BASE)}"}


def told_motions(count=5):
    motions = some_motions(np.random.default_rng(8), count, ("LIN",))
    return [dataclasses.replace(m, **TOLD) for m in motions]


@pytest.mark.parametrize("suffix", [*LANGUAGES, ".csv"])
def test_no_frame_is_set_unasked(tmp_path, suffix):
    file = tmp_path / f"p{suffix}"
    for motions in (some_motions(np.random.default_rng(8), 5, ("LIN",)), told_motions()):
        notes = write_program(file, None, motions)
        text = file.read_text()
        assert not SETS.search(text), text
        assert not re.search(r"\b(?:tool0|wobj0)\b", text)
        assert problem_codes(read_program(file)) == LEFT_OUT[suffix]
        assert_same(motions, read_program(file).motions)
        assert len(notes) == (0 if suffix == ".csv" else 2)
        for note in notes:
            assert sentence(note, "de") != str(note)
    head = text[: text.index(SAYS_MOTION[suffix])]
    assert TOLD["tool"] in head and TOLD["base"] in head  # the numbers to be set are told


SAYS_MOTION = {".src": "\nPTP", ".mod": "MoveJ", ".script": "movej", ".csv": "\nx_mm"}
NUMBERS = {
    ".src": (
        ";   $TOOL={FRAME: X 10.000000,Y 20.000000,Z 300.500000,A 0.0000000,B 90.0000000,C 0.0000000}",
        ";   $BASE={FRAME: X 1500.000000,Y -250.000000,Z 420.125000,A 30.0000000,B 0.0000000,C 0.0000000}",
    ),
    ".mod": (
        "!   [[10.000000,20.000000,300.500000],[",
        "!   [[1500.000000,-250.000000,420.125000],[",
    ),
    ".script": (
        "#   set_tcp(p[0.010000000, 0.020000000,",
        "#   ref_frame = p[1.500000000, -0.250000000,",
    ),
}


@pytest.mark.parametrize("suffix", LANGUAGES)
def test_known_numbers_are_told_in_the_languages_own_form_and_set_if_asked_for(tmp_path, suffix):
    file = tmp_path / f"p{suffix}"
    write_program(file, None, told_motions())
    for line in NUMBERS[suffix]:
        assert line in file.read_text()
    assert not write_program(file, None, told_motions(), tools="as-known", bases="as-known")
    assert len(SETS.findall(file.read_text())) == 2
    program = read_program(file)
    assert not program.problems
    np.testing.assert_allclose(frame_in_words(program.motions[0].tool), TOOL, atol=1e-3)
    np.testing.assert_allclose(frame_in_words(program.motions[0].base), BASE, atol=1e-3)
    unknown = some_motions(np.random.default_rng(8), 3, ("LIN",))
    with pytest.raises(ProgramError, match="numbers of the tool are not known"):
        write_program(file, None, unknown, tools="as-known")


def test_frames_of_the_controller_are_set_by_name(tmp_path):
    motions = told_motions()
    assert not write_program(tmp_path / "p.src", None, motions, tools=3, bases="5")
    rows = (tmp_path / "p.src").read_text().splitlines()
    assert rows.count("BAS (#TOOL,3 )") == rows.count("BAS (#BASE,5 )") == 1
    assert rows.index("BAS (#BASE,5 )") > rows.index("BAS (#INITMOV,0 )")
    first = read_program(tmp_path / "p.src").motions[0]
    assert (first.tool, first.base) == ("TOOL_DATA[3]", "BASE_DATA[5]")

    notes = write_program(tmp_path / "p.mod", None, motions, tools="tGrind", bases="wobj0")
    text = (tmp_path / "p.mod").read_text()
    assert text.count("tGrind\\WObj:=wobj0;") == 5 and not SETS.search(text)
    assert [note.arguments["name"] for note in notes] == ["tGrind", "wobj0"]
    first = read_program(tmp_path / "p.mod").motions[0]
    assert first.tool == "tGrind" and first.base.startswith("wobj0")

    write_program(tmp_path / "p.csv", None, motions, tools="tGrind", bases=BASE)
    assert "# tool: tGrind (gripper X 10" in (tmp_path / "p.csv").read_text()

    for suffix, name, culprit in (
        (".src", "tGrind", "KRL's frames have numbers"),
        (".mod", "3", "no name of RAPID"),
        (".mod", "a;b", "no name of RAPID"),
        (".script", "Plane_1", "URScript sets its base by numbers"),
    ):
        (tmp_path / f"p{suffix}").unlink(missing_ok=True)
        with pytest.raises(ProgramError, match=culprit):
            write_program(tmp_path / f"p{suffix}", None, motions, bases=name)
        assert not (tmp_path / f"p{suffix}").exists()


def test_a_program_that_changes_frames_leaves_none_to_the_controller(tmp_path):
    """It has one frame in force: the poses in the other one would be ground in it."""
    for kind in ("tool", "base"):
        motions = told_motions()
        for motion in motions[3:]:
            setattr(motion, kind, "another")
        for suffix in (".src", ".script"):
            told = "changes between frames .*another"
            if (kind, suffix) == ("base", ".script"):  # written with one, if the other is known
                told = "where the base 'another' lies is not known"
            for given in (None, {TOLD[kind]: np.eye(4)}):
                with pytest.raises(ProgramError, match=told):
                    write_program(tmp_path / f"p{suffix}", None, motions, **{f"{kind}s": given})
        write_program(
            tmp_path / "p.src", None, motions, **{f"{kind}s": {TOLD[kind]: 1, "another": 2}}
        )
        found = [getattr(m, kind) for m in read_program(tmp_path / "p.src").motions]
        name = f"{kind}_data".upper()
        assert found == [f"{name}[1]"] * 3 + [f"{name}[2]"] * 2
        # So are frames that only the controller knows told apart when they are read.
        with pytest.raises(ProgramError, match="changes between frames"):
            write_program(tmp_path / "q.src", None, read_program(tmp_path / "p.src"))
        write_program(tmp_path / "p.mod", None, motions)
        found = [getattr(m, kind) for m in read_program(tmp_path / "p.mod").motions]
        name = {"tool": "tBelt", "base": "wPart"}[kind]
        assert found == [name] * 3 + [f"{name}_2"] * 2
        # A table has none: what cannot be brought into its frames is left out, and told.
        notes = write_program(tmp_path / "p.csv", None, motions)
        rows = (tmp_path / "p.csv").read_text().splitlines()
        assert len([row for row in rows if row[0] in "-0123456789"]) == 3
        assert "another" in str(notes[-1]) and any(
            "another" in row for row in rows if row[0] == "#"
        )


def test_a_part_in_the_hand_is_robhold(tmp_path):
    motions = some_motions(np.random.default_rng(2), 5, ("LIN",))
    numbers = {"tools": np.eye(4), "bases": np.eye(4)}
    write_program(tmp_path / "p.mod", None, motions, part_in_hand=True, **numbers)
    text = (tmp_path / "p.mod").read_text()
    assert "tooldata tool_1:=[FALSE," in text and "wobjdata wobj_1:=[TRUE," in text
    program = read_program(tmp_path / "p.mod")
    assert not program.problems
    assert program.motions[0].base.endswith("held by the robot")
    known = {"tools": "as-known", "bases": "as-known"}
    write_program(tmp_path / "q.mod", None, program, **known)  # told by the words of its frames
    assert "wobjdata wobj_1:=[TRUE," in (tmp_path / "q.mod").read_text()
    write_program(tmp_path / "r.mod", None, program)
    text = (tmp_path / "r.mod").read_text()
    assert "this tooldata, robhold FALSE" in text and "this wobjdata, robhold TRUE" in text
    for suffix in (".src", ".script"):
        with pytest.raises(ProgramError, match="robhold"):
            write_program(tmp_path / f"p{suffix}", None, program)


@pytest.mark.parametrize("suffix", LANGUAGES)
def test_over_a_gap_nothing_is_ground(tmp_path, suffix):
    motions = some_motions(np.random.default_rng(3), 4, ("LIN",))
    motions.insert(2, Motion("PTP", None, 17, "x"))
    write_program(tmp_path / f"p{suffix}", None, motions)
    after = read_program(tmp_path / f"p{suffix}")
    assert [m.kind for m in after.motions] == ["PTP", "LIN", "PTP", "LIN"]
    assert "no pose is known for line 17" in (tmp_path / f"p{suffix}").read_text()
    arc = some_motions(np.random.default_rng(3), 3, ("CIRC",))
    arc.insert(2, Motion("PTP", None, 17, "x"))  # between the auxiliary point and the end
    write_program(tmp_path / f"p{suffix}", None, arc)
    assert read_program(tmp_path / f"p{suffix}").motions[1].kind == "PTP"


@pytest.mark.parametrize("turn", ["path", "hold path"])
@pytest.mark.parametrize("suffix", [".src", ".mod", ".script", ".csv"])
def test_an_arc_whose_auxiliary_point_is_not_known_is_left_out(tmp_path, suffix, turn):
    start, end = np.eye(4), np.eye(4)
    end[0, 3] = 10.0
    write_program(
        tmp_path / f"p{suffix}",
        None,
        [
            Motion("PTP", start, 1, "p"),
            Motion("CIRC", None, 2, "p", aux=True, turn=turn),
            Motion("CIRC", end, 2, "p", 10.0, turn=turn),
        ],
    )
    assert "no pose is known for line 2" in (tmp_path / f"p{suffix}").read_text()
    read = read_program(tmp_path / f"p{suffix}")
    assert [m.kind for m in read.motions if m.pose is not None] == ["PTP", "PTP"]


def test_splines_speeds_and_blends(tmp_path):
    at = [frames.from_abc((10.0 * k, 0, 0), (0, 0, 0)) for k in range(6)]
    kinds = ["PTP", "SPL", "SPL", "SPL", "LIN", "LIN"]
    feeds = [None, 50.0, 50.0, 80.0, 50.0, 60.0]
    motions = [Motion(k, p, 0, "", v) for k, p, v in zip(kinds, at, feeds)]
    write_program(tmp_path / "p.src", None, motions, blend_mm=2.0, comment="näïve\r\nDEF x()")
    data = (tmp_path / "p.src").read_bytes()
    assert data.count(b"\n") == data.count(b"\r\n") and data.isascii()
    rows = data.decode().splitlines()
    assert "&COMMENT n??ve DEF x()" in rows and "$APO.CDIS=2" in rows
    assert sum(row.startswith("SPLINE") for row in rows) == 1
    assert [row for row in rows if "WITH $VEL.CP=0.08" in row][0].startswith("SPL {X 30")
    assert sum(row.startswith("$VEL.CP") for row in rows) == 2
    assert [m.speed_mm_s for m in read_program(tmp_path / "p.src").motions] == feeds
    write_program(tmp_path / "p.mod", None, motions, blend_mm=7.0)
    text = (tmp_path / "p.mod").read_text()
    assert text.count(",z5,") == 5 and text.count(",fine,") == 1
    write_program(tmp_path / "p.script", None, motions, blend_mm=7.0)
    text = (tmp_path / "p.script").read_text()
    assert text.count("r=0.004)") == 4 and text.count("r=0.0)") == 1  # never to the middle


@pytest.mark.parametrize(
    "change, culprit",
    [
        (lambda m: m[1].pose.__setitem__((0, 0), 5.0), "pose 1: its matrix is no rotation"),
        (lambda m: m[1].pose.__setitem__((0, 3), np.nan), "not finite"),
        (lambda m: setattr(m[1], "speed_mm_s", -1.0), "motion 1: the speed is -1"),
        (lambda m: setattr(m[1], "kind", "CIRC"), "motion 1: the arc has no auxiliary"),
        (lambda m: m.clear(), "no pose"),
    ],
)
def test_what_cannot_be_written_is_named(tmp_path, change, culprit):
    motions = some_motions(np.random.default_rng(1), 3, ("LIN",))
    change(motions)
    for suffix in LANGUAGES:
        with pytest.raises(ProgramError, match=culprit):
            write_program(tmp_path / f"p{suffix}", None, motions)
        assert not (tmp_path / f"p{suffix}").exists()


def test_names_and_languages(tmp_path):
    motions = some_motions(np.random.default_rng(1), 3, ("LIN",))
    for name in ("1st", "a-b", "a" * 25):
        with pytest.raises(ProgramError, match="no name of a KRL module"):
            write_program(tmp_path / f"{name}.src", None, motions)
    write_program(tmp_path / "1st part.mod", None, motions)
    assert (tmp_path / "1st part.mod").read_text().startswith("MODULE p_1st_part\n")
    assert len(identifier("x" * 90, 32)) == 32
    with pytest.raises(ProgramError, match="no program is written as '.as'"):
        write_program(tmp_path / "p.as", None, motions)
    write_program(tmp_path / "p.txt", ".src", motions)
    assert "DEF p ( )" in (tmp_path / "p.txt").read_text()


@pytest.mark.parametrize("suffix", [*LANGUAGES, ".csv"])
def test_the_time_of_writing_goes_with_the_number_of_poses(tmp_path, suffix):
    def work(n):
        poses = np.tile(np.eye(4), (n, 1, 1))
        poses[:, 0, 3] = np.arange(n) * 0.5
        write_program(tmp_path / f"p{suffix}", None, [{"poses": poses, "feed_mm_s": 40.0}])

    assert growth(work, 3000) < 3


def test_convert_from_the_command_line(tmp_path, capsys):
    motions = some_motions(np.random.default_rng(1), 5, ("LIN",))
    write_program(tmp_path / "p.src", None, motions)
    new = tmp_path / "p.mod"
    assert cli.main(["program", "convert", str(tmp_path / "p.src"), "-o", str(new)]) == 0
    assert_same(motions, read_program(new).motions)
    told = capsys.readouterr().err
    assert "uses tBelt, which it does not declare" in told and "uses wPart" in told
    again = ["--language", "de", "program", "convert", str(new), "--base", "4"]
    assert cli.main([*again, "-o", str(tmp_path / "q.src")]) == 0
    text = (tmp_path / "q.src").read_text()
    assert "BAS (#BASE,4 )" in text and "; $TOOL is not set" in text
    told = capsys.readouterr().err
    assert "das Programm setzt kein Werkzeug" in told and "Basis" not in told
    numbers = ["--tool", "0,0,120.5,0,90,0", "--base=-5,0,0,0,0,0", "--force"]
    assert cli.main(["program", "convert", str(new), "-o", str(tmp_path / "q.src"), *numbers]) == 0
    first = read_program(tmp_path / "q.src").motions[0]
    assert first.tool == "X 0 Y 0 Z 120.5 A 0 B 90 C 0" and first.base.startswith("X -5 ")
    assert capsys.readouterr().err == "note: read 5 of 5 motions\n"
    assert cli.main(["program", "convert", str(new), "-o", str(new) + "x", "--tool", "1,2"]) == 2
    assert "--tool 1,2:" in capsys.readouterr().err
    assert cli.main(["program", str(new), "--tool", "3"]) == 2
    assert "--tool" in capsys.readouterr().err
    assert cli.main(["program", "convert", str(new), "-o", str(tmp_path / "p.xyz")]) == 2
    assert "no program is written as '.xyz'" in capsys.readouterr().err


@pytest.mark.parametrize(
    "suffix, set_there",
    [
        (
            ".src",
            ["$ACC.CP=0.9", "$ACC.ORI1=250", "$ACC.ORI2=250", "$VEL.ORI1=120.5", "$VEL.ORI2=120.5"],
        ),
        (".mod", ["PathAccLim TRUE\\AccMax:=0.9,TRUE\\DecelMax:=0.9;", "[50,120.5,5000,1000]"]),
        (".script", ["a=0.9, v=0.05"]),
    ],
)
def test_the_accelerations_that_feeds_count_on_are_set(tmp_path, suffix, set_there):
    motions = [dataclasses.replace(m, speed_mm_s=50.0) for m in told_motions()]
    write_program(tmp_path / f"a{suffix}", None, motions, pace=(900.0, 250.0, 120.5))
    text = (tmp_path / f"a{suffix}").read_text()
    assert not [one for one in set_there if one not in text]
    write_program(tmp_path / f"b{suffix}", None, motions)
    assert not [one for one in set_there if one in (tmp_path / f"b{suffix}").read_text()]
    set_and_not = [read_program(tmp_path / f"{name}{suffix}") for name in "ab"]
    assert_same(*(one.motions for one in set_and_not))
    assert problem_codes(set_and_not[0]) == problem_codes(set_and_not[1])


def test_external_axes_at_zero_are_none_and_others_are_refused(tmp_path):
    motions = some_motions(np.random.default_rng(0), 5)
    still = [dataclasses.replace(one, external=(0.0, 0.0)) for one in motions]
    write_program(tmp_path / "still.script", None, still)
    away = [*still[:-1], dataclasses.replace(still[-1], external=(500.0,))]
    with pytest.raises(ProgramError, match="external axes are written as"):
        write_program(tmp_path / "away.script", None, away)
    write_program(tmp_path / "away.src", None, away)
    assert "E1 500" in (tmp_path / "away.src").read_text()
