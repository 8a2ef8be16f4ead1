"""Castings sorted by their scans: passes, passes with a plan of its own, scrap."""

import csv
import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.reporting.language import Language
from beltgrinding.studies import sorting, sorting_report
from test_plan_stock import given, ply, raw  # noqa: F401
from test_scan import pytestmark  # noqa: F401

QUICK = {"check": False, "rounds": 3}


def stock(thick, amplitude=0.02):
    return lambda x, y: thick + amplitude * np.sin(2 * np.pi * x / 40.0) + 0.0 * y


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scans")
    for name, thick in (("deep", -0.3), ("even", 0.25), ("thick", 1.5)):
        ply(folder / f"{name}.ply", *raw(stock(thick)))
    return folder


@pytest.fixture(scope="module")
def coarse(given):  # noqa: F811
    return jobs.validate({**given, "sampling": {"spacing_mm": 2.0}})


@pytest.fixture(scope="module")
def batch(coarse, scans, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sorted")
    told = []
    found = sorting.sort(
        coarse, [scans], folder, QUICK, 0.9, {"aligned": True}, workers=0, told=told.append
    )
    assert [one.done for one in told] == [1, 2, 3]
    return folder, found


def test_each_part_is_sorted_with_its_reason(batch):
    folder, found = batch
    rows = {row["part"]: row for row in found.parts}
    assert {name: row["sorted"] for name, row in rows.items()} == {
        "deep": sorting.SCRAP,
        "even": sorting.PLANNED,
        "thick": sorting.SCRAP,
    }
    even, thick, deep = rows["even"], rows["thick"], rows["deep"]
    assert even["in_share"] < 0.9 <= even["planned_in_share"]
    assert (folder / "even" / "job.json").exists() and even["plan"] == str(folder / "even")
    assert not (folder / "thick").exists() and thick["planned_in_share"] < 0.9
    assert "grinding adds nothing" in deep["reason"] and deep["in_share"] is None
    assert max(thick["shares"].values()) > 0.1 and "%" in thick["reason"]
    with open(folder / sorting.TABLE, newline="") as file:
        kept = list(csv.DictReader(file))
    assert [row["sorted"] for row in kept] == [row["sorted"] for row in found.parts]


def test_the_plan_that_is_told_is_the_one_that_grinds_it_so(batch):
    folder, found = batch
    row = next(row for row in found.parts if row["part"] == "even")
    ground = beltgrinding.run(folder / "even" / "job.json")
    assert ground.verdict["in_share"] == pytest.approx(row["planned_in_share"], abs=2e-3)


def test_a_part_passes_where_the_program_is_good_enough(coarse, scans):
    options = {"aligned": True}
    found = sorting.sort(coarse, [scans / "even.ply"], None, QUICK, 0.2, options, workers=0)
    assert found.parts[0]["sorted"] == sorting.PASSES and found.parts[0]["planned_in_share"] is None


def test_the_report_names_all_in_both_languages(batch, coarse):
    folder, found = batch
    html = sorting_report.write(folder, found, coarse, 0.9).read_text()
    for text in ("passes with this plan", "scrap", "even", "grinding adds nothing"):
        assert text in html
    german = sorting_report.document(found, coarse, 0.9, Language("de"))
    for text in ("besteht mit diesem Plan", "Ausschuss", "das Schleifen trägt nichts auf"):
        assert text in german
    assert sorting_report.counts(found)[sorting.SCRAP] == 2


def test_the_command_sorts_on_processes(coarse, scans, tmp_path, capsys):
    pytest.importorskip("distributed")
    job = tmp_path / "job.json"
    job.write_text(json.dumps(coarse))
    parts = [str(scans / "deep.ply"), str(scans / "even.ply")]
    options = ["--aligned", "--share", "0.2", "--workers", "2", "-o", str(tmp_path / "out")]
    assert cli.main(["sort", str(job), *parts, *options]) == 0
    said = capsys.readouterr().out
    assert "deep: scrap" in said and "even: passes" in said and "1 passes, 1 scrap" in said
    assert (tmp_path / "out" / sorting_report.REPORT).exists()


def test_mistakes_are_told(coarse, tmp_path):
    for arguments, code in (
        (([tmp_path],), "studies.no_scans"),
        ((["a.ply"], None, {}, 1.5), "studies.sort_share"),
        ((["a.ply"], None, {"round": 3}), "base.unknown_key"),
    ):
        with pytest.raises(InputError) as error:
            sorting.sort(coarse, *arguments)
        assert error.value.code == code
    row = sorting.sort(coarse, [tmp_path / "none.ply"], workers=0).parts[0]
    assert row["sorted"] == sorting.UNKNOWN and "none.ply" in row["reason"]
