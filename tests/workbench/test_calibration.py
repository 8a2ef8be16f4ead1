"""Calibration of the removal law: grinds of a known law, damaged tables, scans, command line."""

import json

import numpy as np
import pytest

from beltgrinding.engine import InputError, core
from beltgrinding.calibration import (
    calibrate as calibration,
    plot as calibration_plot,
    table as calibration_table,
)
from beltgrinding import cli
from beltgrinding.simulation import run as runs
from beltgrinding.job import law as laws, load as jobs
from test_job import plate_job

K, ALPHA, BETA, GAMMA = 2e-5, 1.3, 1.2, 0.1  # at 0.1 MPa, 20 m/s, 50 mm/s


def rate(force, speed, area):
    """dh/dt of the known law, mm/s."""
    return K * 20e3 * (speed / 20) ** BETA * 0.1 * (force / area / 0.1) ** ALPHA


def grinds(seed, count=40, noise=0.1, wear_J=None, passes=False):
    """Columns of random grinds: stationary, or passes measured by their depth."""
    random = np.random.default_rng(seed)
    force, speed = random.uniform(5, 60, count), random.uniform(10, 35, count)
    area = random.choice([60.0, 120.0, 240.0], count)
    columns = {"force_N": force, "belt_speed_m_s": speed, "area_mm2": area}
    if passes:
        feed, width = random.uniform(10, 200, count), np.full(count, 20.0)
        columns.update(feed_mm_s=feed, contact_width_mm=width)
        removed = rate(force, speed, area) * (feed / 50) ** GAMMA * area / (width * feed)
    else:
        columns["time_s"] = random.uniform(3, 30, count)
        removed = rate(force, speed, area) * area * columns["time_s"]
    if wear_J:
        columns["work_J"] = random.uniform(0, 1.5 * wear_J, count)
        removed = removed * np.exp(-columns["work_J"] / wear_J)
    removed = removed * np.exp(noise * random.normal(size=count))
    columns["depth_mm" if passes else "removed_volume_mm3"] = removed
    return {name: values.tolist() for name, values in columns.items()}


def found(result):
    return {one["name"]: one for one in result["report"]["parameters"]}


def true_coefficient(law):
    """K of the known law at the references of another."""
    ratio = law["reference_speed_m_s"] / 20
    pressure = law["reference_pressure_MPa"] / 0.1
    feed = law["reference_feed_mm_s"] / 50 if law["feed_exponent"] else 1.0
    return K * ratio ** (BETA - 1) * pressure ** (ALPHA - 1) * feed**GAMMA


def write_csv(path, columns, separator=","):
    lines = [separator.join(columns)]
    lines += [separator.join(str(v) for v in row) for row in zip(*columns.values())]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_grinds_without_scatter_give_the_law_itself():
    law = calibration.fit(grinds(1, noise=0.0))["law"]
    assert law["model"] == "local" and law["wear"] == {"model": "none"}
    assert law["pressure_exponent"] == pytest.approx(ALPHA, abs=1e-6)
    assert law["speed_exponent"] == pytest.approx(BETA, abs=1e-6)
    assert law["coefficient_mm2_per_N"] == pytest.approx(true_coefficient(law), rel=1e-6)
    assert law["calibration"]["parameters"] == [
        "coefficient",
        "pressure_exponent",
        "speed_exponent",
    ]
    assert np.shape(law["calibration"]["covariance"]) == (3, 3)


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    hits = []
    for seed in range(120):
        result = calibration.fit(grinds(seed, 24, wear_J=3e5))
        truth = {
            "coefficient": true_coefficient(result["law"]),
            "pressure_exponent": ALPHA,
            "speed_exponent": BETA,
            "wear_scale": 3e5,
        }
        hits += [
            one["low"] <= truth[name] <= one["high"]
            for name, one in found(result).items()
            if one["free"] and name in truth
        ]
    assert len(hits) > 440
    print(f"coverage of the 95 % intervals: {np.mean(hits):.3f}")
    assert 0.92 <= np.mean(hits) <= 0.99


def test_outliers_do_not_move_it():
    columns = grinds(5)
    clean = found(calibration.fit(columns))
    for place, factor in ((3, 6.0), (11, 0.1), (20, 8.0), (30, 0.2)):
        columns["removed_volume_mm3"][place] *= factor
    result = calibration.fit(columns)
    assert set(result["report"]["outliers"]) >= {4, 12, 21, 31}
    for name in ("pressure_exponent", "speed_exponent"):
        width = clean[name]["high"] - clean[name]["low"]
        assert abs(found(result)[name]["value"] - clean[name]["value"]) < 0.35 * width
    assert any("outliers" in warning for warning in result["report"]["warnings"])


def test_force_and_speed_that_move_together_are_named():
    columns = grinds(2)
    speed = 10.0 * (np.array(columns["force_N"]) / 5) ** 0.5
    columns["belt_speed_m_s"] = speed.tolist()
    columns["area_mm2"] = [100.0] * len(speed)
    volume = rate(np.array(columns["force_N"]), speed, 100.0) * 100.0 * columns["time_s"]
    columns["removed_volume_mm3"] = volume.tolist()
    result = calibration.fit(columns)
    text = " ".join(result["report"]["warnings"])
    assert "force and belt speed move together" in text and "cannot separate" in text
    assert result["law"]["speed_exponent"] == 1.0
    # The force carries both: 1.3 + (1.2 - 1) / 2.
    assert result["law"]["pressure_exponent"] == pytest.approx(ALPHA + (BETA - 1) / 2, abs=1e-3)


def test_what_the_data_do_not_tell_is_fixed():
    columns = grinds(3)
    columns["belt_speed_m_s"] = [20.0] * 40
    result = calibration.fit(columns)
    assert not found(result)["speed_exponent"]["free"]
    assert any("do not vary belt speed" in warning for warning in result["report"]["warnings"])
    random = np.random.default_rng(3)
    columns = grinds(3, noise=0.6)
    columns["belt_speed_m_s"] = random.uniform(19, 21.5, 40).tolist()
    result = calibration.fit(columns)
    speed = found(result)["speed_exponent"]  # as published, and as wide
    assert speed["value"] == pytest.approx(1.35, abs=0.35) and speed["high"] - speed["low"] > 2.0
    text = " ".join(result["report"]["warnings"])
    assert "effect of belt speed undetermined" in text and "what is published" in text
    columns = {**grinds(4), "work_J": random.uniform(0, 1e5, 40).tolist()}
    result = calibration.fit(columns)
    wear = laws.engine_wear({"wear": {"curve": [], **result["law"]["wear"]}})
    half, whole = (core.belt_remaining(wear, {"work": work}) for work in (5e4, 1e5))
    assert whole / half > np.exp(-5e4 / 5e5)


def test_wear_and_time_are_found():
    columns = grinds(6, 60, noise=0.05, wear_J=2e5)
    volume = np.array(columns["removed_volume_mm3"]) * (np.array(columns["time_s"]) / 10) ** 0.4
    columns["removed_volume_mm3"] = volume.tolist()
    result = calibration.fit(columns)
    assert result["law"]["wear"]["scale"] == pytest.approx(2e5, rel=0.15)
    assert result["law"]["wear"]["variable"] == "work"
    assert found(result)["time_exponent"]["value"] == pytest.approx(1.4, abs=0.05)
    assert any("time^1." in warning for warning in result["report"]["warnings"])


def test_moving_passes_and_their_prediction():
    result = calibration.fit(grinds(7, 60, passes=True))
    for name, truth in (("pressure_exponent", ALPHA), ("feed_exponent", GAMMA)):
        one = found(result)[name]
        assert one["free"] and abs(one["value"] - truth) < one["high"] - one["low"]
    within = []
    for seed in range(20):
        law = calibration.fit_law(grinds(seed, 60, passes=True))
        fresh = grinds(100 + seed, 60, passes=True)
        said = calibration.predict(law, fresh)
        error = np.log(np.array(fresh["depth_mm"]) / said["predicted"])
        assert np.median(np.abs(error)) < 0.1
        within += list(np.abs(error) < 1.96 * said["ln_deviation"])
    assert 0.91 < np.mean(within) < 0.98
    del fresh["depth_mm"]
    assert np.allclose(calibration.predict(law, fresh)["predicted"], said["predicted"])
    # A law that was never calibrated predicts as well: Hammann's depth K V_b F / (V_w l_w).
    row = {"force_N": 50, "belt_speed_m_s": 20, "feed_mm_s": 100, "contact_width_mm": 25}
    plain = calibration.predict({"model": "hammann", "coefficient_mm2_per_N": 1e-5}, [row])
    assert plain["predicted"][0] == pytest.approx(1e-5 * 20e3 * 50 / (100 * 25))


def test_unknown_areas_are_told_by_the_removal():
    columns = grinds(9, 60)
    whole = found(calibration.fit(columns))
    hidden = {
        **columns,
        "area_mm2": ["" if i % 4 == 0 else a for i, a in enumerate(columns["area_mm2"])],
    }
    result = calibration.fit(hidden)
    assert any("15 of 60 contact areas are unknown" in w for w in result["report"]["warnings"])
    for name in ("pressure_exponent", "speed_exponent"):
        width = whole[name]["high"] - whole[name]["low"]
        assert abs(found(result)[name]["value"] - whole[name]["value"]) < width
    nowhere = {key: values for key, values in columns.items() if key != "area_mm2"}
    result = calibration.fit(nowhere)
    assert any("no contact area is known" in w for w in result["report"]["warnings"])


def test_a_prediction_without_wear_or_areas_takes_the_calibrations():
    columns = grinds(17, 60, noise=0.02, wear_J=2e5)
    law = calibration.fit_law(columns)
    few = {key: columns[key] for key in ("force_N", "belt_speed_m_s", "time_s")}
    said = calibration.predict(law, few)
    whole = calibration.predict(law, columns)
    assert np.median(np.abs(np.log(said["predicted"] / whole["predicted"]))) < 0.6
    assert (said["ln_deviation"] > whole["ln_deviation"]).all()
    nowhere = {key: values for key, values in columns.items() if key != "area_mm2"}
    law = calibration.fit_law(nowhere)
    half = {key: values[:20] for key, values in nowhere.items()}
    both = [calibration.predict(law, table)["predicted"][:20] for table in (nowhere, half)]
    assert np.allclose(*both)
    with pytest.raises(InputError, match="counts the belt's wear as work"):
        calibration.predict(law, {"wear": half.pop("work_J"), **half})


def test_other_units_are_converted():
    columns = grinds(18, passes=True)
    other = {key: np.array(values) for key, values in columns.items()}
    other["feed (mm/min)"] = 60 * other.pop("feed_mm_s")
    other["Depth [\u00b5m]"] = 1000 * other.pop("depth_mm")
    one, two = (calibration_table.from_columns(table) for table in (columns, other))
    assert np.allclose(one.feed, two.feed) and np.allclose(one.measured, two.measured)
    with pytest.raises(InputError, match="has 3 values, others 40"):
        calibration.fit({**columns, "area_mm2": [1, 2, 3]})


def test_areas_from_the_wheel():
    columns = grinds(10, 8)
    del columns["area_mm2"]
    given = {"wheel_radius_mm": 60, "wheel_width_mm": 15, "rim_thickness_mm": 10}
    given["youngs_modulus_MPa"] = 5
    columns.update({key: [value] * 8 for key, value in given.items()})
    columns["force_N"] = [10.0, 40.0] * 4
    table = calibration_table.from_columns(columns)
    assert (table.area[1::2] > table.area[::2]).all() and (table.area > 10).all()


def test_tables_of_any_writing_read_alike(tmp_path):
    columns = grinds(11)
    whole = calibration.read(write_csv(tmp_path / "a.csv", columns))
    lines = [
        "# measured in spring",
        "",
        "# " + " ; ".join(["Note", *map(str.upper, columns)][::-1]),
    ]
    for row in zip(*columns.values()):
        lines.append(";".join(["a, b", *(str(v).replace(".", ",") for v in row)][::-1]))
    (tmp_path / "b.csv").write_bytes(b"\xef\xbb\xbf" + "\r\n".join(lines).encode())
    other = calibration.read(tmp_path / "b.csv")
    for key in ("force", "speed", "time", "area", "measured"):
        assert np.allclose(getattr(whole, key), getattr(other, key))
    assert other.lines[0] == 4 and "'Note'" in other.notes[0]
    renamed = dict(
        zip(
            ("avg_force_N", "avg_rpm", "grind_area_mm2", "grind_time_s", "removed_mm3"),
            columns.values(),
        )
    )
    nominal = calibration_table.from_columns(renamed)
    real = calibration_table.from_columns(renamed, 100.0)
    assert np.allclose(nominal.speed, 2 * real.speed)
    assert any("nominal drive wheel of 200 mm" in note for note in nominal.notes)


@pytest.mark.parametrize(
    "content, culprit",
    [
        ("", "not even a header"),
        ("force_N,belt_speed_m_s,time_s,removed_volume_mm3\n", "not even a row"),
        ("1,2,3\n4,5,6\n", "line 1: this is no header"),
        ("force_N,time_s,removed_volume_mm3\n1,2,3\n", "belt_speed_m_s or rpm"),
        ("force_N,rpm,time_s\n1,2,3\n", "removed_volume_mm3 or depth_mm"),
        ("force_N,rpm,removed_mm3\n1,2,3\n", "time_s or feed_mm_s"),
        ("force_N,rpm,feed_mm_s,removed_mm3\n1,2,3,4\n", "line 2: length_mm"),
        ("force_N,rpm,feed_mm_s,depth_mm\n1,2,3,4\n", "line 2: contact_width_mm"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,3\n", "line 2: 3 columns where the header has 4"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,3,4,5\n", "separate the columns by ';'"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,,4\n", "line 2: time_s"),
        ("force_N,rpm,time_s,removed_mm3\n,2,3,4\n", "line 2: column 'force_N' is empty"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,3,4\n1,2,3,5 mm\n", "line 3: column 'removed_mm3'"),
        ("force_N,rpm,time_s,removed_mm3\n1,-2,3,4\n", "must be positive"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,3,inf\n", "must be positive"),
        ("force_N,force,rpm,time_s,removed_mm3\n1,2,3,4,5\n", "same column"),
        ("force_N,rpm,time_s,removed_mm3\n1,2,3,4\n", "1 grinds are too few"),
    ],
)
def test_wrong_tables_name_the_culprit(tmp_path, content, culprit):
    (tmp_path / "grinds.csv").write_text(content)
    with pytest.raises(InputError, match="grinds.csv") as caught:
        calibration.fit(tmp_path / "grinds.csv")
    assert culprit in str(caught.value)


def test_damaged_tables_never_crash(tmp_path):
    whole = write_csv(tmp_path / "whole.csv", grinds(12, 8, wear_J=1e5)).read_bytes()
    random = np.random.default_rng(13)
    damaged = tmp_path / "damaged.csv"
    refused = 0
    for _ in range(300):
        content = bytearray(whole[: random.integers(0, len(whole) + 1)])
        for place in random.integers(0, max(1, len(content)), random.integers(1, 12)):
            if content:
                content[place] = random.integers(0, 256)
        damaged.write_bytes(content)
        try:
            calibration.fit(damaged)
        except InputError as error:
            assert "damaged.csv" in str(error)
            refused += 1
    assert refused > 100
    with pytest.raises(InputError, match="cannot be read"):
        calibration.fit(tmp_path / "absent.csv")


def test_the_scan_of_a_known_coefficient():
    random = np.random.default_rng(14)
    x, y = np.meshgrid(np.arange(0, 60, 0.5), np.arange(0, 40, 0.5))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    removed = 0.12 * np.exp(-(((points[:, 1] - 20) / 8) ** 2)) + 0.01
    hits, offsets = [], []
    for _ in range(40):
        form = sum(  # the stock is never quite what it should be, over some millimetres
            0.004 * np.sin(points[:, k] / random.uniform(1.0, 2.0) + random.uniform(0, 6))
            for k in (0, 1)
        )
        measured = 0.2 - 1.25 * removed + 0.03 + form + 0.005 * random.normal(size=x.size)
        measured[random.integers(0, x.size, 300)] += 0.4  # dust
        measured[random.integers(0, x.size, 200)] = np.nan
        scan = calibration.calibrate_from_scan(
            measured, 0.2 - removed, removed, 1e-5, points, offset=True
        )
        hits.append(scan["interval"][0] <= 1.25e-5 <= scan["interval"][1])
        assert scan["coefficient"] == pytest.approx(1.25e-5, rel=0.05)
        low, high = scan["offset_interval_mm"]
        offsets.append(low <= 0.03 <= high)
    assert np.mean(hits) > 0.8 and np.mean(offsets) > 0.7
    with pytest.raises(InputError, match="0 samples are both"):
        calibration.calibrate_from_scan(np.full(50, np.nan), np.ones(50), np.ones(50), 1e-5)
    with pytest.raises(InputError, match="different samples"):
        calibration.calibrate_from_scan(np.ones(5), np.ones(4), np.ones(5), 1e-5)


def test_the_scan_of_a_simulated_part():
    job = plate_job()
    ground = {}
    for coefficient in (4e-5, 5e-5):
        job["law"] = {"coefficient_mm2_per_N": coefficient}
        ground[coefficient] = runs.run(jobs.validate(job)).field.height
    fresh = np.full(len(ground[4e-5]), 0.2)
    scan = calibration.calibrate_from_scan(ground[5e-5], ground[4e-5], fresh - ground[4e-5], 4e-5)
    assert scan["coefficient"] == pytest.approx(5e-5, rel=0.03)


@pytest.mark.slow
def test_command_line(tmp_path, capsys):
    table = write_csv(tmp_path / "grinds.csv", grinds(15, wear_J=2e5))
    law, plot, report = (str(tmp_path / name) for name in ("law.json", "plot.png", "report.json"))
    arguments = ["calibrate", str(table), "-o", law, "--plot", plot, "--report", report]
    assert cli.main(arguments) == 0
    printed = capsys.readouterr().out
    assert "pressure_exponent" in printed and "left-out grinds" in printed
    written = json.loads((tmp_path / "law.json").read_text())
    assert written["model"] == "local" and written["wear"]["model"] == "exponential"
    assert json.loads((tmp_path / "report.json").read_text())["r2"] > 0.9
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    assert cli.main([*arguments[:-3], str(tmp_path / "plot.doc")]) == 2
    assert "a plot is a file .png" in capsys.readouterr().err
    assert cli.main([*arguments, "--wear-unit", "0"]) == 2
    assert "positive number of joules" in capsys.readouterr().err
    with pytest.raises(SystemExit) as ended:
        cli.main([*arguments, "--wear-unit", "nan"])
    assert ended.value.code == 2 and "--wear-unit" in capsys.readouterr().err
    passes = calibration.fit(grinds(16, passes=True))["report"]
    assert calibration_plot.render(passes, "svg").startswith(b"<?xml")
