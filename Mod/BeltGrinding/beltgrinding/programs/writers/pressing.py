"""What sets the force of a new program's motions: statements of the force device, or comments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.frames import rotation_vectors
from ...base.kinds import Floats, known
from ..patch.text import decimal
from ..program import Fact, ProgramError

if TYPE_CHECKING:
    from ..force_device import ForceDevice
    from .sheet import Sheet

TURN = 1.0  # degrees that the pressing direction may turn before force_mode is called anew
# Of force_mode: m/s along the pressing direction; m and rad that the others may deviate.
LIMITS = "[0.1, 0.1, 0.15, 0.35, 0.35, 0.35]"


def settle(sheet: Sheet) -> list[Fact]:
    """Gives the steps the forces that the sheet's device sets; PTP motions have none then. Facts tell of forces
    that it cannot set."""
    device = sheet.device
    if device is None:
        return []
    others: list[tuple[float, float]] = []
    for step in sheet.steps:
        wanted = device.force_N if step.force is None else step.force
        step.force = None
        if wanted is None or step.kind == "PTP":
            continue
        step.force = device.settable(wanted)
        if not device.least_N <= wanted <= (device.greatest_N or wanted):
            others.append((wanted, step.force))
    if not others:
        return []
    return [
        Fact(
            "programs.writers.force_range",
            "{count} motions want {least:.4g} to {most:.4g} N, which is beyond the force device's range: they "
            "have {low:.4g} to {high:.4g} N",
            count=len(others),
            least=min(one for one, _ in others),
            most=max(one for one, _ in others),
            low=min(one for _, one in others),
            high=max(one for _, one in others),
        )
    ]


def late(sheet: Sheet, language: str) -> list[Fact]:
    """A warning where a device answers after a dead time, and the program's text (its suffix) does not switch earlier."""
    device = sheet.device
    if device is None or not device.dead_time_s or (language == ".src" and sheet.form == "spline"):
        return []
    return [
        Fact(
            "programs.writers.force_late",
            "the force comes {seconds:g} s behind each statement (belt_machine.force_device.dead_time_s), and the program "
            "does not switch earlier: only KRL's spline blocks do",
            seconds=device.dead_time_s,
        )
    ]


def not_set(sheet: Sheet) -> list[Fact]:
    """A warning where the program does not set the forces that its motions are to have."""
    forces = [step.force for step in sheet.steps if step.kind != "PTP" and step.force is not None]
    if sheet.device is not None or not forces:
        return []
    return [
        Fact(
            "programs.writers.force_not_set",
            "the file does not set the pressing force (its comments have {least:.4g} to {most:.4g} N): set it by "
            "hand, or say by belt_machine.force_device how a program sets it (docs/force-device.md)",
            least=min(forces),
            most=max(forces),
        )
    ]


def before(sheet: Sheet, language: str, sign: str) -> list[str]:
    """For each step what comes before it: the statement that sets another force, or, without a device, a comment
    that begins with ``sign``; "" where the force stays."""
    device = sheet.device
    lines: list[str] = []
    force: float | None = None
    for step in sheet.steps:
        if device is None:
            changed = step.force != force
            force = step.force
            comment = f"{sign} force as set" if force is None else f"{sign} force {force:g} N"
            lines.append(comment if changed else "")
        elif step.force is None or step.force == force:
            lines.append("")
        else:
            force = step.force
            lines.append(device.statement(language, force))
    return lines


def force_mode(sheet: Sheet, place: str) -> list[str]:
    """Of URScript, for each step: force_mode where the force or the pressing direction becomes another,
    end_force_mode before a motion that does not press; one more for the program's end. ``place``: a Python format
    of six numbers, a pose in the base."""
    device = known(sheet.device)
    lines: list[str] = []
    force: float | None = None
    direction = np.zeros(3)
    for step in sheet.steps:
        line = ""
        if step.force is None or step.kind == "PTP":
            line = "end_force_mode()" if force is not None else ""
            force = None
        else:
            frame = task_frame(device, sheet.frames[step.pose])
            turned = direction @ frame[:3, 2] < np.cos(np.radians(TURN))
            if step.force != force or turned:
                force, direction = step.force, frame[:3, 2]
                newton = decimal(-force if device.held else force, 3, 1)
                task = place % (*(frame[:3, 3] / 1000.0), *rotation_vectors(frame[None, :3, :3])[0])
                line = (
                    f"force_mode(pose_trans(ref_frame, {task}), [0, 0, 1, 0, 0, 0], "
                    f"[0.0, 0.0, {newton}, 0.0, 0.0, 0.0], 2, {LIMITS})"
                )
        lines.append(line)
    return [*lines, "end_force_mode()" if force is not None else ""]


def task_frame(device: ForceDevice, base_from_tcp: Floats) -> Floats:
    """4 x 4 in the base along whose z the wheel's and the part's surfaces press each other."""
    contact = np.eye(4) if device.contact is None else device.contact
    return contact if device.held else base_from_tcp @ contact


def along(device: ForceDevice, base_from_tcp: Floats) -> Floats:
    """(3,) unit vector in the tool along which the robot presses."""
    z = task_frame(device, base_from_tcp)[:3, 2]
    pressed: Floats = base_from_tcp[:3, :3].T @ (-z if device.held else z)
    return pressed


def runs(sheet: Sheet) -> list[str]:
    """Of RAPID's FCPress, for each step "start", "press", "end" or "": those of a run that presses, and the motion
    behind it on which it leaves the part; its own last one where none follows."""
    found = [""] * len(sheet.steps)
    begin: int | None = None
    for k in range(len(sheet.steps) + 1):
        step = sheet.steps[k] if k < len(sheet.steps) else None
        if step is not None and step.kind != "PTP" and step.force:
            begin = k if begin is None else begin
            found[k] = "start" if k == begin else "press"
            continue
        if begin is not None:
            leaves = step is not None and step.kind == "LIN"
            last = k if leaves else k - 1
            if (
                last == begin
                or sheet.steps[last].kind == "CIRC"
                or sheet.steps[begin].kind == "CIRC"
            ):
                raise ProgramError(
                    "programs.writers.short_press",
                    "pose {pose}: FCPress begins and ends a pass by a straight motion each: give the pass two at least",
                    pose=sheet.steps[begin].pose,
                )
            found[last] = "end"
            sheet.steps[last].force = 0.0
        begin = None
    return found
