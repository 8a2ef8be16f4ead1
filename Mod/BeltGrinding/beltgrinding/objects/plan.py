"""A plan in the document: its settings, what it found, and feeds and forces that wait to be applied."""

import hashlib
import json
import os
from pathlib import Path

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..engine import InputError
from ..planning import apply, pictures, rounds as plans
from ..programs.patch.patch import patch
from . import job_inputs, result_files
from .job_data import children, inspection
from .properties import Key, Output, add_keys, add_outputs, to_job
from .proxy import Proxy
from .robot_path import RobotPath, read_again

KEYS = (
    Key("FeedMin", "Speed", "Limits", "plan.feed_min_mm_s"),
    Key("FeedMax", "Speed", "Limits", "plan.feed_max_mm_s"),
    Key("ForceMin", "Force", "Limits", "plan.force_min_N"),
    Key("ForceMax", "Force", "Limits", "plan.force_max_N"),
    Key("Levels", "Integer", "Limits", "plan.levels"),
    Key("Keep", "JSON", "Limits", "plan.keep"),
    Key("Rounds", "Integer", "Rounds", "plan.rounds"),
    Key("LeastGain", "Float", "Rounds", "plan.least_gain"),
    Key("MostChange", "Float", "Rounds", "plan.most_change"),
    Key("Smoothing", "Float", "Rounds", "plan.smoothing"),
    Key("Check", "Bool", "Rounds", "plan.check"),
)
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
    Output("Data", "String", "Plan", "figures as JSON", True),
    Output("Paths", "StringList", "Plan", "names of the job's paths", True),
    Output("PathOf", "IntegerList", "Plan", "path of every pose, from 0", True),
    Output("Along", "FloatList", "Plan", "way of the contact up to every pose, mm", True),
    Output("Rapid", "BoolList", "Plan", "nothing is ground on the way to these poses", True),
    Output("OldFeeds", "FloatList", "Plan", "before, of every pose, mm/s", True),
    Output("NewFeeds", "FloatList", "Plan", "planned, of every pose, mm/s", True),
    Output("OldForces", "FloatList", "Plan", "before, of every pose, N", True),
    Output("NewForces", "FloatList", "Plan", "planned, of every pose, N", True),
    Output("Kept", "BoolList", "Plan", "poses whose force is the belt machine's still", True),
    Output("Changes", "String", "Plan", "of each path, what changes in its file; JSON", True),
    Output("LeftPoints", "VectorList", "Plan", "corners of what stays out of tolerance", True),
    Output("LeftTriangles", "IntegerList", "Plan", "three of them each", True),
    Output("LeftStates", "IntegerList", "Plan", "of the corners: as planning.reasons", True),
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

    def add_properties(self, obj):
        add_keys(obj, KEYS)
        add_outputs(obj, OUTPUTS)
        for name, text in PICTURES:
            if name not in obj.PropertiesList:
                obj.addProperty("App::PropertyFileIncluded", name, "Plan", text)
                obj.setEditorMode(name, 2)

    def execute(self, obj):
        self.update(obj)

    def update(self, obj):
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

    def settings(self, obj):
        """As Resources/schema/plan.schema.json has them."""
        data = {}
        to_job(obj, KEYS, data)
        return data["plan"]

    def data(self, obj):
        """The figures as ``planning.summary`` gives them; None if there are none yet."""
        return json.loads(obj.Data) if obj.Data else None


def fingerprint(obj, job):
    """Hash of all that a plan depends on."""
    data = [job_inputs.fingerprint(job), inspection(job), obj.Proxy.settings(obj)]
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def paths_of(job):
    """The job's paths, in the order in which they are ground."""
    return children(job, RobotPath)


def sources(job):
    """Of each path the file that it was read from, or None; as ``planning.Commands`` takes them."""
    return [path.Source or None for path in paths_of(job)]


class Found:
    """A plan with what the document keeps of it; made in any thread. ``words``: as ``pictures.WORDS``."""

    def __init__(self, plan, words=None, context=None):
        self.plan = plan
        drawn = pictures.draw(plan, context)
        whole = pictures.composed(drawn, plan.why["shares"], words)
        self.pictures = result_files.Written({"Picture": whole, "Strip": pictures.strip(drawn)})


def store(obj, job, found, planned):
    """Puts a ``Found`` into a Plan object. ``planned``: ``fingerprint`` of what was planned."""
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
    obj.Data = json.dumps(summary)
    obj.Rates = [
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
    obj.Along = _along(job, commands)
    obj.Rapid = tuple(bool(value) for value in commands.rapid)
    new = np.where(commands.rapid, commands.feeds, plan.new[commands.group])
    factor = np.where(commands.rapid, 1.0, plan.factors[commands.group])
    obj.OldFeeds, obj.NewFeeds = commands.feeds.tolist(), new.tolist()
    obj.OldForces, obj.NewForces = commands.forces.tolist(), (commands.forces * factor).tolist()
    given = np.concatenate([one["forces"] for one in commands.arrays])
    obj.Kept = tuple(bool(value) for value in (given < 0) & (factor == 1.0))
    obj.Changes = json.dumps(
        [apply.changes(plan, k) if source else [] for k, source in enumerate(commands.sources)]
    )
    points, triangles, states = _left(plan)
    obj.LeftPoints = [tuple(point) for point in points.tolist()]
    obj.LeftTriangles = triangles.ravel().tolist()
    obj.LeftStates = states.tolist()
    result_files.store(obj, found.pictures)
    obj.Fingerprint = planned
    obj.Applied = obj.OutOfDate = False


def _along(job, commands):
    """(motions,) mm, through all programs."""
    lengths = []
    for path in paths_of(job):
        steps = np.linalg.norm(np.diff(path.Proxy.contacts(path), axis=0), axis=1)
        lengths.append(np.append(0.0, steps))
    return np.cumsum(np.concatenate(lengths)).tolist()


def _left(plan):
    """(points (n, 3) mm, triangles (m, 3), states (n,)): what stays out of tolerance, on the ground surface."""
    field, states = plan.after.field, plan.why["state"]
    triangles = np.asarray(field.triangles, dtype=int)
    left = triangles[(states[triangles] != 0).sum(axis=1) > 1]
    used, numbers = np.unique(left, return_inverse=True)
    points = np.asarray(field.points)[used] + (
        np.asarray(field.height, dtype=float)[used, None] * np.asarray(field.normals)[used]
    )
    return points, numbers.reshape(-1, 3), states[used]


def put_in(obj):
    """Gives the job's paths the planned feeds and forces. Raises InputError; then nothing is changed."""
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
    owner = np.array(obj.PathOf)
    feeds, forces = np.array(obj.NewFeeds), np.array(obj.NewForces)
    forces[np.array(obj.Kept, dtype=bool)] = -1.0
    for k, path in enumerate(paths):
        path.FeedOverride = 0.0
        path.ForceOverride = 0.0
        path.Feeds, path.Forces = feeds[owner == k].tolist(), forces[owner == k].tolist()
        path.Planned = True
        path.recompute()
    obj.AppliedFingerprint = fingerprint(obj, job)
    obj.Proxy.update(obj)


def write_programs(obj, folder):
    """Writes the job's program files with the planned feeds and forces into ``folder``; nothing else of them changes.

    Returns (paths of the files, labels of the paths that have none). Raises InputError, and writes none, where a
    file is no longer the one that was read, something lies there already, or a feed has no place in it.
    """
    if not obj.Fingerprint:
        raise InputError("planning.none_yet", "{object}: nothing is planned yet", object=obj.Label)
    todo, without = [], []
    for name, changes in zip(obj.Paths, json.loads(obj.Changes)):
        path = obj.Document.getObject(name)
        if path is None or not path.Source:
            without.append(name if path is None else path.Label)
            continue
        output = Path(folder, os.path.basename(path.Source))
        _check_program(path, output, [one for *_, one in todo])
        todo.append((path.Source, changes, output))
    with job_inputs.scratch_folder() as scratch:  # all of them can be written, or none is
        for number, (source, changes, output) in enumerate(todo):
            tried = Path(scratch, str(number))
            tried.mkdir()
            _write_program(source, changes, tried / output.name)
    for source, changes, output in todo:
        _write_program(source, changes, output)
    return [output for *_, output in todo], without


def _write_program(source, changes, output):
    try:
        if changes:
            patch(source, changes, output)
        else:
            write_whole(output, Path(source).read_bytes())
    except OSError as error:
        raise cannot_be_written(output, error) from None


def _check_program(path, output, others):
    if path.Values:
        raise InputError(
            "planning.values_in_document",
            "{object}: its values stand in the document; save them beside the program first",
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
