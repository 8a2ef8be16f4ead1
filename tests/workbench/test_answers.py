"""The answers of studies: yield, main effects, Sobol indices, the best setting, the report."""

import ast
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.base import messages
from beltgrinding.engine import InputError
from beltgrinding.planning import pictures
from beltgrinding.studies import (
    answers,
    best,
    chaos,
    design,
    effects,
    making,
    names,
    report,
    resampling,
    share,
    sobol,
    sorting_report,
    vary,
)
from beltgrinding.studies.table import Table
from test_job import plate_job

ROOT = Path(__file__).resolve().parents[2]
ot = pytest.importorskip("openturns")

# Ishigami and Homma 1990, with a = 7, b = 0.1: f = sin x1 + a sin² x2 + b x3⁴ sin x1, x uniform in [-π, π].
A, B = 7.0, 0.1
VARIANCE = A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 0.5
FIRST = np.array([0.5 * (1 + B * np.pi**4 / 5) ** 2, A**2 / 8, 0.0]) / VARIANCE
TOTAL = FIRST + np.array([1, 0, 1]) * (8 * B**2 * np.pi**8 / 225) / VARIANCE
WITHIN = 0.02


def ishigami(x):
    return np.sin(x[:, 0]) + A * np.sin(x[:, 1]) ** 2 + B * x[:, 2] ** 4 * np.sin(x[:, 0])


def study_of(names, method, runs, **more):
    """A study with its defaults; each name varies in [-π, π]."""
    given = {
        "job": plate_job(),
        "vary": [
            {"name": name, "key": f"placement.{axis}", "range": [-np.pi, np.pi]}
            for name, axis in zip(names, vary.AXES)
        ],
        "design": {"method": method, "runs": runs, "seed": 3},
        **more,
    }
    return making.validate(given, "/")


def table_of(study, function, fail=(), verdict=None):
    """(Table, meta) of a study whose figure f is a function of the values (n, d)."""
    found = vary.variables(study)
    made = design.design(study, found)
    names = [one.name for one in found]
    values = np.array([[float(v) for v in row] for row in made.rows])
    said = function(values)
    status = ["error" if k in fail else "done" for k in range(len(values))]
    columns = {"run": list(range(1, len(values) + 1))}
    columns.update({name: values[:, k].tolist() for k, name in enumerate(names)})
    columns["f"] = [None if k in fail else float(v) for k, v in enumerate(said)]
    if verdict is not None:
        words = verdict(said)
        columns["overall"] = [None if k in fail else w for k, w in enumerate(words)]
    columns["status"] = status
    columns["error"] = ["the stock is too small" if k in fail else "" for k in range(len(values))]
    columns["job_hash"] = [""] * len(values)
    return Table(columns), design.meta(study, made, names)


def codes(found):
    return {note["code"] for note in found["note_facts"]}


def test_the_interval_is_wilsons():
    # Of Newcombe 1998 (Statistics in Medicine 17:857), table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
    for passed, count, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ):
        assert share.wilson(passed, count) == pytest.approx((low, high), abs=6e-5)
    assert share.wilson(20, 20)[1] == 1.0
    assert share.wilson(0, 0) == (None, None)


def test_what_is_not_known_has_not_passed():
    found = share.of(["pass", "pass", "fail", "unknown"], True)
    assert found["share"] == 0.5 and found["unknown"] == 1 and found["low"] < 0.5 < found["high"]
    assert share.of(["pass"], False)["low"] is None


@pytest.mark.slow
def test_indices_of_blocks_are_those_of_ishigamis_function():
    study = study_of("abc", "sobol_indices", 4096)
    table, meta = table_of(study, ishigami)
    found = answers.answers(study, meta, table)["figures"]["f"]["sobol"]
    assert found["method"] == "blocks" and found["count"] == 4096
    for kind, exact in (("first", FIRST), ("total", TOTAL)):
        value, low, high = np.array(found[kind]).T
        assert np.abs(value - exact).max() < WITHIN
        assert (low <= exact + WITHIN).all() and (high >= exact - WITHIN).all()
        assert (low < value).all() and (value < high).all()


def test_what_two_variables_do_together():
    study = study_of("abc", "sobol_indices", 1024)
    study["design"]["second_order"] = True
    table, meta = table_of(study, ishigami)
    found = answers.answers(study, meta, table)["figures"]["f"]["sobol"]
    assert found["second"][0][2] == pytest.approx(TOTAL[2], abs=0.06)  # x1 with x3, and no others
    assert abs(found["second"][0][1]) < 0.06 and abs(found["second"][1][2]) < 0.06


@pytest.mark.slow
def test_indices_of_a_sample_are_those_of_ishigamis_function():
    for method in ("latin_hypercube", "monte_carlo", "sobol"):
        study = study_of("abc", method, 256)
        table, meta = table_of(study, ishigami)
        found = answers.answers(study, meta, table)["figures"]["f"]["sobol"]
        assert found["method"] == "chaos" and found["q2"] > chaos.DOUBTFUL > found["linear_q2"]
        assert np.abs(np.array(found["first"])[:, 0] - FIRST).max() < WITHIN
        assert np.abs(np.array(found["total"])[:, 0] - TOTAL).max() < WITHIN


@pytest.mark.slow
def test_a_poor_expansion_gives_no_index():
    study = study_of("abc", "monte_carlo", 120)
    noise = np.random.default_rng(1).normal(size=120)
    table, meta = table_of(study, lambda x: x[:, 0] + 2.0 * noise)
    found = answers.answers(study, meta, table)["figures"]["f"]["sobol"]
    assert found["first"] is None and found["q2"] < chaos.POOR
    assert found["reason"]["code"] == "studies.indices_poor"
    some, meta = table_of(study, lambda x: x[:, 0] + 0.35 * noise)
    found = answers.answers(study, meta, some)["figures"]["f"]["sobol"]
    assert found["doubt"]["code"] == "studies.indices_doubtful" and found["first"][0][0] > 0.9


def test_correlated_variables_have_no_indices():
    study = study_of(
        "ab", "monte_carlo", 100, correlations=[{"between": ["a", "b"], "coefficient": 0.6}]
    )
    table, meta = table_of(study, lambda x: x[:, 0])
    found = answers.answers(study, meta, table)
    assert found["figures"]["f"]["sobol"]["reason"]["code"] == "studies.indices_of_correlated"
    assert "studies.correlated_effects" in codes(found)


def test_few_values_and_text_have_indices():
    entries = [
        {"name": "x", "key": "placement.x_mm", "range": [0.0, 1.0]},
        {"name": "grit", "key": "belt.material", "values": ["soft", "hard", "harder"]},
        {"name": "n", "key": "placement.y_mm", "values": [1.0, 2.0, 5.0], "weights": [1, 1, 2]},
    ]
    study = {"vary": entries, "correlations": []}
    from beltgrinding.studies.inputs import inputs_of

    x, grit, n = inputs_of(study, ["x", "grit", "n"])
    rng = np.random.default_rng(0)
    a, g, b = (
        rng.random(400),
        rng.integers(0, 3, 400),
        rng.choice([1.0, 2.0, 5.0], 400, p=[0.25, 0.25, 0.5]),
    )
    text = np.array(["soft", "hard", "harder"], dtype=object)[g]
    columns = np.column_stack([x.coded(a), grit.coded(text), n.coded(b)])
    figure = a + np.array([0.0, 2.0, -1.0])[g] + 0.1 * b**2
    found = chaos.of_sample(columns, figure, [x.law(), grit.law(), n.law()])
    parts = np.array(
        [
            1 / 12,
            np.var([0.0, 2.0, -1.0]),
            0.01 * (0.25 * 1 + 0.25 * 16 + 0.5 * 625 - (0.25 + 1 + 12.5) ** 2),
        ]
    )
    assert np.array(found["total"])[:, 0] == pytest.approx(parts / parts.sum(), abs=WITHIN)
    assert grit.value(1.2) == "hard" and n.value(3.9) == 5.0


def test_failed_runs_are_told_and_left_out():
    study = study_of("abc", "sobol_indices", 1024)
    table, meta = table_of(study, ishigami, fail=(3, 1024 + 3, 2 * 1024 + 7))
    found = answers.answers(study, meta, table)
    assert found["runs"]["failed"] == 3 and "studies.failed_runs" in codes(found)
    assert found["runs"]["errors"] == [{"text": "the stock is too small", "count": 3, "run": 4}]
    indices = found["figures"]["f"]["sobol"]
    assert indices["count"] == 1022 and indices["size"] == 1024
    assert np.abs(np.array(indices["total"])[:, 0] - TOTAL).max() < 0.05


def test_a_design_of_failures_answers_nothing():
    study = study_of("a", "monte_carlo", 3)
    table, meta = table_of(study, lambda x: x[:, 0], fail=(0, 1, 2))
    with pytest.raises(InputError) as error:
        answers.answers(study, meta, table)
    assert error.value.code == "studies.nothing_done"


def test_the_yield_of_a_sample_is_the_probability():
    study = study_of("ab", "monte_carlo", 2000)

    def verdict(said):
        return ["pass" if one > np.pi / 2 else "fail" for one in said]

    table, meta = table_of(study, lambda x: x[:, 0], verdict=verdict)
    whole = answers.answers(study, meta, table)["yield"][0]
    assert whole["low"] < 0.25 < whole["high"] and whole["high"] - whole["low"] < 0.05


def test_the_yield_of_blocks_counts_independent_runs_only():
    study = study_of("abc", "sobol_indices", 64)
    table, meta = table_of(study, ishigami, verdict=lambda said: ["pass"] * len(said))
    assert answers.answers(study, meta, table)["yield"][0]["count"] == 128


def test_a_grid_has_no_intervals_and_says_so():
    entries = [
        {"name": "a", "key": "placement.x_mm", "range": [0, 1], "steps": 5},
        {"name": "b", "key": "placement.y_mm", "range": [0, 1], "steps": 3},
    ]
    study = study_of("", "grid", 1, vary=entries)
    table, meta = table_of(
        study, lambda x: 3.0 * x[:, 0] - x[:, 1], verdict=lambda said: ["pass"] * len(said)
    )
    found = answers.answers(study, meta, table)
    assert "studies.grid_yield" in codes(found) and found["yield"][0]["low"] is None
    one = found["figures"]["f"]
    a, b = one["effects"]
    assert (a["swing"], b["swing"]) == pytest.approx((3.0, -1.0)) and a["low"] is None
    assert [level["from"] for level in a["levels"]] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert one["regression"]["r2"] == pytest.approx(1.0)
    assert one["sobol"]["reason"]["code"] == "studies.indices_of_grid"


def test_standardised_coefficients_and_their_intervals():
    rng = np.random.default_rng(4)
    x = {
        "a": rng.normal(size=300),
        "b": 5.0 + 10.0 * rng.normal(size=300),
        "c": rng.normal(size=300),
    }
    y = 2.0 * x["a"] + 0.1 * x["b"] + rng.normal(size=300)
    found = effects.regression(x, y, resampling.counts(300))
    whole = np.sqrt(4.0 + 1.0 + 1.0)
    for row, exact in zip(found["rows"], (2.0 / whole, 1.0 / whole, 0.0)):
        assert row["low"] < exact < row["high"] and row["high"] - row["low"] < 0.25
    assert found["r2"] == pytest.approx(5.0 / 6.0, abs=0.05)
    twice = {**x, "again": x["a"]}
    assert effects.regression(twice, y) is None  # they do not determine the coefficients


def test_intervals_cover_as_often_as_they_say():
    rng, inside = np.random.default_rng(5), 0
    for _ in range(100):
        values = np.repeat([0.0, 1.0], 40)
        y = values + rng.normal(size=80)
        one = effects.main_effects({"x": values}, y, resampling.counts(80))[0]
        inside += one["low"] < 1.0 < one["high"]
    assert 86 <= inside <= 100  # of 95 expected, with 4 of their standard deviations


FIGURES = {"time": np.array([9.0, 5.0, 5.0, 3.0]), "share": np.array([1.0, 0.9, 0.95, 0.5])}
ALL = np.ones(4, dtype=bool)


def test_the_best_run_keeps_the_limits():
    found = best.of_runs(FIGURES, "time", "minimise", {"share": (0.8, None)}, ALL)
    assert (found["run"], found["ties"], found["feasible"]) == (1, [2], 3)
    found = best.of_runs(FIGURES, "share", "maximise", {"time": (None, 6.0)}, ALL)
    assert found["run"] == 2 and found["value"] == 0.95
    none = best.of_runs(FIGURES, "time", "minimise", {"share": (1.5, None)}, ALL)
    assert none["run"] is None and none["nearest"]["run"] == 0
    assert none["nearest"]["beyond"] == {"share": pytest.approx(0.5)}
    with pytest.raises(InputError) as error:
        best.of_runs(FIGURES, "tima", "minimise", {}, ALL)
    assert error.value.code == "studies.best_no_figure"


def test_the_surface_finds_what_lies_between_the_runs():
    wanted = {"figure": "f", "goal": "minimise", "limits": {"f": [None, 1.0]}, "surface": True}
    study = study_of("ab", "latin_hypercube", 60, answers={"best": wanted})
    table, meta = table_of(study, lambda x: (x[:, 0] - 1.0) ** 2 + (x[:, 1] + 0.5) ** 2)
    found = answers.answers(study, meta, table)["best"]
    said = found["surface"]
    assert said["values"] == {"a": pytest.approx(1.0, abs=0.02), "b": pytest.approx(-0.5, abs=0.02)}
    assert said["feasible"] and found["value"] > said["predicted"]["f"] - 1e-9
    assert said["q2"]["f"][0] > 0.999 > said["q2"]["f"][1]


@pytest.fixture(scope="module")
def ground_study(tmp_path_factory):
    """The folder of a small study that was run."""
    folder = tmp_path_factory.mktemp("study")
    job = plate_job()
    job["sampling"]["spacing_mm"] = 2.0
    given = {
        "job": job,
        "vary": [
            {"name": "force", "key": "belt_machine.force_N", "range": [10, 60]},
            {"name": "allowance", "key": "stock.allowance_mm", "range": [0.1, 0.4]},
        ],
        "design": {"runs": 24},
        "answers": {
            "best": {
                "figure": "removed_volume_mm3",
                "goal": "maximise",
                "limits": {"removed_volume_mm3": [None, 150.0]},
                "surface": True,
            }
        },
    }
    making.study(given, folder, workers=0)
    return folder


@pytest.fixture(scope="module")
def two_figures(ground_study, tmp_path_factory):
    """The same in another folder, asked for two figures: of each there are several pictures."""
    folder = tmp_path_factory.mktemp("two") / "study"
    shutil.copytree(ground_study, folder)
    given = json.loads((folder / "study.json").read_text())
    given["answers"]["figures"] = ["removed_volume_mm3", "in_share"]
    (folder / "study.json").write_text(json.dumps(given))
    return folder


@pytest.mark.slow
def test_a_ground_study_has_its_report(ground_study):
    found = report.write_answers(ground_study)
    assert json.loads((ground_study / report.ANSWERS).read_text()) == found
    one = found["figures"]["removed_volume_mm3"]
    force = next(row for row in one["regression"]["rows"] if row["variable"] == "force")
    assert force["low"] > 0.3  # who presses harder removes more
    assert found["runs"]["done"] == 24
    said = found["best"]["surface"]
    assert said["checked"]["removed_volume_mm3"] == pytest.approx(
        said["predicted"]["removed_volume_mm3"], rel=0.15
    )
    pictures = {path.name for path in (ground_study / report.PICTURES).iterdir()}
    assert {"yield.png", "matrix.png", "removed_volume_mm3-tornado.png"} <= pictures
    html = (ground_study / report.REPORT).read_text()
    assert "Tolerance yield" in html and html.count("data:image/png") == len(pictures)


@pytest.mark.slow
def test_the_report_speaks_german(two_figures):
    report.write_answers(two_figures, "de")
    html = (two_figures / report.REPORT).read_text()
    assert "Ausbeute nach der Toleranz" in html and "standardisierter Koeffizient" in html
    for english in ("Tolerance yield", "what varies", "first level", "Latin hypercube"):
        assert english not in html


@pytest.mark.slow
def test_the_command_writes_answers_beside_the_table(ground_study, capsys):
    (ground_study / report.REPORT).unlink(missing_ok=True)
    given = str(ground_study / "study.json")
    call = ["study", given, "-o", str(ground_study), "--workers", "0"]
    assert cli.main([*call, "--no-report"]) == 0
    assert not (ground_study / report.REPORT).exists()
    assert cli.main([*call, "--language", "de"]) == 0
    told = capsys.readouterr()
    assert report.REPORT in told.out and "only 24 runs" in told.err
    assert "Ausbeute" in (ground_study / report.REPORT).read_text()


def test_every_text_is_there_in_german():
    german, texts = messages.of_report("de"), set()
    for file in Path(report.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            called = isinstance(node, ast.Call) and getattr(node.func, "id", None) == "words"
            if called and isinstance(node.args[0], ast.Constant):
                texts.add(node.args[0].value)
    texts |= {*names.NAMES.values(), *names.OF_ZONE.values(), *report.METHODS.values()}
    texts |= {"first level", "last level", "all levels", "set to", "plus", "times"}
    texts |= {*sorting_report.TEXTS.values(), *pictures.WORDS.values()} - {"before", "as planned"}
    texts -= {pictures.WORDS["why"]}
    texts |= {"whole part passes", "nowhere too much left", "nowhere cut too deep"}
    assert len(texts) > 90 and sorted(texts - german.keys()) == []


def test_notes_have_a_german_form():
    fact = {"code": "studies.open_runs", "text": "", "arguments": {"open": 3, "count": 7}}
    assert messages.sentence(fact, "de").startswith("3 von 7")
