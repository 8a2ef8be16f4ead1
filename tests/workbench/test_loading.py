"""A belt that loads with chips: in jobs, over programs with pauses and dressings, in belt files and belt plans."""

import copy
import json
import math

import numpy as np
import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.calibration import finish_table
from beltgrinding.cli import verify
from beltgrinding.contact import single_contact
from beltgrinding.engine import InputError
from beltgrinding.job import law as laws, load as jobs
from beltgrinding.planning import belt_loading, belt_plan, rounds
from beltgrinding.planning.belt_loading import Between, Stretch
from beltgrinding.planning.belt_plan import Costs
from beltgrinding.planning.commands import Commands
from test_job import DOWN, plate_job

LOADS = {"loading_share": 0.4, "loading_scale": 600.0, "loading_recovery_s": 4.0}
WEAR = {"model": "exponential", "variable": "work", "scale": 20000.0, "rest": 0.2}


def job_of(**wear):
    """Two passes beside each other with a way through the air, by two programs."""
    given = plate_job()
    given["law"] = {"model": "local_linear", "wear": {**LOADS, **wear}}
    given["belt_machine"]["belt"] = {"loading": 0.3}
    poses = given["programs"][0]["poses"]
    poses += [
        {"x_mm": 50, "y_mm": 20, "z_mm": 9.0, **DOWN, "feed_mm_s": 60, "rapid": True},
        {"x_mm": 10, "y_mm": 20, "z_mm": 9.0, **DOWN, "feed_mm_s": 60},
    ]
    second = copy.deepcopy(given["programs"][0])
    for pose in second["poses"]:
        pose["y_mm"] = 8
    given["programs"].append(second)
    return given


def by_itself(job, steps, duration):
    """(loading in the end, mean loading) by the closed forms along the steps of a run."""
    wear, loading, clock, before = job["law"]["wear"], 0.3, 0.0, -1
    mean, whole = 0.0, 0.0
    for time, seconds, force, program in zip(
        steps["time"], steps["duration"], steps["force"], steps["program"]
    ):
        free = time - 0.5 * seconds - clock
        for one in job["programs"][before + 1 : program + 1]:
            free += one.get("pause_s", 0.0)
            loading *= wear.get("dressing_rest", 0.0) if one.get("dress") else 1.0
        clock, before = time + 0.5 * seconds, program
        loading *= math.exp(-free / wear["loading_recovery_s"])
        if force > 0.0:
            x = force * 20.0 * seconds / wear["loading_scale"]  # 20 m/s
            mean += force * seconds * (1.0 - (1.0 - loading) * -math.expm1(-x) / x)
            whole += force * seconds
            loading = 1.0 - (1.0 - loading) * math.exp(-x)
        else:
            loading *= math.exp(-seconds / wear["loading_recovery_s"])
    return loading * math.exp(-(duration - clock) / wear["loading_recovery_s"]), mean / whole


@pytest.mark.parametrize(
    "change", [{}, {"pause_s": 3.0}, {"dress": True}, {"pause_s": 2.0, "dress": True}]
)
def test_programs_load_the_belt_and_pauses_and_dressings_free_it(change):
    job = job_of(dressing_rest=0.25)
    job["programs"][1].update(change)
    result = beltgrinding.run(job)
    summary = result.summary
    loading, mean = by_itself(job, result.steps, summary["process_time_s"])
    assert summary["belt"]["loading"] == pytest.approx(loading, rel=2e-3)
    assert summary["belt"]["remaining_cut"] == pytest.approx(1.0 - 0.4 * loading, rel=2e-3)
    plain = copy.deepcopy(job)
    plain["law"] = {"model": "local_linear"}
    plain["belt_machine"]["belt"] = {}
    plain["programs"][1].pop("dress", None)
    fresh = beltgrinding.run(plain).summary
    share = summary["removed_volume_mm3"] / fresh["removed_volume_mm3"]
    assert share == pytest.approx(1.0 - 0.4 * mean, rel=5e-3)
    assert summary["process_time_s"] == fresh["process_time_s"]


def test_a_run_that_goes_on_from_a_kept_one_knows_another_pause():
    ends = []
    for pause in (0.0, 5.0, 0.0):
        job = job_of()
        job["programs"][1]["pause_s"] = pause
        ends.append(beltgrinding.run(job).summary["belt"]["loading"])
    assert ends[0] == ends[2] != ends[1]


def test_a_pause_cools_the_part():
    from test_heat import STEEL

    hottest = []
    for pause in (0.0, 60.0):
        job = plate_job()
        job["heat"] = dict(STEEL)
        job["programs"].append({**copy.deepcopy(job["programs"][0]), "pause_s": pause})
        hottest.append(float(np.max(beltgrinding.run(job).field.heat["rise"])))
    assert hottest[1] < hottest[0]


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda job: job["law"]["wear"].update(loading_share=0.0), "no loading share"),
        (
            lambda job: (
                job["law"].update(model="geometric"),
                job["belt_machine"].update(control="position"),
            ),
            "geometric",
        ),
        (
            lambda job: (
                job["law"].update(wear={}),
                job["belt_machine"].update(belt={}),
                job["programs"][1].update(dress=True),
            ),
            r"programs\[1\].dress",
        ),
        (lambda job: job["law"]["wear"].update(loading_share=1.5), "loading_share"),
        (lambda job: job["law"]["wear"].update(loading_scale=0.0), "loading_scale"),
        (lambda job: job["belt_machine"]["belt"].update(loading=1.5), "loading"),
        (lambda job: job["programs"][1].update(pause_s=-1.0), "pause_s"),
    ],
)
def test_what_would_be_ignored_is_refused(change, words):
    job = job_of()
    change(job)
    with pytest.raises(InputError, match=words):
        beltgrinding.run(job)


def test_the_belts_file_carries_its_loading_and_older_files_have_none(tmp_path):
    (tmp_path / "job.json").write_text(json.dumps(job_of()))
    belt = tmp_path / "belt.json"
    belt.write_text(json.dumps({"work_J": 5.0, "removed_mm3": 1.0, "hours": 0.1}))
    assert laws.read_belt(belt)["loading"] == 0.0
    given = ["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out"), "-q"]
    cli.main([*given, "--belt", str(belt)])
    kept = json.loads(belt.read_text())
    assert 0.0 < kept["loading"] < 1.0 and kept["work_J"] > 5.0
    cli.main([*given, "--belt", str(belt), "--force"])
    assert json.loads(belt.read_text())["loading"] != kept["loading"]


def test_plans_keep_pauses_and_dressings_and_a_contact_counts_them():
    job = job_of()
    job["programs"][1].update(pause_s=3.0, dress=True)
    read = jobs.validate(job)
    commands = Commands(read, rounds.validate({"timing": "job"}))
    planned = commands.with_feeds(commands.feed())["programs"]
    assert planned[1]["pause_s"] == 3.0 and planned[1]["dress"] is True
    assert "pause_s" not in planned[0]
    own = {"programs": [{"file": "a.src", "pause_s": 2.0, "dress": True}]}
    assert verify._entry(own, "a.src") == {**own["programs"][0]}
    found = single_contact.at_pose(read, 2, 2)
    assert found["force"] == pytest.approx(30.0, rel=1e-3)
    read["law"]["wear"]["loading_share"] = 0.0
    read["belt_machine"]["belt"]["loading"] = 0.0
    with pytest.raises(InputError, match=r"programs\[1\].dress"):
        single_contact.at_pose(read, 2, 2)


def test_a_table_of_the_finish_must_say_the_cut_of_a_belt_that_loads():
    remaining = finish_table.wear_by(jobs.validate(job_of()))
    with pytest.raises(InputError, match="remaining_cut"):
        remaining(100.0, 0.0)


def test_stretches_of_a_part_lead_to_the_loading_of_its_simulation():
    job = job_of()
    job["programs"][1].update(pause_s=1.5)
    read = jobs.validate(job)
    read["belt_machine"]["belt"]["loading"] = 0.0
    result = beltgrinding.run(read)
    part = belt_loading.stretches(jobs_typed(read), result)
    assert sum(one.share for one in part) == pytest.approx(1.0)
    assert [one.share > 0.0 for one in part] == [True, True, False]
    _, after = belt_loading.over(
        laws.engine_wear(read["law"]), part, 0.0, result.summary["belt"]["work_J"], 1.0
    )
    assert after == pytest.approx(result.summary["belt"]["loading"], rel=2e-3)


def jobs_typed(job):
    from beltgrinding.job.typed import typed

    return typed(job)


def test_many_stretches_become_few_and_keep_their_sums():
    random = np.random.default_rng(3)
    part = [Stretch(0.01, float(random.uniform(0, 2)), 0.1, 0) for _ in range(100)]
    fewer = belt_loading._fewer(part)
    assert len(fewer) == belt_loading.MOST
    for k in range(4):
        assert sum(one[k] for one in fewer) == pytest.approx(sum(one[k] for one in part))
    wear = laws.engine_wear(jobs.validate(job_of(loading_recovery_s=50.0))["law"])
    few, all_of = (belt_loading.over(wear, tuple(one), 0.2, 3000.0, 1.0) for one in (fewer, part))
    assert few == pytest.approx(all_of, abs=0.02)


def test_a_loaded_belt_that_is_followed_removes_what_the_first_part_lost():
    given = job_of(**WEAR, loading_scale=3000.0, loading_recovery_s=60.0)
    given["belt_machine"]["belt"] = {}
    job = jobs.validate(given)
    part, fresh = belt_plan.part_of(job, 3.0, 0.0, "feed")
    between = Between(pause_s=5.0)
    found = belt_plan.plan(job, part, Costs(1e4, 0.0, 1.0), 4, between=between)
    belt = {}
    for row in found.rows:
        tried = copy.deepcopy(job)
        tried["belt_machine"]["belt"].update(belt)
        tried["programs"][0]["pause_s"] = 5.0 if belt else 0.0
        for pose in (pose for one in tried["programs"] for pose in one["poses"]):
            pose["feed_mm_s"] *= 1.0 if pose["rapid"] else row["feed_factor"]
        result = beltgrinding.run(tried)
        belt = {
            key: result.summary["belt"][key]
            for key in ("work_J", "removed_mm3", "hours", "loading")
        }
        assert result.summary["removed_volume_mm3"] == pytest.approx(
            fresh.summary["removed_volume_mm3"], rel=0.01
        )
    factors = [row["feed_factor"] for row in found.rows]
    assert factors[0] == pytest.approx(1.0, abs=1e-6) and factors[3] < factors[1] < 0.97


def test_dressings_and_pauses_make_a_belt_last_longer_and_cost_their_time():
    given = job_of(**WEAR, loading_scale=3000.0, loading_recovery_s=60.0)
    given["belt_machine"]["belt"] = {}
    job = jobs.validate(given)
    part, _ = belt_plan.part_of(job, 14.0, 0.0, "feed")
    costs = Costs(50.0, 1.0, 1.5)
    plain, paused, dressed = (
        belt_plan.plan(job, part, costs, 40, between=one)
        for one in (Between(), Between(pause_s=100.0), Between(dress_every=2, dress_s=7.0))
    )
    assert plain.life < paused.life and plain.life < dressed.life
    rows = dressed.rows
    undressed = rows[2]["seconds"] - part.other_s - part.ground_s / rows[2]["feed_factor"]
    assert undressed == pytest.approx(7.0)
    assert rows[2]["cut"] > rows[1]["cut"]
    before = rows[1]["seconds"] - part.other_s - part.ground_s / rows[1]["feed_factor"]
    assert before == pytest.approx(0.0, abs=1e-9)


def test_a_belt_that_only_loads_can_be_planned_and_one_that_does_not_gains_nothing_by_a_pause():
    given = job_of()
    given["belt_machine"]["belt"] = {}
    part, _ = belt_plan.part_of(jobs.validate(given), 3.0, 0.0, "feed")
    assert belt_plan.plan(jobs.validate(given), part, Costs(1.0, 1.0, 1.0), 3).belts == 0
    given["law"]["wear"] = WEAR
    job = jobs.validate(given)
    part, _ = belt_plan.part_of(job, 3.0, 0.0, "feed")
    assert part.stretches == ()
    for between in (Between(pause_s=1.0), Between(dress_every=1), Between(dress_s=1.0)):
        with pytest.raises(InputError, match="loading_share"):
            belt_plan.plan(job, part, Costs(1.0, 1.0, 1.0), 3, between=between)
    with pytest.raises(InputError, match="none below 0"):
        belt_loading.check(Between(pause_s=-1.0), laws.engine_wear(job["law"]))


def test_the_command_of_a_belt_plan_takes_pauses_and_dressings(tmp_path, capsys):
    given = job_of(**WEAR)
    given["belt_machine"]["belt"] = {}
    (tmp_path / "job.json").write_text(json.dumps(given))
    begin = ["belt-plan", str(tmp_path / "job.json"), "-o", str(tmp_path / "out"), "--parts", "9"]
    costs = ["--belt-cost", "0.1", "--change-min", "0.02", "--minute-cost", "1.5"]
    assert cli.main([*begin, *costs, "-q"]) == 0
    plain = json.loads((tmp_path / "out" / "belt_plan.json").read_text())
    more = ["--pause-s", "30", "--dress-every", "3", "--dress-s", "2"]
    assert cli.main([*begin, *costs, *more, "-q"]) == 0
    found = json.loads((tmp_path / "out" / "belt_plan.json").read_text())
    assert found["seconds"] != plain["seconds"]
    given["law"]["wear"] = WEAR
    (tmp_path / "job.json").write_text(json.dumps(given))
    assert cli.main([*begin, *costs, *more]) == 2
    assert "law.wear.loading_share is 0" in capsys.readouterr().err
