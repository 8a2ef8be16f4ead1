"""Belt plans: the cheapest belts for a batch against all ways, limits, and whole simulations with the worn belt."""

import copy
import csv
import itertools
import json

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.planning import belt_chart, belt_plan
from beltgrinding.planning.belt_plan import Costs
from beltgrinding.simulation import run as runs
from support import pictures
from test_job import plate_job

WEAR = {"model": "exponential", "variable": "work", "scale": 4000.0, "rest": 0.2}
COSTS = Costs(0.3, 1.0, 1.5)


def job_of(wear=None, **belt):
    given = plate_job()
    given["law"] = {"model": "local_linear", "wear": wear or WEAR}
    given["belt_machine"]["belt"] = belt
    return jobs.validate(given)


@pytest.fixture(scope="module")
def part():
    return belt_plan.part_of(job_of(), 3.0, 0.0, "feed")[0]


def cost_of(job, part, costs, counts):
    """Of belts with so many parts each, all of them new, by itself; None where one lasts for fewer."""
    lasts = belt_plan._life(
        belt_plan.laws.engine_wear(job["law"]),
        part,
        job["belt_machine"]["belt"],
        costs,
        sum(counts),
    )
    if max(counts) > len(lasts):
        return None
    changing = costs.belt + costs.minute * costs.change_s / 60.0
    return sum(changing + sum(row["cost"] for row in lasts[:n]) for n in counts)


@pytest.mark.slow
@pytest.mark.parametrize("belt_cost", [0.0, 0.05, 0.3, 50.0])
def test_no_other_way_is_cheaper_for_twelve_parts(part, belt_cost):
    job, costs = job_of(), Costs(belt_cost, 1.0, 1.5)
    found = belt_plan.plan(job, part, costs, 12)
    cheapest = np.inf
    for cuts in itertools.product((False, True), repeat=11):
        at = [k + 1 for k, cut in enumerate(cuts) if cut]
        counts = np.diff([0, *at, 12]).tolist()
        cost = cost_of(job, part, costs, counts)
        cheapest = min(cheapest, np.inf if cost is None else cost)
    # The belt that is on the machine is new, and paid.
    changing = costs.belt + costs.minute * costs.change_s / 60.0
    assert found.cost == pytest.approx(cheapest - changing, rel=1e-9)
    assert found.cost <= found.until_worn_out + 1e-9
    told = sum(row["cost"] for row in found.rows) + found.belts * changing
    assert told == pytest.approx(found.cost, rel=1e-9)


def test_dear_belts_are_used_longer_and_cheap_ones_changed_sooner(part):
    job = job_of()
    belts = [belt_plan.plan(job, part, Costs(c, 2.0, 1.5), 60).belts for c in (0.0, 0.5, 40.0)]
    assert belts[0] > belts[1] > belts[2], belts


@pytest.mark.parametrize("follow, force_max", [("feed", 0.0), ("force", 90.0), ("both", 45.0)])
def test_a_worn_belt_that_is_followed_removes_what_a_fresh_one_does(follow, force_max):
    job = job_of()
    part, fresh = belt_plan.part_of(job, 3.0, force_max, follow)
    found = belt_plan.plan(job, part, Costs(1e4, 0.0, 1.0), 6)
    worn, row = {"work_J": 0.0, "removed_mm3": 0.0, "hours": 0.0}, found.rows[5]
    for one in found.rows[:5]:
        worn["work_J"] += part.work_J * one["force_factor"] / one["feed_factor"]
        worn["removed_mm3"] += part.removed_mm3
    tried = copy.deepcopy(job)
    tried["belt_machine"]["belt"] = worn
    tried["belt_machine"]["force_N"] *= row["force_factor"]
    for pose in tried["programs"][0]["poses"]:
        pose["feed_mm_s"] *= row["feed_factor"]
    result = runs.run(tried)
    assert result.summary["removed_volume_mm3"] == pytest.approx(
        fresh.summary["removed_volume_mm3"], rel=0.01
    )
    assert result.summary["process_time_s"] == pytest.approx(row["seconds"], rel=1e-3)
    unfollowed = copy.deepcopy(tried)
    unfollowed["programs"] = job["programs"]
    unfollowed["belt_machine"]["force_N"] = job["belt_machine"]["force_N"]
    less = runs.run(unfollowed).summary["removed_volume_mm3"]
    assert less < 0.9 * fresh.summary["removed_volume_mm3"], "else there is nothing to follow"


def test_a_belt_that_is_worn_already_goes_on_only_as_long_as_it_pays(part):
    job = job_of(work_J=9000.0)
    cheap = belt_plan.plan(job, part, Costs(0.01, 0.0, 1.5), 20)
    dear = belt_plan.plan(job, part, Costs(500.0, 0.0, 1.5), 20)
    assert cheap.rows[0]["new_belt"] and not dear.rows[0]["new_belt"]
    assert dear.belts < cheap.belts


def test_parts_beyond_what_the_wear_was_measured_for_are_counted(part):
    job = job_of(
        {"model": "curve", "variable": "work", "curve": [[0.0, 1.0], [2000.0, 0.8], [3300.0, 0.7]]}
    )
    found = belt_plan.plan(job, part, Costs(1e3, 0.0, 1.5), 12)
    assert [row["beyond_measured"] for row in found.rows[:3]] == [False] * 3
    assert belt_plan.summary(found, COSTS)["parts_beyond_measured_wear"] == 9


def test_five_hundred_parts_over_the_life_of_their_belts_as_the_manual_shows_them():
    job = job_of({**WEAR, "scale": 40000.0})
    part, _ = belt_plan.part_of(job, 3.0, 90.0, "both")
    found = belt_plan.plan(job, part, Costs(1.2, 4.0, 1.5), 500)
    assert found.belts == 5 and found.cost < found.until_worn_out
    pictures.keep("belt-plan", belt_chart.draw(found))
    pictures.check(pictures.RELEASE, ["belt-plan"])


def test_a_calibrated_wear_says_how_long_a_belt_may_last():
    wear = {**WEAR, "scale": 40000.0, "rest": 0.0}
    job = job_of(wear)
    part = belt_plan.part_of(job, 10.0, 0.0, "feed")[0]
    assert belt_plan.plan(job, part, COSTS, 400).life_95 is None
    told = {"parameters": ["ln_wear_scale"], "covariance": [[0.01]], "scatter": 0.1}
    law = {**job["law"], "calibration": told}
    found = belt_plan.plan({**job, "law": law}, part, COSTS, 400)
    low, high = found.life_95
    assert low < found.life < high < 400
    for by, end in ((-0.196, low), (0.196, high)):
        moved = job_of({**wear, "scale": wear["scale"] * np.exp(by)})
        assert end == pytest.approx(belt_plan.plan(moved, part, COSTS, 400).life, rel=0.08)
    assert belt_plan.summary(found, COSTS)["life_parts_95"] == [low, high]


def test_limits_end_a_belts_life(part):
    job = job_of()
    narrow = belt_plan.part_of(job, 20.0, 0.0, "feed")[0]
    assert belt_plan.plan(job, narrow, COSTS, 30).life < belt_plan.plan(job, part, COSTS, 30).life
    assert (
        min(r["feed_factor"] for r in belt_plan.plan(job, narrow, COSTS, 30).rows) >= 20 / 30 - 1e-9
    )
    short = {**WEAR, "scale": 0.01, "rest": 0.0}
    with pytest.raises(InputError, match="not even a fresh belt"):
        broken = job_of(short)
        belt_plan.plan(broken, belt_plan.part_of(broken, 29.0, 0.0, "feed")[0], COSTS, 3)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"wear": {"model": "none"}}, "law.wear.model"),
        ({"feed_min": 40.0}, "beyond the limits"),
        ({"parts": 0}, "give 1 to"),
        ({"costs": Costs(-1.0, 0.0, 1.0)}, "none below 0"),
        ({"costs": Costs(float("nan"), 0.0, 1.0)}, "none below 0"),
    ],
)
def test_nonsense_is_refused(change, words):
    with pytest.raises(InputError, match=words):
        job = job_of(change.get("wear"))
        part = belt_plan.part_of(job, change.get("feed_min", 3.0), 0.0, "feed")[0]
        belt_plan.plan(job, part, change.get("costs", COSTS), change.get("parts", 5))


def test_the_command_writes_what_it_tells(tmp_path, capsys):
    given = plate_job()
    given["law"] = {"model": "local_linear", "wear": WEAR}
    (tmp_path / "job.json").write_text(json.dumps(given))
    begin = ["belt-plan", str(tmp_path / "job.json"), "-o", str(tmp_path / "out"), "--parts", "40"]
    costs = ["--belt-cost", "0.1", "--change-min", "0.02", "--minute-cost", "1.5"]
    assert cli.main([*begin, *costs]) == 0
    data = json.loads((tmp_path / "out" / "belt_plan.json").read_text())
    rows = list(csv.DictReader((tmp_path / "out" / "parts.csv").read_text().splitlines()))
    assert len(rows) == 40 == sum(data["parts_per_belt"])
    assert sum(int(row["new_belt"]) for row in rows) == data["new_belts"] > 0
    assert (tmp_path / "out" / "belt_plan.png").read_bytes().startswith(b"\x89PNG")
    assert f"{data['cost']:.2f}" in capsys.readouterr().out
    assert cli.main([*begin, *costs, "-q"]) == 0, "its own files may be replaced"
    assert cli.main([*begin, *costs, "--follow", "force"]) == 2
    assert "--force-max" in capsys.readouterr().err
