"""What studies and results read back of their own, damaged: one line that names the file, or read as if it were whole;
never another error."""

import json
import shutil
from pathlib import Path

import pytest

from beltgrinding.base import folders
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.simulation.result import Result
from beltgrinding.simulation import run as runs
from beltgrinding.studies import making, store, table
from test_job import plate_job

OTHERS = ["", "{", "{}", "[]", "[1]", "null", "3", '"x"', '{"a": NaN}', "\x00", "[" * 5000]


def quick_job():
    job = plate_job()
    job["sampling"]["spacing_mm"] = 2.0
    job["cell"] = {"check_collisions": False}
    return job


def wrong(data):
    """Copies of what a JSON file holds with each key of the first two levels left out, or of another type."""
    for key in data:
        yield json.dumps({k: v for k, v in data.items() if k != key})
        for other in (None, {}, [], "x", -1, True):
            if type(other) is not type(data[key]):
                yield json.dumps({**data, key: other})


def told(read, path):
    """Whether ``read()`` refuses the file, naming it on one line."""
    try:
        read()
    except InputError as error:
        text = str(error)
        assert path.name in text and "\n" not in text, text
        return True
    return False


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    given = {
        "job": quick_job(),
        "vary": [{"name": "force", "key": "belt_machine.force_N", "values": [20.0, 40.0]}],
        "design": {"method": "grid"},
    }
    making.study(given, folder, workers=0)
    return folder


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A result's folder, as an older version left it: without sums, which would tell of all."""
    folder = tmp_path_factory.mktemp("result") / "out"
    runs.run(jobs.validate(quick_job())).write(folder)
    summary = json.loads((folder / "summary.json").read_text())
    for key in ("files", "sha256"):
        del summary[key]
    (folder / "summary.json").write_text(json.dumps(summary))
    return folder


@pytest.fixture
def copied(study, tmp_path):
    return Path(shutil.copytree(study, tmp_path / "study"))


@pytest.mark.parametrize("name", [store.DESIGN, store.STUDY, table.FILE])
@pytest.mark.parametrize("text", OTHERS)
def test_another_file_of_a_study_is_told(copied, name, text):
    (copied / name).write_text(text)
    assert told(lambda: making.Study.read(copied), copied / name)


def test_a_missing_key_of_a_design_is_named(copied):
    path = copied / store.DESIGN
    path.write_text("{}")
    with pytest.raises(InputError, match=r"design\.json: the key 'method' is missing") as error:
        making.Study.read(copied)
    assert error.value.code == "base.missing_key"


@pytest.mark.parametrize("name", [store.DESIGN, store.STUDY])
def test_a_design_and_a_study_of_other_keys_are_told_or_answered(copied, name):
    path = copied / name
    whole = json.loads(path.read_text())
    for text in wrong(whole):
        path.write_text(text)
        told(lambda: making.Study.read(copied), path)
    path.write_text(json.dumps({**whole, "later": 1}))
    assert told(lambda: making.Study.read(copied), path) == (name == store.STUDY)


@pytest.mark.parametrize(
    "old, new, code",
    [
        ("\n1,", "\none,", "studies.no_run"),
        (",done,", ",fine,", "studies.no_run"),
        ("force,", "farce,", "studies.lacks_column"),
        ("force,", "run,", "studies.no_table"),
    ],
)
def test_a_table_that_is_no_more_one_is_told(copied, old, new, code):
    path = copied / table.FILE
    text = path.read_text()
    path.write_text(text.replace(old, new, 1))
    assert text != path.read_text()
    with pytest.raises(InputError) as error:
        making.Study.read(copied)
    assert error.value.code == code


def test_a_run_of_other_keys_is_made_again_or_taken(copied):
    path = next((copied / store.RUNS).glob("*/*.json"))
    whole = json.loads(path.read_text())
    kept = store.Store(copied)
    assert kept.read(path.stem) == whole
    for text in OTHERS:
        path.write_text(text)
        assert kept.read(path.stem) is None, text
    for text in wrong(whole):
        path.write_text(text)
        found = kept.read(path.stem)
        assert found is None or isinstance(found["figures"], dict)


@pytest.mark.parametrize(
    "name", ["summary.json", "events.json", "verdict.json", "steps.csv", "motions.csv"]
)
def test_another_file_of_a_result_is_told(result, tmp_path, name):
    copy = Path(shutil.copytree(result, tmp_path / "copy"))
    Result.read(copy)
    path = copy / name
    for text in OTHERS:
        path.write_text(text)
        is_list = name == "events.json" and text == "[]"
        assert told(lambda: Result.read(copy), path) != is_list, text


@pytest.mark.slow
def test_a_verdict_and_a_summary_of_other_keys_are_told_or_read(result, tmp_path):
    copy = Path(shutil.copytree(result, tmp_path / "copy"))
    for name in ("verdict.json", "summary.json"):
        path = copy / name
        whole = path.read_text()
        for text in wrong(json.loads(whole)):
            path.write_text(text)
            told(lambda: Result.read(copy), path)
        path.write_text(whole)


@pytest.mark.parametrize("text", ["", "{", "{}", "[]", "null", '{"design": {}}', '{"programs": 3}'])
def test_another_job_in_a_height_field_is_told(result, tmp_path, text):
    copy = Path(shutil.copytree(result, tmp_path / "copy"))
    path = copy / "heightfield.h5"
    field, _ = core.HeightField.from_hdf5(str(path))
    path.write_bytes(field.hdf5(text))
    assert told(lambda: Result.read(copy), path)


@pytest.mark.parametrize(
    "text", ["", "{}", "[]", "null", '{"files": 1, "gone": []}', '{"files": ["../x"], "gone": []}']
)
def test_a_damaged_journal_is_told(result, tmp_path, text):
    copy = Path(shutil.copytree(result, tmp_path / "copy"))
    journal = copy / f"{folders.JOURNAL}0"
    journal.mkdir()
    (journal / folders.MANIFEST).write_text(text)
    assert told(lambda: Result.read(copy), journal / folders.MANIFEST)
    shutil.rmtree(journal)
    Result.read(copy)
