"""One force for all that is set by hand, where the programs' files set none; feeds that a program has itself."""

import json

import numpy as np
import pytest

from beltgrinding import planning
from beltgrinding.base import frames
from beltgrinding.cli import main
from beltgrinding.job import load as jobs
from beltgrinding.planning import apply, rounds
from beltgrinding.planning.commands import Commands
from beltgrinding.programs.program import Motion
from beltgrinding.programs.registry import read_program
from beltgrinding.programs.writers.writer import write_program
from test_job import plate

STOCK = 0.1  # mm, of which even the greatest feed takes too much


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    """A plate of 60 x 40 mm and a program without forces whose blocks of 3 mm go as fast as blocks do."""
    folder = tmp_path_factory.mktemp("hand")
    motions = []
    for y in (8.0, 16.0, 24.0, 32.0):
        for x in np.arange(0.0, 60.1, 3.0):
            pose = frames.from_abc((x, y, STOCK), (0.0, 0.0, 180.0))
            kind, feed = ("LIN", 80.0) if x else ("PTP", None)
            motions.append(Motion(kind, pose, 0, "", feed))
    write_program(folder / "path.src", None, motions, digits="robot")
    (folder / "plate.brep").write_text(plate().write_brep())
    job = {
        "design": {"file": "plate.brep", "faces": [1]},
        "sampling": {"spacing_mm": 1.5},
        "stock": {"allowance_mm": STOCK},
        "belt_machine": {
            "wheel": {"radius_mm": 30, "width_mm": 15, "crown_radius_mm": 80},
            "force_N": 40.0,
        },
        "law": {"coefficient_mm2_per_N": 1.2e-4},
        "cell": {"check_collisions": False},
        "programs": [{"file": "path.src"}],
        "inspection": {"tolerance_mm": [-0.05, 0.05]},
    }
    job["design"] = {"brep": plate().write_brep()}
    return folder, job


def planned(given, **settings):
    folder, job = given
    job = jobs.validate(job, folder)
    return planning.plan(job, {"check": False, "rounds": 5, **settings})


def test_one_force_for_all_is_found_and_stands_in_the_job(given, tmp_path):
    fixed = planned(given)
    assert rounds.summary(fixed)["force_by_hand"] is None
    free = planned(given, force_min_N=5.0)
    told = rounds.summary(free)
    assert told["after"]["in_tolerance"] > rounds.summary(fixed)["after"]["in_tolerance"] + 0.1
    hand = told["force_by_hand"]
    assert hand["before_N"] == 40.0 and 5.0 <= hand["after_N"] < 30.0
    assert len(set(free.factors.tolist())) == 1
    assert free.job["belt_machine"]["force_N"] == hand["after_N"]
    assert not any("force_N" in pose for pose in free.job["programs"][0]["poses"])
    written, warnings = apply.write(free, tmp_path / "out")
    assert written == ["path.src"] and not warnings
    kept = jobs.load(tmp_path / "out" / "job.json")
    assert kept["belt_machine"]["force_N"] == hand["after_N"]
    assert all(m.force_N is None for m in read_program(tmp_path / "out" / "path.src").motions)


def test_the_command_tells_what_to_set_or_that_less_would_help(given, tmp_path, capsys):
    folder, job = given
    file = folder / "job.json"
    file.write_text(json.dumps(job))
    command = [
        "plan",
        str(file),
        "-o",
        str(tmp_path / "a"),
        "--set",
        "check=false",
        "--set",
        "rounds=2",
    ]
    assert main(command) == 0
    assert "the force is fixed: less of it would help" in capsys.readouterr().out
    assert main([*command, "--force", "--set", "force_min_N=5"]) == 0
    assert "N by hand on the belt machine in place of 40 N" in capsys.readouterr().out


def test_a_force_device_lets_forces_fall_unless_the_settings_say_otherwise(given):
    folder, job = given
    device = {"kind": "analog", "output": 1, "scale_per_N": 0.01, "greatest_N": 80}
    machine = {**job["belt_machine"], "force_device": device}
    with_device = (folder, {**job, "belt_machine": machine})
    free = planned(with_device, rounds=2)
    assert free.settings["force_min_N"] == pytest.approx(2.0)  # a twentieth
    assert not free.commands.by_hand and free.factors.min() < 0.9
    assert planned(with_device, rounds=1, timing="job").settings["force_min_N"] == 0.0


def test_a_program_is_not_made_slower_than_it_is(given):
    """Blocks of 3 mm last 36 ms at 83 mm/s. Its own 120 mm/s stay allowed; a chosen limit holds."""
    folder, job = given
    text = (folder / "path.src").read_text().replace("$VEL.CP=0.08", "$VEL.CP=0.2")
    assert "$VEL.CP=0.2" in text
    (folder / "fast.src").write_text(text.replace("DEF path", "DEF fast"))
    job = jobs.validate({**job, "programs": [{"file": "fast.src"}]}, folder)
    data, settings = rounds.in_time(job, rounds.validate({}))
    commands = Commands(data, settings)
    own = ~np.isin(np.arange(len(commands)), commands.group[commands.rapid])
    assert commands.too_short()[own].all()
    # 200 mm/s are above what the robot comes to on a pass at 1200 mm/s2, and no less than it does.
    assert commands.feed_range[1][own].max() > 110.0
    data, settings = rounds.in_time(job, rounds.validate({"feed_max_mm_s": 60.0}))
    assert Commands(data, settings).feed_range[1][own].max() <= 60.0
