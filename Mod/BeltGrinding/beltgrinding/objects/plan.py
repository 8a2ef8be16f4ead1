"""A plan in the document: its settings, what it found, and feeds and forces that wait to be applied."""

from __future__ import annotations

import functools
import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..base.files import cannot_be_written
from ..base.kinds import Array, Context, Facts, Json
from ..engine import InputError, core
from ..cell.tool_path import tool_path
from ..job import robot_time
from ..planning import from_file, grinding, pictures, rounds as plans, wheels, written
from ..planning.search import BUDGET_S, Search
from ..programs.force_device import ForceDevice
from ..programs.writers.writer import zones_written
from . import ground_by, job_inputs, result_files, stored_facts
from .belt_machine import BeltMachine
from .job_data import KEYS as JOB_KEYS, inspection, required
from .kinds import DocumentObject
from .properties import Key, Output, add_keys, add_outputs, from_job, to_job
from .proxy import Proxy
from .raster_path import KEYS as PASSES, RasterPath, settings_of, take
from .robot_path import force_device, read_again, roll_of

EXPORTED = "passes.src"  # as what a path is exported
SEARCH_S = int(BUDGET_S)  # for passes where there are none yet
PLANNING = 0.6  # of the time; the rest reads and simulates what would be written

KEYS = (
    Key("Goal", "Enumeration", "Goal", "plan.goal"),
    Key("Timing", "Enumeration", "Goal", "plan.timing"),
    Key("WantedShare", "Float", "Goal", "plan.wanted_share"),
    Key("Probability", "Float", "Goal", "plan.probability"),
    Key("PlacementDeviation", "Length", "Goal", "plan.placement_sd_mm"),
    Key("FeedMin", "Speed", "Limits", "plan.feed_min_mm_s"),
    Key("FeedMax", "Speed", "Limits", "plan.feed_max_mm_s"),
    Key("ForceMin", "Force", "Limits", "plan.force_min_N"),
    Key("ForceMax", "Force", "Limits", "plan.force_max_N"),
    Key("FeedChange", "Float", "Limits", "plan.feed_change_mm_s_mm"),
    Key("Acceleration", "Acceleration", "Limits", "plan.acceleration_mm_s2"),
    Key("ForceChange", "Float", "Limits", "plan.force_change_N_s"),
    Key("PressureMax", "Pressure", "Limits", "plan.pressure_max_MPa"),
    Key("HeatMax", "Float", "Limits", "plan.heat_max_MPa_m_s"),
    Key("Levels", "Integer", "Limits", "plan.levels"),
    Key("Keep", "JSON", "Limits", "plan.keep"),
    Key("Rounds", "Integer", "Rounds", "plan.rounds"),
    Key("SearchResolution", "Enumeration", "Rounds", "plan.search_resolution"),
    Key("LeastGain", "Float", "Rounds", "plan.least_gain"),
    Key("MostChange", "Float", "Rounds", "plan.most_change"),
    Key("Smoothing", "Float", "Rounds", "plan.smoothing"),
    Key("Check", "Bool", "Rounds", "plan.check"),
)
TIME_LAW = ("timing", *robot_time.KEYS)  # keys of a job's simulation
TIMING = [key for key in JOB_KEYS if key.key.removeprefix("simulation.") in TIME_LAW]
OUTPUTS = (
    Output("Better", "Bool", "Plan", "more of the area comes into tolerance than before"),
    Output("Applied", "Bool", "Plan", "the programs of the job have the planned feeds and forces"),
    Output("OutOfDate", "Bool", "Plan", "an input, the tolerance or a setting has changed since"),
    Output("InToleranceBefore", "Float", "Plan", "share of the area, percent"),
    Output("InTolerance", "Float", "Plan", "share of the area as planned, percent"),
    Output("ProcessTimeBefore", "Float", "Plan", "what the robot takes, s"),
    Output("ProcessTime", "Float", "Plan", "what the robot takes as planned, s"),
    Output("Rates", "StringList", "Plan", "what every round found"),
    Output("Reasons", "StringList", "Plan", "why what is out of tolerance stays so"),
    Output("FilesShort", "StringList", "Plan", "where its programs, read again, fall short of it"),
    stored_facts.output("FilesShort", "Plan"),
    Output("Data", "String", "Plan", "figures as JSON", True),
    Output("Paths", "StringList", "Plan", "names of the job's paths", True),
    Output("PathOf", "IntegerList", "Plan", "path of every pose, from 0", True),
    Output("Along", "FloatList", "Plan", "way of the contact up to every pose, mm", True),
    Output("Rapid", "BoolList", "Plan", "nothing is ground on the way to these poses", True),
    Output("OldFeeds", "FloatList", "Plan", "before, of every pose, mm/s", True),
    Output("NewFeeds", "FloatList", "Plan", "planned, of every pose, mm/s", True),
    Output("OldForces", "FloatList", "Plan", "before, of every pose, N", True),
    Output("NewForces", "FloatList", "Plan", "planned, of every pose, N", True),
    Output("Zones", "FloatList", "Plan", "planned, of every pose, mm; below 0: the default", True),
    Output("TimeLaw", "String", "Plan", "of the job, as it is planned for; JSON", True),
    Output("Kept", "BoolList", "Plan", "poses whose force is the belt machine's still", True),
    Output("Changes", "String", "Plan", "of each path, what changes in its file; JSON", True),
    Output("LeftPoints", "VectorList", "Plan", "corners of what stays out of tolerance", True),
    Output("LeftTriangles", "IntegerList", "Plan", "three of them each", True),
    Output("LeftStates", "IntegerList", "Plan", "of the corners: as planning.reasons", True),
    Output("Raster", "String", "Plan", "settings of the passes, if they are laid anew; JSON", True),
    Output("Fingerprint", "String", "Plan", "hash of what was planned", True),
    Output("AppliedFingerprint", "String", "Plan", "hash of the same job with its plan", True),
)
PICTURES = (
    ("Picture", "before, as planned and why, from two sides"),
    ("Strip", "before, as planned and why, from one side"),
)


class Plan(Proxy):
    """Proxy of the App::FeaturePython. It holds what was found; ``apply_plan`` puts it into the job's paths."""

    TYPE = "BeltGrinding::Plan"
    VIEW = "PlanView"

    def add_properties(self, obj: DocumentObject) -> None:
        earlier = "Goal" in obj.PropertiesList and "Timing" not in obj.PropertiesList
        add_keys(obj, KEYS)
        if earlier:  # a plan of an earlier version: by the job's time law
            obj.Timing = "job"
        if "LayPasses" not in obj.PropertiesList:
            text = (
                "the passes are laid anew, too: step-over, run-out, how often they are run through"
            )
            obj.addProperty("App::PropertyBool", "LayPasses", "Passes", text)
        if "SearchSeconds" not in obj.PropertiesList:
            text = "so long it searches for direction and belt angle of passes that are laid anew, on all cores; 0: by rules alone"
            obj.addProperty("App::PropertyInteger", "SearchSeconds", "Passes", text)
        add_outputs(obj, OUTPUTS)
        for name, text in PICTURES:
            if name not in obj.PropertiesList:
                obj.addProperty("App::PropertyFileIncluded", name, "Plan", text)
                obj.setEditorMode(name, 2)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def update(self, obj: DocumentObject) -> None:
        """Marks it as out of date, or as applied."""
        job = obj.getParentGroup()
        if job is None or not obj.Fingerprint:
            return
        try:
            now = fingerprint(obj, job)
        except InputError:
            now = ""
        applied = bool(obj.AppliedFingerprint) and now == obj.AppliedFingerprint
        if obj.Applied != applied:
            obj.Applied = applied
        stale = not applied and now != obj.Fingerprint
        if obj.OutOfDate != stale:
            obj.OutOfDate = stale

    def settings(self, obj: DocumentObject) -> dict[str, Any]:
        """As Resources/schema/plan.schema.json has them."""
        data: dict[str, Any] = {}
        to_job(obj, KEYS, data)
        return data["plan"]

    def data(self, obj: DocumentObject) -> dict[str, Any] | None:
        """The figures as ``planning.summary`` gives them; None if there are none yet."""
        return json.loads(obj.Data) if obj.Data else None


def fingerprint(obj: DocumentObject, job: DocumentObject) -> str:
    """Hash of all that a plan depends on."""
    settings = obj.Proxy.settings(obj)
    if settings["timing"] == "robot":
        settings["controller"] = required(job, BeltMachine, "belt machine").Controller
    else:
        del settings["timing"]  # as before there was a choice
    data = [job_inputs.fingerprint(job), inspection(job), settings, obj.LayPasses]
    if obj.LayPasses and obj.SearchSeconds:
        data.append(obj.SearchSeconds)
    return hashlib.sha256(json.dumps(data, sort_keys=True, allow_nan=False).encode()).hexdigest()


def paths_of(job: DocumentObject) -> list[DocumentObject]:
    """The job's paths that are ground, in their order."""
    return ground_by.active(job)


def sources(job: DocumentObject) -> list[str | None]:
    """Of each path the file that it was read from, or None; as ``planning.Commands`` takes them."""
    return [path.Source or None for path in paths_of(job)]


def entry(path: DocumentObject) -> dict[str, Any] | None:
    """With what a job reads a path's file as the path does; None where its poses were made here."""
    if not path.Source:
        return None
    roll, direction = roll_of(path)
    given = {
        "roll": roll,
        "roll_direction": direction,
        "values": json.loads(path.Values) if path.Values else None,
        **job_inputs.overrides(path),
    }
    return {"file": path.Source, **{key: one for key, one in given.items() if one is not None}}


def passes_of(job: DocumentObject) -> DocumentObject:
    """The raster path of a job that no other path grinds; it is the one that is laid anew. Raises InputError."""
    paths = paths_of(job)
    if len(paths) != 1 or not isinstance(paths[0].Proxy, RasterPath):
        raise InputError(
            "planning.no_passes",
            "{object}: to lay passes anew it must have one active raster path and no other active program; it has {paths}",
            object=job.Label,
            paths=", ".join(path.Label for path in paths) or "-",
        )
    return paths[0]


class Work:
    """What is planned of a job, collected here and now; ``find`` plans it, in any thread. Raises InputError."""

    def __init__(self, obj: DocumentObject, job: DocumentObject) -> None:
        self.settings = plans.validate(obj.Proxy.settings(obj))
        self.sources = sources(job)
        self.read = [entry(path) for path in paths_of(job)]
        self.raster = settings_of(passes_of(job)) if obj.LayPasses else None
        self.search_s = max(obj.SearchSeconds, 0) if obj.LayPasses else 0
        self.planned = fingerprint(obj, job)

    def find(
        self,
        data: Json,
        context: Context = None,
        told: Callable[[dict[str, Any]], object] | None = None,
        words: Mapping[str, str] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Found:
        """A ``Found`` for a job's data. ``stop()``: whether the best passes so far are enough. Raises InputError, Cancelled."""
        context = context or core.RunContext()
        searched, whole = {**self.settings, "check": False}, self.settings["check"]
        first = context.part(0.0, PLANNING if whole else 1.0)
        ground = None
        if self.raster is None:
            plan = plans.plan(data, searched, first, told, self.sources)
        else:
            # Zones as the path's export will have them: KRL's, in the form of the job's controller.
            zones = functools.partial(zones_written, name=EXPORTED, form=robot_time.form(data))
            search = None
            if self.search_s:
                further = [*wheels.series(wheels.own(data)), *wheels.of_presets()]
                search = Search(self.search_s, further=wheels.mounted(data, further))
            ground = grinding.grind(data, self.raster, searched, first, told, zones, search, stop)
            plan = ground.plan
        checked: from_file.Checked | None = None
        refused: Facts = []
        if whole:
            with job_inputs.scratch_folder() as folder:
                checked = from_file.check(
                    plan,
                    folder,
                    functools.partial(
                        written.entries,
                        folder=folder,
                        read=self.read,
                        suffix=Path(EXPORTED).suffix,
                        refused=refused,
                    ),
                    context.part(PLANNING, 1.0),
                    told,
                    before=ground is None,
                    refine=False,
                )
            plan = checked.plan
            checked = checked._replace(notes=[*refused, *checked.notes])
        if ground is not None:
            if checked is not None:
                plan = plan._replace(checked={"after": checked.figures})
            plan = plans.against(plan, data, context)
            ground = ground._replace(plan=plan)
        return Found(plan, self.planned, ground, words, checked=checked)


class Found:
    """A plan with what the document keeps of it; made in any thread. ``words``: as ``pictures.WORDS``; ``ground``: a
    ``grinding.Ground``, where the passes were laid anew; ``checked``: what its programs do, which are the plan's figures then;
    ``result``: of the planned job, at its own resolution."""

    def __init__(
        self,
        plan: plans.Plan,
        planned: str,
        ground: grinding.Ground | None = None,
        words: Mapping[str, str] | None = None,
        context: Context = None,
        checked: from_file.Checked | None = None,
    ) -> None:
        self.plan, self.planned, self.ground = plan, planned, ground
        self.result = plan.after if checked is None else checked.planned.after
        self.checked = checked
        drawn = pictures.draw(plan, context)
        whole = pictures.composed(drawn, plan.why["shares"], words)
        self.pictures = result_files.Written({"Picture": whole, "Strip": pictures.strip(drawn)})


def store(obj: DocumentObject, job: DocumentObject, found: Found) -> None:
    """Puts a ``Found`` into a Plan object."""
    plan = found.plan
    obj.Fingerprint = (
        obj.AppliedFingerprint
    ) = ""  # half of it is there: no plan, rather than two in one
    commands, summary = plan.commands, plans.summary(plan)
    told = summary["checked"] or summary
    before, after = told["before"], told["after"]
    obj.Better = plan.better
    obj.InToleranceBefore = 100.0 * before["in_tolerance"]
    obj.InTolerance = 100.0 * after["in_tolerance"]
    obj.ProcessTimeBefore, obj.ProcessTime = before["process_time_s"], after["process_time_s"]
    tried: dict[str, Any] = {} if found.ground is None else {"tried": found.ground.tried}
    if found.ground is not None and found.ground.search is not None:
        kept = ("reachable", "reachable_by_any", "wheels", "seconds", "through")
        tried["search"] = {name: found.ground.search[name] for name in kept}
    checked = found.checked
    files = {} if checked is None else {"from_file": checked.entry}
    stored_facts.store(obj, "FilesShort", [*checked.short, *checked.notes] if checked else [])
    obj.Data = json.dumps({**summary, **tried, **files}, allow_nan=False)
    obj.Rates = [
        f"{'coarse: ' if one.get('resolution') == 'coarse' else ''}"
        f"{100.0 * one['in_tolerance']:.1f} %, rms {one['rms_mm']:.3f} mm, {one['process_time_s']:.1f} s"
        for one in plan.rounds
    ]
    obj.Reasons = [
        f"{100.0 * share:.1f} %: {pictures.WORDS[word]}"
        for word, share in sorted(plan.why["shares"].items(), key=lambda one: -one[1])
        if share > pictures.SMALLEST
    ]
    obj.Paths = [path.Name for path in paths_of(job)]
    obj.PathOf = commands.of_program.tolist()
    obj.Along = _along(plan)
    obj.Raster = "" if found.ground is None else json.dumps(found.ground.settings, allow_nan=False)
    obj.Rapid = tuple(bool(value) for value in commands.rapid)
    new = np.where(commands.rapid, commands.feeds, plan.new[commands.group])
    factor = np.where(commands.rapid, 1.0, plan.factors[commands.group])
    obj.OldFeeds, obj.NewFeeds = commands.feeds.tolist(), new.tolist()
    obj.OldForces = commands.forces.tolist()
    obj.NewForces = commands.written(commands.forces * factor).tolist()
    obj.Zones = np.concatenate([one["zones"] for one in commands.arrays]).tolist()
    obj.TimeLaw = json.dumps(
        {key: plan.job["simulation"][key] for key in TIME_LAW}, allow_nan=False
    )
    given = np.concatenate([one["forces"] for one in commands.arrays])
    # The passes' own force, and one that was found for them, is not the belt machine's.
    others = found.ground is not None and found.ground.settings["force_N"] > 0.0
    obj.Kept = tuple(bool(value) for value in (given < 0) & (factor == 1.0) & (not others))
    obj.Changes = json.dumps(
        [written.changes(plan, k) if source else [] for k, source in enumerate(commands.sources)],
        allow_nan=False,
    )
    points, triangles, states = _left(plan)
    obj.LeftPoints = [tuple(point) for point in points.tolist()]
    obj.LeftTriangles = triangles.ravel().tolist()
    obj.LeftStates = states.tolist()
    result_files.store(obj, found.pictures)
    obj.Fingerprint = found.planned
    obj.Applied = obj.OutOfDate = False


def _along(plan: plans.Plan) -> list[float]:
    """(motions,) mm that the contact goes, through all programs."""
    lengths = []
    for number in range(len(plan.job["programs"])):
        contacts = tool_path(plan.job, number, []).work_from_contact()[:, :3, 3]
        lengths.append(np.append(0.0, np.linalg.norm(np.diff(contacts, axis=0), axis=1)))
    return np.cumsum(np.concatenate(lengths)).tolist()


def _left(plan: plans.Plan) -> tuple[Array, Array, Array]:
    """(points (n, 3) mm, triangles (m, 3), states (n,)): what stays out of tolerance, on the ground surface."""
    field, states = plan.after.field, plan.why["state"]
    triangles = np.asarray(field.triangles, dtype=int)
    left = triangles[(states[triangles] != 0).sum(axis=1) > 1]
    used, numbers = np.unique(left, return_inverse=True)
    points = np.asarray(field.points)[used] + (
        np.asarray(field.height, dtype=float)[used, None] * np.asarray(field.rays)[used]
    )
    return points, numbers.reshape(-1, 3), states[used]


def put_in(obj: DocumentObject, ground: grinding.Ground | None = None) -> None:
    """Gives the job's paths the planned feeds and forces, and its raster path the passes they are for. ``ground``: the
    ``grinding.Ground``, where it is there still; else they are laid once more. Raises InputError; then nothing is
    changed."""
    job = obj.getParentGroup()
    if not obj.Fingerprint:
        raise InputError("planning.none_yet", "{object}: nothing is planned yet", object=obj.Label)
    obj.Proxy.update(obj)
    paths = paths_of(job)
    if obj.Applied:
        return
    if obj.OutOfDate or [path.Name for path in paths] != list(obj.Paths):
        raise InputError(
            "planning.out_of_date",
            "{object}: an input has changed since it was planned; plan again",
            object=obj.Label,
        )
    if obj.Raster:
        _lay(paths[0], obj, ground)
    if obj.TimeLaw:  # a plan of earlier versions has none
        from_job(job, TIMING, {"simulation": json.loads(obj.TimeLaw)})
    owner = np.array(obj.PathOf)
    feeds, forces = np.array(obj.NewFeeds), np.array(obj.NewForces)
    forces[np.array(obj.Kept, dtype=bool)] = -1.0
    for k, path in enumerate(paths):
        path.FeedOverride = 0.0
        path.ForceOverride = 0.0
        path.Feeds, path.Forces = feeds[owner == k].tolist(), forces[owner == k].tolist()
        if obj.TimeLaw and not path.Source:
            path.Zones = np.array(obj.Zones)[owner == k].tolist()
        path.Planned = True
        path.recompute()
    obj.AppliedFingerprint = fingerprint(obj, job)
    obj.Proxy.update(obj)


def _lay(path: DocumentObject, obj: DocumentObject, ground: grinding.Ground | None) -> None:
    settings = json.loads(obj.Raster)
    if ground is None:
        laid: dict[str, Any] = {}
        to_job(path, PASSES, laid)
        from_job(path, PASSES, {"raster": settings})
        path.recompute()
        if len(path.Feeds) != len(obj.NewFeeds):
            from_job(path, PASSES, laid)
            path.recompute()
            raise InputError(
                "planning.other_passes",
                "{object}: its passes cannot be laid as they were planned; plan again",
                object=path.Label,
            )
    else:
        take(path, settings, ground.laid)
    path.Proposed = False


def write_programs(obj: DocumentObject, folder: Path | str) -> tuple[list[Path], list[str]]:
    """Writes the job's program files with the planned feeds and forces into ``folder``; nothing else of them changes.

    Returns (paths of the files, labels of the paths that have none). Raises InputError, and writes none, where a
    file is no longer the one that was read, something lies there already, or a feed has no place in it.
    """
    if not obj.Fingerprint:
        raise InputError("planning.none_yet", "{object}: nothing is planned yet", object=obj.Label)
    todo: list[tuple[str, Any, Path, ForceDevice | None]] = []
    without: list[str] = []
    for name, changes in zip(obj.Paths, json.loads(obj.Changes)):
        path = obj.Document.getObject(name)
        if path is None or not path.Source:
            without.append(name if path is None else path.Label)
            continue
        output = Path(folder, os.path.basename(path.Source))
        _check_program(path, output, [one[2] for one in todo])
        todo.append((path.Source, changes, output, force_device(path)))
    with job_inputs.scratch_folder() as scratch:  # all of them can be written, or none is
        for number, (source, changes, output, device) in enumerate(todo):
            tried = Path(scratch, str(number))
            tried.mkdir()
            written.write_changed(source, changes, tried / output.name, device)
    for source, changes, output, device in todo:
        try:
            written.write_changed(source, changes, output, device)
        except OSError as error:
            raise cannot_be_written(output, error) from None
    return [one[2] for one in todo], without


def _check_program(path: DocumentObject, output: Path, others: Sequence[Path]) -> None:
    if path.Values:
        raise InputError(
            "planning.values_in_document",
            "{object}: its values are in the document; save them beside the program first",
            object=path.Label,
        )
    read, mine = read_again(path)["frames"], path.Proxy.arrays(path)["frames"]
    if read.shape != mine.shape or not np.allclose(read, mine, atol=1e-6):
        raise InputError(
            "planning.file_changed",
            "{file}: is no longer what {object} was read from; read it again, and plan again",
            file=path.Source,
            object=path.Label,
        )
    if output in others or os.path.lexists(output):
        raise InputError(
            "planning.is_there",
            "{file}: is there already; choose another folder",
            file=output,
        )
