"""A program for the whole robot in the document: what was planned, and the arm's way through it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, NamedTuple

import FreeCAD
import numpy as np

from ..base.kinds import Array, Context, Facts, Json
from ..engine import InputError, core
from ..robot_program import walk as walks, write as writing
from ..robot_program.moves import Whole
from . import ground_by, job_inputs, stored_facts
from .belt_machine import BeltMachine
from .creation import make_child
from .job_data import child, required
from .kinds import DocumentObject, Event
from .properties import Output, add_outputs
from .proxy import Proxy

PLANNING = 0.85  # of the time; the rest looks at what is near on the way
GROUP = "Robot program"
OUTPUTS = (
    Output("OutOfDate", "Bool", GROUP, "an input has changed since"),
    Output(
        "Duration", "Float", GROUP, "from home to home, s; the arm does not speed up or slow down"
    ),
    Output("Motions", "Integer", GROUP, "number of its motions"),
    Output("Passes", "Integer", GROUP, "number of its passes"),
    Output("LimitMargin", "Float", GROUP, "least distance from a joint's limit, degrees"),
    Output("Refused", "StringList", GROUP, "for which it must not run"),
    stored_facts.output("Refused", GROUP),
    Output("Notes", "StringList", GROUP, "what is to be known of it"),
    stored_facts.output("Notes", GROUP),
    Output("RobotMoves", "String", GROUP, "the motions as JSON", True),
    Output("Places", "String", GROUP, "of the arm on its way, as JSON", True),
    Output("Events", "String", GROUP, "as events.json has them", True),
    Output("Fingerprint", "String", GROUP, "hash of what was planned", True),
)


class Found(NamedTuple):
    """What a plan brings."""

    whole: Whole
    walk: walks.Walk
    events: list[Event]


class RobotProgram(Proxy):
    """Proxy of the App::FeaturePython. Its settings are the belt machine's property RobotProgram."""

    TYPE = "BeltGrinding::RobotProgram"
    VIEW = "RobotProgramView"
    _held: tuple[str, walks.Walk] | None = None

    def add_properties(self, obj: DocumentObject) -> None:
        add_outputs(obj, OUTPUTS)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def update(self, obj: DocumentObject) -> None:
        """Marks it as out of date."""
        job = obj.getParentGroup()
        if job is None or not obj.Fingerprint:
            return
        try:
            stale = fingerprint(job) != obj.Fingerprint
        except InputError:
            stale = True
        if obj.OutOfDate != stale:
            obj.OutOfDate = stale

    def settings(self, obj: DocumentObject) -> dict[str, Any]:
        """The belt machine's that it goes by: robot, and who holds what."""
        machine = required(obj.getParentGroup(), BeltMachine, "belt machine")
        return {"robot": machine.Proxy.robot(machine), "holding": machine.Holding}

    def walk(self, obj: DocumentObject) -> walks.Walk:
        """The arm's way through the program; it was planned."""
        if self._held is None or self._held[0] != obj.Places:
            self._held = obj.Places, walks.Walk.from_data(json.loads(obj.Places))
        return self._held[1]

    def arrays(self, obj: DocumentObject) -> dict[str, Array]:
        """dict(frames, joints_deg, external) at the places of the way; frames as those of a RobotPath."""
        walk = self.walk(obj)
        return {
            "frames": walk.frames(),
            "joints_deg": np.array(walk.joints_deg),
            "external": np.array(walk.external),
        }

    def events(self, obj: DocumentObject) -> list[Event]:
        """Events, whose ``pose`` is a place of the way."""
        found: list[Event] = json.loads(obj.Events or "[]")
        return found


def fingerprint(job: DocumentObject) -> str:
    """Hash of all that a program depends on. Raises InputError."""
    controller = required(job, BeltMachine, "belt machine").Controller
    data = [job_inputs.fingerprint(job), controller]
    return hashlib.sha256(json.dumps(data, allow_nan=False).encode()).hexdigest()


def find(data: Json, context: Context = None) -> Found:
    """What the program of a job's validated data is; in any thread. Raises InputError, Cancelled."""
    context = context or core.RunContext()
    whole = writing.plan_job(data, context.part(0.0, PLANNING))
    walk = walks.walk(data, whole, None, context.part(PLANNING, 1.0))
    return Found(whole, walk, walks.events(whole, walk, data["cell"]["clearance_mm"]))


def store(obj: DocumentObject, job: DocumentObject, found: Found) -> None:
    """Puts a ``Found`` into a RobotProgram object."""
    whole, walk = found.whole, found.walk
    obj.Fingerprint = ""  # half of it is there
    obj.RobotMoves = json.dumps(whole.data(), allow_nan=False)
    obj.Places = json.dumps(walk.data(), allow_nan=False)
    obj.Events = json.dumps(found.events, allow_nan=False)
    obj.Duration, obj.Motions = walk.times[-1], len(whole.moves)
    obj.Passes = whole.figures["passes"]
    obj.LimitMargin = whole.figures["least_limit_margin_deg"]
    stored_facts.store(obj, "Refused", whole.problems)
    stored_facts.store(obj, "Notes", whole.notes)
    obj.Fingerprint = fingerprint(job)


def make_robot_program(
    job: DocumentObject, compute: bool = True, context: Context = None
) -> DocumentObject:
    """Plans the job's program for the whole robot, from home to home, and keeps it in its RobotProgram object, which it
    returns; ``write_robot_program`` writes it. ``compute=False`` only makes the object. Raises InputError, Cancelled.
    """
    label, before = FreeCAD.Qt.translate("BeltGrinding", "Robot program"), child(job, RobotProgram)
    obj = make_child(job, RobotProgram, "RobotProgram", label, {})
    if not compute:
        return obj
    try:
        with job_inputs.scratch_folder() as folder:
            store(obj, job, find(job_inputs.to_data(job, folder), context))
    except BaseException:
        if before is None:
            obj.Document.removeObject(obj.Name)
        raise
    return obj


def write_robot_program(obj: DocumentObject, file: Path | str, unsafe: bool = False) -> Facts:
    """Writes what was planned as a robot program in the language of the file's suffix. The base is that of the belt
    machine's ``RobotProgram``, else the first path's ``ProgramBase``, the tool that one's ``ProgramTool``; without these,
    the numbers of the job's robot. ``unsafe``: in spite of its problems.
    Returns what ``write_program`` does. Raises InputError."""
    check(obj, unsafe)
    whole, job = Whole.from_data(json.loads(obj.RobotMoves)), obj.getParentGroup()
    first = ground_by.required(job)[0]
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.to_data(job, folder)
        own = data["robot"]["program"]["base"]
        return writing.write(
            file,
            data,
            whole,
            tools=first.ProgramTool.strip() or None,
            bases=None if own else first.ProgramBase.strip() or None,
            unsafe=unsafe,
        )


def check(obj: DocumentObject, unsafe: bool = False) -> None:
    """Raises InputError for a program that is not to be written: none, an old one, one with problems unless ``unsafe``."""
    if not obj.Fingerprint:
        raise InputError("planning.none_yet", "{object}: nothing is planned yet", object=obj.Label)
    obj.Proxy.update(obj)
    if obj.OutOfDate:
        raise InputError(
            "planning.out_of_date",
            "{object}: an input has changed since it was planned; plan again",
            object=obj.Label,
        )
    problems = Whole.from_data(json.loads(obj.RobotMoves)).problems
    if problems and not unsafe:
        raise InputError(
            "objects.robot_program_unsafe",
            "The program is not written: {problem} ({count} problems in all)",
            problem=problems[0],
            count=len(problems),
        )
