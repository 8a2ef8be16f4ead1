"""The search for direction, belt angle and wheel: it finds what the rules do not, is never worse, and does not depend on processes."""

import json
import math
import os
import signal
import threading
import time

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.cli import background, searching
from beltgrinding.engine import core
from beltgrinding.job import load as jobs
from beltgrinding.planning import by_rules, candidates, grinding, moves, rough, search, wheels
from beltgrinding.planning.queue import Queue
from beltgrinding.planning.candidates import Seen
from beltgrinding.planning.search import Search
from beltgrinding.raster import raster_path, reach_map
from test_job import plate

QUICK = {"rounds": 1, "check": False}
ACROSS = {
    "along": "direction",
    "direction": [0.0, 1.0, 0.0],
    "step_over_mm": 4.0,
    "max_tilt_deg": 0.0,
}


def trough(radius=14.0, length=20.0, half=30.0, count=8):
    """A faceted trough along x, open upwards, over ``half`` degrees to either side."""
    angles = np.radians(np.linspace(-half, half, count + 1))
    rim = np.column_stack([radius * np.sin(angles), radius - radius * np.cos(angles)])
    rows = [[x, y, z] for x in (0.0, length) for y, z in rim]
    n = count + 1
    triangles = []
    for k in range(count):
        triangles += [[k, n + k, n + k + 1], [k, n + k + 1, k + 1]]
    return core.shape_from_mesh(
        core.TriangleMesh(np.array(rows, np.float32), np.array(triangles, np.uint32))
    )


def job_of(shape, radius=20.0, width=5.0, spacing=1.2, allowance=0.15, tolerance=0.1):
    return jobs.validate(
        {
            "design": {"brep": shape.write_brep()},
            "sampling": {"spacing_mm": spacing},
            "stock": {"allowance_mm": allowance},
            "inspection": {"tolerance_mm": [-tolerance, tolerance]},
            "belt_machine": {"wheel": {"radius_mm": radius, "width_mm": width}, "force_N": 15},
            "cell": {"check_collisions": False},
            "programs": [{"poses": []}],
        }
    )


@pytest.fixture
def small(monkeypatch):
    """Few candidates."""
    for name, count in {"LEADERS": 2, "FINALS": 2, "FURTHER": 1, "PATIENCE": 2}.items():
        monkeypatch.setattr(search, name, count)
    monkeypatch.setattr(by_rules, "TRIES", 1)


def test_geometry_says_along_which_way_the_wheel_gets_to_a_trough():
    job = job_of(trough())
    ways = [{"along": "direction", "direction": way} for way in ([1.0, 0, 0], [0, 1.0, 0])]
    settings = raster_path.validate({"max_tilt_deg": 0.0})
    seen = reach_map.look(job, settings, ways, (0.0, 90.0))
    shares = {(one.way["direction"][0], one.belt_angle_deg): one.share for one in seen.found}
    # The belt must travel along the trough: passes along it, or across it with the belt square to them.
    assert shares[1.0, 0.0] > 0.95 and shares[0, 90.0] > 0.95, shares
    assert shares[1.0, 90.0] < 0.3 and shares[0, 0.0] < 0.3, shares
    assert seen.fits.mean() > 0.95
    # A wheel that is smaller than the trough gets there any way.
    smaller = reach_map.look(job_of(trough(), radius=8.0), settings, ways, (0.0,))
    assert min(one.share for one in smaller.found) > 0.95


def test_geometry_knows_belts_too():
    belt = {"kind": "free_belt", "free_run": {"length_mm": 150, "width_mm": 10}}
    job = jobs.validate({**job_of(plate()), "belt_machine": belt})
    settings = raster_path.validate({})
    ways = reach_map.ways(job, settings)
    seen = reach_map.look(job, settings, ways[:2], (0.0,))
    assert [one.share for one in seen.found] == [1.0] * len(seen.found) and seen.fits.all()
    assert len(reach_map.distinct([*ways, *ways])) == len(ways)


def test_candidates_come_by_what_the_wheel_gets_to_and_other_wheels_between_them():
    own, other = ({"wheel": {"radius_mm": r, "width_mm": 5.0}} for r in (20.0, 8.0))
    first = {"along": "u", "direction": [1.0, 0, 0], "belt_angle_deg": 0.0, "step_over_mm": 4.0}

    def seen(machine, **shares):
        found = [
            reach_map.Reach({"along": way}, 0.0, share, share) for way, share in shares.items()
        ]
        return Seen(machine, reach_map.Map(found, np.ones(1, dtype=bool)))

    found = candidates.candidates(
        seen(own, u=0.6, v=0.95, rings=0.9), [seen(other, u=1.0, v=0.2)], ("first", own, first)
    )
    told = [(move[1]["wheel"]["radius_mm"], move[2]["along"]) for move in found]
    assert told == [(20.0, "v"), (8.0, "u"), (20.0, "rings")]  # what is far behind is none
    # A step-over in mm is none for another wheel.
    assert [move[2]["step_over_mm"] for move in found] == [4.0, 0.0, 4.0]
    both = seen(own, u=0.6), [seen(other, u=1.0)], ("first", own, first)
    assert candidates.candidates(*both, ["step_over_mm"])[0][2]["step_over_mm"] == 4.0


@pytest.mark.slow
def test_a_search_finds_the_way_and_is_the_same_on_any_number_of_processes(small):
    job = job_of(trough())
    by_hand = grinding.grind(job, ACROSS, QUICK)
    told = []
    found = [
        grinding.grind(
            job, ACROSS, QUICK, told=told.append, search=Search(search.UNTIL_IT_PAYS, workers=n)
        )
        for n in (1, 2)
    ]
    before, after = (
        one.plan.after.summary["in_tolerance_area_share"] for one in (by_hand, found[0])
    )
    assert after > before + 0.3, (before, after)
    assert found[0].settings == found[1].settings and found[0].tried == found[1].tried
    assert np.array_equal(found[0].plan.new, found[1].plan.new)
    assert any("change" in one for one in told) and "rounds" not in told[0]
    report = found[0].search
    assert report["through"] and report["reachable"] > 0.95
    best = max(one["in_tolerance"] for one in report["tried"])
    assert after == pytest.approx(best, abs=0.02)
    json.dumps(report, allow_nan=False)


def test_what_is_given_stays(small):
    given = Search(search.UNTIL_IT_PAYS, fixed=("along", "belt_angle_deg", "direction"), workers=1)
    found = grinding.grind(job_of(trough()), ACROSS, QUICK, search=given)
    rows = {(one["along"], *one["direction"], one["belt_angle_deg"]) for one in found.tried}
    assert rows == {("direction", 0.0, 1.0, 0.0, 0.0)}


@pytest.mark.slow
def test_without_time_or_wish_it_gives_what_the_rules_give(small):
    job = job_of(trough())
    by_hand = grinding.grind(job, ACROSS, QUICK)
    told = []
    options = {"search": Search(60.0, workers=1), "stop": lambda: True, "told": told.append}
    found = grinding.grind(job, ACROSS, QUICK, **options)
    shares = [one.plan.after.summary["in_tolerance_area_share"] for one in (by_hand, found)]
    assert shares[1] >= shares[0] - 1e-9 and not found.search["through"]
    assert told[: len(found.tried)] == found.tried
    # A wish is heard in the processes, too: the rules try no second passes.
    assert [one["change"] for one in found.tried] == ["first", "full"]


@pytest.mark.slow
def test_further_wheels_are_told_with_what_they_would_bring(small):
    # With little force the wheel's rim reaches into the trough further than its shape does.
    job = job_of(trough(radius=8.0, length=12.0, half=60.0), radius=20.0, width=8.0, tolerance=0.04)
    further = wheels.mounted(job, [wheels.Wheel(6.0, 3.0), wheels.Wheel(100.0, 8.0)])
    along = {**ACROSS, "direction": [1.0, 0.0, 0.0], "step_over_mm": 0.0}
    found = grinding.grind(job, along, QUICK, search=Search(search.UNTIL_IT_PAYS, further=further))
    told = {one["wheel"]["radius_mm"]: one for one in found.search["wheels"]}
    assert told[6.0]["reachable"] > 0.9 > found.search["reachable"]
    assert told[6.0]["gain"] > 0.1 and told[100.0]["gain"] is None
    assert found.plan.job["belt_machine"]["wheel"]["radius_mm"] == 20.0
    taken = grinding.grind(job, along, QUICK, search=Search(search.UNTIL_IT_PAYS, wheels=further))
    assert taken.plan.job["belt_machine"]["wheel"]["radius_mm"] == 6.0
    share = taken.plan.after.summary["in_tolerance_area_share"]
    assert share > found.plan.after.summary["in_tolerance_area_share"] + 0.03


def test_wheels_are_sizes_of_a_series_or_given():
    own = wheels.Wheel(20.0, 16.0)
    found = wheels.series(own)
    assert own not in found and wheels.Wheel(10.0, 10.0) in found
    assert wheels.Wheel(20.0, 12.5) in found and any(one.crown for one in found)
    assert wheels.given("20x15, 10x8c40") == [wheels.Wheel(20, 15), wheels.Wheel(10, 8, 40)]
    machines = wheels.mounted(job_of(plate()), [wheels.Wheel(20.0, 5.0), wheels.Wheel(10.0, 8.0)])
    assert [one["wheel"]["radius_mm"] for one in machines] == [10.0]  # the own one is none
    platen = jobs.validate({**job_of(plate()), "belt_machine": {"kind": "free_belt"}})
    assert wheels.mounted(platen, found) == ()


def tried(machine=None, shares=None, gentler=(0.0, 1.0), levels=9, **wanted):
    none = dict.fromkeys(
        ("slowest_feed", "shared", "fringe", "border", "no_room", "no_motion"), 0.0
    )
    settings = raster_path.validate({"along": "direction", **wanted})
    machine = machine or job_of(plate())["belt_machine"]
    up = np.array([0.0, 0.0, 1.0])
    feeds = np.ones(3), np.ones(3)
    return rough.Tried(
        *("first", machine, settings, 0.5, feeds, {**none, **(shares or {})}, 0.2),
        *(6.0, 8.0, 3.0, levels, 40, 10.0, 0.0, 1, gentler, up),
        *(np.zeros((0, 3)), 0.0, 0.0),
    )


@pytest.mark.parametrize("spacing, glances", [(1.2, False), (0.2, True)])
def test_a_glance_is_taken_where_a_rough_plan_has_more_samples(spacing, glances):
    job = job_of(trough(length=200.0), spacing=spacing)
    assert rough.glances(job, raster_path.validate({})) is glances


def test_moves_answer_to_what_stays_out():
    def names(one, fixed=()):
        return sorted(move[0] for _, move in moves.Moves(fixed)(one) if move[0] != "near")

    assert names(tried()) == []
    hidden = tried(shares={"no_room": 0.3})
    assert names(hidden) == ["belt_angle"] * 2 + ["direction"] * 2
    assert names(hidden, ("belt_angle_deg", "along")) == []
    leaned = tried(shares={"shared": 0.2}, belt_angle_deg=90.0)
    told = {move[0]: move[2] for _, move in moves.Moves()(leaned)}
    assert told["lean"]["max_tilt_deg"] == 5.0 and told["belt_angle"]["belt_angle_deg"] == 67.5


def test_no_turn_is_hoped_to_get_where_no_belt_angle_does():
    def hope(reachable):
        found = moves.Moves((), 0, reachable)(tried(shares={"no_room": 0.3}))
        return max((share for share, move in found if move[0] == "belt_angle"), default=0.0)

    assert hope(1.0) > hope(0.9) > hope(0.7) == 0.0


def test_the_most_promising_of_all_is_tried_next_and_none_twice():
    far, near = tried(), tried()._replace(in_tolerance=0.8)

    def source(one):
        names = ("much", "little") if one is near else ("far", "very")
        shares = (0.5, 0.1) if one is near else (0.6, 1.0)
        return [
            (share, (name, one.machine, {"name": name, "of": one.in_tolerance}))
            for name, share in zip(names, shares)
        ]

    waiting = Queue([source], set())
    waiting.add(far)
    waiting.add(near)
    assert [name for name, *_ in waiting.take(3)] == ["much", "little", "very"]
    waiting.add(near)
    assert [name for name, *_ in waiting.take(3)] == ["far"]
    assert not waiting.take(3)


def test_what_is_a_little_different_is_tried_last_the_same_each_time():
    def near(one, *given):
        found = sorted(moves.Moves(*given)(one), key=lambda pair: -pair[0])
        last = [move for share, move in found if share == 0.0]
        assert found[len(found) - len(last) :] == [(0.0, move) for move in last]
        return last

    assert near(tried()) == []  # nothing stays out
    one = tried(shares={"border": 0.2})
    found = near(one)
    assert len(found) > 5 and found == near(one) and found != near(one, (), 1)
    changed = {key for move in found for key, value in move[2].items() if value != one.wanted[key]}
    assert changed <= {"run_out_mm", "step_over_mm", "belt_angle_deg", "direction"}
    kept = near(one, ("run_out_mm", "direction", "along"))
    assert {key for move in kept for key, value in move[2].items() if value != one.wanted[key]} <= {
        "step_over_mm",
        "belt_angle_deg",
    }


def test_less_force_at_borders_is_tried_where_the_program_sets_forces():
    own = job_of(plate())["belt_machine"]
    device = {**own, "force_device": {**own["force_device"], "kind": "analog"}}

    def told(one):
        return {move[0]: (share, move[2]) for share, move in by_rules.others(one)}

    left = {"border": 0.05, "shared": 0.02}
    share, wanted = told(tried(device, left))["border_force"]
    assert share > told(tried(device, left))["run_out"][0]
    assert wanted["border_force_share"] == by_rules.BORDER_FORCE
    assert wanted["step_over_mm"] == pytest.approx(by_rules.CLOSER * 3.0)
    for one in (
        tried(own, left),  # one force, set by hand
        tried(device, {"shared": 0.2}),
        tried(device, left, entry="direct"),
        tried(device, left, border_force_share=0.3),
        tried({**device, "control": "position"}, left),
    ):
        assert "border_force" not in told(one)


def test_one_pass_less_is_tried_where_there_are_few():
    def wider(**given):
        moves = by_rules.others(tried(**given))
        return [one[2]["step_over_mm"] for _, one in moves if one[2]["step_over_mm"] > 3.0]

    border = {"border": 0.05}
    (two,) = wider(shares=border, levels=2)
    assert 2 * 3.0 < two < 2.01 * 3.0  # 2 passes cover at most that
    (three,) = wider(shares=border, levels=3)
    assert 1.5 * 3.0 < three < 1.51 * 3.0
    assert wider(shares=border, levels=1) == wider(shares=border) == wider(levels=2) == []


def test_less_force_is_tried_where_it_is_set_by_hand():
    own = job_of(plate())["belt_machine"]

    def forces(one):
        return [move[1]["force_N"] for _, move in by_rules.others(one) if move[0] == "force"]

    assert forces(tried(own, gentler=(0.3, 0.2))) == [pytest.approx(0.2 * own["force_N"])]
    assert forces(tried(own, gentler=(0.3, 0.001))) == [rough.FORCE_LEAST]
    least = {**own, "force_N": rough.FORCE_LEAST}
    for one in (
        tried(own),
        tried(least, gentler=(0.3, 0.5)),
        tried({**own, "control": "position"}, gentler=(0.3, 0.2)),
        tried(own, gentler=(0.3, 0.2), force_N=12.0),  # the user's own
    ):
        assert forces(one) == []


def test_turns_are_about_the_mean_normal():
    about = np.array([0.0, 0.0, 1.0])
    assert moves.turned([2.0, 0.0, 1.0], about, 90.0) == [0.0, 1.0, 0.0]
    assert [moves.half_turn(a) for a in (0.0, 90.0, 112.5, -112.5, 180.0)] == [
        0,
        90,
        -67.5,
        67.5,
        0,
    ]
    assert math.isclose(
        np.linalg.norm(moves.turned([1.0, 1.0, 0.0], about, 22.5)), 1.0, abs_tol=1e-4
    )


def test_ctrl_c_takes_the_best_so_far_once_it_is_there(capsys):
    # Of Python again: OpenTURNS, which another test may have called here, has Ctrl-C end the process.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    watched = searching.Watched(None)
    assert not watched.interrupted()  # nothing is there yet

    def work(context):
        watched.told({"change": "first"})
        threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        end = time.monotonic() + 30.0
        while not watched.enough and time.monotonic() < end:
            time.sleep(0.05)
        context.throw_if_cancelled()
        return "the best"

    try:
        assert background.run(work, True, watched.interrupted) == "the best"
    finally:
        signal.signal(signal.SIGINT, before)
    assert "Ctrl-C once more" in capsys.readouterr().out
    assert not watched.interrupted()  # the second one ends it


@pytest.mark.slow
def test_the_command_searches_and_keeps_what_it_tried(tmp_path, capsys):
    (tmp_path / "trough.brep").write_text(trough().write_brep())
    out = tmp_path / "out"
    quick = ["--set", "check=false", "--set", "rounds=1", "--budget", "60"]
    begin = ["grind", str(tmp_path / "trough.brep"), "-o", str(out), "--stock", "0.15", *quick]
    assert cli.main(begin) == 0
    printed = capsys.readouterr().out
    assert "belt deg" in printed and "some wheel to" in printed
    plan = json.loads((out / "plan.json").read_text())
    assert plan["search"]["tried"] and plan["search"]["geometry"]
    wheel = json.loads((out / "job.json").read_text())["belt_machine"]["wheel"]
    assert wheel["radius_mm"] in [one["wheel"]["radius_mm"] for one in plan["search"]["tried"]]
    assert len({one["wheel"]["radius_mm"] for one in plan["search"]["geometry"]}) > 1


@pytest.mark.parametrize(
    "options, words",
    [
        (["--budget", "soon"], "--budget soon: give seconds from 0, or none"),
        (["--budget", "-1"], "give seconds from 0"),
        (["--wheels", "large"], "'large' is no wheel"),
        (["--wheels", "20x0"], "'20x0' is no wheel"),
        (["--processes", "-1"], "--processes -1"),
    ],
)
def test_nonsense_is_refused(tmp_path, capsys, options, words):
    (tmp_path / "plate.brep").write_text(plate().write_brep())
    out = tmp_path / "out"
    assert cli.main(["grind", str(tmp_path / "plate.brep"), "-o", str(out), *options]) == 2
    assert words in capsys.readouterr().err and not out.exists()
