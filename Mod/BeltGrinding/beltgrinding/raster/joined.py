"""Groups of passes one after the other as one path: the passes of a raster, further ones with another way or belt angle, and all of
them once more."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Array, Json
from ..engine import InputError
from . import reachable

KEY = "raster.further_passes"
MOST_POSES = 300_000
OF_POSES = ("contacts", "frames", "feeds", "forces", "rapid", "contact", "lines", "zones")
SUMMED = ("cuts", "beside", "stuck")


def groups(settings: Json) -> list[dict[str, Any]]:
    """The settings of each group of passes: those of a raster, then with what each of its further groups has in their place."""
    first: dict[str, Any] = {**settings, "further_passes": []}
    return [first, *({**first, **one} for one in settings["further_passes"])]


def join(parts: Sequence[Json]) -> dict[str, Any]:
    """One path of what ``raster_path.raster`` lays, with ``places`` if all have them; all else is as in the first."""
    if len(parts) == 1:
        return dict(parts[0])
    result = dict(parts[0])
    _refuse(sum(len(one["frames"]) for one in parts))
    for name in OF_POSES:
        result[name] = np.concatenate([one[name] for one in parts])
    for name in SUMMED:
        result[name] = sum(one[name] for one in parts)
    begins = np.cumsum([0, *(len(one["frames"]) for one in parts)])
    result["passes"] = [
        {**one, "first": one["first"] + int(begin), "last": one["last"] + int(begin)}
        for begin, part in zip(begins, parts)
        for one in part["passes"]
    ]
    if all("places" in one for one in parts):
        result["places"] = _places([one["places"] for one in parts])
    return result


def repeat(result: dict[str, Any], count: int) -> None:
    """Has all passes of a path run through ``count`` times, from the end back to the beginning as from pass to pass. Raises InputError."""
    if count == 1:
        return
    _refuse(count * len(result["frames"]), "raster.repeats")
    again = join([result] * count)
    for name in (*OF_POSES, "passes"):
        result[name] = again[name]
    if "fit" in result:
        result["fit"] = np.tile(result["fit"], count)


def _refuse(poses: int, key: str = KEY) -> None:
    if poses > MOST_POSES:
        raise InputError(
            "raster.too_many_poses",
            "{key}: all passes together have {poses} poses, more than {most}",
            key=key,
            poses=poses,
            most=MOST_POSES,
        )


def _places(parts: Sequence[Json]) -> dict[str, Any]:
    """What ``reachable.look`` found of each group, of the same places: a place is ground by the group that gets to it."""

    def any_of(name: str) -> Array:
        return np.logical_or.reduce([one[name] for one in parts])

    states = np.stack([one["state"] for one in parts])
    state = np.full(states.shape[1], reachable.NOT_WANTED)
    for one in (reachable.NO_ROOM, reachable.NO_PASS, reachable.GROUND):
        state[(states == one).any(axis=0)] = one
    fits, counted = any_of("fits"), np.max([one["counted"] for one in parts], axis=0)
    found = {**parts[0], "state": state, "fits": fits, "counted": counted, "alone": any_of("alone")}
    return reachable.with_shares(found, max(one["another_way"] for one in parts))
