"""The command line under misuse: exit 0, 2 or 130, one line, and nothing else."""

import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

import beltgrinding
from beltgrinding.base import messages
from beltgrinding.base.cells import cell, comment_cells
from beltgrinding.engine import InputError, core
from support.results import unseal
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]

START = ROOT / "Mod" / "BeltGrinding" / "beltgrind.py"
PYTHONPATH = str(Path(core.__file__).parent)


def call(*words, cwd, **options):
    """A process of the command line that has ended; its words may be bytes."""
    environment = {**os.environ, "PYTHONPATH": PYTHONPATH, **options.pop("env", {})}
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    command = [sys.executable, str(START), *words]
    return subprocess.run(command, cwd=cwd, env=environment, timeout=120, **streams)


def one_line(done, *parts):
    """What a refused command says."""
    text = done.stderr.decode()
    assert done.returncode == 2, text
    assert text.startswith("beltgrind: ") and text.count("\n") == 1, text
    for part in parts:
        assert part in text
    return text


@pytest.fixture
def job():
    data = plate_job()
    data["sampling"]["spacing_mm"] = 3.0
    return data


def written(folder, data, name="job.json"):
    path = folder / name
    path.write_text(json.dumps(data) if isinstance(data, dict) else data)
    return name


def test_whole_numbers_may_have_a_point(tmp_path, job):
    job["design"]["faces"] = [1.0]
    done = call("run", written(tmp_path, job), "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    job["design"]["faces"] = [1.5]
    one_line(call("run", written(tmp_path, job), "-o", "out", cwd=tmp_path), "design.faces")


BAD_NAMES = {
    "nul": "a\0b.step",
    "half a character": "a\ud800.step",
    "too long": "a" * 300 + ".step",
    "links in a circle": "loop.step",
    "a folder": "folder.step",
    "a device": "/dev/zero",
    "missing": "missing.step",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", BAD_NAMES)
@pytest.mark.parametrize("key", ["design", "stock", "program", "surrogate"])
def test_a_file_that_is_none_is_one_line(tmp_path, job, name, key):
    (tmp_path / "loop.step").symlink_to("loop.step")
    (tmp_path / "folder.step").mkdir()
    path = BAD_NAMES[name]
    if key == "design":
        job["design"] = {"file": path}
    elif key == "stock":
        job["stock"] = {"kind": "mesh", "file": path.replace(".step", ".stl")}
    elif key == "program":
        job["programs"] = [{"file": path.replace(".step", ".src")}]
    else:
        compliance = {"model": "surrogate", "surrogate_file": path}
        job["belt_machine"]["compliance"] = compliance
    told = one_line(call("run", written(tmp_path, job), "-o", "out", cwd=tmp_path))
    assert "fault of this program" not in told
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    "text, words",
    [
        ('{"design": {}, "design": {}}', "'design' is there twice"),
        ('{"design": ' + "9" * 400 + "}", "too large a number"),
        ('{"design": ' + "9" * 5000 + "}", "job.json"),
        ('{"design": 1e999}', "too large a number"),
        ("[" * 100_000, "job.json"),
        ("\0", "line 1: no JSON"),
        ('{"a": "\udcff"}'.encode("utf-8", "surrogateescape").decode("latin-1"), "job"),
        ("1", "job"),
        ("", "no JSON"),
    ],
)
def test_a_job_that_is_none_is_one_line(tmp_path, text, words):
    told = one_line(call("run", written(tmp_path, text), "-o", "out", cwd=tmp_path), words)
    assert "fault of this program" not in told


def test_a_huge_frame_is_refused(tmp_path, job):
    pose = {"position_mm": [1e300, 0, 0], "abc_deg": [0, 0, 0]}
    job["cell"] = {"mounting": "part", "base_from_robot": pose}
    for path in ("base_from_robot", "base_from_contact"):
        job["cell"] = {path: pose}
        done = call("run", written(tmp_path, job), "-o", "out", cwd=tmp_path)
        assert b"fault of this program" not in done.stderr and done.returncode in (0, 2)


def test_folders_whose_names_are_no_text(tmp_path, job):
    folder = os.fsencode(tmp_path) + b"/w\xe4rme"
    os.mkdir(folder)
    Path(os.fsdecode(folder), "plate.brep").write_text(job["design"]["brep"])
    job["design"] = {"file": "plate.brep"}
    Path(os.fsdecode(folder), "job.json").write_text(json.dumps(job))
    done = call(b"run", folder + b"/job.json", b"-o", folder + b"/out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for words in ([b"verdict", folder + b"/out"], [b"report", folder + b"/out"]):
        done = call(*words, cwd=tmp_path)
        assert done.returncode == 0, done.stderr


def test_standard_output_that_nobody_takes(tmp_path, job):
    written(tmp_path, job)
    reader, writer = os.pipe()
    os.close(reader)
    done = call("run", "job.json", "-o", "out", cwd=tmp_path, stdout=writer)
    os.close(writer)
    assert done.returncode == 0 and b"beltgrind: " not in done.stderr
    with open("/dev/full", "wb") as full:
        one_line(call("schema", cwd=tmp_path, stdout=full), "No space left on device")
    closed = subprocess.run(
        ["sh", "-c", f'"{sys.executable}" "{START}" schema >&- 2>&-'],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": PYTHONPATH},
    )
    assert closed.returncode in (0, 2)


def test_a_fault_of_ours_says_so_with_a_file_to_send(tmp_path):
    code = (
        "import sys\n"
        "from beltgrinding.cli import main, lists\n"
        "def broken(arguments): raise RuntimeError('it broke')\n"
        "lists._schema = broken\n"
        "sys.exit(main(['schema']))\n"
    )
    path = os.pathsep.join([str(ROOT / "Mod" / "BeltGrinding"), PYTHONPATH])
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": path, "TMPDIR": str(tmp_path)},
        capture_output=True,
    )
    one_line(done, "a fault of this program", "RuntimeError: it broke")
    (report,) = tmp_path.glob("beltgrind-fault-*.txt")
    assert str(report) in done.stderr.decode() and "it broke" in report.read_text()


def test_a_cache_that_cannot_be_used_is_done_without(tmp_path, job):
    cache = tmp_path / "cache" / "beltgrinding"
    environment = {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    job["belt_machine"]["compliance"] = {"model": "wheel_rim"}
    written(tmp_path, job)
    heights = []
    for spoil in (None, "folder", "damaged", "as a file"):
        if spoil == "folder":
            for path in list(cache.iterdir()):
                path.unlink()
                path.mkdir()
        elif spoil == "damaged":
            for path in list(cache.iterdir()):
                path.rmdir()
                path.write_bytes(b"no rim")
        elif spoil == "as a file":
            for path in list(cache.iterdir()):
                path.unlink()
            cache.rmdir()
            cache.write_text("no folder")
        done = call("run", "job.json", "-o", "out", "-q", cwd=tmp_path, env=environment)
        assert done.returncode == 0, done.stderr
        heights.append((tmp_path / "out" / "deviation.ply").read_bytes())
    assert heights.count(heights[0]) == 4


@pytest.mark.slow
def test_a_result_of_anything_is_one_line(tmp_path, job):
    done = call("run", written(tmp_path, job), "-o", "out", "-q", cwd=tmp_path)
    assert done.returncode == 0
    for name, texts in {
        "events.json": ["1", "[1]", '[{"kind": 1}]', '[{"kind": "gouge", "time": "x"}]', "null"],
        "summary.json": ["1", "{}", '{"samples": "x"}', '{"samples": 1, "versions": {}}', "[]"],
        "verdict.json": ["1", "[]", '{"overall": 3}'],
        "steps.csv": ["", "a,b\n1,2\n", "time_s\nx\n"],
        "motions.csv": ["", "program\n"],
        "convergence.json": ["1", "{}"],
    }.items():
        for text in texts:
            unseal(tmp_path / "out")
            kept = {p: p.read_bytes() for p in (tmp_path / "out").iterdir()}
            (tmp_path / "out" / name).write_text(text)
            for command in (["verdict", "out"], ["report", "out"]):
                done = call(*command, cwd=tmp_path)
                if done.returncode:
                    assert "fault of this program" not in one_line(done), (name, text, command)
            for path in (tmp_path / "out").iterdir():
                path.unlink()
            for path, data in kept.items():
                path.write_bytes(data)


def test_an_hdf5_file_that_leads_elsewhere_is_refused(tmp_path):
    result = beltgrinding.run(plate_job())
    secret = tmp_path / "secret.h5"
    result.field.write_hdf5(str(secret))
    raw = tmp_path / "raw.bin"
    raw.write_bytes(result.field.height.tobytes())
    count = result.field.size

    def external_link(file):
        file["height"] = h5py.ExternalLink(str(secret), "height")

    def soft_link(file):
        file["copy"] = result.field.height
        file["height"] = h5py.SoftLink("copy")

    def external_storage(file):
        whole = [(str(raw), 0, 8 * count)]
        file.create_dataset("height", (count,), "f8", external=whole)

    def virtual(file):
        layout = h5py.VirtualLayout((count,), "f8")
        layout[:] = h5py.VirtualSource(str(secret), "height", (count,))
        file.create_virtual_dataset("height", layout)

    def foreign_filter(file):
        file.create_dataset("height", data=result.field.height, compression="gzip")

    for kind in (external_link, soft_link, external_storage, virtual, foreign_filter):
        path = tmp_path / "field.h5"
        result.field.write_hdf5(str(path))
        with h5py.File(path, "r+") as file:
            del file["height"]
            kind(file)
        with pytest.raises(InputError, match="'height' lies in another file or needs a foreign"):
            core.HeightField.from_hdf5(str(path))


def test_no_name_is_a_formula_in_a_table():
    for text in ("=HYPERLINK(1)", "+1", "-1", "@SUM(A1)", "\t=1"):
        assert cell(text) == "'" + text
    assert cell("tool 1") == "tool 1" and cell("") == ""
    assert comment_cells("base a,=HYPERLINK(1)") == "base a =HYPERLINK(1)"
    assert comment_cells("X 1, Y 2") == "X 1, Y 2"


def test_no_title_is_a_command_in_a_report(tmp_path):
    result = beltgrinding.run(plate_job())
    for title in ('$(touch x)"; rm -rf *', "`id`", "-rf", "a'b\nc"):
        html = beltgrinding.report(result, tmp_path / "r.html", title=title).read_text()
        command = html.split('class="command">')[1].split("</pre>")[0]
        name = command.split("beltgrind run ")[1].split(" -o out")[0].replace("&quot;", '"')
        assert (
            name[0] == name[-1] == '"'
            and not set(name[1:-1]) & set("$`\"\\\n'*;")
            and name[1] != "-"
        )


def test_no_name_commands_the_terminal(tmp_path):
    done = call("run", "\x1b[2J\u202egpj.json", "-o", "out", cwd=tmp_path)
    told = one_line(done, "\\x1b[2J")
    assert "\x1b" not in told and "\u202e" not in told


def test_a_form_of_a_document_tells_nothing_but_its_arguments():
    told = {"code": "unknown.code", "arguments": {"a": 1.5}}
    for text in ("{a.__class__}", "{a:>999999999}", "{b}", "{", "{a!r:.3q}"):
        assert messages.sentence({**told, "text": text}, "de") == text
    assert messages.sentence({**told, "text": "{a:.2f}"}, "de") == "1.50"
    fact = core.Fact("x.y", "{a:.3g}", a=float(np.inf))
    json.dumps(messages.fact_data(fact), allow_nan=False)
