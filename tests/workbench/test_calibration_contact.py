"""Grinds made by whole simulations: the law fitted to them grinds the same volumes again."""

import copy
import json

import numpy as np
import pytest

import beltgrinding
from beltgrinding.calibration import calibrate as calibration
from beltgrinding.calibration.table import from_columns
from beltgrinding.cli import main
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from test_job import plate_job

FORCES, FEEDS, SPEEDS = (12.0, 20.0, 33.0, 55.0), (20.0, 60.0), (14.0, 26.0)
LENGTH = 40.0  # mm, of the pass
TRUTH = {"model": "local", "coefficient_mm2_per_N": 4e-6, "reference_pressure_MPa": 0.15}
WHEEL = {  # of plate_job
    "wheel_radius_mm": 60.0,
    "wheel_width_mm": 15.0,
    "rim_thickness_mm": 15.0,
    "youngs_modulus_MPa": 5.0,
}


def grind(law, force, feed, speed):
    """Volume of a moving pass by a whole simulation, mm3."""
    job = plate_job()
    job["law"] = copy.deepcopy(law)
    job["belt_machine"].update(force_N=force, belt_speed_m_s=speed)
    for pose in job["programs"][0]["poses"]:
        pose["feed_mm_s"] = feed
    result = beltgrinding.run(job)
    assert "volume_lost" not in result.summary["events"]
    return result.summary["removed_volume_mm3"]


def grinds(alpha):
    """(rows of force, feed, speed; columns of a table) of the law with the exponent ``alpha``."""
    law = {**TRUTH, "pressure_exponent": alpha, "speed_exponent": 1.3}
    rows = [(f, w, s) for f in FORCES for w in FEEDS for s in SPEEDS]
    force, feed, speed = np.array(rows).T.tolist()
    removed = [grind(law, *row) for row in rows]
    columns = {"force_N": force, "feed_mm_s": feed, "belt_speed_m_s": speed}
    columns.update(length_mm=[LENGTH] * len(rows), removed_volume_mm3=removed)
    return rows, columns


@pytest.mark.slow
@pytest.mark.parametrize("alpha", [1.9, 2.65])
def test_the_law_grinds_the_very_test_grinds_again(alpha):
    rows, columns = grinds(alpha)
    wheel = {key: [value] * len(rows) for key, value in WHEEL.items()}
    result = calibration.fit({**columns, **wheel})
    law, report = result["law"], result["report"]
    assert law["pressure_exponent"] == pytest.approx(alpha, abs=0.05)
    assert law["calibration"]["fit"]["contacts_known"] == len(rows)
    assert any("contacts of 16 of 16 grinds are solved" in text for text in report["warnings"])
    ratio = [grind(law, *row) / was for row, was in zip(rows, columns["removed_volume_mm3"])]
    print(f"alpha {alpha}: simulated again over measured {min(ratio):.4f} to {max(ratio):.4f}")
    assert max(abs(one - 1.0) for one in ratio) < 0.02
    told = calibration.predict(law, {**columns, **wheel})["predicted"]
    assert np.allclose(told, columns["removed_volume_mm3"], rtol=0.02)

    # Fitted to mean pressures it would remove too much, which the report says.
    table = from_columns({**columns, **wheel})
    mean = calibration.fit({**columns, "area_mm2": table.area.tolist()})
    told = [text for text in mean["report"]["warnings"] if "a simulation removes" in text]
    assert len(told) == 1
    ratio = grind(mean["law"], *rows[4]) / columns["removed_volume_mm3"][4]
    print(f"fitted to mean pressures: {ratio:.3f}, told: {told[0]}")
    assert ratio > 1.04


@pytest.mark.slow
def test_the_jobs_wheel_stands_for_the_grinds(tmp_path, capsys):
    _, columns = grinds(1.9)
    job = plate_job()
    by_columns = calibration.fit_law(
        {**columns, **{key: [value] * len(FORCES) * 4 for key, value in WHEEL.items()}}
    )
    machine = jobs.validate(job)["belt_machine"]
    by_job = calibration.fit_law(columns, machine=machine)
    assert by_job["pressure_exponent"] == pytest.approx(by_columns["pressure_exponent"], abs=1e-6)
    assert calibration.predict(by_job, columns)["predicted"] == pytest.approx(
        columns["removed_volume_mm3"], rel=0.02
    )
    lines = [",".join(columns), *(",".join(map(str, row)) for row in zip(*columns.values()))]
    (tmp_path / "grinds.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "job.json").write_text(json.dumps(job))
    arguments = ["calibrate", str(tmp_path / "grinds.csv"), "--job", str(tmp_path / "job.json")]
    assert main([*arguments, "-o", str(tmp_path / "law.json")]) == 0
    written = json.loads((tmp_path / "law.json").read_text())
    assert written["pressure_exponent"] == pytest.approx(by_job["pressure_exponent"], abs=1e-9)
    assert "are solved from wheel and part (wheel_rim)" in capsys.readouterr().err
    machine["compliance"]["model"] = "geometric"
    with pytest.raises(InputError, match="is rigid"):
        calibration.fit(columns, machine=machine)


def test_what_is_not_known_of_contacts_is_told():
    random = np.random.default_rng(1)
    force, speed = random.uniform(10, 60, 24), random.uniform(10, 30, 24)
    columns = {
        "force_N": force.tolist(),
        "belt_speed_m_s": speed.tolist(),
        "time_s": [10.0] * 24,
        "removed_volume_mm3": (1e-2 * force**1.5 * speed).tolist(),
        "area_mm2": [500.0] * 24,
        **{key: [value] * 24 for key, value in WHEEL.items()},
    }
    columns["wheel_radius_mm"][:6] = [""] * 6
    columns["part_radius_mm"] = ["", 30.0] * 12
    table = from_columns(columns)
    assert np.isnan(table.relative[:6]).all() and (table.area[:6] == 500.0).all()
    assert np.allclose(table.relative[6:].mean(axis=1), 1.0)
    assert (np.diff(table.relative[6:], axis=1) <= 1e-9).all() and table.relative[6:, 0].min() > 1.2
    assert (table.area[6:] < 300.0).all()
    result = calibration.fit(columns)
    text = " ".join(map(str, result["report"]["warnings"]))
    assert "contacts of 18 of 24 grinds are solved" in text
    assert "contacts of 6 grinds are not known" in text
    assert "18 contact areas are taken from wheel and part, not from the table" in text
    profile = result["law"]["calibration"]["fit"]["pressure_profile"]
    assert profile == pytest.approx(table.relative[6:].mean(axis=0).tolist())
