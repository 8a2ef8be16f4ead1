"""The estimate of the time that a run still takes."""

import pytest
from beltgrinding.gui.common.time_left import TimeLeft, duration


def test_an_even_pace_is_told_exactly():
    left = TimeLeft()
    told = [left.update(0.1 * k, 0.001 * k) for k in range(601)]
    assert told[5] is None  # too early to say
    assert told[300] == pytest.approx(70.0) and told[600] == pytest.approx(40.0)


def test_it_follows_a_pace_that_changes():
    left = TimeLeft()
    for k in range(100):  # a fast beginning: half of it in 10 s
        left.update(0.1 * k, 0.005 * k)
    told = [left.update(10 + 0.1 * k, 0.5 + 0.0005 * k) for k in range(600)]
    assert told[-1] == pytest.approx((0.5 - 0.0005 * 599) / 0.005, rel=0.01)


def test_it_does_not_jump():
    """Where the pace wavers, as between grinding and rapid moves, the number runs down all the same."""
    left, told, share = TimeLeft(), [], 0.0
    for k in range(1, 1200):
        share += 0.0004 if k % 80 < 40 else 0.0012
        told.append(left.update(0.1 * k, share))
    told = [t for t in told if t is not None]
    steps = [b - a for a, b in zip(told, told[1:])]
    raw = TimeLeft()
    raw._smoothed = lambda seconds, estimate: estimate
    share, jumps = 0.0, []
    for k in range(1, 1200):
        share += 0.0004 if k % 80 < 40 else 0.0012
        jumps.append(raw.update(0.1 * k, share))
    jumps = [t for t in jumps if t is not None]
    worst = max(abs(b - a) for a, b in zip(jumps, jumps[1:]))
    # Beyond the first seconds, when little is known: at most some tenths more than the time that passed.
    assert max(map(abs, steps[100:])) < 0.8 < worst, (max(map(abs, steps[100:])), worst)


def test_a_run_that_stands_still_has_no_time():
    left = TimeLeft()
    left.update(1.0, 0.2)
    assert left.update(2.0, 0.2) is None


def test_times_are_said_as_people_do():
    assert [duration(t) for t in (0, 59.4, 59.6, 200, 3599.6, 3900)] == [
        "0 s", "59 s", "1 min 00 s", "3 min 20 s", "1 h 00 min", "1 h 05 min"
    ]  # fmt: skip
