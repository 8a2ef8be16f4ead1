"""Calls side by side: the same answers whatever the number of processes, deaths, deadlines, cancellation."""

import os
import signal
import threading
import time
from pathlib import Path

import pytest

from beltgrinding.base import crew, processes
from beltgrinding.base.crew import Call, Crew
from beltgrinding.engine import Cancelled, InputError, core


@pytest.fixture(autouse=True)
def _found_by_processes(monkeypatch):
    """The processes find the functions of this file."""
    known = os.environ.get("PYTHONPATH", "")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path(__file__).parent), known]))


def square(x):
    time.sleep(0.01 * (5 - x % 5))  # the last ones are ready first
    return x * x


def threads_of(x):
    return os.getpid(), x


def refuse(x):
    raise InputError("test.refused", "{x} is refused", x=x)


def die(_):
    os.kill(os.getpid(), signal.SIGKILL)


def sleep(seconds):
    time.sleep(seconds)
    return seconds


@pytest.mark.parametrize("workers", [1, 3])
def test_answers_stand_in_the_order_of_the_calls(workers):
    seen = []
    with Crew(workers) as hands:
        found = hands.run([Call(square, (x,)) for x in range(11)], lambda k, a: seen.append(k))
        assert [one.value for one in found] == [x * x for x in range(11)]
        assert sorted(seen) == list(range(11))
        first = {one.value[0] for one in hands.run([Call(threads_of, (0,))] * 6)}
        again = {one.value[0] for one in hands.run([Call(threads_of, (0,))] * 6)}
    assert again <= first or workers > 1  # the processes live on
    assert os.getpid() not in first | again


def test_errors_come_back_and_the_others_go_on():
    with Crew(2) as hands:
        found = hands.run([Call(refuse, (3,)), Call(square, (2,)), Call(die, (0,))])
    assert isinstance(found[0].error, InputError) and str(found[0].error) == "3 is refused"
    assert found[1].value == 4 and found[1].error is None
    assert found[2].error.code == "base.process_died"


def test_a_deadline_leaves_the_rest():
    begun = time.monotonic()
    with Crew(1) as hands:
        hands.run([Call(square, (1,))])
        found = hands.run(
            [Call(sleep, (0.0,)), Call(sleep, (60.0,)), Call(square, (1,))],
            over=crew.End(time.monotonic() + 1.0).passed,
        )
        assert found[0].value == 0.0 and found[1] is found[2] is None
        assert hands.run([Call(square, (3,))])[0].value == 9  # it works on after that
    assert time.monotonic() - begun < 30.0


def test_a_cancellation_ends_the_processes():
    context = core.RunContext()
    threading.Timer(0.5, context.cancel).start()
    begun = time.monotonic()
    with Crew(1) as hands, pytest.raises(Cancelled):
        hands.run([Call(sleep, (60.0,))], context=context)
    assert time.monotonic() - begun < 30.0


def test_processes_are_as_many_as_find_room():
    assert processes.with_room(1.0) == processes.cores()
    assert processes.with_room(1e18) == 1
    assert Crew(3).most == 3 and Crew(3, bytes_each=1e18).most == 1
    assert Crew().most == processes.cores()
