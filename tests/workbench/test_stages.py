"""Several wheels and belts, one after the other."""

import json

import numpy as np
import pytest

from beltgrinding import cli
from beltgrinding.cli import stages as stages_command
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.planning import belts, by_rules, rounds, stages, wheels
from beltgrinding.planning.search import Search
from beltgrinding.planning.stages import Node, Step, Tool
from beltgrinding.raster import reach_map
from support import synthetic_finish as made_up
from test_job import plate
from test_search import job_of

ALONG = {"along": "direction", "direction": [1.0, 0.0, 0.0]}


def sheet_with_groove(radius=5.0, half=50.0, sheet=14.0, count=8, length=16.0):
    """A sheet with a round groove along x in its middle."""
    angles = np.radians(np.linspace(-half, half, count + 1))
    y, z = radius * np.sin(angles), radius * (1.0 - np.cos(angles))
    y, z = [y[0] - sheet, *y, y[-1] + sheet], [z[0], *z, z[-1]]
    points = [[x, b, c] for x in (0.0, length) for b, c in zip(y, z)]
    n, triangles = len(y), []
    for k in range(n - 1):
        triangles += [[k, n + k, n + k + 1], [k, n + k + 1, k + 1]]
    mesh = core.TriangleMesh(np.array(points, np.float32), np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh)


def law_file(folder, coefficient):
    file = folder / f"law{coefficient}.json"
    file.write_text(json.dumps({"coefficient_mm2_per_N": coefficient}))
    return file


def test_belts_are_presets_with_laws_of_their_own(tmp_path):
    file = law_file(tmp_path, 2e-4)
    rough, fine = belts.given(f"P80={file}, p240")
    assert (rough.grit, fine.grit, fine.law) == (80.0, 240.0, None)
    job = jobs.validate(job_of(plate()))
    job["finish"] = jobs.validate(
        {**job, "finish": {"grit": 120, "initial_Ra_um": 3.2, "model": made_up.model()}}
    )["finish"]
    job["belt_machine"]["belt"]["work_J"] = 7.0
    found = belts.mounted(job, rough)
    assert found["law"]["coefficient_mm2_per_N"] == 2e-4 and found["finish"]["grit"] == 80.0
    assert found["belt_machine"]["belt"]["work_J"] == 0.0  # a fresh one
    assert belts.mounted(job, fine)["law"] == job["law"]
    assert [one.code for one in belts.notes(job, [rough, fine])] == ["planning.belt_law"]
    plain = {key: value for key, value in job.items() if key != "finish"}
    alike = belts.given("P80,P240")
    assert [one.code for one in belts.notes(plain, alike)][1:] == ["planning.belts_alike"]
    assert belts.notes(plain, [rough]) == []


@pytest.mark.parametrize(
    "options, words",
    [
        (["--belts", "P81"], "no 'p81' among the belts"),
        (["--belts", "P80,p80"], "names a belt twice"),
        (["--belts", "P80=none.json"], "none.json"),
        (["--stages", "0"], "--stages 0: give a number from 1"),
        (["--stages", "2", "--wheels", "any"], "stages need the sizes of wheels"),
        (["--stages", "2", "--set-raster", "region_points=[[0,0,0]]"], "choose their own regions"),
    ],
)
def test_nonsense_is_refused(tmp_path, capsys, options, words):
    (tmp_path / "plate.brep").write_text(plate().write_brep())
    out = tmp_path / "out"
    given = ["grind", str(tmp_path / "plate.brep"), "-o", str(out), "--budget", "0", *options]
    assert cli.main(given) == 2
    assert words in capsys.readouterr().err and not out.exists()


def test_a_stages_job_begins_with_what_is_left_and_leaves_an_allowance(tmp_path):
    job = job_of(plate())
    job["inspection"]["zones"] = jobs.validate(
        {**job, "inspection": {"zones": [{"name": "a", "tolerance_mm": [-0.05, 0.02]}]}}
    )["inspection"]["zones"]
    found = stages.job_of(Tool(job, "", 0), Step(0, True, 0.06), tmp_path / "left.h5")
    assert found["stock"] == {**job["stock"], "left_by": str(tmp_path / "left.h5")}
    assert found["inspection"]["tolerance_mm"] == pytest.approx([-0.04, 0.16])
    assert found["inspection"]["zones"][0]["tolerance_mm"] == pytest.approx([0.01, 0.08])
    assert stages.job_of(Tool(job, "", 0), Step(0, True, 0.0), None) == job
    # Where the raw part lay, and how thick it was, is in what the first stage left.
    moved = {**job["stock"], "offset_mm": 0.3, "placement": {"position_mm": [1.0, 0.0, 0.0]}}
    found = stages.job_of(
        Tool({**job, "stock": moved}, "", 0), Step(0, True, 0.0), tmp_path / "left.h5"
    )
    assert found["stock"] == {**job["stock"], "left_by": str(tmp_path / "left.h5")}


def node(*shares, leave=0.0, seconds=10.0, open_zones=0):
    steps = tuple(Step(k, True, leave) for k in range(len(shares)))
    return Node(steps, shares, (seconds,) * len(shares), ({},) * len(shares), 0.9, open_zones, "")


def test_the_fewest_stages_that_reach_what_any_reach_are_the_best():
    slow, quick = node(0.93, seconds=90.0), node(0.928, seconds=30.0)
    two, three = node(0.9, 0.97), node(0.9, 0.97, 0.974)
    assert stages._best([slow, quick]) is quick  # within half a point, the quickest
    assert stages._best([slow, two, three]) is two
    assert stages._best([slow, node(0.9, 0.99, leave=0.1)]) is slow  # it is not at its end
    finished = node(0.9, 0.92)
    assert stages._best([node(0.95, open_zones=1), finished]) is finished
    assert stages.pays((0.9, 0), (0.905, 0)) and not stages.pays((0.9, 0), (0.904, 0))
    assert stages.pays((0.9, 1), (0.9, 0))


def chosen(shape, more, **options):
    job = job_of(shape, **options)
    machines = [job["belt_machine"], *wheels.mounted(job, more)]
    settings = rounds.validate({"rounds": 1, "check": False})
    chooser = stages.Chooser(
        stages.tools(job, machines, []),
        stages.first_settings(ALONG),
        settings,
        Search(0.0, workers=2),  # rules alone
    )
    return chooser, chooser.choose(2)


def written(folder):
    def write(number, ground, _):
        file = folder / f"{number}.h5"
        ground.plan.after.field.write_hdf5(file)
        return ground.plan.after, file

    return write


@pytest.mark.slow
def test_a_plate_is_one_stage(monkeypatch):
    monkeypatch.setattr(stages, "WAYS", 1)
    chooser, best = chosen(plate(20.0, 15.0), [wheels.Wheel(8.0, 4.0)], radius=20.0, width=8.0)
    assert len(best.steps) == 1
    assert any(len(one.steps) == 2 for one in chooser.nodes)  # two were tried


@pytest.mark.slow
def test_a_small_wheel_grinds_what_a_large_one_cannot_enter(tmp_path, monkeypatch):
    ways = [{"along": "u"}, ALONG]
    monkeypatch.setattr(reach_map, "ways", lambda *_: ways)
    monkeypatch.setattr(by_rules, "TRIES", 1)
    small = wheels.Wheel(4.0, 2.5, 4.0)
    chooser, best = chosen(sheet_with_groove(), [small], radius=40.0, width=10.0)
    assert [(one.tool, one.everywhere) for one in best.steps] == [(0, True), (1, False)]
    singles = [one for one in chooser.nodes if len(one.steps) == 1]
    most = max(singles, key=lambda one: one.shares[-1])
    # Nearer than any wheel alone, in less time than the small one, which is the better of them.
    assert best.shares[-1] > most.shares[-1] + 0.005, (best.shares, most.shares)
    assert most.steps[0].tool == 1 and sum(best.times_s) < 0.8 * most.times_s[0]
    found = stages.grind(chooser, best, written(tmp_path))
    assert len(found.stages) == 2 and found.changes() == [["wheel"]] and not found.dropped
    large, both = found.stages
    assert both.share > large.share + 0.03, (large.share, both.share)
    # The second one begins with the heights that the first one left, and grinds in the groove.
    assert (both.result.field.height <= np.asarray(large.result.field.height) + 1e-6).all()
    ground = np.asarray(both.result.field.trace["last"]) != core.NEVER
    across = abs(np.asarray(both.result.field.points)[ground, 1])
    assert np.median(across) < 6.0
    told = found.report(chooser)
    assert told["tool_changes"] == 1 and told["stages"][1]["changed"] == ["wheel"]
    json.dumps(told, allow_nan=False)


def test_stages_of_an_earlier_plan_are_told(tmp_path):
    for number in (1, 2, 3):
        (tmp_path / f"stage_{number}").mkdir()
    assert not stages_command._left_over(tmp_path, 3)
    (note,) = stages_command._left_over(tmp_path, 2)
    assert note.arguments["file"].endswith("stage_3")


def test_a_region_is_the_stages_own():
    with pytest.raises(InputError, match="choose their own regions"):
        stages.first_settings({"region_points": [[0.0, 0.0, 0.0]]})
    with pytest.raises(InputError, match="further_passes: stages choose their own regions"):
        stages.first_settings({"further_passes": [{"belt_angle_deg": 90.0}]})
