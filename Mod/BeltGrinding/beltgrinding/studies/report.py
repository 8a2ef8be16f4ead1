"""The report of a study: its answers and their pictures in one HTML file, and beside it as files."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.files import cannot_be_written, json_bytes, write_whole
from ..base.kinds import Context, Json
from ..base.messages import sentence
from ..base.resources import resources
from ..engine import core
from ..reporting.facts import part_name
from ..reporting.language import DASH, Language
from ..reporting.layout import facts, section, table as html_table, whole_page
from ..reporting.markup import data_uri, element
from . import answers as answering, charts, checking, names
from .making import Study

if TYPE_CHECKING:
    from .kinds import Pictures
    from .table import Table

ANSWERS = "answers.json"
REPORT = "report.html"
PICTURES = "pictures"
PRINT_DPI = 130
MOST_PAIRS = 15
METHODS = {
    "grid": "grid: every value with every other",
    "latin_hypercube": "Latin hypercube",
    "sobol": "Sobol sequence",
    "monte_carlo": "Monte Carlo",
    "sobol_indices": "blocks for Sobol indices",
}


def write_answers(
    folder: Path | str, language: str = "en", context: Context = None, study: Study | None = None
) -> dict[str, Any]:
    """Writes a study's answers into its folder: answers.json, report.html and pictures/*.png. ``language``: "en" or "de";
    ``study``: the ``Study`` of the folder, read from it if None. Returns the answers. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    folder = Path(folder)
    study = study or Study.read(folder)
    words = Language(language)
    found = answering.answers(study.study, study.design, study.table, context)
    checking.check(found, study.study, context)
    pictures = draw(found, study.table, words, PRINT_DPI, context)
    files = {
        folder / ANSWERS: json_bytes(found),
        folder / REPORT: document(found, study.study, pictures, words).encode(),
        **{folder / PICTURES / name: data for name, data in pictures.items()},
    }
    try:
        (folder / PICTURES).mkdir(parents=True, exist_ok=True)
        for path, data in files.items():
            write_whole(path, data)
    except OSError as error:
        raise cannot_be_written(error.filename or folder, error) from None
    return found


def draw(
    found: Json, table: Table, words: Language, dpi: float = PRINT_DPI, context: Context = None
) -> dict[str, bytes]:
    """{file name: bytes of a PNG}: yield.png, matrix.png and of each figure FIGURE-tornado.png, -effects.png,
    -scatter.png, -sobol.png, as far as there is something to draw."""
    made: dict[str, bytes] = {}
    kinds = ("tornado", "effects", "scatter", "sobol")
    wanted: list[tuple[str, str, str | None]] = [("yield", "yield", None)]
    for name in found["figures"]:
        wanted += [(f"{file_stem(name)}-{kind}", kind, name) for kind in kinds]
    for stem, kind, name in [*wanted, ("matrix", "matrix", None)]:
        if context is not None:
            context.throw_if_cancelled()
        content = one(found, table, kind, name, words, dpi)
        if content is not None:
            made[f"{stem}.png"] = content
    return made


def one(
    found: Json, table: Table, kind: str, name: str | None, words: Language, dpi: float = PRINT_DPI
) -> bytes | None:
    """Bytes of a PNG: a chart ("yield", "matrix"; "tornado", "effects", "scatter", "sobol" of the figure ``name``) of the
    answers; None where there is nothing to draw."""
    done = np.flatnonzero(table.done)
    verdicts = table[answering.OVERALL][done] if answering.OVERALL in table.columns else None
    variables = {key: answering.plain(table[key][done]) for key in found["varied"]}
    if kind == "yield":
        rows = [(names.yielded(each, words), each) for each in found["yield"]]
        return charts.yields(rows, words, dpi) if rows else None
    if kind == "matrix":
        first = list(found["figures"])[:2]
        columns = dict(list(variables.items())[: charts.MOST_IN_MATRIX - len(first)])
        columns.update({names.figure(n, words): table[n][done].astype(float) for n in first})
        return charts.matrix(columns, verdicts, words, dpi) if len(columns) > 1 else None
    if name is None:
        return None
    told, text = found["figures"][name], names.figure(name, words)
    if kind == "scatter":
        values = table[name][done].astype(float)
        return charts.scatter(variables, values, verdicts, text, words, dpi)
    if kind == "sobol":
        if not told["sobol"].get("first"):
            return None
        return charts.indices(told["sobol"], told["sobol"]["variables"], text, words, dpi)
    drawn = charts.tornado if kind == "tornado" else charts.effects
    return drawn(told["effects"], told["mean"], text, words, dpi)


def file_stem(name: str) -> str:
    """A figure's name as the beginning of a file's."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name)


def document(found: Json, study: Json, pictures: Pictures, words: Language) -> str:
    """The whole HTML text. ``study``: with its job; ``pictures``: of ``draw``."""
    title = words("Belt grinding: study of {part}", part=part_name(study["job"]))
    style = (resources() / "report" / "report.css").read_text(encoding="utf-8")
    style += (resources() / "report" / "study.css").read_text(encoding="utf-8")
    body = [
        _head(found, title, words),
        _yield(found, pictures, words),
        _best(found, words),
        *(_figure(name, one, pictures, words) for name, one in found["figures"].items()),
        _matrix(pictures, words),
        _runs(found, study, words),
        _failed(found, words),
    ]
    return whole_page(title, style, element("main", body), words.code)


def _head(found: Json, title: str, words: Language) -> list[Any]:
    runs, whole = found["runs"], next((o for o in found["yield"] if o["of"] == "overall"), None)
    tiles = [
        (words.whole(runs["done"]), words("runs with figures")),
        (words.whole(runs["failed"]), words("runs that could not be run")),
    ]
    if whole is not None:
        text = words.percent(whole["share"])
        if whole["low"] is not None:
            text += f" ({words.percent(whole['low'])} … {words.percent(whole['high'])})"
            told = words("of the parts pass; in brackets the 95 % interval")
        else:
            told = words("of the runs pass; not a probability")
        tiles.insert(0, (text, told))
    shown = [element("div", element("b", a), element("span", b), class_="tile") for a, b in tiles]
    notes = [element("p", sentence(n, words.code), class_="note") for n in found["note_facts"]]
    return [
        element("p", words("Study of a belt-grinding job"), class_="kind"),
        element("h1", title),
        element("div", shown, class_="tiles"),
        notes,
    ]


def _picture(pictures: Pictures, name: str, alt: str) -> Any:
    if name not in pictures:
        return None
    return element("img", src=data_uri(pictures[name], "image/png"), alt=alt)


def _yield(found: Json, pictures: Pictures, words: Language) -> Any:
    if not found["yield"]:
        return None
    rows = [
        [
            names.yielded(one, words),
            words.whole(one["passed"]),
            words.whole(one["failed"]),
            words.whole(one["unknown"]),
            words.percent(one["share"]),
            _interval(one, words.percent),
        ]
        for one in found["yield"]
    ]
    heads = [
        ("", "name"),
        (words("passed"), "number"),
        (words("failed"), "number"),
        (words("not known"), "number"),
        (words("share"), "number"),
        (words("95 % interval"), "number"),
    ]
    about = words(
        "The interval is Wilson's, for independent runs. A run whose verdict is not known has not passed."
    )
    return section(
        words("Tolerance yield"),
        _picture(pictures, "yield.png", words("Tolerance yield")),
        html_table(heads, rows),
        element("p", about, class_="small"),
    )


def _interval(
    one: Json, shown: Callable[[float], str], low: str = "low", high: str = "high"
) -> str:
    if one[low] is None:
        return DASH
    return f"{shown(one[low])} … {shown(one[high])}"


def _best(found: Json, words: Language) -> Any:
    best = found.get("best")
    if best is None:
        return None
    goal = words("least") if best["goal"] == "minimise" else words("greatest")
    name = names.figure(best["figure"], words)
    said = [element("p", words("Wanted is the {goal} value of: {figure}.", goal=goal, figure=name))]
    if best["passing"]:
        said.append(element("p", words("Only runs that pass are looked at.")))
    limits = [
        (names.figure(key, words), f"{_end(low, words)} … {_end(high, words)}")
        for key, (low, high) in best["limits"].items()
    ]
    if limits:
        said.append(facts([(words("limit: {figure}", figure=key), text) for key, text in limits]))
    if best["run"] is not None:
        told = words(
            "Run {run} is the best of {feasible} runs that keep all limits, of {judged}: {value}.",
            run=best["run"],
            feasible=best["feasible"],
            judged=best["judged"],
            value=words.figures(best["value"]),
        )
        said.append(element("p", element("b", told)))
        if best["ties"]:
            ties = ", ".join(str(run) for run in best["ties"][:20])
            said.append(element("p", words("As good are the runs {runs}.", runs=ties)))
    elif best["nearest"] is not None:
        beyond = ", ".join(
            f"{names.figure(key, words)}: {words.figures(far, 3)}"
            for key, far in best["nearest"]["beyond"].items()
        )
        told = words(
            "None of {judged} runs keeps all limits. The nearest is run {run}; it is beyond them by: {beyond}.",
            judged=best["judged"],
            run=best["nearest"]["run"],
            beyond=beyond,
        )
        said.append(element("p", element("b", told)))
    else:
        said.append(element("p", element("b", words("There is no run to choose from."))))
    if "values" in best:
        rows = [(key, _text(value, words)) for key, value in best["values"].items()]
        rows += [
            (names.figure(key, words), words.figures(value))
            for key, value in best["figures"].items()
        ]
        said.append(facts(rows))
    return section(words("The best setting"), said, _surface(best, words))


def _surface(best: Json, words: Language) -> Any:
    if "surface" not in best:
        return None
    said = best["surface"]
    if said is None:
        return element("p", words("There are too few runs for a response surface."), class_="note")
    told = "; ".join(
        words(
            "{figure}: Q2 {chaos} by polynomial chaos, {linear} by linear regression",
            figure=names.figure(key, words),
            chaos=words.number(a, 3),
            linear=words.number(b, 3),
        )
        for key, (a, b) in said["q2"].items()
    )
    quality = element("p", words("On runs that were left out: {told}.", told=told), class_="small")
    if "poor" in said:
        text = words("The response surface predicts left-out runs too badly to be followed.")
        return [element("p", text, class_="note"), quality]
    rows = [(key, _text(value, words)) for key, value in said["values"].items()]
    for key, value in said["predicted"].items():
        name = names.figure(key, words)
        rows.append((words("predicted: {figure}", figure=name), words.figures(value)))
        if said.get("checked", {}).get(key) is not None:
            text = words("simulated: {figure}", figure=name)
            rows.append((text, words.figures(said["checked"][key])))
    text = words("Between the runs, the response surface suggests this; run it as a check.")
    if "checked" in said and said["checked_feasible"]:
        text = words(
            "Between the runs, the response surface suggests this; it was run, and keeps all limits."
        )
    elif "checked" in said:
        text = words(
            "Between the runs, the response surface suggests this; it was run, and does not keep all limits."
        )
    elif not said["feasible"]:
        text = words(
            "The response surface keeps all limits nowhere; this comes nearest. Run it as a check."
        )
    failed = None
    if "check_failed" in said:
        told_ = words("It could not be run: {why}", why=said["check_failed"])
        failed = element("p", told_, class_="note")
    return [
        element("h3", words("Between the runs")),
        element("p", text),
        failed,
        facts(rows),
        quality,
    ]


def _end(value: float | None, words: Language) -> str:
    return DASH if value is None else words.figures(value)


def _text(value: Any, words: Language) -> str:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return words.figures(value, 5) if number else str(value)


def _figure(name: str, one: Json, pictures: Pictures, words: Language) -> Any:
    stem, text = file_stem(name), names.figure(name, words)
    heads = [
        (words("what varies"), "name"),
        (words("first to last level"), "number"),
        (words("95 % interval"), "number"),
        (words("all levels"), "number"),
        (words("standardised coefficient"), "number"),
        (words("95 % interval"), "number"),
    ]
    slopes = {}
    if one["regression"] is not None:
        slopes = {row["variable"]: row for row in one["regression"]["rows"]}
    shown = lambda value: words.figures(value, 3)  # noqa: E731
    rows = []
    for effect in sorted(one["effects"], key=lambda e: -e["range"]):
        slope = slopes.get(effect["variable"])
        rows.append(
            [
                effect["variable"],
                shown(effect["swing"]),
                _interval(effect, shown),
                shown(effect["range"]),
                DASH if slope is None else shown(slope["coefficient"]),
                DASH if slope is None else _interval(slope, shown),
            ]
        )
    spread = words(
        "Mean {mean}, standard deviation {deviation}; 5th, 50th, 95th percentile {p05}, {p50}, {p95}; of {count} runs.",
        mean=words.figures(one["mean"]),
        deviation=shown(one["deviation"]),
        count=one["count"],
        **{key: words.figures(value) for key, value in one["quantiles"].items()},
    )
    linear = None
    if one["regression"] is not None:
        share = words.number(one["regression"]["r2"], 3)
        text_ = words("The linear regression explains R² = {share} of the variance.", share=share)
        linear = element("p", text_, class_="small")
    return section(
        text,
        element("p", spread),
        _picture(pictures, f"{stem}-tornado.png", words("Tornado chart")),
        html_table(heads, rows),
        linear,
        element("h3", words("Mean over each variable")),
        _picture(pictures, f"{stem}-effects.png", words("Main effects")),
        element("h3", words("Sobol indices")),
        _sobol(one["sobol"], stem, pictures, words),
        element("h3", words("All runs")),
        _picture(pictures, f"{stem}-scatter.png", words("Scatter charts")),
    )


def _sobol(found: Json, stem: str, pictures: Pictures, words: Language) -> list[Any]:
    said = []
    for key in ("reason", "doubt"):
        if key in found:
            said.append(element("p", sentence(found[key], words.code), class_="note"))
    if not found.get("first"):
        return said
    said.append(_picture(pictures, f"{stem}-sobol.png", words("Sobol indices")))
    number = lambda value: words.number(value, 3)  # noqa: E731
    rows = [
        [name, number(a[0]), f"{number(a[1])} … {number(a[2])}", number(b[0]), f"{number(b[1])} … {number(b[2])}"]
        for name, a, b in zip(found["variables"], found["first"], found["total"])
    ]  # fmt: skip
    heads = [
        (words("what varies"), "name"),
        (words("alone (first order)"), "number"),
        (words("95 % interval"), "number"),
        (words("with the others (total)"), "number"),
        (words("95 % interval"), "number"),
    ]
    said.append(html_table(heads, rows))
    if "second" in found:
        said.append(_pairs(found, words))
    if found["method"] == "blocks":
        text = words(
            "By Martinez' estimator from {count} of {size} rows of the design's blocks.",
            count=found["count"],
            size=found["size"],
        )
    else:
        text = words(
            "By a polynomial chaos expansion of {terms} terms from {count} runs. Of runs that were left out it predicts Q2 "
            "= {q2} of the variance, a linear regression {linear}.",
            terms=found["terms"],
            count=found["count"],
            q2=words.number(found["q2"], 4),
            linear=words.number(found["linear_q2"], 4),
        )
    said.append(element("p", text, class_="small"))
    return said


def _pairs(found: Json, words: Language) -> Any:
    """Indices of the second order, the largest first."""
    named = found["variables"]
    pairs = [(i, j) for i in range(len(named)) for j in range(i)]
    pairs.sort(key=lambda pair: -found["second"][pair[0]][pair[1]])
    rows = [
        [f"{named[j]} × {named[i]}", words.number(found["second"][i][j], 3)]
        for i, j in pairs[:MOST_PAIRS]
    ]
    heads = [(words("two together"), "name"), (words("beyond each alone"), "number")]
    return html_table(heads, rows)


def _matrix(pictures: Pictures, words: Language) -> Any:
    picture = _picture(pictures, "matrix.png", words("Each against each other"))
    return None if picture is None else section(words("Each against each other"), picture)


def _runs(found: Json, study: Json, words: Language) -> Any:
    rows = []
    for one in study["vary"]:
        name = one.get("name", one["key"])
        hows = {"set": "set to", "add": "plus", "multiply": "times"}
        how = words(hows[one.get("how", "set")])
        rows.append([name, one["key"], how, _given(one, words)])
    heads = [
        (words("what varies"), "name"),
        (words("key of the job"), ""),
        (words("how"), ""),
        (words("values"), ""),
    ]
    design = [
        (words("design of the runs"), words(METHODS[found["design"]["method"]])),
        (words("runs"), words.whole(found["runs"]["all"])),
        (words("seed"), str(found["design"]["seed"])),
    ]
    return section(words("What was run"), facts(design), html_table(heads, rows))


def _given(one: Json, words: Language) -> str:
    if "parts" in one:
        return words("{count} parts", count=len(one["parts"]))
    if "values" in one:
        return ", ".join(_text(value, words) for value in one["values"][:12]) + (
            ", …" if len(one["values"]) > 12 else ""
        )
    if "range" in one:
        return f"{_text(one['range'][0], words)} … {_text(one['range'][1], words)}"
    given = one["distribution"]
    values = ", ".join(f"{key} {_text(v, words)}" for key, v in given.items() if key != "kind")
    return f"{given['kind']}: {values}"


def _failed(found: Json, words: Language) -> Any:
    if not found["runs"]["errors"]:
        return None
    rows = [
        [words.whole(one["count"]), str(one["run"]), one["text"]] for one in found["runs"]["errors"]
    ]
    heads = [
        (words("runs"), "number"),
        (words("the first is run"), "number"),
        (words("why, in English"), "name"),
    ]
    return section(words("Runs that could not be run"), html_table(heads, rows))
