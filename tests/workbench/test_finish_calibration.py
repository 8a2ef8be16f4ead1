"""Calibration of the finish, on made-up measurements whose truth is known."""

import json

import numpy as np
import pytest

from beltgrinding import calibration, cli
from beltgrinding.base import schemas
from beltgrinding.calibration import finish, finish_table
from beltgrinding.engine import Cancelled, InputError, core
from beltgrinding.job import load as jobs
from support import synthetic_finish as made_up
from test_job import plate_job

TRUTH = made_up.TRUTH


def codes(found):
    return [warning.code for warning in found["report"]["warnings"]]


def truth_at(model):
    """Ra of the made-up belt at a model's references."""
    c = {
        "grit": model["reference_grit"],
        "pressure_MPa": model["reference_pressure_MPa"],
        "belt_speed_m_s": model["reference_belt_speed_m_s"],
        "feed_mm_s": model["reference_feed_mm_s"],
        "remaining_cut": 1.0,
    }
    return float(made_up.steady(c))


def test_without_scatter_the_truth_is_found():
    found = calibration.fit_finish(made_up.columns(scatter=1e-5))
    model = found["model"]
    for name in TRUTH:
        if name != "coefficient_um":
            assert model[name] == pytest.approx(TRUTH[name], abs=2e-3), name
    assert model["coefficient_um"] == pytest.approx(truth_at(model), rel=2e-3)
    rule = schemas.schema("job")["properties"]["finish"]["properties"]["model"]
    assert not list(schemas.problems(model, rule, "model"))


@pytest.mark.slow
def test_intervals_hold_the_truth_in_nearly_all_tables():
    inside = total = 0
    for seed in range(12):
        found = calibration.fit_finish(made_up.columns(count=45, scatter=0.12, seed=seed))
        rows = {row["name"]: row for row in found["report"]["parameters"]}
        rows["coefficient_um"]["truth"] = truth_at(found["model"])
        rows["rest_per_pass"] = found["report"]["rest_per_pass"]
        for name, row in rows.items():
            inside += row["low"] <= row.get("truth", TRUTH[name]) <= row["high"]
            total += 1
    assert total == 84 and 0.88 * total <= inside


def test_left_out_measurements_are_told_better_than_by_plain_ways():
    report = calibration.fit_finish(made_up.columns(scatter=0.1, passes=False))["report"]
    left, plain = report["left_out"], report["plain"]
    assert left["median"] < 0.13
    assert left["median"] < 0.6 * plain["grit_only"]["median"] < plain["constant"]["median"]


def test_a_new_measurement_lies_in_its_interval():
    model = calibration.fit_finish(made_up.columns(count=50, scatter=0.1, seed=3))["model"]
    new = finish_table.from_columns(made_up.columns(count=400, scatter=0.1, seed=4))
    told = finish.predict(model, new)
    known = np.isfinite(told)
    away = np.abs(np.log(new.measured[known] / told[known]))
    assert known.mean() > 0.7
    assert (away < 1.96 * model["ln_deviation"]).mean() > 0.93


def test_outside_of_what_was_measured_nothing_is_told():
    model = calibration.fit_finish(made_up.columns())["model"]
    inside = {name: [np.exp(np.log(span).mean())] for name, span in model["ranges"].items()}
    row = {**inside, "Ra_um": [1.0]}
    assert np.isfinite(finish.predict(model, finish_table.from_columns(row))).all()
    for name, (low, high) in model["ranges"].items():
        for value in (0.9 * low, 1.1 * high):
            if name == "remaining_cut" and value > 1.0:
                continue
            outside = finish_table.from_columns({**row, name: [value]})
            assert np.isnan(finish.predict(model, outside)).all(), name


def test_blunders_hardly_count():
    table = made_up.columns(count=50, scatter=0.05)
    table["Ra_um"][7] *= 20.0
    found = calibration.fit_finish(table)
    assert found["report"]["outliers"] == [8]
    assert found["model"]["grit_exponent"] == pytest.approx(TRUTH["grit_exponent"], abs=0.12)


def test_what_does_not_vary_has_no_exponent_and_a_range_of_one_value():
    found = calibration.fit_finish(made_up.columns(fixed=("belt_speed_m_s",)))
    assert found["model"]["belt_speed_exponent"] == 0.0
    low, high = found["model"]["ranges"]["belt_speed_m_s"]
    assert low == high and "calibration.finish_not_varied" in codes(found)


def test_without_passes_no_share_of_them_is_made_up():
    found = calibration.fit_finish(made_up.columns(passes=False))
    assert "rest_per_pass" not in found["model"] and found["report"]["rest_per_pass"] is None
    assert "calibration.finish_no_rest" in codes(found)


def test_effects_that_move_together_are_named_or_refused():
    table = made_up.columns(count=60)
    random = np.random.default_rng(5)
    together = 0.5 * np.asarray(table["belt_speed_m_s"]) / 20.0
    table["pressure_MPa"] = (together * np.exp(0.02 * random.standard_normal(60))).tolist()
    try:
        found = calibration.fit_finish(table)
    except InputError as error:
        assert error.code == "calibration.finish_undetermined"
    else:
        assert "calibration.together" in codes(found)
    table["pressure_MPa"] = together.tolist()  # the same to the last bit
    with pytest.raises(InputError) as refused:
        calibration.fit_finish(table)
    assert refused.value.code == "calibration.finish_undetermined"


def test_tables_that_cannot_be_are_refused():
    whole = made_up.columns(count=20)
    for change, code in (
        ({"Ra_um": None}, "calibration.no_column"),
        ({"grit": None}, "calibration.no_column"),
        ({"pressure_MPa": None}, "calibration.no_column"),
        ({"feed_mm_s": [0.0] * 20}, "calibration.finish_stands"),
        ({"remaining_cut": [1.2] * 20}, "calibration.cut_above_one"),
        ({"Ra_um": ["rough"] * 20}, "calibration.no_number"),
        ({"Ra_um": [-1.0] * 20}, "calibration.cell_not_positive"),
    ):
        table = {**whole, **change}
        with pytest.raises(InputError) as refused:
            calibration.fit_finish({k: v for k, v in table.items() if v is not None})
        assert refused.value.code == code
    few = {name: values[:5] for name, values in whole.items()}
    with pytest.raises(InputError) as refused:
        calibration.fit_finish(few)
    assert refused.value.code == "calibration.finish_too_few"


def test_force_over_area_is_the_pressure_and_a_job_tells_what_wear_leaves():
    table = made_up.columns(scatter=1e-5, passes=False)
    cut = np.asarray(table.pop("remaining_cut"))
    table["work_J"] = (-1e5 * np.log(cut)).tolist()
    table["force_N"] = [100.0 * p for p in table.pop("pressure_MPa")]
    table["area_mm2"] = [100.0] * len(cut)
    remaining = lambda work, removed: np.exp(-work / 1e5)
    found = calibration.fit_finish(table, remaining)
    model = found["model"]
    assert "calibration.wear_by_job" in codes(found)
    assert model["wear_exponent"] == pytest.approx(TRUTH["wear_exponent"], abs=2e-3)
    assert model["pressure_exponent"] == pytest.approx(TRUTH["pressure_exponent"], abs=2e-3)
    assert "calibration.wear_without_job" in codes(calibration.fit_finish(table))
    none = finish_table.wear_by(jobs.validate(plate_job()))
    assert "calibration.no_wear_by_job" in codes(calibration.fit_finish(table, none))


def test_a_fit_tells_how_far_it_is_and_is_cancelled():
    context, table = core.RunContext(), made_up.columns(count=60)
    assert calibration.fit_finish(table, context=context) and context.progress > 0.95
    context.cancel()
    with pytest.raises(Cancelled):
        calibration.fit_finish(table, context=context)


def test_the_command_writes_what_a_job_takes(tmp_path, capsys):
    table = made_up.write(tmp_path / "ra.csv", made_up.columns())
    model, report = tmp_path / "model.json", tmp_path / "report.json"
    arguments = ["calibrate-finish", str(table), "-o", str(model), "--report", str(report)]
    assert cli.main([*arguments, "--source", "SYNTHETIC"]) == 0
    told = capsys.readouterr().out
    assert "left-out measurements, the model" in told and "by the grit alone" in told
    written = json.loads(model.read_text())
    rule = schemas.schema("job")["properties"]["finish"]["properties"]["model"]
    assert not list(schemas.problems(written, rule, "model")) and written["source"] == "SYNTHETIC"
    assert json.loads(report.read_text())["measurements"] == 40
    # Its own files it may write again, another's only when it is told to.
    assert cli.main(arguments) == 0 and json.loads(model.read_text())["source"] == str(table)
    model.write_text('{"coefficient_um": 1}')
    assert cli.main(arguments) != 0 and model.read_text() == '{"coefficient_um": 1}'
