"""In a file's place ``-`` is standard input or output on the command line."""

import json

from test_job import plate_job
from test_misuse import call, one_line


def test_a_job_comes_in_and_a_file_goes_out(tmp_path):
    job = plate_job()
    job["sampling"]["spacing_mm"] = 3.0
    ran = call("run", "-", "-o", "out", "-q", cwd=tmp_path, input=json.dumps(job).encode())
    assert ran.returncode == 0, ran.stderr
    told = call("verdict", "out", "-o", "-", cwd=tmp_path)
    kept = (tmp_path / "out" / "verdict.json").read_bytes()
    assert told.stdout == kept and b"verdict: " in told.stderr, told.stderr
    plane = ("--point", "0,0,0", "--normal", "0,1,0")
    cut = call("section", "out", *plane, "-o", "-", cwd=tmp_path).stdout
    assert cut.startswith(b"piece,face,") and b"{" not in cut
    assert not (tmp_path / "-").exists()
    faces = call("faces", "-", cwd=tmp_path, input=json.dumps(job).encode())
    assert faces.returncode == 0 and faces.stdout.startswith(b"face"), faces.stderr


def test_what_cannot_be_without_a_name_says_so(tmp_path):
    one_line(call("run", "-", "-o", "out", cwd=tmp_path, input=b"{"), "-: line 1", "JSON")
    one_line(call("program", "-", cwd=tmp_path, input=b"PTP"), "-: ")
    twice = call("calibrate", "-", "-o", "-", "--report", "-", cwd=tmp_path, input=b"")
    one_line(twice, "two results")


def test_elsewhere_it_is_a_files_name(tmp_path, monkeypatch):
    from beltgrinding import cli
    from beltgrinding.base.files import write_whole
    from beltgrinding.base.regular_files import read_regular

    monkeypatch.chdir(tmp_path)
    assert cli.main(["faces", "missing.step"]) == 2  # also once a command has run in this process
    write_whole("-", b"abc")
    assert (tmp_path / "-").read_bytes() == read_regular("-", 9) == b"abc"
