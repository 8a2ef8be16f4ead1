"""The pictures of a report: the whole part from two sides, and its worst spots from near."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Context, Json
from ..engine import core
from ..inspection import picture
from .markup import data_uri

REACH = 2.5  # samples that a spot may lie behind what a picture shows, and still be marked


class Shot(NamedTuple):
    """A picture and the marks on it: (number of the spot from 1, column, row)."""

    view: picture.View
    uri: str
    marks: list[tuple[int, float, float]]


def draw(
    field: core.HeightField,
    scale: tuple[float, float, float],
    shape: core.Shape | None,
    spots: Sequence[Json],
    context: Context = None,
    near: bool = True,
    beside: Callable[[Mapping[str, picture.View]], Any] | None = None,
) -> dict[str, Any]:
    """dict: ``front`` and ``back``, a ``Shot`` each; ``close``: list of those of ``spots``, if ``near``;
    ``beside``: what ``beside`` returns for the ``View`` of front and back, meanwhile, in a thread of its own.
    """
    colours = core.deviation_colours(field, *scale)
    studio = picture.Studio(field, colours, shape, context)
    slack = REACH * field.spacing
    with ThreadPoolExecutor(1) as packing, ThreadPoolExecutor(
        1
    ) as other:  # one alone cannot use two processors
        sides = dict(zip(("front", "back"), studio.both(context)))
        made = other.submit(beside, sides) if beside is not None else None
        whole = {
            name: Shot(view, packing.submit(_uri, view), _marks(view, spots, slack))
            for name, view in sides.items()
        }
        close = []
        for spot in spots if near else ():
            view = studio.close_up(
                np.array(spot["point"]),
                np.array(spot["normal"]),
                spot["extent"],
                context,
            )
            x, y, _ = view.project([spot["point"]])[0]
            close.append(Shot(view, packing.submit(_uri, view), [(spot["number"], x, y)]))
        return {
            **{name: _packed(shot) for name, shot in whole.items()},
            "close": [_packed(shot) for shot in close],
            "beside": made.result() if made is not None else None,
        }


def _packed(shot: Shot) -> Shot:
    return shot._replace(uri=shot.uri.result())


def _marks(view: picture.View, spots: Sequence[Json], slack: float) -> list[Any]:
    if not spots:
        return []
    points = np.array([spot["point"] for spot in spots])
    # What faces away lies on the other side, even where a thin part hides it by less than that.
    facing = np.array([spot["normal"] for spot in spots]) @ view.direction < 0.05
    seen = view.shows(points, slack) & facing
    places = view.project(points)
    return [
        (spot["number"], *place[:2]) for spot, place, there in zip(spots, places, seen) if there
    ]


def _uri(view: picture.View) -> str:
    return data_uri(picture.png(view.pixels), "image/png")
