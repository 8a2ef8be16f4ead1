"""The sections of a report that judge: verdict, tolerances, events, and how sure all that is."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Json
from ..base.messages import body, event_message, event_title, notes, sentence, warnings
from ..engine import core
from ..inspection import finish_zones
from ..job.poses import program_name
from . import charts, facts, verdict_section
from .convergence_section import convergence_part
from .layout import section, table
from .markup import element

if TYPE_CHECKING:
    from .content import Content
    from .language import Language
    from .markup import Markup

MOST_EVENTS = 500  # rows of the full table
MOST_PAIRS = 20  # of bodies, the nearest ones
SEVERITIES = ("error", "warning", "info")


def passed(content: Content) -> bool | None:
    """True, False, or None where it cannot be told."""
    verdict, summary = content.verdict, content.result.summary
    if verdict is not None:
        known = [one["verdict"] for one in [*verdict["faces"], *verdict["zones"]]]
        thick = [(zone["thickness"] or {}).get("verdict") for zone in verdict["zones"]]
        if "fail" in known or "fail" in thick:
            return False
        unsure = "unknown" in known or verdict["missed_rays"]
        return None if unsure else verdict["overall"] == "pass"
    out = summary["above_tolerance_area_share"] + summary["below_tolerance_area_share"]
    if out > 0.0:
        return False
    return None if summary["missed_rays"] else True


def head(content: Content, words: Language, scale: tuple[float, float, float]) -> Markup:
    """Title, verdict in one glance, and the figures that matter."""
    summary = content.result.summary
    deviation = summary["deviation_mm"]
    kind, text = state(content, words)
    share, above, below = _shares(content)
    said = [in_tolerance(content, words, scale)]
    if above > 0.0:
        said.append(
            words(
                "On {share} too much is left, at most {most} mm above the design.",
                share=words.percent(above),
                most=words.number(deviation["max"]),
            )
        )
    if below > 0.0:
        said.append(
            words(
                "On {share} it is cut too deep, at most {most} mm below the design.",
                share=words.percent(below),
                most=words.number(-deviation["min"]),
            )
        )
    if kind == "open" and (content.verdict or summary)["missed_rays"]:
        said.append(words("Over some of the area no stock was found, so nothing is known there."))
    tiles = [
        (words.percent(share), words("of the area in tolerance")),
        (f"{words.number(deviation['max'], 3, True)} mm", words("highest deviation")),
        (f"{words.number(deviation['min'], 3, True)} mm", words("lowest deviation")),
        (f"{words.number(summary['removed_volume_mm3'], 0)} mm³", words("removed")),
        (words.seconds(summary.get("process_time_s")), words("of robot time")),
        (words.whole(len(content.result.events)), words("events on the way")),
    ]
    return element(
        "header",
        element("p", words("Belt grinding report"), class_="kind"),
        element("h1", content.title),
        element(
            "div",
            element("strong", text),
            element("p", " ".join(said)),
            class_=f"verdict {kind}",
        ),
        [element("p", sentence(note, words.code), class_="note") for note in content.notes],
        element(
            "div",
            [
                element("div", element("b", value), element("span", label), class_="tile")
                for value, label in tiles
            ],
            class_="tiles",
        ),
    )


def state(content: Content, words: Language) -> tuple[str, str]:
    """("pass", "fail" or "open", the same in words); of a coarse run it says so."""
    kind, text = {
        True: ("pass", words("In tolerance")),
        False: ("fail", words("Not in tolerance")),
        None: ("open", words("Cannot be told")),
    }[passed(content)]
    if content.verdict is not None and finish_zones.decides(content.verdict):
        text = {
            "fail": words("In tolerance, but the finish of a zone is not as called for"),
            "open": words("In tolerance, but the finish of a zone is not known"),
        }[kind]
    if content.result.summary.get("resolution") == "coarse":
        text = words("{verdict} (coarse resolution, for searching)", verdict=text)
    return kind, text


def in_tolerance(content: Content, words: Language, scale: tuple[float, float, float]) -> str:
    """A sentence on the share of the area that is good."""
    zones = bool(content.result.job["inspection"].get("zones"))
    return words(
        "After this grind {share} of the ground area keeps within {band}.",
        share=words.percent(_shares(content)[0]),
        band=words("the limits of its zone") if zones else words.band(*scale[:2]),
    )


def _shares(content: Content) -> tuple[float, ...]:
    """Shares of the inspected area: good, above and below, by the zones' limits where there are any."""
    verdict, summary = content.verdict, content.result.summary
    if verdict is not None:
        return verdict["in_share"], verdict["above_share"], verdict["below_share"]
    return tuple(summary[f"{side}_tolerance_area_share"] for side in ("in", "above", "below"))


def spot(found: Json, verdict: Json | None, words: Language) -> str:
    """A few words on a worst spot."""
    beyond = f"{words.number(max(found['beyond'], 0.0))} mm"
    value = words.number(found["deviation"], 3, True)
    if found["deviation"] > 0:
        text = words("{mm} mm, {beyond} too much left", mm=value, beyond=beyond)
    else:
        text = words("{mm} mm, cut {beyond} too deep", mm=value, beyond=beyond)
    text += f"; Face{found['face']}, ({verdict_section.place(found['point'], words)}) mm"
    if "cluster" in found:
        text += f"; {words.number(found['cluster']['area_mm2'], 1)} mm²"
        motions = found["cluster"]["motions"][:1]
        if motions and motions[0]["line"]:
            text += ", " + words("line {line}", line=motions[0]["line"])
    return text


def tolerance(
    content: Content, words: Language, scale: tuple[float, float, float]
) -> Markup | None:
    """Tolerances per face or zone, clusters, and the histogram."""
    chart = charts.histogram(content.result.field, scale, words)
    caption = words(
        "How much of the ground area lies how far from the design. Green bars are in tolerance. The "
        "scale upwards is that of the square root, so that small shares are seen."
    )
    verdict = content.verdict
    tables = _by_face(content, words, scale)
    if verdict is not None:
        zones, faces = verdict_section.zones(verdict, words), verdict_section.faces(verdict, words)
        sections = verdict_section.sections(verdict, words)
        tables = [zones, element("h3", words("By face")) if zones else None, faces, sections]
    return section(
        words("Tolerance"),
        *tables,
        element("figure", chart, element("figcaption", caption), class_="wide") if chart else None,
        verdict_section.clusters(verdict, words) if verdict is not None else None,
    )


def _by_face(content: Content, words: Language, scale: tuple[float, float, float]) -> Markup:
    """The table of faces."""
    lower, upper, _ = scale
    found = faces_of(content.result.field, lower, upper)
    rows = [
        (
            f"Face{one['face']}",
            words.band(lower, upper),
            words.number(one["area"], 1),
            words.percent(one["in"]),
            words.percent(one["above"]),
            words.percent(one["below"]),
            words.number(one["max"], 3, True),
            words.number(one["min"], 3, True),
            verdict_section.mark(
                "pass" if one["in"] == 1.0 and not one["missed"] else "fail", words
            ),
        )
        for one in found
    ]
    heads = [
        (words("Face"), ""),
        (words("Tolerance"), "number"),
        (words("Area, mm²"), "number"),
        (words("good"), "number"),
        (words("too much left"), "number"),
        (words("cut too deep"), "number"),
        (words("highest, mm"), "number"),
        (words("lowest, mm"), "number"),
        (words("Verdict"), ""),
    ]
    return [table(heads, rows, "list faces")]


def faces_of(field: core.HeightField, lower: Any, upper: Any) -> list[dict[str, Any]]:
    """List of dicts, one a face of the field: ``face`` (from 1), ``area`` (mm2), shares ``in``,
    ``above``, ``below`` of what was inspected, ``min`` and ``max`` (mm; None: nothing inspected),
    ``missed`` (samples).
    """
    found, areas = [], field.areas.astype(float)
    seen = (field.flags & core.MISSED) == 0
    for face in np.unique(field.faces):
        of = field.faces == face
        height, area = field.height[of & seen], areas[of & seen]
        whole = area.sum()
        above = float(area[height > upper].sum() / whole) if whole > 0.0 else None
        below = float(area[height < lower].sum() / whole) if whole > 0.0 else None
        bad = bool(len(height)) and bool(((height > upper) | (height < lower)).any())
        share = None if above is None else (1.0 - above - below if bad else 1.0)
        found.append(
            {
                "face": int(face) + 1,
                "area": float(areas[of].sum()),
                "in": share,
                "above": above,
                "below": below,
                "min": float(height.min()) if len(height) else None,
                "max": float(height.max()) if len(height) else None,
                "missed": int((of & ~seen).sum()),
            }
        )
    return found


def events(content: Content, words: Language) -> Markup | None:
    """What happens on the way, by kind; the first of each."""
    found = content.result.events
    if not found:
        text = words("Nothing out of the ordinary happens on the way.")
        return section(words("Events"), element("p", text), _clearances(content, words))
    counts = Counter(event["kind"] for event in found)
    first = {}
    for event in found:
        first.setdefault(event["kind"], event)
    order = sorted(counts, key=lambda kind: (_rank(first[kind]), -counts[kind], kind))
    rows = [
        (
            [
                _severity(first[kind], words),
                element("b", words(event_title(first[kind]))),
            ],
            words.whole(counts[kind]),
            where(first[kind], content.result.job, words),
            [
                _begun(event_message(first[kind], words.code)),
                _advice(first[kind], words),
            ],
        )
        for kind in order
    ]
    heads = [
        (words("What"), ""),
        (words("How often"), "number"),
        (words("First at"), ""),
        (words("The first of them"), ""),
    ]
    return section(words("Events"), table(heads, rows, "list events"), _clearances(content, words))


def _clearances(content: Content, words: Language) -> list[Markup] | None:
    """How near the cell's bodies come to each other; None where none were given."""
    found = content.result.summary.get("clearances")
    if not found:
        return None
    rows = [
        (
            " – ".join(words.short(body(name, words.code)) for name in pair["bodies"]),
            words.number(pair["distance_mm"], 1),
            where({**pair, "time": pair["time_s"]}, content.result.job, words),
        )
        for pair in found[:MOST_PAIRS]
    ]
    heads = [
        (words("Bodies"), ""),
        (words("Least distance, mm"), "number"),
        (words("Where"), ""),
    ]
    return [element("h3", words("Clearances")), table(heads, rows)]


def _begun(text: str) -> str:
    return text[:1].upper() + text[1:]


def _rank(event: Json) -> int:
    severity = event.get("severity", "warning")
    return SEVERITIES.index(severity) if severity in SEVERITIES else len(SEVERITIES)


def _severity(event: Json, words: Language) -> list[Markup | str] | None:
    """A dot in the severity's colour, told in words as well; nothing where it is not known."""
    severity = event.get("severity")
    if severity not in SEVERITIES:
        return None
    text = {
        "error": words("error"),
        "warning": words("warning"),
        "info": words("note"),
    }[severity]
    return [element("span", text, class_=f"severity {severity}"), " "]


def _advice(event: Json, words: Language) -> Markup | None:
    return element("p", words(event["advice"]), class_="advice") if event.get("advice") else None


def where(event: Json, job: Json, words: Language) -> str:
    """Program, pose, line and time of an event."""
    parts = []
    if len(job["programs"]) > 1:
        parts.append(words.short(Path(program_name(job, event["program"])).name))
    if event.get("line"):
        parts.append(words("line {line}", line=event["line"]))
    parts.append(words("pose {pose}", pose=event["pose"] + 1))
    parts.append(f"{words.number(event['time'], 2)} s")
    return ", ".join(parts)


def all_events(content: Content, words: Language) -> Markup | None:
    """The table of all events, at the report's end."""
    found = content.result.events
    if not found:
        return None
    rows = [
        (
            words.number(event["time"], 2),
            words.number(event.get("duration"), 2),
            words(event_title(event)),
            where_short(event, content.result.job, words),
            "" if event.get("face") is None else f"Face{event['face']}",
            _begun(event_message(event, words.code)),
        )
        for event in found[:MOST_EVENTS]
    ]
    heads = [
        (words("Time, s"), "number"),
        (words("Lasts, s"), "number"),
        (words("What"), ""),
        (words("Where in the program"), ""),
        (words("Face"), ""),
        (words("Message"), ""),
    ]
    left = len(found) - len(rows)
    note = words("{count} more stand in events.json.", count=words.whole(left)) if left else None
    return section(
        words("All events"),
        table(heads, rows, "list events"),
        element("p", note) if note else None,
        class_="all",
    )


def where_short(event: Json, job: Json, words: Language) -> str:
    """As ``where``, without the time."""
    return where(event, job, words).rpartition(", ")[0]


def trust(content: Content, words: Language) -> Markup | None:
    """How sure the result is: doubtful things, uncertainty, convergence, warnings."""
    result = content.result
    rows = [
        (
            element("b", words.whole(count), class_="bad" if count else "good"),
            what,
            meaning if count or count is None else "",
        )
        for what, count, meaning in facts.doubts(
            result.job, result.summary, result.events, content.verdict, words
        )
    ]
    heads = [
        (words("Count"), "number"),
        (words("Doubtful"), ""),
        (words("What it means"), ""),
    ]
    told = warnings(result.summary, words.code)
    if content.verdict is not None:
        told += notes(content.verdict, words.code)
    return section(
        words("How sure is that?"),
        element(
            "p",
            words("Everything that weakens the result is counted here, also where it is zero."),
        ),
        table(heads, rows, "list doubts"),
        element("ul", [element("li", text) for text in told], class_="warnings") if told else None,
        _uncertainty(result.summary, words),
        _cell_errors(result.summary, words),
        _convergence(content.convergence, words),
    )


def _cell_errors(summary: Json, words: Language) -> Markup | None:
    told = summary.get("cell_error_mm")
    if told is None:
        return None
    text = words(
        "The size of the contact's cells leaves heights open by {most} mm at most, mostly at edges; at 95 % of the "
        "ground area by less than {p95} mm. Whether {share} of it is in tolerance it may leave open.",
        most=words.number(told["max"]),
        p95=words.number(told["p95"]),
        share=words.percent(told["undecided_area_share"]),
    )
    return element("p", text)


def _uncertainty(summary: Json, words: Language) -> Markup:
    if "deviation_sd_mm" not in summary:
        text = words(
            "How far the true deviation may differ is not known: the law was not calibrated."
        )
        return element("p", text, class_="unknown")
    sd = summary["deviation_sd_mm"]
    text = words(
        "By the calibration's scatter the deviation has a standard deviation of {mean} mm on average; "
        "95 % of the area are surer than {p95} mm. Weighed by that, {share} of the area is expected in "
        "tolerance.",
        mean=words.number(sd["mean"]),
        p95=words.number(sd["p95"]),
        share=words.percent(summary["expected_in_tolerance_area_share"]),
    )
    return element("p", text)


def _convergence(convergence: Json | None, words: Language) -> list[Any]:
    head = element("h3", words("Are the settings fine enough?"))
    if convergence is None:
        text = words("This was not checked.")
        return [head, element("p", text, class_="unknown")]
    return [head, convergence_part(convergence, words)]
