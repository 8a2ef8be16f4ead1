"""The part of a report that shows a verdict: zones, faces, clusters and the motions that made them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json
from ..inspection import section_figures
from .layout import table
from .markup import element

if TYPE_CHECKING:
    from .language import Language
    from .markup import Markup

MOST_CLUSTERS = 15
MOST_MOTIONS = 3  # named of a cluster


def zones(verdict: Json, words: Language) -> list[Any] | None:
    """The table of tolerance zones, and of their thicknesses; None where the job has no zones."""
    found = [zone for zone in verdict["zones"] if zone["name"] is not None]
    if not found:
        return None
    heads = [
        (words("Zone"), "name"),
        (words("Tolerance"), "number"),
        (words("Faces"), ""),
        *_heads(words),
    ]
    rows = []
    for zone in verdict["zones"]:
        name = words("everywhere else") if zone["name"] is None else zone["name"]
        if zone.get("edge_radius_mm") is not None:
            radius = words.figures(zone["edge_radius_mm"])
            name += words(" (edges below {radius} mm radius)", radius=radius)
        rows.append(
            (
                name,
                words.band(*zone["tolerance_mm"]),
                ", ".join(str(face) for face in zone["faces"]),
                *_figures(zone, words),
            )
        )
    return [
        table(heads, rows, "list faces"),
        _thickness(found, words),
        _edges(found, words),
    ]


def faces(verdict: Json, words: Language) -> list[Any]:
    """The table of faces."""
    waves = [face.get("waviness") or {} for face in verdict["faces"]]
    shown = any(wave.get("along") or wave.get("across") for wave in waves)
    heads = [(words("Face"), ""), *_heads(words)]
    if shown:
        heads[-1:-1] = [(words("waves across / along the feed, µm"), "number")]
    rows = []
    for face, wave in zip(verdict["faces"], waves):
        row = [f"Face{face['face']}", *_figures(face, words)]
        if shown:
            row[-1:-1] = [" / ".join(_wave(wave.get(way), words) for way in ("across", "along"))]
        rows.append(row)
    note = words(
        "Waves: the greatest height Wt of what overlapping passes leave (ISO 21920-2), along profiles."
    )
    return [
        table(heads, rows, "list faces"),
        element("p", note, class_="small") if shown else None,
    ]


def _heads(words: Language) -> list[Any]:
    return [
        (words("Area, mm²"), "number"),
        (words("good"), "number"),
        (words("too much left"), "number"),
        (words("cut too deep"), "number"),
        (words("highest, mm"), "number"),
        (words("lowest, mm"), "number"),
        (words("Verdict"), ""),
    ]


def _figures(region: Json, words: Language) -> list[str]:
    deviation = region["deviation_mm"] or {"min": None, "max": None}
    return [
        words.number(region["area_mm2"], 1),
        words.percent(region["in_share"] if region["deviation_mm"] else None),
        words.percent(region["above_share"]),
        words.percent(region["below_share"]),
        words.number(deviation["max"], 3, True),
        words.number(deviation["min"], 3, True),
        mark(region["verdict"], words),
    ]


def mark(verdict: str, words: Language) -> Markup:
    """pass, fail or unknown as a coloured word."""
    text = {
        "pass": words("pass"),
        "fail": words("fail"),
        "unknown": words("not known"),
    }[verdict]
    return element("span", text, class_=f"mark {verdict}")


def _wave(wave: Json | None, words: Language) -> str:
    return words.number(1000.0 * wave["Wt_mm"], 1) if wave else words.number(None)


def _edges(found: Json, words: Language) -> list[Markup] | None:
    """The table of edge zones' profiles."""

    def span(figures: Json | None) -> str:
        if not figures:
            return "–"
        return f"{words.number(figures['min'], 3)} … {words.number(figures['max'], 3)}"

    rows = [
        (
            zone["name"],
            words.whole(zone["edge"]["sections"]),
            *(
                span(zone["edge"][name])
                for name in ("design_radius_mm", "radius_mm", "chord_loss_mm")
            ),
        )
        for zone in found
        if zone.get("edge")
    ]
    if not rows:
        return None
    heads = [
        (words("Zone"), ""),
        (words("Sections"), "number"),
        (words("design's radius, mm"), "number"),
        (words("radius left, mm"), "number"),
        (words("chord loss, mm"), "number"),
    ]
    return [element("h3", words("Edges")), table(heads, rows, "list faces")]


def _thickness(found: Json, words: Language) -> list[Markup] | None:
    rows = []
    for zone in found:
        thick = zone.get("thickness")
        if not thick:
            continue
        deviation = thick["deviation_mm"] or {"min": None, "max": None, "mean": None}
        rows.append(
            (
                zone["name"],
                words.band(*thick["tolerance_mm"]),
                words.number(deviation["mean"], 3, True),
                words.number(deviation["max"], 3, True),
                words.number(deviation["min"], 3, True),
                words.percent(thick["out_share"]),
                words.whole(thick["unmeasured"]),
                mark(thick["verdict"], words),
            )
        )
    if not rows:
        return None
    heads = [
        (words("Zone"), ""),
        (words("Thickness against the design"), "number"),
        (words("mean, mm"), "number"),
        (words("thickest, mm"), "number"),
        (words("thinnest, mm"), "number"),
        (words("out of tolerance"), "number"),
        (words("not measured"), "number"),
        (words("Verdict"), ""),
    ]
    return [element("h3", words("Thickness")), table(heads, rows, "list faces")]


def sections(verdict: Json, words: Language) -> list[Any] | None:
    """The tables of the job's sections: designed, before and after; None where it asks for none."""
    made: list[Any] = []
    states = {
        "round": words("round"),
        "sharp": words("sharp"),
        "not_round": words("not round"),
        "few_samples": words("too few samples"),
        "open": words("not all around"),
        "missed": words("stock missed"),
        "not_known": words("not known"),
    }
    what = {
        "chord_mm": words("chord"),
        "thickness_mm": words("greatest thickness"),
        "radius_mm": words("radius"),
        "thicknesses_mm": words("thickness at {distance} mm"),
    }
    edges = {"leading": words("leading edge"), "trailing": words("trailing edge")}
    heads = [
        (words("Figure"), ""),
        (words("designed, mm"), "number"),
        (words("before, mm"), "number"),
        (words("after, mm"), "number"),
    ]
    for one in verdict.get("sections", ()):
        rows = []
        for key, edge, distance, cells in section_figures.rows(one):
            name = what[key].format(distance=words.figures(distance))
            name = name if edge is None else f"{edges[edge]}: {name}"
            told = (words.number(c, 3) if isinstance(c, float) else states[c] for c in cells)
            rows.append((name, *told))
        made.append(element("h3", words("Section {name}", name=one["name"])))
        made.append(table(heads, rows, "list") if rows else element("p", words("not known")))
    return made or None


def finishes(verdict: Json, words: Language) -> Markup | None:
    """The table of what zones call for of the finish; None where none does."""
    rows = []
    for zone in verdict["zones"]:
        asked = zone.get("finish")
        if not asked:
            continue
        told, ra, lay = [], asked.get("Ra"), asked.get("lay")
        if ra:
            limit = words.figures(ra["limit_um"])
            told.append((f"Ra {limit} µm ({asked['acceptance']})", ra["above_share"], ra))
        if lay:
            told.append((words("lay {symbol}", symbol=lay["symbol"]), lay["off_share"], lay))
        for what, off, one in told:
            unknown = words.percent(one["unknown_share"], 1)
            verdict_of = mark(one["verdict"], words)
            rows.append((zone["name"], what, words.percent(off, 1), unknown, verdict_of))
    if not rows:
        return None
    heads = [
        (words("Zone"), ""),
        (words("Called for"), ""),
        (words("beyond"), "number"),
        (words("not known"), "number"),
        (words("Verdict"), ""),
    ]
    return table(heads, rows, "list faces")


def clusters(verdict: Json, words: Language) -> list[Any] | None:
    """The places out of tolerance, largest first, with the lines of the program that made them."""
    found = verdict["clusters"]
    if not found:
        return None
    rows = [
        (
            str(one["number"]),
            words("too much left") if one["side"] == "above" else words("cut too deep"),
            words.number(one["area_mm2"], 1),
            words.number(one["worst"]["value_mm"], 3, True),
            words.number(max(one["worst"]["beyond_mm"], 0.0), 3),
            ", ".join(str(face) for face in one["faces"]),
            place(one["worst"]["point_mm"], words),
            made_by(one, verdict["programs"], words),
        )
        for one in found[:MOST_CLUSTERS]
    ]
    heads = [
        ("", "number"),
        (words("What"), ""),
        (words("Area, mm²"), "number"),
        (words("worst, mm"), "number"),
        (words("beyond, mm"), "number"),
        (words("Faces"), ""),
        (words("Worst at x, y, z, mm"), "place"),
        (words("By which motions"), ""),
    ]
    whole = verdict["clusters_in_all"]
    count = sum(side["count"] for side in whole.values())
    left = count - len(rows)
    note = words("{count} smaller ones stand in verdict.json.", count=words.whole(left))
    intro = words(
        "Connected areas out of tolerance, the largest first. The share is that of the area which the "
        "motion to that line made."
    )
    return [
        element("h3", words("Where it is out of tolerance")),
        element("p", intro, class_="small"),
        table(heads, rows, "list clusters"),
        element("p", note, class_="small") if left > 0 else None,
    ]


def place(point: Sequence[float], words: Language) -> str:
    """A point, mm."""
    return ", ".join(words.number(value, 1) for value in point)


def made_by(cluster: Json, programs: Sequence[Json], words: Language) -> str:
    """The motions that made a cluster, in a few words."""
    parts = []
    untouched = cluster["untouched_share"]
    if untouched:
        parts.append(words("{share} never touched", share=words.percent(untouched, 0)))
    for motion in cluster["motions"][:MOST_MOTIONS]:
        if motion["program"] is None:
            text = words("motion {number}", number=motion["motion"] + 1)
        elif motion["line"]:
            text = words("line {line}", line=motion["line"])
        else:
            text = words("pose {pose}", pose=motion["pose"] + 1)
        if motion["program"] is not None and len(programs) > 1:
            name = words.short(Path(programs[motion["program"]]["name"]).name)
            text = f"{name}, {text}"
        parts.append(f"{text} ({words.percent(motion['share'], 0)})")
    left = cluster["motion_count"] - min(len(cluster["motions"]), MOST_MOTIONS)
    if left > 0:
        parts.append(words("{count} more", count=words.whole(left)))
    return "; ".join(parts) or words("not known")
