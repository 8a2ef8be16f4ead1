"""Which runs a study makes: points of the unit cube by a design of OpenTURNS, then quantiles of what varies.

All designs but the grid are laid in the cube of a copula: independent, or Gaussian with the study's correlations. Each
coordinate u then becomes the u-quantile of its variable, so that lists of values, ranges and distributions mix.
Latin hypercubes with correlations: the strata are put into the order of the ranks of a correlated sample (Iman and Conover,
A distribution-free approach to inducing rank correlation among input variables, Communications in Statistics B 11,
1982), so that each stratum is still hit once.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from ..base import processes
from ..base.kinds import Array, Context, Floats, Json
from ..engine import InputError
from . import vary

if TYPE_CHECKING:
    from .kinds import OpenTurns, Quantile
    from .vary import Variable

MOST_RUNS = 1_000_000
GRID, INDICES = "grid", "sobol_indices"
NEEDS = {  # keys of a distribution's kind
    "normal": ("mean", "sd"),
    "uniform": ("lower", "upper"),
    "lognormal": ("mean", "sd"),
    "triangular": ("lower", "mode", "upper"),
    "weibull": ("scale", "shape"),
}
KEYS = {"kind", "lower", "upper"}  # of every distribution
BOUNDED = ("uniform", "triangular")  # by their own ends
INSIDE = 1e-12  # a quantile is asked for no nearer to 0 and 1: some are infinite there

Rows: TypeAlias = Sequence[tuple[Any, ...]]


class Design(NamedTuple):
    """The runs of a study."""

    rows: Rows  # tuples of values, one of each variable; of PART its number from 0
    size: int  # runs of one block of sobol_indices; of all others all
    method: str


def openturns() -> OpenTurns:
    """The package, which may only be used in a process of its own (``processes.apart``): each of its calls has Ctrl-C throw a
    C++ exception, which ends the process. Raises InputError where it is missing."""
    try:
        import openturns
    except ImportError as error:
        raise InputError(
            "studies.no_openturns",
            "studies need OpenTURNS (Debian: python3-openturns): {reason}",
            reason=error,
        ) from None
    return openturns


def design(study: Json, found: Sequence[Variable], context: Context = None) -> Design:
    """The ``Design`` of a study; ``found``: its [Variable]. Raises InputError, Cancelled."""
    matrix = correlations(study, found)
    if study["design"]["method"] == GRID and not any("distribution" in one.given for one in found):
        return _grid(found)
    return processes.apart(_design, study["design"], found, matrix, context=context)


def _design(
    wanted: Json, found: Sequence[Variable], matrix: Floats | None, context: object
) -> Design:
    if wanted["method"] == GRID:
        return _grid(found)
    quantiles = [quantile(one, f"vary[{k}]") for k, one in enumerate(found)]
    try:
        cube = _cube(wanted, len(found), matrix)
    except (TypeError, ValueError, RuntimeError) as error:  # as it tells of too many variables
        raise InputError(
            "studies.design_refused",
            "{key}: OpenTURNS makes no such design of {count} variables: {reason}",
            key="design.method",
            count=len(found),
            reason=" ".join(str(error).split())[:200],
        ) from None
    if len(cube) > MOST_RUNS:
        raise _too_many(len(cube))
    columns = [of(column) for of, column in zip(quantiles, cube.T)]
    return Design(list(zip(*columns)), wanted["runs"], wanted["method"])


def _too_many(count: int) -> InputError:
    return InputError(
        "studies.too_many_runs",
        "the design has {count} runs, more than {most}; take fewer values or steps",
        count=count,
        most=MOST_RUNS,
    )


def _cube(wanted: Json, dimension: int, matrix: Floats | None) -> Floats:
    """(runs, dimension) in [0, 1]."""
    ot = openturns()
    ot.RandomGenerator.SetSeed(wanted["seed"])
    free = ot.IndependentCopula(dimension)
    copula = free if matrix is None else _gaussian(ot, matrix)
    runs, method = wanted["runs"], wanted["method"]
    if method == "monte_carlo":
        return np.array(copula.getSample(runs))
    if method == "sobol":
        return np.array(
            ot.LowDiscrepancyExperiment(ot.SobolSequence(), copula, runs, True).generate()
        )
    if method == "latin_hypercube":
        strata = np.array(ot.LHSExperiment(free, runs).generate())
        if matrix is None:
            return strata
        ranks = np.argsort(np.argsort(np.array(copula.getSample(runs)), axis=0), axis=0)
        return np.take_along_axis(np.sort(strata, axis=0), ranks, axis=0)
    return _blocks(ot, dimension, runs, wanted["second_order"])


def _blocks(ot: OpenTurns, dimension: int, runs: int, second_order: bool) -> Floats:
    """The blocks of OpenTURNS' SobolIndicesExperiment: A, B, A with each column of B and, of the second order, B with each
    column of A. A and B are a Sobol sequence of twice the dimension, shifted at random: the indices' error is then a
    fraction of what it is with numbers drawn at random."""
    both = ot.IndependentCopula(2 * dimension)
    even = ot.LowDiscrepancyExperiment(ot.SobolSequence(), both, runs, True)
    even.setRandomize(True)
    drawn = np.array(even.generate())
    a, b = drawn[:, :dimension], drawn[:, dimension:]
    blocks = [a, b, *_exchanged(a, b)]
    if second_order and dimension > 2:
        blocks += _exchanged(b, a)
    return np.vstack(blocks)


def _exchanged(rows: Floats, others: Floats) -> list[Floats]:
    """Copies of ``rows``, each with another column of ``others``."""
    made = []
    for k in range(rows.shape[1]):
        one = rows.copy()
        one[:, k] = others[:, k]
        made.append(one)
    return made


def _gaussian(ot: OpenTurns, matrix: Floats) -> OpenTurns:
    return ot.NormalCopula(ot.CorrelationMatrix(len(matrix), matrix.ravel().tolist()))


def correlations(study: Json, found: Sequence[Variable]) -> Floats | None:
    """(variables, variables), the copula's; None where all are independent. Raises InputError for those that cannot be, and
    for a design that has none."""
    if not study["correlations"]:
        return None
    names = [one.name for one in found]
    matrix, told = np.eye(len(names)), set()
    for k, one in enumerate(study["correlations"]):
        where = f"correlations[{k}].between"
        for name in one["between"]:
            if name not in names:
                from ..base.schema_errors import hint

                raise InputError(
                    "studies.correlated_unknown",
                    "{key}: nothing that varies is called '{name}'; {hint}",
                    key=where,
                    name=name,
                    hint=hint(name, names),
                )
        i, j = sorted(names.index(name) for name in one["between"])
        if i == j or (i, j) in told:
            raise InputError(
                "studies.correlated_twice",
                "{key}: give two different names, each pair once",
                key=where,
            )
        told.add((i, j))
        matrix[i, j] = matrix[j, i] = one["coefficient"]
    if np.linalg.eigvalsh(matrix).min() <= 0.0:
        raise InputError(
            "studies.impossible_correlations",
            "{key}: no variables can be correlated like that: the matrix is not positive definite",
            key="correlations",
        )
    _check_method(study["design"]["method"])
    return matrix


def _check_method(method: str) -> None:
    """Raises InputError for a design that has no correlations."""
    if method == GRID:
        raise InputError(
            "studies.grid_correlated",
            "{key}: a grid has every value with every other; leave the correlations out, or choose another method",
            key="correlations",
        )
    if method == INDICES:
        raise InputError(
            "studies.indices_correlated",
            "{key}: Sobol indices are those of independent variables; leave the correlations out",
            key="correlations",
        )


def quantile(one: Variable, where: str) -> Quantile:
    """A function (n,) in [0, 1] -> list of values of a Variable. Raises InputError."""
    given = one.given
    if "parts" in given:
        return _of_list(list(range(len(given["parts"]))), None, where)
    if "values" in given:
        return _of_list(given["values"], given.get("weights"), where)
    ot = openturns()
    if "range" in given:
        lower, upper = given["range"]
        law = ot.Uniform(*_ordered(lower, upper, f"{where}.range"))
    else:
        law = distribution(ot, given["distribution"], f"{where}.distribution")
    if "weights" in given:
        raise _needless("weights", where)

    def of(cube: Floats) -> list[float]:
        inside = np.clip(cube, INSIDE, 1.0 - INSIDE)
        return [float(law.computeQuantile(float(u))[0]) for u in inside]

    return of


def _needless(name: str, where: str) -> InputError:
    return InputError(
        "studies.needless_key",
        "{key}: '{name}' says nothing here; leave it out",
        key=where,
        name=name,
    )


def _of_list(values: Sequence[Any], weights: Sequence[float] | None, where: str) -> Quantile:
    if weights is not None and len(weights) != len(values):
        raise InputError(
            "studies.weights",
            "{key}: {count} weights for {values} values; give each one",
            key=f"{where}.weights",
            count=len(weights),
            values=len(values),
        )
    shares = np.ones(len(values)) if weights is None else np.asarray(weights, dtype=float)
    ends = np.cumsum(shares / shares.sum())

    def of(cube: Array) -> list[Any]:
        return [values[k] for k in np.minimum(np.searchsorted(ends, cube, "right"), len(ends) - 1)]

    return of


def _ordered(lower: float, upper: float, where: str) -> tuple[float, float]:
    if not lower < upper:
        raise InputError(
            "studies.ends_swapped",
            "{key}: the lower end {lower:g} must lie below the upper one, {upper:g}",
            key=where,
            lower=lower,
            upper=upper,
        )
    return float(lower), float(upper)


def distribution(ot: OpenTurns, given: Json, where: str) -> OpenTurns:
    """The OpenTURNS distribution of a study's. Raises InputError."""
    kind = given["kind"]
    for name in NEEDS[kind]:
        if name not in given:
            raise InputError(
                "studies.distribution_lacks",
                "{key}: a distribution of the kind {kind} needs '{name}'",
                key=where,
                kind=kind,
                name=name,
            )
    for name in sorted(set(given) - KEYS - set(NEEDS[kind])):
        raise _needless(name, where)
    if "lower" in given and "upper" in given:
        _ordered(given["lower"], given["upper"], where)
    law = _law(ot, given, where)
    return law if kind in BOUNDED else _cut_off(ot, law, given, where)


def _law(ot: OpenTurns, given: Json, where: str) -> OpenTurns:
    kind = given["kind"]
    if kind == "normal":
        return ot.Normal(float(given["mean"]), float(given["sd"]))
    if kind == "uniform":
        return ot.Uniform(float(given["lower"]), float(given["upper"]))
    if kind == "weibull":
        return ot.WeibullMin(float(given["scale"]), float(given["shape"]), 0.0)
    if kind == "lognormal":
        if not given["mean"] > 0.0:
            raise InputError(
                "studies.lognormal_mean",
                "{key}: the mean of a lognormal distribution must be above 0",
                key=f"{where}.mean",
            )
        return ot.LogNormalMuSigma(float(given["mean"]), float(given["sd"]), 0.0).getDistribution()
    if not given["lower"] <= given["mode"] <= given["upper"]:
        raise InputError(
            "studies.mode_outside", "{key}: the mode must lie between the ends", key=f"{where}.mode"
        )
    return ot.Triangular(*(float(given[name]) for name in ("lower", "mode", "upper")))


def _cut_off(ot: OpenTurns, law: OpenTurns, given: Json, where: str) -> OpenTurns:
    """The distribution between its ends, where it has any."""
    ends = [name for name in ("lower", "upper") if name in given]
    if not ends:
        return law
    low = law.computeCDF(float(given["lower"])) if "lower" in given else 0.0
    high = law.computeCDF(float(given["upper"])) if "upper" in given else 1.0
    if not high - low > INSIDE:
        raise InputError(
            "studies.cut_off_all",
            "{key}: between its ends there is nothing of the distribution",
            key=where,
        )
    if len(ends) == 2:
        return ot.TruncatedDistribution(law, float(given["lower"]), float(given["upper"]))
    side = ot.TruncatedDistribution.LOWER if ends == ["lower"] else ot.TruncatedDistribution.UPPER
    return ot.TruncatedDistribution(law, float(given[ends[0]]), side)


def _grid(found: Sequence[Variable]) -> Design:
    columns = [_steps(one, f"vary[{k}]") for k, one in enumerate(found)]
    count = 1
    for column in columns:
        count *= len(column)
        if count > MOST_RUNS:
            raise _too_many(count)
    return Design(list(itertools.product(*columns)), count, GRID)


def _steps(one: Variable, where: str) -> Sequence[Any]:
    """The values of a Variable in a grid."""
    given = one.given
    if "parts" in given:
        return list(range(len(given["parts"])))
    if "values" in given:
        return given["values"]
    if "steps" not in given:
        raise InputError(
            "studies.no_steps",
            "{key}: in a grid a range or a distribution needs 'steps', the number of its values",
            key=where,
        )
    if "range" in given:
        lower, upper = _ordered(given["range"][0], given["range"][1], f"{where}.range")
        return np.linspace(lower, upper, given["steps"]).tolist()
    middles = (np.arange(given["steps"]) + 0.5) / given["steps"]
    return quantile(one, where)(middles)


def meta(study: Json, made: Design, names: list[str]) -> dict[str, Any]:
    """What is needed to evaluate the design, as design.json has it."""
    wanted = study["design"]
    return {
        "method": made.method,
        "size": made.size,
        "second_order": bool(made.method == INDICES and wanted["second_order"]),
        "seed": wanted["seed"],
        "runs": len(made.rows),
        "varied": names,
    }


def part_column(found: Sequence[Variable], rows: Rows, names: Sequence[str]) -> Rows:
    """``rows`` with the names of the parts in place of their numbers."""
    at = [k for k, one in enumerate(found) if one.key == vary.PART]
    if not at:
        return rows
    k = at[0]
    return [(*row[:k], names[row[k]], *row[k + 1 :]) for row in rows]
