"""What couples a plan's motions: change of feed and force, acceleration, pressure, heat; each kept, and told."""

import copy

import numpy as np
import pytest

from beltgrinding import planning
from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs
from beltgrinding.planning import limits, rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.simulation import run as runs
from test_plan import SETTINGS, job  # noqa: F401 (a fixture)

EXACT = 1e-6


def pairs(plan):
    first, second, way = plan.commands.neighbours()
    assert len(first) > 20 and (way > 0).all()
    return first, second, way


@pytest.fixture(scope="module")
def free(job):  # noqa: F811
    return planning.plan(job, SETTINGS)


def share(plan):
    return plan.after.summary["in_tolerance_area_share"]


@pytest.mark.slow
def test_feed_changes_no_faster_than_may_be_along_the_path(job, free):
    first, second, way = pairs(free)
    assert (abs(free.new[first] - free.new[second]) / way).max() > 10.0
    plan = planning.plan(job, {**SETTINGS, "feed_change_mm_s_mm": 3.0})
    assert plan.better
    assert (abs(plan.new[first] - plan.new[second]) / way).max() <= 3.0 + EXACT
    # It costs something; one feed for all, the best of many, is much worse.
    alike = max(
        runs.run(plan.commands.with_feeds(plan.old * f)).summary["in_tolerance_area_share"]
        for f in (0.7, 0.85, 1.0, 1.2, 1.5)
    )
    assert alike + 0.3 < share(plan) < share(free)
    gentle = planning.plan(job, {**SETTINGS, "feed_change_mm_s_mm": 0.5})
    assert share(gentle) < share(plan)
    assert gentle.why["shares"]["change"] > 0.05 > free.why["shares"]["change"]


def test_acceleration_bounds_what_a_feed_may_become(job):
    plan = planning.plan(job, {**SETTINGS, "acceleration_mm_s2": 60.0, "feed_change_mm_s_mm": 3.0})
    first, second, way = pairs(plan)
    one, other = plan.new[first], plan.new[second]
    assert plan.better and share(plan) > plan.rounds[0]["in_tolerance"] + 0.2
    assert (abs(one**2 - other**2) <= 2.0 * 60.0 * way + EXACT).all()
    assert (abs(one - other) <= 3.0 * way + EXACT).all()
    assert plan.new.min() >= 3.0 - EXACT and plan.new.max() <= 150.0 + EXACT


def test_motions_that_stay_bound_their_neighbours(job):
    keep = [{"program": 1, "first_line": 30, "last_line": 34}]
    plan = planning.plan(job, {**SETTINGS, "keep": keep, "feed_change_mm_s_mm": 1.0})
    first, second, way = pairs(plan)
    kept = plan.commands.kept
    assert kept.any() and np.array_equal(plan.new[kept], plan.old[kept])
    free = ~(kept[first] & kept[second])
    assert (abs(plan.new[first] - plan.new[second]) <= way + EXACT)[free].all()


def test_what_contradicts_itself_already_stays(job):
    """Two motions that stay and differ by more than is allowed; positioning faster than any planned feed."""
    wild = copy.deepcopy(job)
    commands = Commands(job, rounds.validate({}))
    program = commands.with_feeds(commands.feed())["programs"][0]
    wild["programs"] = [program]
    for k, pose in enumerate(program["poses"]):
        if 20 <= k < 24:
            pose["feed_mm_s"] = 20.0 if k % 2 else 90.0
        if 30 <= k < 32:
            pose.update(feed_mm_s=400.0, force_N=0.0)
    wild = jobs.validate(wild)
    keep = [{"program": 1, "first_pose": 21, "last_pose": 24}]
    plan = planning.plan(wild, {**SETTINGS, "keep": keep, "feed_change_mm_s_mm": 3.0})
    kept = plan.commands.kept
    assert kept.sum() == 4 and np.array_equal(plan.new[kept], plan.old[kept])
    assert np.isfinite(plan.new).all() and np.isfinite(plan.factors).all()
    rapid = np.bincount(plan.commands.group, plan.commands.rapid) > 0
    assert rapid.any() and np.array_equal(plan.new[rapid], plan.old[rapid])
    first, second, way = pairs(plan)
    free = ~(kept[first] & kept[second])
    good = abs(plan.new[first] - plan.new[second]) <= 3.0 * way + EXACT
    told = rounds.summary(plan)["beyond_limits"]
    assert plan.better and told["after"] == (~good).sum() > 0 and told["before"] > told["after"]
    # Beside those that stay and contradict each other nothing can be right; everywhere else it is.
    apart = np.flatnonzero(kept)[[0, -1]]
    assert good[free & ((second < apart[0] - 2) | (first > apart[1] + 2))].all()


def test_force_changes_no_faster_than_may_be_in_time(job):
    settings = {**SETTINGS, "force_min_N": 5.0, "force_max_N": 90.0, "feed_min_mm_s": 45.0}
    free = planning.plan(job, settings)
    first, second, _ = pairs(free)

    def steps(plan):
        seconds = plan.commands.motion_seconds(plan.new)
        force = plan.commands.force(plan.factors)
        return abs(force[first] - force[second]) / (0.5 * (seconds[first] + seconds[second]))

    own = free.commands.force(np.ones(len(free.commands)))
    plain = own[first] == own[second]  # the program's own ramps may stay
    rate = steps(free)[plain].max() / 4.0
    plan = planning.plan(job, {**settings, "force_change_N_s": rate})
    assert plan.better and steps(plan)[plain].max() <= rate * (1 + EXACT)
    forces = plan.commands.force(plan.factors)[own > 0]
    assert (
        forces.min() >= 5.0 * own[own > 0].min() / own.max() - EXACT
        and forces.max() <= 90.0 + EXACT
    )


@pytest.mark.slow
@pytest.mark.parametrize("limit", ["pressure_max_MPa", "heat_max_MPa_m_s", "law"])
def test_forces_keep_to_pressure_and_heat(job, limit):
    settings = {**SETTINGS, "force_min_N": 5.0, "force_max_N": 120.0, "feed_min_mm_s": 60.0}
    free = planning.plan(job, settings)
    peak = free.after.steps["peak_pressure"].max()
    most, given = 0.85 * peak, job
    if limit == "law":
        given = jobs.validate(
            {**copy.deepcopy(job), "law": {**job["law"], "pressure_limit_MPa": most}}
        )
    else:
        speed = job["belt_machine"]["belt_speed_m_s"] if limit.startswith("heat") else 1.0
        settings = {**settings, limit: most * speed}
    plan = planning.plan(given, settings)
    told = rounds.summary(plan)["after"]
    assert plan.better
    assert told["peak_pressure_MPa"] == pytest.approx(plan.after.steps["peak_pressure"].max())
    assert told["over_limit"] <= EXACT, "the last rounds lower what is above it"
    assert told["in_tolerance"] > plan.rounds[0]["in_tolerance"] + 0.1


def test_few_feeds_and_gentle_changes_contradict_each_other(job):
    with pytest.raises(InputError, match="levels.*acceleration_mm_s2"):
        planning.plan(job, {**SETTINGS, "levels": 3, "acceleration_mm_s2": 100.0})


def test_a_profile_is_the_wanted_one_where_that_keeps_the_limits(job):
    plan = planning.plan(job, {**SETTINGS, "rounds": 1})
    wide = rounds.validate({"feed_change_mm_s_mm": 1e5, "acceleration_mm_s2": 1e8})
    assert np.array_equal(
        limits.feeds(plan.commands, plan.new, np.ones(len(plan.new)), wide), plan.new
    )


def test_a_time_law_with_acceleration_is_planned_too(job):
    slow = copy.deepcopy(job)
    slow["simulation"].update(timing="trapezoidal", path_acceleration_mm_s2=150.0)
    plan = planning.plan(jobs.validate(slow), SETTINGS)
    before, after = (one.summary["in_tolerance_area_share"] for one in (plan.before, plan.after))
    assert plan.better and after > before + 0.2
