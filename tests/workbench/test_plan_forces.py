"""Forces that are planned with the feeds: what more force would remove, and what comes of it."""

import copy

import numpy as np
import pytest

from beltgrinding import planning
from beltgrinding.engine import core
from beltgrinding.job import load as jobs, poses as job_poses
from beltgrinding.planning import reasons, with_force
from beltgrinding.planning.commands import Commands
from beltgrinding.planning.thinning import Thinned
from beltgrinding.simulation import run as runs
from test_job import plate
from test_plan import SETTINGS, job  # noqa: F401, the fixture


def single(force, coefficient=2e-6):
    """A job of one motion, 10 mm along a plate beside its border, which removes little."""
    pose = {"y_mm": 4.0, "z_mm": 0.2, "qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
    poses = [{**pose, "x_mm": x, "feed_mm_s": 20.0} for x in (20.0, 30.0)]
    return jobs.validate(
        {
            "design": {"brep": plate().write_brep()},
            "sampling": {"spacing_mm": 0.5},
            "stock": {"kind": "allowance", "allowance_mm": 0.2},
            "belt_machine": {
                "wheel": {"radius_mm": 30, "width_mm": 15, "crown_radius_mm": 80},
                "force_N": force,
            },
            "law": {"coefficient_mm2_per_N": coefficient},
            "cell": {"check_collisions": False},
            "programs": [{"poses": poses}],
        }
    )


def columns(influence, samples):
    """(samples, motions) mm."""
    found = np.zeros((samples, len(influence)))
    motions = np.repeat(np.arange(len(influence)), np.diff(influence.first.astype(int)))
    np.add.at(found, (influence.sample.astype(int), motions), influence.depth)
    return found


def test_what_more_force_removes_is_what_simulations_say():
    """5 % more force in whole simulations; the widened contact is in it, a multiple of the removal is not it. Less force
    would be another thing: at the border the contact changes its shape there."""
    asked = runs.run(single(30.0), influence=True, forces=True)
    plain = runs.run(single(30.0))
    assert (np.asarray(asked.field.height) == np.asarray(plain.field.height)).all()
    more, less = (np.asarray(run.field.height) for run in (runs.run(single(31.5)), plain))
    found = (less - more) / 0.05
    told = columns(asked.force_influence, asked.field.size).sum(axis=1)
    removed = columns(asked.influence, asked.field.size).sum(axis=1)
    mine = told > 0.2 * told.max()
    assert mine.sum() > 100
    error = np.abs(told - found)[mine] / found[mine]
    assert (
        np.median(error) < 0.03 and np.percentile(error, 95) < 0.15
    )  # of a step of 5 %, at the contact's rim
    assert told.sum() == pytest.approx(found.sum(), rel=0.01)
    copied = np.abs(removed - found).sum()
    assert np.abs(told - found).sum() < 0.2 * copied


def test_a_position_has_no_force_to_change():
    given = copy.deepcopy(single(30.0))
    given["belt_machine"]["control"] = "position"
    given["programs"][0]["poses"] = [
        {**pose, "z_mm": -0.1} for pose in given["programs"][0]["poses"]
    ]
    asked = runs.run(jobs.validate(given), influence=True, forces=True)
    assert len(asked.influence.sample) > 0 and len(asked.force_influence.sample) == 0


@pytest.mark.slow
def test_forces_with_feeds_bring_more_into_tolerance(job):  # noqa: F811
    feeds = planning.plan(job, {**SETTINGS, "rounds": 8})
    both = planning.plan(job, {**SETTINGS, "rounds": 8, "force_min_N": 5.0, "force_max_N": 60.0})
    left = [1.0 - one.after.summary["in_tolerance_area_share"] for one in (feeds, both)]
    assert left[1] < 0.8 * left[0]
    free = ~both.commands.rapid
    between = (both.factors >= 5.0 / 30.0 - 1e-9) & (both.factors <= 2.0 + 1e-9)
    assert between[both.commands.group[free]].all()
    kept = [one["in_tolerance"] for one in both.rounds]
    assert both.after.summary["in_tolerance_area_share"] == max(kept)


def test_a_round_that_is_worse_is_taken_back(job, monkeypatch):  # noqa: F811
    """The next one starts from the best, and goes half as far."""
    seen, following = [], planning.rounds.following

    def spoilt(what, **given):
        seen.append((what.feeds, given["reach"]))
        new, force, told = following(what, **given)
        return (0.3 * new if len(seen) == 2 else new), force, told

    monkeypatch.setattr(planning.rounds, "following", spoilt)
    plan = planning.plan(job, SETTINGS)
    assert plan.rounds[2]["in_tolerance"] < plan.rounds[1]["in_tolerance"]
    assert (seen[2][0] == seen[1][0]).all() and seen[2][1] == 0.5 * seen[1][1]


def test_no_motion_is_moved_that_has_no_effect():
    """Forces that nothing asks for stay as they are."""
    rng = np.random.default_rng(3)
    depth = np.abs(rng.normal(0.05, 0.01, (40, 4)))
    first = np.arange(0, 161, 40)
    sample = np.tile(np.arange(40), 4)
    influence = core.Influence(first, sample, depth.T.ravel())
    by_force = core.Influence(first, sample, 1.1 * depth.T.ravel())
    ones = np.ones(4)
    ranges = with_force.Ranges(0.5 * ones, 2.0 * ones, 0.8 * ones, 1.25 * ones)
    half, weight = 0.05 * np.ones(40), np.ones(40)
    paces = (ones, ones)
    context = core.RunContext()

    def solve(deviation):
        return with_force.solve(
            influence, by_force, deviation, half, weight, ranges, paces, 1e-3, context
        )

    longer, stronger, told = solve(np.full(40, 0.01))  # within the band
    assert (stronger == 1.0).all() and told["residual"] < 1e-6
    longer, stronger, told = solve(np.full(40, 0.4))  # far beyond: both do what they can
    assert longer == pytest.approx(2.0 * ones, abs=1e-3)
    assert stronger == pytest.approx(1.25 * ones, abs=1e-3)


def test_thinned_samples_keep_area_and_sides():
    shape = plate()
    field, _ = core.sample_faces(shape, [0], 0.2)
    weight = np.asarray(field.areas, dtype=float).copy()
    weight[:50] = 0.0
    given = {"belt_machine": {"contact_spacing_mm": 1.5}}
    thinned = Thinned(field, given, weight)
    assert len(thinned.kept) < 0.1 * field.size and (np.diff(thinned.kept) > 0).all()
    assert thinned.weight.sum() == pytest.approx(weight.sum())
    sample = np.arange(field.size)
    influence = core.Influence(
        np.array([0, field.size, field.size]), sample, 1.0 + sample.astype(np.float32)
    )
    fewer = thinned.influence(influence, field.size)
    assert (fewer.first == [0, len(thinned.kept), len(thinned.kept)]).all()
    np.testing.assert_array_equal(fewer.depth, 1.0 + thinned.kept)
    # Samples that are no closer than the contact tells apart all stay.
    coarse, _ = core.sample_faces(shape, [0], 1.0)
    all_ = Thinned(coarse, given, np.asarray(coarse.areas))
    assert (all_.kept == np.arange(coarse.size)).all()


def test_what_stays_beside_the_path_is_told_apart(job):  # noqa: F811
    """A path on half of the plate: nothing reaches the rest, and contacts fade out beside it."""
    given = copy.deepcopy(job)
    arrays = Commands(job, planning.rounds.validate({})).arrays[0]
    poses = job_poses.list_poses(arrays)
    half = [pose for pose in poses if pose["y_mm"] < 18.0]
    given["programs"] = [{"poses": half}]
    plan = planning.plan(jobs.validate(given), {**SETTINGS, "rounds": 3})
    shares, state = plan.why["shares"], plan.why["state"]
    points = np.asarray(plan.after.field.points)
    assert shares["no_motion"] > 0.2 and shares["fringe"] > 0.01
    fringe = points[state == reasons.FRINGE]
    missed = points[state == reasons.NOT_REACHED]
    assert fringe[:, 1].min() > missed[:, 1].min() - 6.0 and fringe[:, 1].max() < 40.0
    assert shares["shared"] < shares["fringe"]
