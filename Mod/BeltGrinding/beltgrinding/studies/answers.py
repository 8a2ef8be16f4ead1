"""What a study's table answers: yield, main effects, Sobol indices, the best setting. docs/study-answers.md says what they mean."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import processes
from ..base.kinds import Array, Context, Facts, Floats, Json
from ..base.messages import fact_data
from ..engine import InputError, core
from . import best, chaos, effects, resampling, share, sobol
from .inputs import inputs_of
from .table import ERROR, FAILED, OPEN, RUN, STATUS

if TYPE_CHECKING:
    from .inputs import Input
    from .kinds import Limits, Variables
    from .table import Table

FORMAT = 1
OVERALL = "overall"
FEW = 30  # runs, below which intervals by resampling are told to be too narrow
# Figures that are answered for if the study names none.
USUAL = """
    in_share
    above_share
    below_share
    worst.beyond_mm
    deviation_mm.rms
    removed_volume_mm3
    process_time_s
    peak_pressure_MPa
""".split()
SIDES = {"above_share": "not_above", "below_share": "not_below"}


class Sample(NamedTuple):
    """The runs that count, as arrays of the same length."""

    rows: Array  # of the table
    variables: dict[str, Array]  # {name: (n,)}
    groups: Array | None  # (n,) runs that depend on each other, or None
    random: bool  # whether a share of them is a probability


def answers(study: Json, meta: Json, table: Table, context: Context = None) -> dict[str, Any]:
    """The answers, a dict as answers.json has it.

    ``study``: with its defaults; ``meta``: of design.json; ``table``: a ``Table``. Raises InputError where nothing was run,
    for figures that the table does not have, and without OpenTURNS; Cancelled.
    """
    asked = {name: study[name] for name in ("answers", "correlations", "vary") if name in study}
    return processes.apart(_answers, asked, meta, table, context=context)


def _answers(study: Json, meta: Json, table: Table, context: core.RunContext) -> dict[str, Any]:
    wanted = study.get("answers", {})
    varied = list(meta["varied"])
    done = table.done
    notes: Facts = []
    runs = _counts(table, notes)
    if not done.any():
        raise InputError(
            "studies.nothing_done",
            "the study has no finished run: there is nothing to answer; its table says what failed",
        )
    if study["correlations"]:
        notes.append(
            core.Fact(
                "studies.correlated_effects",
                "what varies is correlated: a main effect holds that of what goes along with it, and Sobol indices, "
                "which belong to independent variables, are not given",
            )
        )
    sample = _sample(table, meta, varied, done)
    inputs = inputs_of(study, varied)
    figures = _figures(table, wanted, varied, done, notes)
    if sample.random and len(sample.rows) < FEW:
        notes.append(
            core.Fact(
                "studies.few_runs",
                "only {count} runs: intervals by resampling so few are too narrow",
                count=len(sample.rows),
            )
        )
    drawn = resampling.counts(len(sample.rows), sample.groups) if sample.random else None
    found: dict[str, Any] = {
        "format": FORMAT,
        "design": {key: meta[key] for key in ("method", "size", "runs", "seed")},
        "runs": runs,
        "varied": varied,
        "confidence": share.CONFIDENCE,
        "yield": _yield(table, meta, notes),
        "figures": {},
    }
    for place, name in enumerate(figures):
        context.throw_if_cancelled()
        context.report(place / len(figures))
        found["figures"][name] = _of_figure(
            name, table, sample, drawn, inputs, meta, study, context
        )
    if wanted.get("best"):
        found["best"] = _best(wanted["best"], table, inputs, study, meta)
    found["note_facts"] = [fact_data(note) for note in notes]
    return found


def _counts(table: Table, notes: Facts) -> dict[str, Any]:
    """dict(all, done, failed, open, errors [dict(text, count, run)]) of the runs."""
    status = table[STATUS]
    texts: dict[str, list[int]] = {}
    for row in np.flatnonzero(status == FAILED):
        told = texts.setdefault(str(table[ERROR][row]), [0, int(table[RUN][row])])
        told[0] += 1
    counts = {
        "all": len(table),
        "done": int(table.done.sum()),
        "failed": int((status == FAILED).sum()),
        "open": int((status == OPEN).sum()),
        "errors": [
            {"text": text, "count": count, "run": run}
            for text, (count, run) in sorted(texts.items(), key=lambda pair: -pair[1][0])
        ],
    }
    if counts["failed"]:
        notes.append(
            core.Fact(
                "studies.failed_runs",
                "{failed} of {count} runs could not be run and are left out of all answers; if they lie where the part "
                "would be bad, the answers look better than they are",
                failed=counts["failed"],
                count=counts["all"],
            )
        )
    if counts["open"]:
        notes.append(
            core.Fact(
                "studies.open_runs",
                "{open} of {count} runs are not run yet and are left out",
                open=counts["open"],
                count=counts["all"],
            )
        )
    return counts


def _sample(table: Table, meta: Json, varied: Sequence[str], done: Array) -> Sample:
    groups = None
    rows = np.flatnonzero(done)
    if meta["method"] == "sobol_indices":
        groups = rows % meta["size"]
    variables = {name: plain(table[name][rows]) for name in varied}
    return Sample(rows, variables, groups, meta["method"] != "grid")


def plain(values: Array) -> Array:
    """Numbers as they are; truth values, lists and texts as texts."""
    if values.dtype.kind in "fiu":
        return values
    return np.array([str(value) for value in values], dtype=object)


def _figures(
    table: Table, wanted: Json, varied: Sequence[str], done: Array, notes: Facts
) -> list[str]:
    """Names of the figures to answer for: numbers, not the same in all runs."""
    asked = wanted.get("figures") or []
    for name in asked:
        if name not in table.columns:
            raise InputError(
                "studies.no_such_figure",
                "{key}: the table has no figure '{name}'; it has {names}",
                key="answers.figures",
                name=name,
                names=", ".join(_numeric(table, varied)),
            )
    there = _numeric(table, varied)
    names = asked or [name for name in USUAL if name in there] or there
    zones = [name for name in there if name.startswith("zones.") and name.endswith(".in_share")]
    kept: list[str] = []
    same: list[str] = []
    for name in dict.fromkeys([*names, *([] if asked else zones)]):
        values = table[name][done]
        known = values[np.isfinite(values)] if values.dtype.kind in "fiu" else values[:0]
        (same if effects.is_constant(known) else kept).append(name)
    if same:
        notes.append(
            core.Fact(
                "studies.same_figures",
                "the same in all runs, or no numbers: {names}",
                names=", ".join(same),
            )
        )
    return kept


def _numeric(table: Table, varied: Sequence[str]) -> list[str]:
    left_out = {RUN, *varied}
    return [n for n in table.names if n not in left_out and table[n].dtype.kind in "fiu"]


def _yield(table: Table, meta: Json, notes: Facts) -> list[dict[str, Any]]:
    """[dict(of, name, passed, ..., low, high)] of the verdict, each zone's, and either side of the tolerance. Empty where
    the table has no verdict. Of blocks, only the first two are independent runs."""
    rows = np.flatnonzero(table.done)
    if meta["method"] == "sobol_indices":
        rows = rows[rows < 2 * meta["size"]]
    random = meta["method"] != "grid"
    found: list[dict[str, Any]] = []

    def add(of: str, name: str, verdicts: Array) -> None:
        found.append({"of": of, "name": name, **share.of(list(verdicts), random)})

    for name in table.names:
        if name == OVERALL:
            add("overall", name, table[name][rows])
        elif name.startswith("zones.") and name.endswith(".verdict"):
            add("zone", name[len("zones.") : -len(".verdict")], table[name][rows])
    for name, side in SIDES.items():
        if name in table.columns and table[name].dtype.kind in "fiu":
            values = table[name][rows]
            words = np.where(np.isfinite(values), np.where(values > 0.0, "fail", "pass"), "unknown")
            add(side, name, words)
    if found and not random:
        notes.append(
            core.Fact(
                "studies.grid_yield",
                "a grid is no sample: the share of its runs that pass is no probability, and nothing has an interval; "
                "take Monte Carlo, a Latin hypercube or a Sobol sequence with the true distributions for a yield",
            )
        )
    if found and meta["method"] in ("latin_hypercube", "sobol"):
        notes.append(
            core.Fact(
                "studies.even_sample",
                "the runs fill the ranges more evenly than chance would: the yield's interval, which takes them for "
                "independent, is wider than it need be",
            )
        )
    return found


def _of_figure(
    name: str,
    table: Table,
    sample: Sample,
    drawn: Floats | None,
    inputs: Sequence[Input],
    meta: Json,
    study: Json,
    context: core.RunContext,
) -> dict[str, Any]:
    values = table[name][sample.rows].astype(float)
    known = np.isfinite(values)
    variables = {key: column[known] for key, column in sample.variables.items()}
    weights = None if drawn is None else drawn[:, known]
    if weights is not None and not known.all():
        weights = weights[weights.sum(axis=1) > 0]
    figure = values[known]
    return {
        "count": int(known.sum()),
        "mean": float(figure.mean()),
        "deviation": float(figure.std(ddof=1)) if len(figure) > 1 else 0.0,
        "least": float(figure.min()),
        "greatest": float(figure.max()),
        "quantiles": {
            f"p{share_:02d}": float(np.percentile(figure, share_)) for share_ in (5, 50, 95)
        },
        "effects": effects.main_effects(variables, figure, weights),
        "regression": effects.regression(variables, figure, weights),
        "sobol": _indices(name, table, inputs, meta, study, context),
    }


def _indices(
    name: str,
    table: Table,
    inputs: Sequence[Input],
    meta: Json,
    study: Json,
    context: core.RunContext,
) -> dict[str, Any]:
    """Sobol indices of a figure, or why there are none: dict(method, variables, first, total, count, ...), or
    dict(reason: a fact)."""

    def none(code: str, text: str, **arguments: object) -> dict[str, Any]:
        return {"reason": fact_data(core.Fact(code, text, **arguments))}

    if study["correlations"]:
        return none(
            "studies.indices_of_correlated",
            "no Sobol indices: what varies is correlated, and they are defined for independent variables",
        )
    method = meta["method"]
    if method == "grid":
        return none(
            "studies.indices_of_grid",
            "no Sobol indices of a grid: take the design sobol_indices, or a random sample",
        )
    values = table[name].astype(float)
    good = table.done & np.isfinite(values)
    used = [one for one in inputs if one.varies]
    columns = np.column_stack([one.coded(table[one.name]) for one in used]) if used else None
    if columns is None or (len(used) < len(inputs) and method == "sobol_indices"):
        # OpenTURNS tells the blocks by the number of columns: a constant one has its block, too.
        used = list(inputs)
        columns = np.column_stack([one.coded(table[one.name]) for one in used])
    names = [one.name for one in used]
    if method == "sobol_indices":
        size = meta["size"]
        kept = sobol.whole_rows(good, size)
        at = np.flatnonzero(np.tile(kept, len(table) // size))
        found = sobol.of_blocks(
            columns[at], values[at], int(kept.sum()), second_order=meta["second_order"]
        )
        if found is None:
            return none(
                "studies.indices_of_few_blocks",
                "no Sobol indices: {count} of {size} rows of the blocks are whole, and {least} are needed",
                count=int(kept.sum()),
                size=size,
                least=sobol.LEAST,
            )
        return {
            "method": "blocks",
            "variables": names,
            "count": int(kept.sum()),
            "size": size,
            **found,
        }
    context.throw_if_cancelled()
    found = chaos.of_sample(columns[good], values[good], [one.law() for one in used])
    if found is None:
        return none(
            "studies.indices_of_few",
            "no Sobol indices: {count} runs are too few for {variables} variables; take {least} at least",
            count=int(good.sum()),
            variables=len(used),
            least=max(chaos.LEAST, chaos.RUNS_A_VARIABLE * len(used)),
        )
    found = {"method": "chaos", "variables": names, "count": int(good.sum()), **found}
    if found["first"] is None:
        found.update(
            none(
                "studies.indices_poor",
                "no Sobol indices: the polynomial chaos expansion predicts left-out runs with Q2 = {q2:.2f}, below "
                "{least:.1f} (a linear regression: {linear:.2f}); take more runs, or the design sobol_indices",
                q2=found["q2"],
                linear=found["linear_q2"],
                least=chaos.POOR,
            )
        )
    elif found["q2"] < chaos.DOUBTFUL:
        found["doubt"] = fact_data(
            core.Fact(
                "studies.indices_doubtful",
                "the polynomial chaos expansion leaves {rest:.3f} of the variance of left-out runs unexplained (Q2 = "
                "{q2:.3f}; a linear regression: {linear:.3f}): an index may be wrong by about that",
                rest=1.0 - found["q2"],
                q2=found["q2"],
                linear=found["linear_q2"],
            )
        )
    return found


def _best(
    wanted: Json, table: Table, inputs: Sequence[Input], study: Json, meta: Json
) -> dict[str, Any]:
    """The best run, as ``best.of_runs``, with its row's values; and what a response surface says, if it is asked."""
    numeric = _numeric(table, [one.name for one in inputs])
    figures = {name: table[name].astype(float) for name in numeric}
    good = table.done.copy()
    if wanted["passing"]:
        good &= table[OVERALL] == "pass"
    limits = {name: (low, high) for name, (low, high) in wanted["limits"].items()}
    figure, goal = wanted["figure"], wanted["goal"]
    found = best.of_runs(figures, figure, goal, limits, good)
    found.update(figure=figure, goal=goal, limits=wanted["limits"], passing=wanted["passing"])
    for row in (found["run"], (found["nearest"] or {}).get("run")):
        if row is not None:
            found["values"] = {one.name: _json(table[one.name][row]) for one in inputs}
            found["figures"] = {
                name: _json(figures[name][row]) for name in dict.fromkeys([figure, *limits])
            }
    number = table[RUN]
    found["ties"] = [int(number[row]) for row in found["ties"]]
    if found["run"] is not None:
        found["run"] = int(number[found["run"]])
    if found["nearest"]:
        found["nearest"]["run"] = int(number[found["nearest"]["run"]])
    if wanted["surface"]:
        found["surface"] = _surface(figures, figure, goal, limits, table, inputs)
    return found


def _surface(
    figures: Variables,
    figure: str,
    goal: str,
    limits: Limits,
    table: Table,
    inputs: Sequence[Input],
) -> dict[str, Any] | None:
    used = [one for one in inputs if one.varies]
    if not used:
        return None
    columns = np.column_stack([one.coded(table[one.name]) for one in used])
    said = best.suggested(
        columns, figures, figure, goal, limits, [one.law() for one in used], table.done
    )
    if said is None or "poor" in said:
        return said
    place = said.pop("inputs")
    values = {one.name: one.value(place[k]) for k, one in enumerate(used)}
    values.update({one.name: one.value(0.0) for one in inputs if not one.varies})
    return {**said, "values": values}


def _json(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not np.isfinite(value) else value
