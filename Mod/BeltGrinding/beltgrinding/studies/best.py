"""The best setting under limits: among the runs, and what a response surface says between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Floats, known
from ..engine import InputError
from . import chaos, design

if TYPE_CHECKING:
    from .kinds import Limits, OpenTurns, Variables

GOALS = ("minimise", "maximise")
TIE = 1e-9  # relative, of the figures' range
CANDIDATES = 4096  # places that a surface is asked at, each round
ROUNDS = 6
SHRINK = 0.4  # of the box around the best place, each round


def of_runs(
    figures: Variables, figure: str, goal: str, limits: Limits, good: Array
) -> dict[str, Any]:
    """The best of the runs that were done.

    ``figures``: {name: (n,)}, NaN where it is not judged; ``figure``: which to ``goal`` ("minimise", "maximise");
    ``limits``: {name: (low or None, high or None)} of other figures or of itself; ``good``: (n,) bool, runs that may be
    chosen. Returns dict(run, value, ties, feasible, judged, nearest): ``run`` is the row, None where no run keeps all
    limits; ``ties``: other rows that are as good; ``nearest``: then dict(run, beyond {name: by how much}), the row that
    breaks them least, each measured by the range of its figure. Raises InputError for a figure that is not there.
    """
    _check(figures, figure, goal, limits)
    values = figures[figure]
    judged = good & np.isfinite(values)
    for name in limits:
        judged &= np.isfinite(figures[name])
    over = {name: beyond(figures[name], *pair) for name, pair in limits.items()}
    inside = judged.copy()
    for far in over.values():
        inside &= far <= 0.0
    found: dict[str, Any] = {"run": None, "value": None, "ties": [], "nearest": None}
    found.update(feasible=int(inside.sum()), judged=int(judged.sum()))
    if inside.any():
        signed = np.where(inside, _sign(goal) * values, np.inf)
        best = int(np.argmin(signed))
        slack = TIE * max(float(np.ptp(values[judged])), 1e-300)
        ties = np.flatnonzero(signed <= signed[best] + slack)
        found.update(run=best, value=float(values[best]), ties=[int(k) for k in ties if k != best])
    elif judged.any():
        total = np.zeros(len(values))
        for name, far in over.items():
            total += far / (float(np.ptp(figures[name][judged])) or 1.0)
        nearest = int(np.argmin(np.where(judged, total, np.inf)))
        broken = {name: float(far[nearest]) for name, far in over.items() if far[nearest] > 0.0}
        found["nearest"] = {"run": nearest, "beyond": broken}
    return found


def _check(figures: Variables, figure: str, goal: str, limits: Limits) -> None:
    if goal not in GOALS:
        raise InputError(
            "studies.best_goal", "best: '{goal}' is no goal; it is minimise or maximise", goal=goal
        )
    for name in (figure, *limits):
        if name not in figures:
            raise InputError(
                "studies.best_no_figure",
                "best: the runs have no figure '{name}' in numbers; there are {names}",
                name=name,
                names=", ".join(sorted(figures)),
            )


def _sign(goal: str) -> float:
    return 1.0 if goal == "minimise" else -1.0


def beyond(values: Array, low: float | None, high: float | None) -> Array:
    """By how much values (of any shape) lie beyond limits, each of which may be None."""
    far = np.zeros(np.shape(values))
    if low is not None:
        far = np.maximum(far, low - values)
    if high is not None:
        far = np.maximum(far, values - high)
    return far


def suggested(
    inputs: Floats,
    figures: Variables,
    figure: str,
    goal: str,
    limits: Limits,
    distributions: Sequence[OpenTurns],
    good: Array,
) -> dict[str, Any] | None:
    """What response surfaces say: a setting between the runs, which is to be run as a check.

    ``inputs``: (n, d) of the variables; ``distributions``: theirs, of OpenTURNS; the rest as ``of_runs``. Searched is
    the box of the runs. Returns dict(inputs (d,), predicted {name: value}, q2 {name: [chaos, linear regression]},
    feasible), or dict(poor: {name: Q2}) where a figure's surface predicts left-out runs too badly. None where there are
    too few runs. Raises InputError as ``of_runs``.
    """
    _check(figures, figure, goal, limits)
    needed = list(dict.fromkeys([figure, *limits]))
    rows = good.copy()
    for name in needed:
        rows &= np.isfinite(figures[name])
    given = inputs[rows]
    quality: dict[str, list[float]] = {}
    surfaces: dict[str, chaos.Surface] = {}
    poor: dict[str, float] = {}
    for name in needed:
        values = figures[name][rows]
        found = chaos.of_sample(given, values, distributions)
        if found is None:
            if len(values) and np.ptp(values) == 0.0:
                surfaces[name] = _level(values[0])
                continue
            return None
        quality[name] = [found["q2"], found["linear_q2"]]
        if found["q2"] < chaos.POOR:
            poor[name] = found["q2"]
        else:
            surfaces[name] = chaos.predictor(given, values, distributions)
    if poor:
        return {"poor": poor, "q2": quality}
    place = _search(given, distributions, surfaces, figure, _sign(goal), limits)
    predicted = {name: float(surface(place[None])[0]) for name, surface in surfaces.items()}
    inside = all(beyond(np.array([predicted[n]]), *pair)[0] <= 0.0 for n, pair in limits.items())
    return {"inputs": place, "predicted": predicted, "q2": quality, "feasible": inside}


def _level(value: float) -> chaos.Surface:
    """The surface of a figure that is the same in all runs."""
    return lambda places: np.full(len(places), value)


def _search(
    given: Floats,
    distributions: Sequence[OpenTurns],
    surfaces: Mapping[str, chaos.Surface],
    figure: str,
    sign: float,
    limits: Limits,
) -> Floats:
    """(d,) the best place of the surfaces: many places of the box, then of ever smaller ones around the best."""
    ot = design.openturns()
    low, high = given.min(axis=0), given.max(axis=0)
    unit = np.asarray(ot.SobolSequence(given.shape[1]).generate(CANDIDATES))
    few = {k: np.unique(given[:, k]) for k, one in enumerate(distributions) if one.isDiscrete()}
    scale = {name: float(np.ptp(surface(given))) or 1.0 for name, surface in surfaces.items()}
    best: Floats | None = None
    size = high - low
    for _ in range(ROUNDS):
        begin = low if best is None else np.clip(best - 0.5 * size, low, high - size)
        places = begin + unit * size
        for k, values in few.items():
            places[:, k] = values[
                np.minimum((unit[:, k] * len(values)).astype(int), len(values) - 1)
            ]
        if best is not None:
            places = np.vstack([best, places])
        far = sum(
            (beyond(surfaces[name](places), *pair) / scale[name] for name, pair in limits.items()),
            np.zeros(len(places)),
        )
        wanted = sign * surfaces[figure](places)
        inside = far <= 0.0
        order = np.where(inside, wanted, np.inf) if inside.any() else far
        best = places[int(np.argmin(order))]
        size = SHRINK * size
    return known(best)
