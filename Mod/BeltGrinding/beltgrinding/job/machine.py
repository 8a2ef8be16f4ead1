"""What kind of belt machine a job has: a contact wheel, a free belt, a platen, a small wheel in a fork."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..base import records, schemas
from ..base.kinds import Json, known
from ..engine import InputError
from ..geometry import fork, free_run
from ..programs import force_device
from .settings import BeltMachine

if TYPE_CHECKING:
    from ..engine import core

WHEEL, FREE_BELT, PLATEN = "contact_wheel", "free_belt", "platen"
SMALL_WHEEL = "small_wheel"
WHEELS = (WHEEL, SMALL_WHEEL)  # a wheel presses the belt


def kind(machine: BeltMachine | Json) -> str:
    """Of a job's ``belt_machine``; without the key, as in files of earlier versions, a contact wheel."""
    if isinstance(machine, BeltMachine):
        return machine.kind or WHEEL
    return machine.get("kind", WHEEL)


def wheel_presses(machine: BeltMachine | Json) -> bool:
    """Whether a wheel presses the belt of a job's ``belt_machine`` on the part."""
    return kind(machine) in WHEELS


def filled(machine: dict[str, Any], rules: Json) -> None:
    """Puts the defaults of the parts that its kind needs into a validated ``belt_machine``; ``rules``: its schema."""
    needed = {
        WHEEL: (),
        SMALL_WHEEL: ("fork",),
        FREE_BELT: ("free_run", "frame"),
        PLATEN: ("free_run", "platen", "frame"),
    }[kind(machine)]
    for name in needed:
        machine[name] = schemas.filled(machine.get(name, {}), rules["properties"][name])


def check(job: Json) -> None:
    """Raises InputError for what the schema cannot say of a validated job's belt machine."""
    machine = job["belt_machine"]
    force_device.device_of(machine.get("force_device"))
    if wheel_presses(machine):
        return check_run(machine)
    if job["law"]["model"] == "geometric":
        raise InputError(
            "job.belt_is_not_rigid",
            "{key}: a {kind} is not rigid; choose another law than geometric",
            key="belt_machine.kind",
            kind=kind(machine),
        )
    check_run(machine)


def check_run(machine: BeltMachine | Json) -> None:
    """Raises InputError where a ``belt_machine`` with its defaults cannot be: a contact beside its rollers, a fork that ends
    within its wheel."""
    machine = records.made(BeltMachine, machine)
    if kind(machine) == SMALL_WHEEL:
        radius = machine.wheel.radius_mm
        if not fork.holds(machine):
            raise InputError(
                "job.short_fork",
                "{key}: the belt's pulleys must lie farther from the axle than the wheel's radius of {radius:.4g} mm",
                key="belt_machine.fork.length_mm",
                radius=radius,
            )
    if wheel_presses(machine):
        return
    run = known(machine.free_run)
    if not abs(run.position_mm) < 0.5 * run.length_mm:
        raise InputError(
            "job.belt_position",
            "{key}: the contact must lie between the rollers, less than {most:.4g} mm from the middle",
            key="belt_machine.free_run.position_mm",
            most=0.5 * run.length_mm,
        )
    if kind(machine) == PLATEN:
        _check_platen(machine)
    least = free_run.short_frame(machine)
    if least is not None:
        raise InputError(
            "job.short_frame",
            "{key}: the belt's pulleys must lie more than {least:.4g} mm behind the rollers' axes; 0 leaves the runs out",
            key="belt_machine.frame.length_mm",
            least=least,
        )


def _check_platen(machine: BeltMachine) -> None:
    platen, run = known(machine.platen), known(machine.free_run)
    radius = platen.radius_mm
    if radius > 0.0:
        least = 0.5 * platen.length_mm / math.sin(free_run.STEEPEST)
        if radius < least:
            raise InputError(
                "job.platen_radius",
                "{key}: a platen of {length:.4g} mm would turn by more than 60 degrees to its ends; give {least:.4g} mm or "
                "more, or 0 for a flat one",
                key="belt_machine.platen.radius_mm",
                length=platen.length_mm,
                least=least,
            )
        thick = sum(layer.thickness_mm for layer in platen.layers)
        if thick >= radius:
            raise InputError(
                "job.platen_layers",
                "{key}: the layers are {thick:.4g} mm thick and reach beyond the middle of the platen's radius of {radius:.4g} mm",
                key="belt_machine.platen.layers",
                thick=thick,
                radius=radius,
            )
    most = run.length_mm - 2.0 * abs(run.position_mm)
    if free_run.length_on(machine) > most:
        raise InputError(
            "job.platen_length",
            "{key}: the platen must lie between the rollers, so that it is {most:.4g} mm long at most",
            key="belt_machine.platen.length_mm",
            most=most,
        )


def need_wheel(job: Json, what: core.Fact) -> None:
    """Raises InputError unless a wheel presses the belt. ``what``: a core.Fact, what knows no other kind."""
    found = kind(job["belt_machine"])
    if found not in WHEELS:
        raise InputError(
            "job.needs_wheel",
            "{what} with a contact wheel only; {key} is {kind}: set contact_wheel, or take a robot program of your own",
            what=what,
            key="belt_machine.kind",
            kind=found,
        )
