"""The form in which a controller follows the passes of a new program: spline blocks, or zones that fit the blocks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .text import ZONE_DIGITS

if TYPE_CHECKING:
    from .sheet import Sheet

FORMS = ("spline", "zones")
CORNER = 30.0  # degrees: a sharper bend ends a block, at which the robot stops
MOST = 1000  # segments of a block
HALF = 0.5  # of the shorter neighbouring way: zones of neighbours do not meet


def fit_zones(sheet: Sheet) -> None:
    """Zones of path motions that have a form: at most half the shorter way before or behind them."""
    if not sheet.form:
        return
    scale = 10.0**ZONE_DIGITS
    before, behind = sheet.ways()
    for step, most in zip(sheet.steps, HALF * np.minimum(before, behind)):
        if step.kind != "PTP":
            wanted = sheet.blend_mm if step.zone is None else step.zone
            step.zone = math.floor(min(wanted, float(most)) * scale) / scale


def blocks(sheet: Sheet) -> set[int]:
    """The steps with which KRL's spline blocks begin. Runs of straight motions without a sharp bend become SPL; a
    straight motion that is alone stops at its end, since the controller rounds no corner to or from a spline.
    """
    begins: set[int] = set()
    if sheet.form != "spline":
        return begins
    steps = sheet.steps
    straight = [step.kind == "LIN" for step in steps]
    ways = np.diff(sheet.positions[[step.pose for step in steps]], axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    directions = ways / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    bend = math.cos(math.radians(CORNER))
    run: list[int] = []
    for k in range(len(steps) + 1):
        goes_on = k < len(steps) and straight[k] and not steps[k].note
        if run and goes_on:
            smooth = k >= 2 and directions[k - 2] @ directions[k - 1] > bend
            frames = (steps[k].tool, steps[k].base) == (steps[run[0]].tool, steps[run[0]].base)
            goes_on_here = smooth and frames and len(run) < MOST
        else:
            goes_on_here = False
        if not goes_on_here:
            if len(run) > 1:
                begins.add(run[0])
                for one in run:
                    steps[one].kind = "SPL"
            elif run:
                steps[run[0]].zone = 0.0
            run = []
        if goes_on or (k < len(steps) and straight[k]):
            run.append(k)
    return begins
