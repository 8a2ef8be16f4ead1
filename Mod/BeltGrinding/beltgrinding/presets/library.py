"""Presets of belt machines, contact wheels, belts, materials, robots and force controls: plain data, every number with its unit and
its source (Resources/presets, and the user's own files; presets.schema.json).
"""

from __future__ import annotations

import copy
import json
import os
import sys
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from ..base import schema_errors, schemas
from ..base.files import at_key, in_file
from ..base.kinds import Json
from ..base.resources import resources
from ..engine import InputError
from . import robot_model
from .job_keys import ACTUATOR, FLAT, JOB_KEYS, MACHINE_KIND, RANGES
from .rubber import cite, modulus, shore_to_modulus, spread_text

__all__ = [
    "actuators",
    "apply",
    "belts",
    "controllers",
    "machines",
    "materials",
    "problems",
    "robots",
    "settings",
    "shore_to_modulus",
    "thermals",
    "wheels",
]

KINDS = (
    "machines",
    "wheels",
    "belts",
    "materials",
    "thermals",
    "robots",
    "actuators",
    "controllers",
)
LABELS = {
    "shore_a": "hardness",
    "youngs_modulus": "Young's modulus",
    "poissons_ratio": "Poisson's ratio",
    "run_width": "width",
    "run_thickness": "thickness",
    "run_tension": "tension",
    "run_modulus": "Young's modulus",
    "run_poissons_ratio": "Poisson's ratio",
    "roller_radius": "rollers' radius",
    "machine_speed": "belt speed of the machine",
    "belt_speed": "belt speed",
    "belt_speed_roughing": "belt speed, roughing",
    "belt_speed_polishing": "belt speed, polishing",
    "belt_speed_offhand": "belt speed, offhand",
}

Preset: TypeAlias = "str | Json | None"  # its id, or itself


class Library(NamedTuple):
    """All presets by kind, and what is wrong with the files (InputError each)."""

    machines: list[dict[str, Any]]
    wheels: list[dict[str, Any]]
    belts: list[dict[str, Any]]
    materials: list[dict[str, Any]]
    thermals: list[dict[str, Any]]
    robots: list[dict[str, Any]]
    actuators: list[dict[str, Any]]
    controllers: list[dict[str, Any]]
    problems: list[InputError]


def user_folder() -> Path:
    """Where the user's own files (*.json) are looked for: FreeCAD's folder for user data when it
    runs inside FreeCAD, else that of the command line's settings.
    """
    freecad = sys.modules.get("FreeCAD")
    if freecad is not None:
        return Path(freecad.getUserAppDataDir(), "BeltGrinding", "presets")
    settings_folder = os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config"
    return Path(settings_folder, "beltgrinding", "presets")


def library() -> Library:
    """Reads all files. A preset that is wrong is left out and stands in ``problems``."""
    found = Library([], [], [], [], [], [], [], [], [])
    files = [
        *sorted((resources() / "presets").glob("*.json")),
        *sorted(user_folder().glob("*.json")),
    ]
    for path in files:
        try:
            _take(path, found)
        except InputError as error:
            found.problems.append(error)
    return found


@lru_cache(maxsize=64)
def _read(path: Path, stamp: object) -> tuple[Json, list[tuple[Sequence[Any], InputError]]]:
    """What stands in a file, and what is wrong with it by the schema; read anew once its stamp changes."""
    data = schemas.read_json(path)
    return data, list(schemas.problems(data, schemas.schema("presets"), "the file"))


def _stamp(path: Path) -> object:
    """What changes with a file's content; None where nothing is known of it."""
    try:
        about = path.stat()
    except OSError:  # reading it says why
        return None
    return about.st_mtime_ns, about.st_size, about.st_ino


def _take(path: Path, found: Library) -> None:
    data, problems = _read(path, _stamp(path))
    if "formulas" in data and path.parent == user_folder():
        raise InputError(
            "presets.formula",
            "{file}: {key}: a formula is a part of the program, not a preset",
            key="formulas",
            file=path,
        )
    bad = set()  # (kind, index)
    for where, problem in problems:
        if len(where) < 2 or where[0] not in KINDS:
            raise in_file(problem, path)
        if tuple(where[:2]) not in bad:
            found.problems.append(in_file(problem, path))
        bad.add(tuple(where[:2]))
    for kind in KINDS:
        records = getattr(found, kind)
        for index, record in enumerate(data.get(kind, [])):
            if (kind, index) in bad:
                continue
            try:
                if any(record["id"] == other["id"] for other in records):
                    raise InputError(
                        "presets.id_taken",
                        "{key}: there is a preset '{name}' already",
                        key="id",
                        name=record["id"],
                    )
                records.append(_with_sources(record, data["sources"]))
            except InputError as error:
                error = error.within("presets.entry", "{entry}.", entry=f"{kind}.{index}")
                found.problems.append(in_file(error, path))


def _with_sources(preset: Json, sources: Json) -> dict[str, Any]:
    """A copy of the preset with the sources themselves in place of their keys."""
    record: dict[str, Any] = copy.deepcopy(dict(preset))
    if "model" in record:
        if record["source"] not in sources:
            raise InputError(
                "presets.no_source",
                "{key}: '{name}' is not among the file's sources",
                key="source",
                name=record["source"],
            )
        record["source"] = sources[record["source"]]
        record["model"] = robot_model.checked_model(record["model"])
        return record
    for key, number in numbers(record).items():
        if number["source"] not in sources:
            raise InputError(
                "presets.no_source",
                "{key}: '{name}' is not among the file's sources",
                key=f"{key}.source",
                name=number["source"],
            )
        number["source"] = sources[number["source"]]
        if "range" in number and number["range"][0] > number["range"][1]:
            raise InputError(
                "presets.range_swapped",
                "{key}: {low} is above {high}",
                key=f"{key}.range",
                low=number["range"][0],
                high=number["range"][1],
            )
    if "shore_a" in record and "youngs_modulus" not in record:
        try:
            modulus(middle(record["shore_a"]))
        except InputError as error:
            raise at_key(error, "shore_a") from None
    return record


def wheels() -> list[dict[str, Any]]:
    """Presets of contact wheels: dict(id, name, and numbers: diameter, width, rim_thickness,
    shore_a, youngs_modulus, poissons_ratio, land_share, each where it is known). A number: dict(value
    or range, unit, source, and where, given, note if there are any).
    """
    return library().wheels


def machines() -> list[dict[str, Any]]:
    """Presets of free belts and platens: as ``wheels``, with kind (a job's belt_machine.kind), run_width, free_length,
    run_thickness, run_tension, run_modulus, run_poissons_ratio, roller_radius, platen_length, machine_speed.
    """
    return library().machines


def belts() -> list[dict[str, Any]]:
    """Presets of belts: as ``wheels``, with grain, grit, grain_size, tension, bending_stiffness."""
    return library().belts


def materials() -> list[dict[str, Any]]:
    """Presets of workpiece materials: as ``wheels``, with belt_speed, belt_speed_roughing,
    belt_speed_polishing, belt_speed_offhand, heat_limit.
    """
    return library().materials


def thermals() -> list[dict[str, Any]]:
    """What temperatures are computed with, by material: as ``wheels``, with conductivity, heat_capacity, density,
    burn_temperature, friction, partition.
    """
    return library().thermals


def robots() -> list[dict[str, Any]]:
    """Presets of robots: dict(id, name, source, model as a job's robot.model; where, text)."""
    return library().robots


def actuators() -> list[dict[str, Any]]:
    """Presets of force controls that take time: as ``wheels``, with lag, moving_mass, damping, speed_limit."""
    return library().actuators


def controllers() -> list[dict[str, Any]]:
    """Presets of robots' controllers: as ``wheels``, with form, interpolation_cycle, path_acceleration,
    angular_acceleration, rotation_speed, default_zone, least_block_length, look_ahead, perhaps least_block_time.
    """
    return library().controllers


def problems() -> list[InputError]:
    """What is wrong with the files of presets: a list of InputError naming file and key."""
    return library().problems


def numbers(preset: Json) -> dict[str, dict[str, Any]]:
    """The numbers of a preset, by name."""
    return {key: value for key, value in preset.items() if isinstance(value, dict)}


def middle(number: Json) -> float:
    """A number's value, or the middle of its range."""
    return number["value"] if "value" in number else sum(number["range"]) / 2.0


def settings(
    wheel: Preset | None = None,
    belt: Preset | None = None,
    material: Preset | None = None,
    actuator: Preset | None = None,
    machine: Preset | None = None,
    thermal: Preset | None = None,
) -> dict[str, Any]:
    """{dotted key of a job: value} of what the presets say; each an id or a preset. Only keys that
    jobs have; the modulus follows from the hardness unless the preset gives it. Raises InputError.
    """
    found: dict[str, Any] = {}
    known = schemas.schema("job")
    chosen = {
        "wheels": wheel,
        "belts": belt,
        "materials": material,
        "actuators": actuator,
        "machines": machine,
        "thermals": thermal,
    }
    for kind, preset in chosen.items():
        if preset is None:
            continue
        if isinstance(preset, str):
            preset = find(kind, preset)
        if kind == "actuators":
            found.update(ACTUATOR)
        if kind == "machines":
            found[MACHINE_KIND] = preset["kind"]
            found.update(FLAT if preset["kind"] == "platen" else {})
        if kind == "thermals":
            found["heat.material"] = preset["name"]
            limit = preset.get("burn_temperature")
            found["heat.burn_source"] = source_text(limit) if limit else ""
            found["heat.burn_temperature_C"] = 0.0
            found.update((key, list(preset[name]["range"])) for name, key in RANGES.items())
        for name, number in numbers(preset).items():
            if name in JOB_KEYS:
                key, factor = JOB_KEYS[name]
                found[key] = factor * middle(number)
        if "shore_a" in preset and "youngs_modulus" not in preset:
            found[JOB_KEYS["youngs_modulus"][0]] = modulus(middle(preset["shore_a"]))
    return {key: value for key, value in found.items() if _is_known(key, known)}


def _is_known(key: str, rules: Json) -> bool:
    for part in key.split("."):
        rules = rules.get("properties", {}).get(part)
        if rules is None:
            return False
    return True


def apply(
    job: Json,
    wheel: Preset | None = None,
    belt: Preset | None = None,
    material: Preset | None = None,
    actuator: Preset | None = None,
    machine: Preset | None = None,
    thermal: Preset | None = None,
) -> dict[str, Any]:
    """A copy of the job (a dict) with what the presets say put in. Raises InputError."""
    changed: dict[str, Any] = copy.deepcopy(dict(job))
    for key, value in settings(wheel, belt, material, actuator, machine, thermal).items():
        *path, last = key.split(".")
        node = changed
        for part in path:
            node = node.setdefault(part, {})
        node[last] = value
    return changed


def find(kind: str, name: str) -> dict[str, Any]:
    """The preset of an id. Raises InputError, also naming files that could not be read."""
    found = library()
    known = {preset["id"]: preset for preset in getattr(found, kind)}
    if name in known:
        return known[name]
    broken = "".join(f" ({problem})" for problem in found.problems)
    raise InputError(
        "presets.no_such",
        "presets: no '{name}' among the {kind}; {hint}{broken}",
        name=name,
        kind=kind,
        hint=schema_errors.hint(name, list(known)),
        broken=broken,
    )


def number_text(number: Json) -> str:
    """Such as "30 to 40 m/s"."""
    span = number["range"] if "range" in number else [number["value"]]
    unit = "" if number["unit"] in ("1", "grit") else " " + number["unit"]
    return " to ".join(f"{value:g}" for value in span) + unit


def label(name: str) -> str:
    """What a number is called in lists."""
    return LABELS.get(name, name.replace("_", " "))


def source_text(number: Json) -> str:
    """The source of a number in one line."""
    return cite(number["source"], number.get("where"))


def describe(preset: Json) -> list[str]:
    """One line for each thing that the preset says, with its source."""
    lines = [preset["text"]] if "text" in preset else []
    if "model" in preset:
        return [cite(preset["source"], preset.get("where")), *lines]
    for name, number in numbers(preset).items():
        lines.append(f"{label(name)} {number_text(number)}: {source_text(number)}")
    return lines


def table(kind: str, presets: Iterable[Json]) -> str:
    """The presets of a kind as a text table with sources."""
    rows = [("id", "preset", "number", "value", "source")]
    for preset in presets:
        start = (preset["id"], preset["name"])
        if "model" in preset:
            length = robot_model.arm(preset["model"]).length
            source = cite(preset["source"], preset.get("where"))
            rows.append((*start, "upper arm and forearm", f"{length:.0f} mm", source))
            continue
        for name, number in numbers(preset).items():
            rows.append((*start, label(name), number_text(number), source_text(number)))
            start = ("", "")
            if name == "shore_a" and "youngs_modulus" not in preset:
                rows.append(
                    ("", "", "modulus", spread_text(middle(number)).split(": ")[1], "from it")
                )
        if "text" in preset:
            rows.append((*start, "", "", preset["text"]))
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = ["  ".join(f"{cell:{width}}" for cell, width in zip(row, (*widths, 0))) for row in rows]
    return "\n".join([kind.upper(), *(line.rstrip() for line in lines)])


def print_list(kind: str | None = None, as_json: bool = False) -> None:
    """Prints the presets of one kind, or of all. Raises InputError for files that are wrong, after
    the good ones are printed.
    """
    found = library()
    chosen = {one: getattr(found, one) for one in ([kind] if kind else KINDS)}
    if as_json:
        print(json.dumps(chosen, indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print("\n\n".join(table(one, presets) for one, presets in chosen.items()))
    if found.problems:
        error, *others = found.problems
        for other in others:
            error = error.followed_by("presets.another", "; {problem}", problem=other)
        raise error
