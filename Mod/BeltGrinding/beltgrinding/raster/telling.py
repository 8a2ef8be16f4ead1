"""Warnings about a raster path: ends, ways, places without room."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.kinds import Facts, Floats, Json
from ..engine import core
from . import passes
from .clearing import Clearing
from .kinds import Levels

CLOSED = 0.5  # of the length of rings; less gets a warning


def ends(result: dict[str, Any], settings: Json, warnings: Facts) -> None:
    if result["cuts"]:
        warnings.append(
            core.Fact(
                "raster.passes_end",
                "at {count} places a pass ends, where the tool would turn by more than {rate:.4g} degrees per "
                "mm or go back in contact; what lies there may stay without a pass",
                count=result["cuts"],
                rate=settings["max_turn_deg_per_mm"],
            )
        )


def ways(clearing: Clearing, result: dict[str, Any], warnings: Facts) -> None:
    blocked = clearing.ways_blocked(result["contacts"], result["rapid"])
    if blocked or result["stuck"]:
        warnings.append(
            core.Fact(
                "raster.ways_blocked",
                "off the passes {tool} goes through the part: on {ways} straight rapid ways, first to pose {pose}, "
                "and {stuck} ends of passes have no room above them; lead the robot there by hand, or take {smaller}",
                tool=clearing.name,
                smaller=clearing.tool.smaller,
                ways=len(blocked),
                pose=blocked[0] + 1 if blocked else 0,
                stuck=result["stuck"],
            )
        )


def way_back(clearing: Clearing, result: dict[str, Any], warnings: Facts) -> None:
    """Of passes that are run through more than once."""
    if clearing.ways_blocked(result["contacts"][[-1, 0]], np.array([True, True])):
        warnings.append(
            core.Fact(
                "raster.way_back_blocked",
                "from the end of the passes straight back to their beginning {tool} goes through the part; lead the "
                "robot there by hand, or enlarge clearance_mm",
                tool=clearing.name,
            )
        )


def fit(clearing: Clearing, settings: Json, result: dict[str, Any], warnings: Facts) -> Floats:
    depth = np.zeros(len(result["frames"]))
    touching = np.flatnonzero(result["contact"])
    depth[touching] = clearing.tool_depth(result["contacts"][touching])
    tight = np.flatnonzero(depth > settings["fit_mm"] * (1.0 + 1e-6) + 1e-9)
    if len(tight):
        worst = int(np.argmax(depth))
        warnings.append(
            core.Fact(
                "raster.wheel_does_not_fit",
                "{tool} does not fit the part at {count} poses: undeformed, it reaches at worst {depth:.2f} mm into "
                "it, at pose {pose}; take {smaller}, or another direction",
                tool=clearing.tool.name,
                smaller=clearing.tool.smaller,
                count=len(tight),
                depth=depth[worst],
                pose=worst + 1,
            )
        )
    met = clearing.held.first_met(result["contacts"][touching])
    if (met >= 0).any():
        warnings.append(
            core.Fact(
                "raster.held_does_not_fit",
                "at {count} poses, first at pose {pose}, what goes with {tool} meets the part, or what is fixed to it: "
                "{bodies}; lay the passes another way, or make room",
                count=int((met >= 0).sum()),
                pose=int(touching[np.argmax(met >= 0)]) + 1,
                tool=clearing.tool.name,
                bodies=", ".join(clearing.in_the_way(result["contacts"][touching])),
            )
        )
    return depth


def no_room(result: dict[str, Any], clearing: Clearing, warnings: Facts) -> None:
    """Before all other warnings."""
    if not result["passes"]:
        return
    contacts = result["contacts"][result["contact"]]
    if (clearing.tool_depth(contacts) <= clearing.fit).any():
        warnings.insert(
            0,
            core.Fact(
                "raster.no_room_for_held",
                "what goes with {tool} would meet the part, or what is fixed to it, wherever {tool} itself has room on these "
                "faces ({bodies}): the passes are laid as if it did not, and must not be ground so; lay them another way, or "
                "make room",
                tool=clearing.tool.name,
                bodies=", ".join(clearing.in_the_way(contacts)),
            ),
        )
        return
    warnings.insert(
        0,
        core.Fact(
            "raster.no_room",
            "{tool} fits nowhere on these faces: the passes are laid as if it did, and must not be ground "
            "with it; take {smaller}, or another direction",
            tool=clearing.tool.name,
            smaller=clearing.tool.smaller,
        ),
    )


def beyond(share: float, warnings: Facts) -> None:
    if share > 0.0:
        warnings.append(
            core.Fact(
                "raster.belt_beyond_faces",
                "at {share:.0f} % of the places the belt's contact goes on over the border of the faces: the passes lie "
                "by what of it is on them",
                share=100.0 * share,
            )
        )


def open_rings(levels: Levels, warnings: Facts) -> None:
    pieces = [piece for level in levels for piece in level]
    closed = sum(passes.length(piece["points"]) for piece in pieces if piece["closed"])
    share = closed / max(sum(passes.length(piece["points"]) for piece in pieces), 1e-9)
    if share < CLOSED:
        warnings.append(
            core.Fact(
                "raster.rings_open",
                "of the length of the passes round the faces {share:.0f} % are closed rings; the others end at "
                "borders or sharp edges",
                share=100.0 * share,
            )
        )
