"""CAD files are read by a process of its own: nothing that happens there reaches this one."""

import json
import os
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from support.freecad import ROOT, SHARED

from beltgrinding.base import kept
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.job import load, workpiece
from beltgrinding.simulation.run import run

PROGRAM = "BELTGRINDING_CAD_READER"
LIMIT = "BELTGRINDING_CAD_TIME_LIMIT_S"
real_parts = pytest.mark.skipif(not SHARED.is_dir(), reason=f"no shared data at {SHARED}")


@pytest.fixture(autouse=True)
def nothing_kept():
    """What was read before would be taken without the reader."""
    with kept.instead(kept.Kept(0)):
        yield


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    """A BREP file of two triangles."""
    corners = np.array([[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 9]], np.float32)
    mesh = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    path = tmp_path_factory.mktemp("plate") / "plate.brep"
    path.write_text(core.shape_from_mesh(mesh).write_brep())
    return path


def reader():
    """The real one."""
    found = list(Path(core.__file__).parent.glob("beltgrinding-cad-reader*"))
    assert len(found) == 1
    return found[0]


@pytest.fixture
def stand_in(tmp_path, monkeypatch):
    """stand_in(text): a script takes the reader's place."""

    def put(text):
        path = tmp_path / "reader"
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv(PROGRAM, str(path))

    return put


@pytest.fixture(autouse=True)
def afterwards(plate, monkeypatch):
    """Whatever a test does, a good file can be read after it, and no child of its own is left."""
    before = children()  # a FreeCAD that other tests of this process keep open
    yield
    monkeypatch.undo()
    assert core.Shape.read(str(plate)).face_count == 2
    assert children() <= before


def children():
    task = Path(f"/proc/{os.getpid()}/task")
    return {pid for one in task.iterdir() for pid in (one / "children").read_text().split()}


def message(path, **kwargs):
    with pytest.raises(InputError) as refused:
        core.Shape.read(str(path), **kwargs)
    text = str(refused.value)
    assert str(path) in text and "\n" not in text
    return text


def alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().split(")")[1].split()[0] not in "ZX"
    except OSError:
        return False


@pytest.mark.parametrize("number", ["SEGV", "BUS", "FPE", "ILL", "ABRT", "KILL"])
def test_a_fault_is_an_error_that_names_the_signal(plate, stand_in, number):
    stand_in(f"#!/bin/sh\nkill -{number} $$\n")
    text = message(plate)
    assert f"SIG{number}" in text and "damaged" in text


@pytest.mark.parametrize(
    "text",
    [
        "#!/bin/sh\nexit 0\n",
        "#!/bin/sh\nexit 3\n",
        "#!/bin/sh\necho rubbish >&3\n",
        "#!/bin/sh\nexec yes rubbish >&3\n",  # without an end
        "#!/bin/sh\necho rubbish >&3\nexec sleep 1000 3>&-\n",
        "#!/bin/sh\nprintf bg-cad-1 >&3\n",
        "#!/bin/sh\nprintf 'bg-cad-1%32s' '' >&3\n",  # a length beyond all memory
    ],
)
def test_rubbish_is_not_taken_for_a_shape(plate, stand_in, text):
    stand_in(text)
    begun = time.monotonic()
    assert "no answer that can be understood" in message(plate)
    assert time.monotonic() - begun < 30


# Reads with the real reader and spoils its answer.
SPOILER = """#!{python}
import os, subprocess, sys
os.dup2(3, 9)
r, w = os.pipe()
os.dup2(w, 3, inheritable=True)
os.close(w)
child = subprocess.Popen([{reader!r}, str(os.getpid()), *sys.argv[2:]], pass_fds=[3])
os.close(3)
with os.fdopen(r, "rb") as answer:
    data = bytearray(answer.read())
assert child.wait() == 0 and len(data) > 1000
{spoil}
with os.fdopen(9, "wb") as out:
    out.write(data)
"""


@pytest.mark.parametrize("spoil", ["del data[len(data) // 2 :]", "data[700] ^= 1", "del data[40]"])
def test_half_a_shape_and_a_changed_one_are_refused(plate, stand_in, spoil):
    stand_in(SPOILER.format(python=sys.executable, reader=str(reader()), spoil="pass"))
    assert core.Shape.read(str(plate)).face_count == 2
    stand_in(SPOILER.format(python=sys.executable, reader=str(reader()), spoil=spoil))
    assert "no answer that can be understood" in message(plate)


def test_what_hangs_is_ended_at_the_time_limit(plate, stand_in, monkeypatch, tmp_path):
    stand_in(f"#!/bin/sh\necho $$ >{tmp_path}/pid\nexec sleep 1000\n")
    monkeypatch.setenv(LIMIT, "0.5")
    begun = time.monotonic()
    text = message(plate)
    assert 0.5 <= time.monotonic() - begun < 30
    assert LIMIT in text and not alive((tmp_path / "pid").read_text().strip())
    monkeypatch.setenv(LIMIT, "soon")
    with pytest.raises(InputError, match=f"{LIMIT} is 'soon'"):
        core.Shape.read(str(plate))


def test_cancelling_ends_the_child_and_its_children(plate, stand_in, tmp_path):
    stand_in(f"#!/bin/sh\nsleep 1000 &\necho $! $$ >{tmp_path}/pids\nwait\n")
    context = core.RunContext()
    threading.Timer(0.5, context.cancel).start()
    begun = time.monotonic()
    with pytest.raises(Cancelled):
        core.Shape.read(str(plate), context)
    assert time.monotonic() - begun < 30
    time.sleep(0.1)
    assert not any(alive(pid) for pid in (tmp_path / "pids").read_text().split())
    with pytest.raises(Cancelled):
        core.Shape.read(str(plate), context)


def test_reads_go_side_by_side(plate, stand_in):
    stand_in("#!/bin/sh\nsleep 1\n")
    begun = time.monotonic()
    threads = [threading.Thread(target=message, args=(plate,)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert time.monotonic() - begun < 7.5  # one after the other: 8 s


def test_it_inherits_nothing(plate, stand_in, tmp_path):
    stand_in(
        f"""#!{sys.executable} -SE
import os
files = ((n, f"/proc/self/fd/{{n}}") for n in os.listdir("/proc/self/fd"))
with open({str(tmp_path / "files")!r}, "w") as out:
    for n, file in files:
        if os.path.lexists(file):
            print(n, os.readlink(file), file=out)
    print("input", len(os.read(0, 9)), file=out)
print("noise")
os.write(2, b"noise")
"""
    )
    with open(tmp_path / "held", "w") as held:
        os.set_inheritable(held.fileno(), True)
        message(plate)
    found = dict(line.split(" ", 1) for line in (tmp_path / "files").read_text().splitlines())
    assert found["1"] == found["2"] == "/dev/null" and found["input"] == "0"
    assert found["3"].startswith("pipe:")
    assert not [f for n, f in found.items() if n != "3" and ("pipe:" in f or f.endswith("held"))]


@pytest.mark.slow
@pytest.mark.parametrize("handler", ["SIG_IGN", "reap"])
def test_a_host_may_reap_its_children_itself(plate, tmp_path, handler):
    """And it may ignore SIGPIPE, and use subprocess at the same time."""
    script = f"""
import os, signal, subprocess, sys, threading
sys.path.insert(0, {str(Path(core.__file__).parent)!r})
from signal import SIG_IGN
import beltgrinding_core as core
def reap(*_):
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        pass
signal.signal(signal.SIGCHLD, {handler})
signal.signal(signal.SIGPIPE, SIG_IGN)
threads = [threading.Thread(target=core.Shape.read, args=({str(plate)!r},)) for _ in range(4)]
for t in threads: t.start()
for t in threads: t.join()
for _ in range(5):
    assert core.Shape.read({str(plate)!r}).face_count == 2
context = core.RunContext()
os.environ["{PROGRAM}"] = {str(tmp_path / 'slow')!r}
threading.Timer(0.3, context.cancel).start()
try:
    core.Shape.read({str(plate)!r}, context)
except core.Cancelled:
    print("cancelled")
"""
    (tmp_path / "slow").write_text("#!/bin/sh\nexec sleep 1000\n")
    (tmp_path / "slow").chmod(0o755)
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "cancelled\n", "")


def test_a_reader_that_is_missing_is_named(plate, monkeypatch, tmp_path):
    monkeypatch.setenv(PROGRAM, str(tmp_path / "nowhere"))
    assert str(tmp_path / "nowhere") in message(plate)
    monkeypatch.delenv(PROGRAM)
    core.set_cad_reader(str(tmp_path / "nobody"))
    try:
        assert str(tmp_path / "nobody") in message(plate)
    finally:
        core.set_cad_reader("")
    # A core without its reader: what FreeCAD's folder would be if the file were lost.
    lone = tmp_path / "lone"
    lone.mkdir()
    (lone / Path(core.__file__).name).write_bytes(Path(core.__file__).read_bytes())
    script = f"import beltgrinding_core as c\ntry:\n c.Shape.read({str(plate)!r})\n"
    script += "except c.InputError as e: print(e)"
    run = lambda: subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": str(lone)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    told = run()
    assert "beltgrinding-cad-reader" in told and str(lone) in told and PROGRAM in told
    # Beside the core it is found; a lost mode (a zip unpacked by Python) is put right.
    beside = lone / reader().name
    beside.write_bytes(reader().read_bytes())
    beside.chmod(0o644)
    assert run() == ""
    # And where the core is a link, beside what it leads to: the Debian package.
    linked = tmp_path / "linked"
    linked.mkdir()
    (linked / Path(core.__file__).name).symlink_to(lone / Path(core.__file__).name)
    lone = linked
    assert run() == ""


def test_the_reader_run_by_hand_says_what_it_is():
    done = subprocess.run([str(reader())], capture_output=True, text=True)
    assert done.returncode == 2 and "reads CAD files" in done.stderr


def test_a_text_from_elsewhere_is_read_apart(plate, stand_in):
    text = plate.read_text()
    assert core.Shape.read_brep(text, "job").write_brep() == core.Shape.from_brep(text).write_brep()
    for broken in ("", "no shape", text[: len(text) // 2]):
        with pytest.raises(InputError, match="^job: "):
            core.Shape.read_brep(broken, "job")
    stand_in("#!/bin/sh\ncat >/dev/null\nkill -SEGV $$\n")
    with pytest.raises(InputError, match="^job: .*SIGSEGV"):
        core.Shape.read_brep(text, "job")
    assert core.Shape.from_brep(text).face_count == 2  # FreeCAD's own need no reader


def job_of(design):
    pose = {"x_mm": 30, "y_mm": 9, "z_mm": 0.2, "qw": 0, "qx": 1, "qy": 0, "qz": 0}
    return {
        "design": {**design, "faces": [1]},
        "sampling": {"spacing_mm": 5.0},
        "stock": {"kind": "allowance", "allowance_mm": 0.2},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}, "force_N": 30},
        "programs": [{"poses": [pose, {**pose, "x_mm": 35}]}],
        "inspection": {"tolerance_mm": [-0.05, 0.05]},
    }


def test_a_job_s_foreign_text_goes_to_the_reader_and_freecad_s_own_does_not(plate, stand_in):
    text = plate.read_text()
    there = run(load.validate(job_of({"brep": text}))).field
    stand_in("#!/bin/sh\ncat >/dev/null\nkill -SEGV $$\n")
    with pytest.raises(InputError) as refused:
        run(load.validate(job_of({"brep": text})))
    assert refused.value.code == "cad.crash"
    here = run(load.validate(job_of({"brep": workpiece.OwnBrep(text)}))).field
    np.testing.assert_array_equal(here.height, there.height)
    np.testing.assert_array_equal(here.points, there.points)


@pytest.mark.parametrize("design", ["file", "brep"])
def test_a_run_is_cancelled_while_it_reads(plate, stand_in, design):
    stand_in("#!/bin/sh\nexec sleep 1000\n")
    given = {"file": str(plate)} if design == "file" else {"brep": plate.read_text()}
    context = core.RunContext()
    threading.Timer(0.3, context.cancel).start()
    with pytest.raises(Cancelled):
        run(load.validate(job_of(given)), context)


@pytest.mark.parametrize("command", ["run", "raster", "contact"])
def test_ctrl_c_ends_a_command_that_reads(plate, stand_in, tmp_path, command):
    stand_in(f"#!/bin/sh\necho $$ >{tmp_path}/pid\nexec sleep 1000\n")
    (tmp_path / "job.json").write_text(json.dumps(job_of({"file": str(plate)})))
    arguments = {"run": ["-o", "out"], "raster": ["-o", "x.csv"], "contact": ["--pose", "1"]}
    words = [sys.executable, "-m", "beltgrinding", command, "job.json", *arguments[command]]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "Mod" / "BeltGrinding")}
    environment["BELTGRINDING_BUILD"] = str(Path(core.__file__).parents[1])
    host = subprocess.Popen(words, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 60
    while not (tmp_path / "pid").exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.2)
    host.send_signal(signal.SIGINT)
    told = host.communicate(timeout=30)[1]
    assert host.returncode == 130, told
    assert "Traceback" not in told
    assert not alive((tmp_path / "pid").read_text().strip())


@real_parts
def test_the_reader_dies_with_its_host(tmp_path):
    part = SHARED / "data" / "cad" / "ball_valve_lever.step"  # seconds to read
    script = f"import beltgrinding_core as c; c.Shape.read({str(part)!r})"
    environment = {**os.environ, "PYTHONPATH": str(Path(core.__file__).parent)}
    host = subprocess.Popen([sys.executable, "-c", script], env=environment)
    found = []
    until = time.monotonic() + 20
    while not found and time.monotonic() < until and host.poll() is None:
        for task in Path(f"/proc/{host.pid}/task").iterdir():
            found += (task / "children").read_text().split()
    assert found, "the reader was not seen"
    time.sleep(0.2)  # past its first lines
    assert alive(found[0])
    host.kill()
    host.wait()
    until = time.monotonic() + 20
    while alive(found[0]) and time.monotonic() < until:
        time.sleep(0.05)
    assert not alive(found[0])


@pytest.mark.skipif(not (SHARED / "attack").is_dir(), reason=f"no shared data at {SHARED}")
def test_a_shape_whose_check_crashes_is_refused():
    """It is read without a fault, and OpenCASCADE's check follows a pointer into nowhere."""
    text = message(SHARED / "attack" / "d71.brep")
    assert "SIGSEGV" in text
