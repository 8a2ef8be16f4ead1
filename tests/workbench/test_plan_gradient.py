"""What a motion's time and force do in the end: against central differences of whole simulations, later passes among them."""

import numpy as np
import pytest

from beltgrinding.engine import InputError, core
from beltgrinding.planning import rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.simulation import run as runs
import test_plan
from test_plan_forces import columns

SETTINGS, job = test_plan.SETTINGS, test_plan.job  # the fixture
CHANGE = 0.03
APART = 22.0  # mm: what motions do that far from each other does not meet
OF_MOST = 0.3  # of a column's greatest entry: where its entries are looked at one by one
BOUNDS = {  # median of single entries; all of a column, over the part
    "feed": (0.1, 0.2),
    "force": (0.1, 0.2),
}


def influences(run):
    return {"feed": run.influence, "force": run.force_influence}


@pytest.fixture(scope="module")
def changed(job):
    """(commands, run with both influences, numbers of motions far apart, mm lower in the end by time and by force)."""
    commands = Commands(job, rounds.validate({**SETTINGS, "force_max_N": 60.0}))
    run = runs.run(job, influence=True, forces=True)
    feeds, ones = commands.feed(), np.ones(len(commands))
    points = np.asarray(run.field.points, dtype=float)
    depth = columns(run.influence.grouped(commands.group, len(commands)), run.field.size)
    some = []
    for k in np.random.default_rng(0).permutation(len(commands)):
        if (depth[:, k] > 0.0).sum() < 30:
            continue
        middle = np.average(points, axis=0, weights=depth[:, k])
        if all(np.linalg.norm(middle - other) > APART for _, other in some):
            some.append((k, middle))

    def height(longer, stronger):
        ground = runs.run(commands.with_feeds(feeds / longer, stronger))
        return np.asarray(ground.field.height, dtype=float)

    more, less = ones.copy(), ones.copy()
    for k, _ in some:
        more[k], less[k] = 1.0 + CHANGE, 1.0 - CHANGE
    found = {
        "feed": (height(less, ones) - height(more, ones)) / (2.0 * CHANGE),
        "force": (height(ones, less) - height(ones, more)) / (2.0 * CHANGE),
    }
    return commands, run, some, found


def errors(told, changed, what):
    """(median of single entries, of all in the sum): relative."""
    _, run, some, found = changed
    points, area = (np.asarray(a, dtype=float) for a in (run.field.points, run.field.areas))
    nearest = np.argmin([np.linalg.norm(points - middle, axis=1) for _, middle in some], axis=0)
    single, whole = [], []
    for number, (k, _) in enumerate(some):
        here = nearest == number
        column, true = told[here, k], found[what][here]
        most = np.abs(true) > OF_MOST * np.abs(true).max()
        single += np.abs(column[most] / true[most] - 1.0).tolist()
        off = (area[here] * np.abs(column - true)).sum()
        whole.append(off / (area[here] * np.abs(true)).sum())
    return np.median(single), np.mean(whole)


@pytest.mark.parametrize("what", BOUNDS)
def test_later_passes_are_in_what_a_motion_does(changed, what):
    commands, run, some, _ = changed
    assert len(some) >= 4
    count, area = len(commands), np.asarray(run.field.areas)
    influence = influences(run)[what]
    told = influence.in_the_end(run.influence, area, commands.group, count)
    single, whole = errors(columns(told, run.field.size), changed, what)
    assert single < BOUNDS[what][0] and whole < BOUNDS[what][1]
    # What a motion does itself is no such gradient.
    alone = columns(influence.grouped(commands.group, count), run.field.size)
    single, whole = errors(alone, changed, what)
    assert single > BOUNDS[what][0] and whole > BOUNDS[what][1]


def test_a_motion_takes_as_much_in_the_end(changed):
    """Under force control later passes only move it, whatever the threads."""
    commands, run, _, _ = changed
    count, area = len(commands), np.asarray(run.field.areas)
    for influence in influences(run).values():
        told = influence.in_the_end(run.influence, area, commands.group, count)
        core.set_threads(1)
        try:
            same = influence.in_the_end(run.influence, area, commands.group, count)
        finally:
            core.set_threads(0)
        assert (same.depth == told.depth).all() and (same.sample == told.sample).all()
        own = columns(influence.grouped(commands.group, count), run.field.size)
        volume = area @ own
        assert area @ columns(told, run.field.size) == pytest.approx(
            volume, abs=0.02 * np.abs(volume).max()
        )


def test_without_feedback_all_stays():
    removed = core.Influence([0, 2, 3], [0, 1, 1], [0.2, 0.1, 0.3])
    assert len(removed.feedback) == 0
    told = removed.in_the_end(removed, np.ones(3), [1, 0], 2)
    assert told.first.tolist() == [0, 1, 3] and told.sample.tolist() == [1, 0, 1]
    assert told.depth == pytest.approx([0.3, 0.2, 0.1])


def test_under_position_control_it_is_not_known(job):
    machine = {**job["belt_machine"], "control": "position"}
    run = runs.run({**job, "belt_machine": machine}, influence=True)
    assert len(run.influence.feedback) == len(run.influence)
    assert not np.asarray(run.influence.feedback).any()


def test_what_does_not_fit_is_refused():
    removed = core.Influence([0, 2, 3], [0, 1, 1], [0.2, 0.1, 0.3])
    for area, group, count in (
        (np.ones(1), [1, 0], 2),
        (np.ones(3), [1], 2),
        (np.ones(3), [1, 2], 2),
    ):
        with pytest.raises(InputError, match="groups of motions"):
            removed.in_the_end(removed, area, group, count)
    with pytest.raises(InputError, match="groups of motions"):
        removed.in_the_end(core.Influence([0, 1], [0], [0.1]), np.ones(3), [1, 0], 2)
