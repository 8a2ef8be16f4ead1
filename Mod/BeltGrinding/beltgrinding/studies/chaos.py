"""Sobol indices of a plain sample, by a polynomial chaos expansion: a figure as a sum of orthonormal polynomials of the
variables, whose squared coefficients are shares of its variance (Sudret 2008, Reliab. Eng. Syst. Saf. 93:964).

OpenTURNS makes the polynomials of each density and chooses among their products by least angles; what the expansion is
worth is told by runs that it has not seen, and a linear regression is judged by the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..base.kinds import Array, Floats
from . import design, resampling
from .effects import is_constant
from .share import CONFIDENCE

if TYPE_CHECKING:
    from .kinds import OpenTurns

HIGHEST = 12  # degree
NORM = 0.65  # of the degrees: interactions of high degree are left out
TERMS = 200  # to choose from, at most
CHOSEN_BY = 400  # runs that choose the terms; all then settle their coefficients
FOLDS = 5
RUNS_A_VARIABLE, LEAST = 3, 20  # runs, at least
POOR = 0.8  # Q2 below which no index is given
DOUBTFUL = 0.98  # below which the doubt is told: indices may be wrong by what is not explained
SEED = 1
GIVES_UP = "LeastSquaresMetaModelSelection-MaximumError"  # a setting of OpenTURNS, of the process

Surface: TypeAlias = Callable[[Floats], Floats]  # a figure at places


class Chaos:
    """The expansion's terms for variables with these distributions (of OpenTURNS, independent)."""

    def __init__(self, distributions: Sequence[OpenTurns], runs: int) -> None:
        self.ot = ot = design.openturns()
        self.size = len(distributions)
        enumerate_ = ot.HyperbolicAnisotropicEnumerateFunction(self.size, NORM)
        most = max(min(TERMS, 2 * runs), self.size + 1)
        # A variable with few values has as many polynomials.
        limits = np.array([_degrees(one) for one in distributions])
        kept = np.zeros((1, self.size), dtype=int)
        for degree in range(1, HIGHEST + 1):
            count = enumerate_.getMaximumDegreeCardinal(degree)
            degrees = np.array([list(enumerate_(k)) for k in range(count)])
            within = degrees[(degrees <= limits).all(axis=1)]
            if degree > 1 and len(within) > most:
                break
            kept = within
        self.degrees = kept  # (terms, variables); the first is the constant
        highest = kept.max(axis=0)
        self.polynomials = [
            (_of_values if one.isDiscrete() else _of_density)(ot, one, int(most_))
            for one, most_ in zip(distributions, highest)
        ]

    def matrix(self, inputs: Floats) -> Floats:
        """(n, terms): the polynomials at ``inputs`` (n, variables)."""
        made = np.ones((len(inputs), len(self.degrees)))
        for k, of in enumerate(self.polynomials):
            made *= of(inputs[:, k])[:, self.degrees[:, k]]
        return made

    def choose(self, matrix: Floats, figure: Floats) -> Array:
        """The numbers of the terms (columns of ``matrix``) that a figure (n,) needs; the constant is one."""
        ot, rows = self.ot, np.arange(len(figure))
        if len(rows) > CHOSEN_BY:
            rows = np.random.default_rng(SEED).choice(rows, CHOSEN_BY, replace=False)
        count = matrix.shape[1]
        each = np.eye(count)
        columns = [ot.LinearFunction([0.0] * count, [0.0], ot.Matrix(one[None])) for one in each]
        angles = ot.LARS()
        angles.setMaximumRelativeConvergence(-1.0)  # by the left-out error alone
        search = ot.LeastSquaresMetaModelSelection(
            ot.Sample(matrix[rows]),
            ot.Sample(figure[rows, None]),
            columns,
            list(range(count)),
            angles,
            ot.CorrectedLeaveOneOut(),
        )
        # By its default it gives up where the first terms leave more than half unexplained.
        before = ot.ResourceMap.GetAsScalar(GIVES_UP)
        ot.ResourceMap.SetAsScalar(GIVES_UP, 1e300)
        try:
            search.run()
        finally:
            ot.ResourceMap.SetAsScalar(GIVES_UP, before)
        chosen = np.flatnonzero(np.asarray(search.getCoefficients()))
        return np.union1d([0], chosen)

    def shares(self, coefficients: Floats, chosen: Array) -> tuple[Floats, Floats]:
        """(first, total) (..., variables): the indices of coefficients (..., chosen)."""
        squares = np.square(coefficients)[..., self.degrees[chosen].any(axis=1)]
        active = self.degrees[chosen][self.degrees[chosen].any(axis=1)] > 0
        alone = active & (active.sum(axis=1) == 1)[:, None]
        variance = np.maximum(squares.sum(axis=-1), 1e-300)[..., None]
        return squares @ alone / variance, squares @ active / variance


def of_sample(
    inputs: Floats,
    figure: Floats,
    distributions: Sequence[OpenTurns],
    confidence: float = CONFIDENCE,
) -> dict[str, Any] | None:
    """Indices from a sample of independent variables: Monte Carlo, Latin hypercube or Sobol sequence.

    ``inputs``: (n, d); ``figure``: (n,), all finite; ``distributions``: of OpenTURNS, one a variable. Returns dict(q2,
    linear_q2, terms, first, total): Q2 is the share of the variance that five-fold cross-validation predicts, of the
    expansion and of a linear regression on the same folds; ``first`` and ``total`` are None where Q2 is below 0.8, else
    a list of [value, low, high] each, whose intervals are the bootstrap's for the chosen terms: what the expansion
    leaves unexplained, 1 - Q2, comes on top. None where the figure is the same in all runs or the runs are fewer than
    20, or 3 a variable.
    """
    runs, size = inputs.shape
    if is_constant(figure) or runs < max(LEAST, RUNS_A_VARIABLE * size):
        return None
    chaos = Chaos(distributions, runs * (FOLDS - 1) // FOLDS)
    matrix = chaos.matrix(inputs)
    wanted = (figure - figure.mean()) / figure.std()
    linear = np.column_stack([np.ones(runs), inputs])
    order = np.random.default_rng(SEED).permutation(runs)
    said, said_linearly = np.empty(runs), np.empty(runs)
    for fold in np.array_split(order, FOLDS):
        kept = np.setdiff1d(order, fold)
        chosen = chaos.choose(matrix[kept], wanted[kept])
        said[fold] = matrix[np.ix_(fold, chosen)] @ _fit(matrix[np.ix_(kept, chosen)], wanted[kept])
        said_linearly[fold] = linear[fold] @ _fit(linear[kept], wanted[kept])
    found: dict[str, Any] = {"q2": _q2(said, wanted), "linear_q2": _q2(said_linearly, wanted)}
    chosen = chaos.choose(matrix, wanted)
    found.update(terms=len(chosen), first=None, total=None)
    if found["q2"] < POOR:
        return found
    columns = matrix[:, chosen]
    first, total = chaos.shares(_fit(columns, wanted), chosen)
    drawn = [
        _fit(columns * np.sqrt(weights)[:, None], wanted * np.sqrt(weights))
        for weights in resampling.counts(runs, samples=resampling.LEAST_SAMPLES * 2)
    ]
    again = chaos.shares(np.array(drawn), chosen)
    for name, values, many in zip(("first", "total"), (first, total), again):
        low, high = resampling.interval(many, confidence)
        # The spread of resampled coefficients shifts their squares upwards.
        low, high = np.minimum(low, values), np.maximum(high, values)
        found[name] = np.column_stack([values, low, high]).tolist()
    return found


def predictor(inputs: Floats, figure: Floats, distributions: Sequence[OpenTurns]) -> Surface:
    """A function of (m, d) that gives the expansion's (m,) of a figure: a response surface."""
    chaos = Chaos(distributions, len(figure))
    middle, spread = figure.mean(), figure.std() or 1.0
    wanted = (figure - middle) / spread
    matrix = chaos.matrix(inputs)
    chosen = chaos.choose(matrix, wanted)
    coefficients = _fit(matrix[:, chosen], wanted)
    return lambda places: middle + spread * (chaos.matrix(places)[:, chosen] @ coefficients)


def _fit(matrix: Floats, wanted: Floats) -> Floats:
    return np.linalg.lstsq(matrix, wanted, rcond=None)[0]


def _q2(said: Floats, wanted: Floats) -> float:
    return float(1.0 - np.mean((said - wanted) ** 2) / np.var(wanted))


def _of_density(ot: OpenTurns, distribution: OpenTurns, highest: int) -> Surface:
    """(n,) -> (n, highest + 1): the orthonormal polynomials of a variable with a density."""
    factory = ot.StandardDistributionPolynomialFactory(distribution)
    standard = ot.DistributionTransformation(distribution, factory.getMeasure())
    polynomials = [factory.build(k) for k in range(highest + 1)]

    def of(values: Floats) -> Floats:
        given = np.asarray(standard(ot.Sample(values[:, None])))[:, 0]
        return np.column_stack([np.array([one(x) for x in given]) for one in polynomials])

    return of


def _of_values(ot: OpenTurns, distribution: OpenTurns, highest: int) -> Surface:
    """The same of a variable with few values: found by orthogonalisation under their probabilities, exact at the values,
    which are all it may be given."""
    points = np.asarray(distribution.getSupport())[:, 0]
    shares = np.array([distribution.computePDF([x]) for x in points])
    middle, spread = points.mean(), np.ptp(points) or 1.0
    powers = np.vander((points - middle) / spread, highest + 1, increasing=True)
    found, _ = np.linalg.qr(np.sqrt(shares)[:, None] * powers)
    at_points = found / np.sqrt(shares)[:, None]
    at_points *= np.sign(at_points[0, 0])

    def of(values: Floats) -> Floats:
        return at_points[np.abs(values[:, None] - points).argmin(axis=1)]

    return of


def _degrees(distribution: OpenTurns) -> int:
    """The highest degree of a variable: of one with few values, by which they are told apart."""
    if distribution.isDiscrete():
        return len(distribution.getSupport()) - 1
    return HIGHEST
