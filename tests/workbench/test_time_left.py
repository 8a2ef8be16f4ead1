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


def test_a_run_that_stands_still_has_no_time():
    left = TimeLeft()
    left.update(1.0, 0.2)
    assert left.update(2.0, 0.2) is None


def test_times_are_said_as_people_do():
    assert [duration(t) for t in (0, 59.4, 59.6, 200, 3599.6, 3900)] == [
        "0 s", "59 s", "1 min 00 s", "3 min 20 s", "1 h 00 min", "1 h 05 min"
    ]  # fmt: skip
