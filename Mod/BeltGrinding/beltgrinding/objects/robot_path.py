"""A robot's program in the document: poses that are the truth, and a Path that is drawn."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import FreeCAD
import numpy as np
import Path

from ..base import frames
from ..base.kinds import Array, Context, Floats, Json
from ..base.stopping import stoppable
from ..engine import Fact, InputError, core
from ..job import robot_time
from ..job.poses import DEFAULT_FEED
from ..programs.program import Motion, corner_of
from ..programs.languages.roll import RULES, lay
from ..programs.problems import ordered
from ..programs.force_device import ForceDevice
from ..programs.registry import read_program, told_problems
from ..programs.writers.frames import words_of_cell
from ..programs.writers.writer import write_program
from . import freecad_path, program_values, stored_facts
from .geometry import matrix
from .kinds import Document, DocumentObject
from .properties import Output, add_outputs, set_by_name
from .proxy import Proxy
from .waiting import wait

if TYPE_CHECKING:
    from ..programs.program import Program

OUTPUTS = (
    Output("Language", "String", "Program", "language of the source"),
    Output("PoseCount", "Integer", "Program", "number of Cartesian poses"),
    Output("PathLength", "Length", "Program", "length of the way of the tool centre point"),
    Output(
        "Duration",
        "Float",
        "Program",
        "time at the programmed feeds without acceleration, s; the job's own: Simulation.ProcessTime",
    ),
    Output("Problems", "StringList", "Program", "what could not be resolved, by file and line"),
    stored_facts.output("Problems", "Program"),
    Output("Planned", "Bool", "Program", "its feeds and forces come from a plan"),
)
# name, type, text; parallel lists, one value per pose
LISTS = (
    ("Poses", "PlacementList", "tool centre points in the program's base frame, mm"),
    ("Feeds", "FloatList", "speed towards each pose, mm/s"),
    ("Forces", "FloatList", "pressing force towards each pose, N; negative: the belt machine's"),
    ("Rapid", "BoolList", "positioning moves: nothing is ground on the way to these poses"),
    ("Lines", "IntegerList", "lines of the source"),
    (
        "Zones",
        "FloatList",
        "mm around each pose in which the corner is rounded; -1: not known; below: -1 less the share of the feed that is kept",
    ),
    ("Gaps", "IntegerList", "line from which on motions are left out before each pose; 0: none"),
)
HELD = (
    (
        "Values",
        "what only the controller knows of the program, as in NAME.values.json; empty: that file's, "
        "where it lies beside the program",
    ),
    ("Asked", "the values that the program asks for"),
)
WITH_FREE_ROLL = ("APT", "G-code", "FreeCAD path")  # languages of tool axes only
FRAMES = (
    (
        "ProgramBase",
        "the base that an exported program sets: the controller's own by number (KRL) or name (RAPID), "
        "as-known (the numbers of the cell), or nothing: it must be in force",
    ),
    (
        "ProgramTool",
        "the tool that an exported program sets: the controller's own by number (KRL) or name (RAPID), "
        "as-known (the numbers of the cell), or nothing: it must be in force",
    ),
)


class RobotPath(Proxy):
    """Proxy of the Path::FeaturePython; ``Path`` follows from the poses and the machine's frames."""

    TYPE = "BeltGrinding::RobotPath"
    VIEW = "RobotPathView"
    _arrays: dict[str, Array] | None = None  # what ``arrays`` gives, until a list changes

    def add_properties(self, obj: DocumentObject) -> None:
        def add(kind: str, name: str, group: str, text: str) -> bool:
            if name in obj.PropertiesList:
                return False
            obj.addProperty(f"App::Property{kind}", name, group, text)
            return True

        add("File", "Source", "Program", "the robot program that the poses come from")
        text = (
            "the CAM path or robot trajectory of FreeCAD that the poses follow, in place of a file"
        )
        add("LinkGlobal", "SourceObject", "Program", text)
        text = (
            "how poses that are tool axes only (APT, G-code, CAM paths) are turned about them: held along "
            "a pass, along the pass, or the belt along RollDirection"
        )
        if add("Enumeration", "Roll", "Program", text):
            obj.Roll = list(RULES)
        text = "along which the belt travels, in the program's base, where Roll is fixed"
        if add("Vector", "RollDirection", "Program", text):
            obj.RollDirection = FreeCAD.Vector(1, 0, 0)
        if add("String", "RollOfPoses", "Program", "the roll that the poses have"):
            obj.setEditorMode("RollOfPoses", 2)
        for name, text in HELD:
            if add("String", name, "Program", text):
                obj.setEditorMode(name, 2)
        add("Speed", "FeedOverride", "Program", "one feed for all poses; 0: as programmed")
        add("Force", "ForceOverride", "Program", "one force for all poses; 0: as programmed")
        if add(
            "Bool", "Active", "Program", "runs, plans and exported jobs take it; else leave it out"
        ):
            obj.Active = True
        add(
            "Precision",
            "PauseBefore",
            "Program",
            "s before the program, in which the belt runs free",
        )
        add("Bool", "DressBefore", "Program", "the belt is dressed before the program")
        for name, text in FRAMES:
            add("String", name, "Export", text)
        if add("Link", "Machine", "Program", "the belt machine, for the cell's frames"):
            obj.setEditorMode("Machine", 2)
        for name, kind, text in LISTS:
            if add(kind, name, "Poses", text):
                obj.setEditorMode(name, 2)
        add_outputs(obj, OUTPUTS)

    def onChanged(self, obj: DocumentObject, name: str) -> None:
        super().onChanged(obj, name)
        if name in ("Poses", "Feeds", "Forces", "Rapid", "Lines", "Zones"):
            self._arrays = None

    def arrays(self, obj: DocumentObject) -> dict[str, Array]:
        """dict(frames, feeds, forces, rapid, lines, zones) as core.ToolPath takes them, no overrides."""
        arrays = self._arrays
        if arrays is None:
            count = len(obj.Poses)
            rows = [placement.toMatrix().A for placement in obj.Poses]
            arrays = self._arrays = {
                "frames": np.array(rows, dtype=float).reshape(count, 4, 4),
                "feeds": np.array(obj.Feeds, dtype=float),
                "forces": np.array(obj.Forces, dtype=float),
                "rapid": np.array(obj.Rapid, dtype=bool),
                "lines": np.array(obj.Lines, dtype=int),
                # A document of before there were zones has none.
                "zones": np.array(obj.Zones or [-1.0] * count, dtype=float),
            }
        if any(len(one) != len(arrays["frames"]) for one in arrays.values()):
            raise InputError(
                "objects.lists_differ",
                "{object}: its lists differ in length; import the program again",
                object=obj.Label,
            )
        return arrays

    def gaps(self, obj: DocumentObject) -> Array:
        """(n,) int: the line from which on motions are left out before each pose, 0: none."""
        count = len(obj.Poses)
        return np.array(obj.Gaps if len(obj.Gaps) == count else [0] * count, dtype=int)

    def digest(self, obj: DocumentObject) -> str:
        """Hash of the poses and what belongs to them."""
        hashed = hashlib.sha256()
        for name, array in self.arrays(obj).items():
            if name != "lines":
                hashed.update(np.ascontiguousarray(array).tobytes())
        return hashed.hexdigest()

    def contacts(self, obj: DocumentObject) -> Floats:
        """(n, 3) mm: where the wheel touches the part at the poses, in the part's coordinates."""
        if len(self.arrays(obj)["frames"]) < 2:
            return np.zeros((0, 3))
        return self._tool_path(obj, self.arrays(obj)["feeds"]).work_from_contact()[:, :3, 3]

    def _tool_path(self, obj: DocumentObject, feeds: Floats) -> core.ToolPath:
        cell = obj.Machine.Proxy.cell(obj.Machine) if obj.Machine else {}
        held = self.arrays(obj)
        lists = held["forces"], held["rapid"], held["lines"]
        return core.ToolPath(held["frames"], feeds, *lists, zones=held["zones"], **cell)

    def execute(self, obj: DocumentObject) -> None:
        if obj.SourceObject is not None:
            follow(obj)
        elif obj.Source and obj.RollOfPoses != (roll := roll_text(obj)):
            if obj.RollOfPoses or roll != "hold":  # one of before there was a choice holds it
                load_program(obj, obj.Source)
        arrays = self.arrays(obj)
        if len(arrays["frames"]) < 2:
            obj.Path = Path.Path()
            obj.PoseCount, obj.PathLength, obj.Duration = len(arrays["frames"]), 0.0, 0.0
            return
        feeds = arrays["feeds"]
        if obj.FeedOverride.Value > 0:
            feeds = np.full(len(feeds), obj.FeedOverride.Value)
        path = self._tool_path(obj, feeds)
        contacts = path.work_from_contact()
        obj.PoseCount = len(contacts)
        steps = np.diff(contacts[:, :3, 3], axis=0)
        obj.PathLength = float(np.linalg.norm(steps, axis=1).sum())
        obj.Duration = path.duration()
        obj.Path = Path.Path(_commands(contacts, feeds, arrays["rapid"]))


def _commands(contacts: Floats, feeds: Floats, rapid: Array) -> list[Any]:
    """X Y Z of the contact in mm, its rotation vector in degrees as U V W (A B C would be drawn as
    angles of a rotary table), F in mm/s."""
    turns = np.degrees(frames.rotation_vectors(contacts[:, :3, :3]))
    rows = np.hstack([contacts[:, :3, 3], turns, np.asarray(feeds, dtype=float)[:, None]]).tolist()
    return [
        Path.Command("G0" if fast else "G1", dict(zip("XYZUVWF", row)))
        for row, fast in zip(rows, rapid)
    ]


def make_robot_path(
    doc: Document, arrays: Mapping[str, Array], label: str = "Program"
) -> DocumentObject:
    """Adds a RobotPath with the poses in ``arrays`` (as ``Program.path_arrays`` gives them)."""
    obj = doc.addObject("Path::FeaturePython", "RobotPath")
    obj.Label = label
    RobotPath(obj)
    set_arrays(obj, arrays)
    return obj


def set_arrays(obj: DocumentObject, arrays: Mapping[str, Array]) -> None:
    """Gives a RobotPath other poses."""
    matrices = np.asarray(arrays["frames"], dtype=float).reshape(-1, 16).tolist()
    obj.Poses = [FreeCAD.Placement(FreeCAD.Matrix(*values)) for values in matrices]
    obj.Feeds = np.asarray(arrays["feeds"], dtype=float).tolist()
    obj.Forces = np.asarray(arrays["forces"], dtype=float).tolist()
    obj.Rapid = tuple(bool(value) for value in arrays["rapid"])
    obj.Lines = np.asarray(arrays["lines"], dtype=int).tolist()
    zones = arrays.get("zones", np.full(len(matrices), -1.0))
    obj.Zones = np.asarray(zones, dtype=float).tolist()
    obj.Gaps = np.asarray(arrays.get("gaps", np.zeros(len(matrices))), dtype=int).tolist()
    obj.Planned = False


def roll_of(obj: DocumentObject) -> tuple[str | None, list[float] | None]:
    """The roll as ``languages.roll.lay`` takes it; held, it is not asked for: most programs have none."""
    direction = list(obj.RollDirection) if obj.Roll == "fixed" else None
    return None if obj.Roll == "hold" else obj.Roll, direction


def roll_text(obj: DocumentObject) -> str:
    """The roll that is asked for, as ``RollOfPoses`` keeps it."""
    rule, direction = roll_of(obj)
    return f"{rule or 'hold'}{'' if direction is None else f' {direction}'}"


def read_arrays(
    path: Path | str,
    roll: str | None = None,
    direction: Sequence[float] | None = None,
    values: Json | None = None,
    device: ForceDevice | None = None,
) -> tuple[Program, dict[str, Array]]:
    """(Program, arrays) of a robot program's file; the window stays alive meanwhile. Raises InputError,
    and Cancelled where a person cancels it; fewer than two poses are refused unless the program asks for values
    that may bring more. ``roll``, ``direction``: as ``languages.roll.lay`` takes them; ``values``: as
    ``read_program`` does, and so the force device.
    """

    def work(context: Context) -> tuple[Program, dict[str, Array]]:
        with stoppable(context or core.RunContext()):
            program = read_program(path, roll, direction, values, force_device=device)
            return program, program.path_arrays(DEFAULT_FEED)

    text = FreeCAD.Qt.translate("BeltGrinding", "Reading {}").format(os.path.basename(path))
    program, arrays = wait(work, text)
    count = len(arrays["frames"])
    if count < 2 and not program_values.asked(program, path):
        why = ""
        if program.problems:
            first = ordered(program.problems)[0]
            why = core.Fact("job.first_problem", " ({problem})", problem=first)
        raise InputError(
            "objects.too_few_targets",
            "{file}: {count} Cartesian targets; two at least make a path{why}",
            file=path,
            count=count,
            why=why,
        )
    return program, arrays


def read_again(obj: DocumentObject) -> dict[str, Array]:
    """The arrays that the file of a RobotPath gives now, as the object reads it. Raises InputError, Cancelled."""
    values = json.loads(obj.Values) if obj.Values else None
    return read_arrays(obj.Source, *roll_of(obj), values, force_device(obj))[1]


def force_device(obj: DocumentObject) -> ForceDevice | None:
    """What sets the pressing force in the programs of a RobotPath's belt machine. Raises InputError."""
    machine = obj.Machine
    return None if machine is None else machine.Proxy.force_device(machine)


def _followed(
    obj: DocumentObject, file: Path | str, form: str
) -> tuple[dict[str, Any], list[Fact]]:
    """As ``robot_time.written``, by a RobotPath's controller and what its job says otherwise; without a belt machine the
    program sets no accelerations. ``form``: "", unless it is given."""
    if obj.Machine is None:
        options, told = robot_time.written({}, file, form)
        return {**options, "pace": None}, told
    job: dict[str, Any] = {"robot": {"controller": obj.Machine.Controller}}
    group = obj.getParentGroup()
    if "PathAcceleration" in getattr(group, "PropertiesList", ()):
        job["simulation"] = {
            "path_acceleration_mm_s2": group.PathAcceleration.Value,
            "angular_acceleration_deg_s2": group.AngularAcceleration,
            "rotation_speed_deg_s": group.RotationSpeed,
        }
    return robot_time.written(job, file, form)


def follow(obj: DocumentObject) -> None:
    """Takes the poses of a RobotPath from its SourceObject. Raises InputError; then nothing is
    changed.

    A CAM path says where the contact runs over the part: the tool frames follow by the cell's.
    """
    source = obj.SourceObject
    program = freecad_path.program_of(source)
    lay(program, *roll_of(obj))
    arrays = program.path_arrays(DEFAULT_FEED)
    count = len(arrays["frames"])
    if count < 2:
        raise InputError(
            "objects.source_too_short",
            "{object}: {source} has {count} poses; two at least make a path",
            object=obj.Label,
            source=source.Label,
            count=count,
        )
    if not hasattr(source, "Trajectory") and obj.Machine is not None:
        cell = obj.Machine.Proxy.cell(obj.Machine)
        arrays["frames"] = frames.base_from_tcp(arrays["frames"], **cell)
    set_arrays(obj, arrays)
    obj.Language = program.language
    stored_facts.store(obj, "Problems", told_problems(program, DEFAULT_FEED))


def load_program(
    obj: DocumentObject, path: Path | str, given: Json | None = None, **values: Any
) -> None:
    """Reads a robot program's file into a RobotPath. Raises InputError; then nothing is changed.

    ``given``: what only the controller knows, as in a values file, from now on; without it what the object
    holds of this file, or what lies beside it. With too little of it the object has no path yet; its first
    problem says so.
    """
    kept = "" if os.path.abspath(path) != obj.Source else obj.Values
    if given is not None:
        kept = json.dumps(given, allow_nan=False)
    values_kept = json.loads(kept) if kept else None
    program, arrays = read_arrays(path, *roll_of(obj), values_kept, force_device(obj))
    if obj.Machine is not None:
        program.check_holding(obj.Machine.Holding)
    set_arrays(obj, arrays)
    obj.RollOfPoses = roll_text(obj)
    obj.SourceObject = None
    obj.Source = os.path.abspath(path)
    obj.Values, obj.Asked = kept, program_values.asked(program, path)
    obj.Language = program.language
    told = told_problems(program, DEFAULT_FEED)
    stored_facts.store(obj, "Problems", [*program_values.no_path(obj), *told])
    set_by_name(obj, values)


def as_run(obj: DocumentObject) -> dict[str, Array]:
    """As ``arrays`` of the proxy of a RobotPath or RobotProgram, its overrides taken in."""
    arrays = dict(obj.Proxy.arrays(obj))
    count = len(arrays["frames"])
    if "FeedOverride" in obj.PropertiesList and obj.FeedOverride.Value > 0:
        arrays["feeds"] = np.full(count, obj.FeedOverride.Value)
    if "ForceOverride" in obj.PropertiesList and obj.ForceOverride.Value > 0:
        arrays["forces"] = np.full(count, obj.ForceOverride.getValueAs("N").Value)
    return arrays


def write(obj: DocumentObject, file: Path | str, **options: Any) -> Any:
    """Writes a RobotPath as a robot program; what ``write_program`` returns. Raises InputError."""
    arrays = as_run(obj)
    words = {"tool": "", "base": ""}
    if obj.Machine is not None and obj.Machine.Robot:
        words = words_of_cell(matrix(obj.Machine.BaseFromRobot), matrix(obj.Machine.FlangeFromTcp))
    motions = [
        Motion(
            "PTP" if fast else "LIN",
            frame,
            int(line),
            obj.Label,
            None if fast else float(feed),
            float(force) if force >= 0 else None,
            tool=words["tool"],
            base=words["base"],
            **corner_of(float(zone)),
        )
        for frame, feed, force, fast, line, zone in zip(
            *(arrays[name] for name in ("frames", "feeds", "forces", "rapid", "lines", "zones"))
        )
    ]
    options.setdefault("tools", obj.ProgramTool.strip() or None)
    options.setdefault("bases", obj.ProgramBase.strip() or None)
    options.setdefault("force_device", force_device(obj))
    options.setdefault("comment", f"{obj.Label}, {len(motions)} poses")
    followed, told = _followed(obj, file, options.pop("form", ""))
    return write_program(file, None, motions, **{**followed, **options}) + told
