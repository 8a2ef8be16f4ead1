"""Files of foreign formats: whatever they hold and whatever they are, this process goes on, within limits,
and nothing of them is left for the next one."""

import hashlib
import os
import shutil
import stat
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from support.freecad import ROOT, SHARED

from beltgrinding.engine import Cancelled, InputError, core

PROGRAM = "BELTGRINDING_CAD_READER"
TIME = "BELTGRINDING_CAD_TIME_LIMIT_S"
MEMORY = "BELTGRINDING_CAD_MEMORY_LIMIT_MB"
ANSWER = "BELTGRINDING_CAD_ANSWER_LIMIT_MB"
CUBE = [[x, y, z] for x in (0, 40) for y in (0, 20) for z in (0, 10)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [t for a, b, c, d in SIDES for t in ((a, b, c), (a, c, d))]
OFF = (
    "OFF\n8 12 0\n"
    + "".join("%d %d %d\n" % tuple(p) for p in CUBE)
    + "".join("3 %d %d %d\n" % t for t in TRIANGLES)
)
MODEL = "3D/3dmodel.model"
TYPES = (
    '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
RELATIONS = (
    '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)


def cube():
    return core.TriangleMesh(np.array(CUBE, np.float32), np.array(TRIANGLES, np.uint32))


def write_3mf(path, vertices, triangles):
    model = (
        '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/'
        'core/2015/02"><resources><object id="1" type="model"><mesh><vertices>'
        + vertices
        + "</vertices><triangles>"
        + triangles
        + '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>'
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        package.writestr("[Content_Types].xml", TYPES)
        package.writestr("_rels/.rels", RELATIONS)
        package.writestr(MODEL, model)


def write(path):
    """A sound file of the suffix's format."""
    if path.suffix == ".off":
        path.write_text(OFF)
    elif path.suffix == ".obj":
        lines = ["v %d %d %d" % tuple(p) for p in CUBE]
        path.write_text(
            "\n".join(lines + ["f %d %d %d" % (a + 1, b + 1, c + 1) for a, b, c in TRIANGLES])
        )
    elif path.suffix == ".stl":
        text = "".join(
            "facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n"
            % "".join("vertex %d %d %d\n" % tuple(CUBE[i]) for i in t)
            for t in TRIANGLES
        )
        path.write_text(f"solid x\n{text}endsolid x\n")
    elif path.suffix == ".3mf":
        vertices = "".join('<vertex x="%d" y="%d" z="%d"/>' % tuple(p) for p in CUBE)
        write_3mf(
            path, vertices, "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % t for t in TRIANGLES)
        )
    else:
        path.write_text(core.shape_from_mesh(cube()).write_brep())
    return path


SHAPES = (".brep", ".step", ".iges")
MESHES = (".off", ".obj", ".stl", ".3mf")


def read(path):
    """Shape or mesh, by the suffix."""
    if path.suffix in (*SHAPES, ".stp", ".igs"):
        return core.Shape.read(str(path))
    return core.read_mesh(str(path))


def refused(path, code=None):
    with pytest.raises(InputError) as error:
        read(path)
    text = str(error.value)
    assert str(path) in text and "\n" not in text
    assert code is None or error.value.code == code, text
    return text


@pytest.fixture
def stand_in(tmp_path, monkeypatch):
    """stand_in(text): a script takes the reader's place."""

    def put(text):
        path = tmp_path / "reader"
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv(PROGRAM, str(path))

    return put


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A mesh and a shape."""
    folder = tmp_path_factory.mktemp("sound")
    return write(folder / "cube.off"), write(folder / "cube.brep")


@pytest.fixture
def afterwards(sound, monkeypatch):
    """Whatever a test does, a good file of each kind is read after it as if nothing had been."""
    yield
    monkeypatch.undo()
    assert len(core.read_mesh(str(sound[0])).triangles) == 12
    assert core.Shape.read(str(sound[1])).face_count == 6


# --- damaged ones


@pytest.mark.parametrize("suffix", MESHES)
def test_a_sound_mesh_is_read(tmp_path, suffix):
    mesh = read(write(tmp_path / f"cube{suffix}"))
    found = sorted(map(tuple, np.asarray(mesh.vertices)[np.asarray(mesh.triangles)].mean(axis=1)))
    there = sorted(map(tuple, np.array(CUBE, np.float32)[np.array(TRIANGLES)].mean(axis=1)))
    np.testing.assert_allclose(found, there, atol=1e-5)


@pytest.mark.usefixtures("afterwards")
def test_an_assertion_of_a_library_is_an_error(tmp_path):
    """Fewer vertices than the file says: assimp gives up by an assertion."""
    lines = OFF.splitlines(keepends=True)
    path = tmp_path / "short.off"
    path.write_text("".join(lines[:6] + lines[7:]))
    assert "assimp ended with SIGABRT" in refused(path, "cad.crash")


@pytest.mark.usefixtures("afterwards")
@pytest.mark.parametrize("suffix", MESHES)
def test_every_cut_of_a_mesh_is_survived(tmp_path, suffix):
    whole = write(tmp_path / f"cube{suffix}").read_bytes()
    path = tmp_path / f"cut{suffix}"
    met = 0
    for cut in np.linspace(1, len(whole) - 1, 6).astype(int):
        path.write_bytes(whole[:cut])
        try:
            read(path)
        except InputError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            met += 1
    assert met > 1


@pytest.mark.slow
@pytest.mark.usefixtures("afterwards")
def test_a_job_s_brep_text_without_one_of_its_lines(tmp_path):
    """Read, healed, checked, measured, sampled and meshed: none of it harms this process."""
    lines = core.shape_from_mesh(cube()).write_brep().splitlines(keepends=True)
    met = 0
    for k in range(3, len(lines), 7):
        try:
            shape = core.Shape.read_brep("".join(lines[:k] + lines[k + 1 :]), "design")
            shape.warnings()
            core.sample_faces(shape, [], 5.0)
            core.triangulate(shape, 1.0)
        except InputError as error:
            assert "\n" not in str(error)
            met += 1
    assert met > 0.3 * len(lines) / 7


# --- limits


@pytest.mark.usefixtures("afterwards")
def test_a_bomb_is_refused_at_the_memory_limit(tmp_path, monkeypatch):
    path = tmp_path / "bomb.3mf"
    write_3mf(path, '<vertex x="0" y="0" z="0"/>' * 1_500_000, "")
    assert path.stat().st_size < 300e3
    monkeypatch.setenv(MEMORY, "60")
    text = refused(path, "cad.memory")
    assert "60 MB" in text and MEMORY in text


@pytest.mark.usefixtures("afterwards")
def test_the_host_watches_the_memory_too(tmp_path, stand_in, monkeypatch):
    stand_in(f"#!{sys.executable} -SE\nx = bytearray(400_000_000)\nimport time\ntime.sleep(1000)\n")
    monkeypatch.setenv(MEMORY, "200")
    begun = time.monotonic()
    refused(write(tmp_path / "cube.off"), "cad.memory")
    assert time.monotonic() - begun < 20


@pytest.mark.usefixtures("afterwards")
@pytest.mark.parametrize("name", ["cube.off", "cube.brep"])
def test_an_answer_too_large_is_refused(tmp_path, monkeypatch, name):
    path = write(tmp_path / name)
    monkeypatch.setenv(ANSWER, "0.0001")
    assert ANSWER in refused(path, "cad.too_large")


@pytest.mark.parametrize("variable", [TIME, MEMORY, ANSWER])
def test_a_limit_that_is_no_number_is_named(tmp_path, monkeypatch, variable):
    path = write(tmp_path / "cube.off")
    for value in ("soon", "-1", "0", "nan", "inf", "1,5", "5 "):
        monkeypatch.setenv(variable, value)
        with pytest.raises(InputError, match=f"{variable} is '{value}'"):
            read(path)


def real():
    (found,) = Path(core.__file__).parent.glob("beltgrinding-cad-reader*")
    return found


# Does what it is asked for but a task.
SLOW = '#!/bin/sh\ncase $3 in {task}) exec sleep 1000 ;; esac\nexec {real} "$@"\n'
LATER = {
    "TRIANGULATE": lambda path, shape, context: core.triangulate(shape, 0.1, context),
    "FACES": lambda path, shape, context: core.shape_from_mesh(cube(), context),
    "BREP": lambda path, shape, context: core.Shape.read(path, context),
    "MESH": lambda path, shape, context: core.read_mesh(
        path.replace(".brep", ".off"), context=context
    ),
}


@pytest.mark.slow
@pytest.mark.usefixtures("afterwards")
@pytest.mark.parametrize("task", LATER)
def test_all_that_is_done_is_cancelled_and_limited(tmp_path, stand_in, monkeypatch, task):
    path = str(write(tmp_path / "cube.brep"))
    write(tmp_path / "cube.off")
    shape = core.Shape.read(path)
    stand_in(SLOW.format(task=task, real=real()))
    context = core.RunContext()
    threading.Timer(0.5, context.cancel).start()
    begun = time.monotonic()
    with pytest.raises(Cancelled):
        LATER[task](path, shape, context)
    assert time.monotonic() - begun < 30
    monkeypatch.setenv(TIME, "0.8")
    begun = time.monotonic()
    with pytest.raises(InputError, match=f"0.8 s.*{TIME}"):
        LATER[task](path, shape, core.RunContext())
    assert time.monotonic() - begun < 30


@pytest.mark.usefixtures("afterwards")
def test_a_mesher_that_crashes_is_an_error(tmp_path, stand_in):
    path = str(write(tmp_path / "cube.brep"))
    stand_in(SLOW.format(task="TRIANGULATE", real=real()).replace("exec sleep 1000", "kill -11 $$"))
    with pytest.raises(InputError, match="SIGSEGV"):
        core.triangulate(core.Shape.read(path), 0.1)


def test_the_reader_meshes_as_this_process_does(tmp_path, monkeypatch):
    """To the last bit: without a reader that works an own shape is meshed here."""
    text = core.shape_from_mesh(cube()).write_brep()
    there = core.triangulate(core.Shape.from_brep(text), 0.1)
    monkeypatch.setenv(PROGRAM, str(tmp_path / "nowhere"))
    here = core.triangulate(core.Shape.from_brep(text), 0.1)
    np.testing.assert_array_equal(here.vertices, there.vertices)
    np.testing.assert_array_equal(here.triangles, there.triangles)


@pytest.mark.slow
@pytest.mark.skipif(not SHARED.is_dir(), reason=f"no shared data at {SHARED}")
def test_meshing_a_spring_that_takes_minutes_is_cancelled():
    shape = core.Shape.read(str(SHARED / "data" / "cad_nasty" / "spring_invalid.igs"))
    context = core.RunContext()
    threading.Timer(1.0, context.cancel).start()
    begun = time.monotonic()
    with pytest.raises(Cancelled):
        core.triangulate(shape, 0.1, context)
    assert time.monotonic() - begun < 30


# --- what is no file


@pytest.mark.parametrize("suffix", [*SHAPES, *MESHES, ".ply"])
def test_what_is_no_file_is_told_as_such(tmp_path, suffix):
    missing = "cad.no_such_file" if suffix in SHAPES else "mesh.no_such_file"
    refused(tmp_path / f"missing{suffix}", missing)
    folder = tmp_path / f"folder{suffix}"
    folder.mkdir()
    refused(folder, "foreign.folder")
    refused(folder / f"missing{suffix}", missing)
    pipe = tmp_path / f"pipe{suffix}"
    os.mkfifo(pipe)
    refused(pipe, "foreign.no_file")
    device = tmp_path / f"device{suffix}"
    device.symlink_to("/dev/zero")
    refused(device, "foreign.no_file")
    loop = tmp_path / f"loop{suffix}"
    loop.symlink_to(loop)
    refused(loop, "foreign.not_opened")
    refused(tmp_path / ("x" * 300 + suffix), "foreign.not_opened")
    empty = tmp_path / f"empty{suffix}"
    empty.touch()
    refused(empty, "foreign.empty")
    file = tmp_path / f"file{suffix}"
    file.write_text(OFF)
    file.chmod(0)
    root = os.geteuid() == 0
    if root:
        os.seteuid(65534)
    try:
        refused(file, "foreign.no_permission")
    finally:
        if root:
            os.seteuid(0)


# --- history

PARTS = {
    "subject step": "propeller_3blade.step",
    "subject iges": "blade_marine_root.iges",
    "other iges": "blade_marine_tip.iges",
    "subject brep": "pump_cover.brep",
}
HISTORY = """
import itertools, locale, sys
from pathlib import Path
sys.path[:0] = {paths!r}
from test_foreign_files import InputError, digest, read
folder = Path({folder!r})
subjects = sorted(folder.glob("subject*"))
first = [digest(path) for path in subjects]
next_one = itertools.cycle(zip(subjects, first))
for other in sorted(folder.iterdir()):
    try:
        read(other)
    except InputError:
        pass
    path, before = next(next_one)
    assert digest(path) == before, (other, path)
if {numbers!r}:
    locale.setlocale(locale.LC_ALL, {numbers!r})
    assert locale.localeconv()["decimal_point"] == ","
for path, before in zip(subjects, first):
    assert digest(path) == before, path
if {numbers!r}:
    assert locale.setlocale(locale.LC_ALL) == {numbers!r}
print(len(subjects))
"""


def results(path):
    """Arrays of all that is made of a file."""
    read_in = read(path)
    if isinstance(read_in, core.TriangleMesh):
        shape = core.shape_from_mesh(read_in)
        return [
            read_in.vertices,
            read_in.triangles,
            np.frombuffer(shape.write_brep().encode(), "u1"),
        ]
    size = float(np.linalg.norm(np.subtract(*read_in.extents())))
    field, _ = core.sample_faces(read_in, [0], size / 30)
    mesh = core.triangulate(read_in, size / 100)
    own = core.Shape.from_brep(read_in.write_brep())
    again, _ = core.sample_faces(own, [0], size / 30)
    return [field.points, field.normals, mesh.vertices, mesh.triangles, again.points]


def digest(path):
    return hashlib.sha256(
        b"".join(np.ascontiguousarray(a).tobytes() for a in results(path))
    ).hexdigest()


def german(folder):
    """The name of a locale with a decimal comma, made where there is none; None: it cannot be."""
    made = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")],
        capture_output=True,
    ) if shutil.which("localedef") else None  # fmt: skip
    return "de_DE.UTF-8" if made and (folder / "de_DE.UTF-8").is_dir() else None


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Files of every format, sound and damaged; the results of `subject*` are compared."""
    folder = tmp_path_factory.mktemp("history")
    for suffix in (".brep", *MESHES):
        kind = "subject" if suffix in (".brep", ".off", ".3mf") else "other"
        whole = write(folder / f"{kind}{suffix}").read_bytes()
        (folder / f"cut{suffix}").write_bytes(whole[: len(whole) // 2])
    for name, file in PARTS.items() if SHARED.is_dir() else ():
        part = SHARED / "data" / "cad" / file
        whole = part.read_bytes()
        shutil.copyfile(part, folder / f"{name}{part.suffix}")
        (folder / f"cut {name}{part.suffix}").write_bytes(whole[: len(whole) // 3])
    return folder


@pytest.mark.slow
def test_a_file_gives_the_same_bytes_whatever_was_read_before(files, tmp_path):
    """And in whatever locale."""
    here = Path(__file__).resolve().parent
    paths = [str(p) for p in (here, here.parent, ROOT / "Mod" / "BeltGrinding")]
    numbers = german(tmp_path) or ""  # elsewhere there is no data to make one of
    done = subprocess.run(
        [sys.executable, "-c", HISTORY.format(paths=paths, folder=str(files), numbers=numbers)],
        capture_output=True,
        text=True,
        env={**os.environ, "LOCPATH": str(tmp_path), TIME: "15"},  # what is cut may heal for ever
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert int(done.stdout) == 3 + 3 * SHARED.is_dir()
