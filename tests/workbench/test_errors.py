"""Typical mistakes: the code, the culprit and the German sentence of each; JSON on the command line."""

import json

import pytest
from test_job import plate_job

from beltgrinding import cli
from beltgrinding.base.messages import sentence, warnings
from beltgrinding.cli.messages import of_locale
from beltgrinding.engine import InputError, core
from beltgrinding.reporting.report import report


def changed(**parts):
    """A job with parts put in; None takes one out."""
    job = plate_job()
    for name, part in parts.items():
        if part is None:
            del job[name]
        elif isinstance(part, dict):
            job[name] = {**job.get(name, {}), **part}
        else:
            job[name] = part
    return job


def with_pose(**values):
    job = plate_job()
    job["programs"][0]["poses"][1].update(values)
    return job


MISTAKES = {
    "missing key": (
        changed(design=None),
        "base.missing_key",
        {"key": "design"},
        "{job}: job: Der Schlüssel 'design' fehlt",
    ),
    "wrong type": (
        changed(sampling={"spacing_mm": "fine"}),
        "base.wrong_type",
        {"key": "sampling.spacing_mm"},
        "{job}: sampling.spacing_mm: 'fine' ist von falscher Art, verlangt ist: Zahl",
    ),
    "unknown key": (
        changed(sampling={"spacing": 1}),
        "base.unknown_key",
        {"key": "sampling.spacing"},
        "{job}: sampling: unbekannter Schlüssel 'spacing'; gemeint ist vielleicht 'spacing_mm'",
    ),
    "below the minimum": (
        changed(belt_machine={"contact_spacing_mm": -0.5}),
        "base.not_above_minimum",
        {"key": "belt_machine.contact_spacing_mm"},
        "{job}: belt_machine.contact_spacing_mm: -0.5 liegt nicht über 0",
    ),
    "not one of": (
        changed(stock={"kind": "air"}),
        "base.not_one_of",
        {"key": "stock.kind"},
        "{job}: stock.kind: 'air' gehört nicht zu ['allowance', 'solid', 'mesh', 'left']",
    ),
    "two of one": (
        changed(design={"file": "part.step"}),
        "base.exactly_one",
        {"key": "design"},
        "{job}: design: genau einen Schlüssel angeben: 'file' oder 'brep'",
    ),
    "limits swapped": (
        changed(inspection={"tolerance_mm": [0.1, -0.1]}),
        "job.limits_swapped",
        {"key": "inspection.tolerance_mm"},
        "{job}: inspection.tolerance_mm: Die untere Grenze liegt über der oberen",
    ),
    "no such face": (
        changed(design={"faces": [9]}),
        "job.no_such_face",
        {"key": "design.faces", "face": 9},
        "design.faces: Es gibt keine Fläche 9; die Form hat 1. Hinweis: design: Nachbarn und Umschlossenes "
        "sagen nicht, welche Seite der losen Flächen 1 außen ist; sie ist, wie die Datei sie angibt. Ansehen, und "
        "umkehren, falls sie in das Teil zeigen",
    ),
    "missing file": (
        changed(design={"brep": None, "file": "none.step"}),
        "cad.no_such_file",
        {},
        "{folder}/none.step: Diese Datei gibt es nicht",
    ),
    "damaged STEP": (
        changed(design={"brep": None, "file": "damaged.step"}),
        "cad.not_readable",
        {},
        "{folder}/damaged.step: keine lesbare STEP-Datei; neu exportieren oder ein anderes Format "
        "nehmen",
    ),
    "wrong pose": (
        with_pose(qw=1.0),
        "frames.quaternion",
        {"pose": 2},
        "programs[0]: Pose 2: das Quaternion hat die Länge 1,414 statt 1; ein Einheitsquaternion "
        "w, x, y, z angeben",
    ),
}


def given(job, folder):
    """The job's file, beside a damaged STEP file."""
    design = job.get("design", {})
    for key in [key for key, value in design.items() if value is None]:
        del design[key]
    (folder / "damaged.step").write_text("ISO-10303-21;\nHEADER;\nDATA;\n#1=CARTESIAN_POINT(")
    path = folder / "job.json"
    path.write_text(json.dumps(job))
    return path


def run(capsys, *arguments):
    """(exit status, what stands on standard error)."""
    status = cli.main([str(argument) for argument in arguments])
    return status, capsys.readouterr().err


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_has_a_code_a_culprit_and_a_german_sentence(mistake, tmp_path, capsys):
    job, code, culprit, german = MISTAKES[mistake]
    path = given(job, tmp_path)
    german = german.format(job=path, folder=tmp_path)
    status, told = run(capsys, "--json-errors", "run", path, "-o", tmp_path / "out")
    assert status == 2 and told.count("\n") == 1
    error = json.loads(told)["error"]
    assert list(error) == ["code", "message", "culprit", "arguments", "context", "remarks"]
    assert error["code"] == code
    assert culprit.items() <= error["culprit"].items()
    named = german.split(": ")[0]
    if named.startswith("/"):
        assert error["culprit"]["file"] == named

    status, plain = run(capsys, "run", path, "-o", tmp_path / "out")
    assert status == 2 and plain == f"beltgrind: {error['message']}\n"
    status, told = run(capsys, "--language", "de", "run", path, "-o", tmp_path / "out")
    assert status == 2 and told == f"beltgrind: {german}\n"
    assert not (tmp_path / "out").exists()


def test_files_that_are_not_there_or_no_json(tmp_path, capsys):
    missing, broken = tmp_path / "none.json", tmp_path / "broken.json"
    broken.write_text('{\n"design": ,\n}')
    for path, code, culprit, german in (
        (missing, "files.cannot_be_read", {}, "lässt sich nicht lesen: Datei oder Ordner fehlt"),
        (tmp_path, "files.cannot_be_read", {}, "lässt sich nicht lesen: das ist ein Ordner"),
        (broken, "base.no_json", {"line": 2}, "Zeile 2: kein JSON: Expecting value"),
    ):
        status, told = run(capsys, "run", path, "-o", tmp_path / "out", "--json-errors")
        error = json.loads(told)["error"]
        assert (status, error["code"]) == (2, code)
        assert error["culprit"] == {"file": str(path), **culprit}
        told = run(capsys, "--language", "de", "run", path, "-o", tmp_path / "out")[1]
        assert told == f"beltgrind: {path}: {german}\n"


def test_a_program_error_names_its_line(tmp_path, capsys):
    job = plate_job()
    (tmp_path / "path.csv").write_text(
        "x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n0,zero,0,1,0,0,0\n"
    )
    job["programs"] = [{"file": "path.csv"}]
    path = given(job, tmp_path)
    error = json.loads(run(capsys, "--json-errors", "run", path, "-o", tmp_path / "out")[1])[
        "error"
    ]
    assert error["code"].startswith("programs.")
    assert error["culprit"] == {"file": "path.csv", "line": 3}


def test_json_of_a_wrong_command_line(capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(["run", "job.json", "--json-errors"])
    error = json.loads(capsys.readouterr().err)["error"]
    assert caught.value.code == 2 and error["code"] == "cli.usage" and "-o" in error["message"]
    with pytest.raises(SystemExit):
        cli.main(["run", "job.json"])
    assert capsys.readouterr().err.startswith("usage: beltgrind run")


def test_the_warnings_of_a_run_stand_behind_its_error():
    error = InputError("simulation.never", "it never touches", depth=float("nan"))
    error = error.within("job.in_program", "{program}: ", program="A")
    error = error.followed_by("simulation.notes", ". Note: {notes}", notes="open shell")
    data = cli.messages.error_data(error)
    assert data["message"] == str(error) == "A: it never touches. Note: open shell"
    assert data["arguments"] == {"depth": "nan"}
    assert data["context"] == [{"code": "job.in_program", "arguments": {"program": "A"}}]
    assert data["remarks"] == [{"code": "simulation.notes", "arguments": {"notes": "open shell"}}]
    assert sentence(error, "de") == "A: it never touches. Hinweis: open shell"


def test_a_fact_in_a_fact_is_told_in_the_same_language():
    inner = InputError("job.no_such_face", "", key="a", face=3, count=2)
    told = core.Fact("inspection.no_motions", "the motions are not known: {reason}", reason=inner)
    assert sentence(told, "de").endswith("nicht bekannt: a: Es gibt keine Fläche 3; die Form hat 2")
    assert isinstance(told.arguments["reason"], str) and json.dumps(told.arguments)


@pytest.mark.parametrize(
    "variables, language",
    [
        ({"LANG": "de_DE.UTF-8"}, "de"),
        ({"LANG": "de_AT.UTF-8", "LC_MESSAGES": "C"}, "en"),
        ({"LANG": "C", "LC_ALL": "de"}, "de"),
        ({"LANG": "de_DE", "LC_ALL": ""}, "de"),
        ({"LANG": "fr_FR.UTF-8"}, "en"),
        ({}, "en"),
    ],
)
def test_the_language_is_that_of_the_locale(variables, language, monkeypatch):
    for name in ("LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert of_locale() == language


def test_the_warnings_of_a_run_are_told_in_german_and_kept_as_facts(tmp_path, capsys):
    path = given(plate_job(), tmp_path)
    status, told = run(capsys, "--language", "de", "run", path, "-o", tmp_path / "out")
    assert status == 0 and "Warnung: design: Nachbarn und Umschlossenes sagen nicht" in told
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    told = [line for line in told.splitlines() if line.startswith("Warnung: ")]
    assert told == [f"Warnung: {text}" for text in warnings(summary, "de")]
    assert summary["warnings"] == warnings(summary, "en")
    assert summary["warnings"][0].startswith("design: neighbours and what they enclose do not")
    assert summary["warning_facts"][0]["code"] == "brep.side_in_doubt"
    report(tmp_path / "out", language="de")
    html = (tmp_path / "out" / "report.html").read_text()
    assert "Nachbarn und Umschlossenes" in html and "what they enclose" not in html
    del summary["warning_facts"]  # of a version before 0.2
    assert warnings(summary, "de") == summary["warnings"]
