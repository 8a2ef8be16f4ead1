"""The pictures of a report: the whole part from two sides, and its worst spots from near."""

from typing import NamedTuple

import numpy as np

from ..engine import core
from ..inspection import picture
from .markup import data_uri

REACH = 2.5  # samples that a spot may lie behind what a picture shows, and still be marked


class Shot(NamedTuple):
    """A picture and the marks on it: (number of the spot from 1, column, row)."""

    view: picture.View
    uri: str
    marks: list


def draw(field, scale, shape, spots, context=None, near=True):
    """dict: ``front`` and ``back``, a ``Shot`` each; ``close``: list of those of ``spots``, if ``near``."""
    colours = core.deviation_colours(field, *scale)
    studio = picture.Studio(field, colours, shape, context)
    slack = REACH * field.spacing
    whole = {}
    for name, view in zip(("front", "back"), studio.both(context)):
        whole[name] = _shot(view, spots, slack)
    close = []
    for spot in spots if near else ():
        view = studio.close_up(
            np.array(spot["point"]), np.array(spot["normal"]), spot["extent"], context
        )
        x, y, _ = view.project([spot["point"]])[0]
        close.append(Shot(view, _uri(view), [(spot["number"], x, y)]))
    return {**whole, "close": close}


def _shot(view, spots, slack):
    marks = []
    if spots:
        points = np.array([spot["point"] for spot in spots])
        # What faces away lies on the other side, even where a thin part hides it by less than that.
        facing = np.array([spot["normal"] for spot in spots]) @ view.direction < 0.05
        seen = view.shows(points, slack) & facing
        places = view.project(points)
        marks = [
            (spot["number"], *place[:2]) for spot, place, there in zip(spots, places, seen) if there
        ]
    return Shot(view, _uri(view), marks)


def _uri(view):
    return data_uri(picture.png(view.pixels), "image/png")
