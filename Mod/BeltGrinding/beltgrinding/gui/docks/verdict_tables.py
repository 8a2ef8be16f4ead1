"""What the verdict's dock writes into its tables and labels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ...inspection import finish_zones, section_figures
from ...objects.preferences import deviation_unit
from ..common.compat import QtGui, translate
from ..common.figures import figure, length_number
from ..common.kinds import Colour, FaceName, Json, Table
from ..common.messages import note_texts
from ..common.theme import theme
from ..common.verdict_words import shares


def table(name: str, titles: Sequence[str]) -> Table:
    """An empty table whose rows are chosen as a whole."""
    made = QtGui.QTableWidget(0, len(titles))
    made.setObjectName(name)
    made.setHorizontalHeaderLabels(titles)
    made.verticalHeader().hide()
    made.verticalHeader().setDefaultSectionSize(20)
    made.horizontalHeader().setStretchLastSection(True)
    made.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
    made.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
    made.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
    made.setWordWrap(False)
    return made


def fill(made: Table, rows: Sequence[Any]) -> None:
    """Puts rows (texts, colour or None) into a table."""
    made.blockSignals(True)
    made.setRowCount(len(rows))
    for i, (texts, colour) in enumerate(rows):
        for k, text in enumerate(texts):
            item = QtGui.QTableWidgetItem(text)
            item.setToolTip(text)
            if colour is not None:
                item.setForeground(colour)
            made.setItem(i, k, item)
    made.setCurrentCell(-1, -1)
    made.resizeColumnsToContents()
    made.blockSignals(False)


def word(verdict: str) -> str:
    """A verdict in the user's language."""
    return {
        "pass": translate("BeltGrinding", "pass"),
        "fail": translate("BeltGrinding", "fail"),
        "unknown": translate("BeltGrinding", "unknown"),
    }[verdict]


def doubts(found: Json) -> str:
    """What the user must know besides, a line each."""
    lines = [
        shares(found),
        translate(
            "BeltGrinding",
            "Removed {:,.1f} mm³, too much left {:,.1f} mm³, cut too deep {:,.1f} mm³",
        ).format(
            found["removed_volume_mm3"], found["excess_volume_mm3"], found["gouge_volume_mm3"]
        ),
    ]
    if found["untouched_area_mm2"] is not None:
        lines.append(
            translate("BeltGrinding", "Never touched: {:,.1f} of {:,.1f} mm²").format(
                found["untouched_area_mm2"], found["area_mm2"]
            )
        )
    counts = (
        (translate("BeltGrinding", "missed rays"), found["missed_rays"]),
        (translate("BeltGrinding", "samples with defective stock"), found["defective_samples"]),
        (
            translate("BeltGrinding", "events outside of the law's range"),
            found["extrapolated_law_events"],
        ),
        (translate("BeltGrinding", "contacts not converged"), found["not_converged_events"]),
        (
            translate("BeltGrinding", "places of the programs not resolved"),
            found["unresolved_motions"] or 0,
        ),
    )
    told = ", ".join(f"{count} {what}" for what, count in counts)
    lines.append(translate("BeltGrinding", "In doubt") + f": {told}")
    return "\n".join([*lines, *note_texts(found)])


class _Rows:
    """A function that makes rows, and the titles of their columns, which wait for the language."""

    def __init__(self, make: Callable[..., list[Any]], titles: Callable[[], list[str]]) -> None:
        self.make, self.titles = make, titles

    def __call__(self, *arguments: Any) -> list[Any]:
        return self.make(*arguments)


def _in_unit(title: str) -> str:
    """Return a column's title with the unit of deviations."""
    return title.format(deviation_unit().symbol)


def _region_titles() -> list[str]:
    return [
        translate("BeltGrinding", "Where"),
        translate("BeltGrinding", "Verdict"),
        translate("BeltGrinding", "In, %"),
        translate("BeltGrinding", "Left, %"),
        translate("BeltGrinding", "Deep, %"),
        _in_unit(translate("BeltGrinding", "Worst, {}")),
        _in_unit(translate("BeltGrinding", "Beyond, {}")),
        _in_unit(translate("BeltGrinding", "Waves Wt, {}")),
    ]


def _colour(verdict: str) -> Colour:
    look = theme()
    colour = {"pass": None, "fail": look.warning, "unknown": look.doubt}[verdict]
    return None if colour is None else QtGui.QColor(colour)


def _regions(found: Json, face_name: FaceName) -> list[Any]:
    """[(region, texts, colour)] of the zones, their thickness, and the faces."""
    rows = []
    for zone in found["zones"]:
        name = zone["name"]
        if name is None:
            if len(found["zones"]) == 1:
                continue  # there are no zones: the faces say it all
            name = translate("BeltGrinding", "elsewhere")
        # A zone may fail by its thickness or its finish alone, which have rows of their own.
        verdict = finish_zones.heights(zone)
        rows.append((zone, [name, word(verdict), *_figures(zone), ""], _colour(verdict)))
        thick = zone["thickness"]
        if thick is not None:
            title = translate("BeltGrinding", "{}: thickness").format(name)
            rows.append((thick, [title, *_thickness(thick)], _colour(thick["verdict"])))
        rows += _finish(name, zone.get("finish") or {})
    for face in found["faces"]:
        wave = face["waviness"]
        told = [
            length_number(wave[name]["Wt_mm"], 1, "") if wave[name] else "–"
            for name in ("along", "across")
        ]
        texts = [face_name(face["face"]), word(face["verdict"]), *_figures(face)]
        rows.append((face, [*texts, " / ".join(told)], _colour(face["verdict"])))
    return rows


def _finish(name: str, finish: Json) -> list[Any]:
    """[(region, texts, colour)] of what a zone calls for of its finish."""
    titles = {
        "Ra": translate("BeltGrinding", "{}: roughness").format(name),
        "lay": translate("BeltGrinding", "{}: lay").format(name),
    }
    rows = []
    for what, beyond in (("Ra", "above_share"), ("lay", "off_share")):
        one = finish.get(what)
        if one is None:
            continue
        worst = one.get("worst")
        good = 1.0 - one[beyond] - one["unknown_share"]
        texts = [
            titles[what],
            word(one["verdict"]),
            figure(100 * max(good, 0.0), ".2f"),
            "",
            "",
            "",
            "",
            "",
        ]
        if what == "Ra" and worst is not None:
            texts[5] = f"{figure(worst['Ra_um'], '.2f')} µm"
            texts[6] = f"{figure(worst['Ra_um'] - one['limit_um'], '+.2f')} µm"
        place = worst or (one.get("unknown") or {}).get("place")
        rows.append(({"worst": place}, texts, _colour(one["verdict"])))
    return rows


def _figures(region: Json) -> list[str]:
    if region["worst"] is None:
        return [""] * 5
    worst = region["worst"]
    shares = [
        f"{figure(100 * region[f'{name}_share'], '.2f')}" for name in ("in", "above", "below")
    ]
    return [
        *shares,
        length_number(worst["value_mm"]),
        length_number(worst["beyond_mm"]),
    ]


def _thickness(thick: Json) -> list[str]:
    if thick["worst"] is None:
        return [word(thick["verdict"]), *[""] * 6]
    worst = thick["worst"]
    share = figure(100 * (1 - thick["out_share"]), ".2f")
    value, beyond = length_number(worst["value_mm"]), length_number(worst["beyond_mm"])
    return [word(thick["verdict"]), share, "", "", value, beyond, ""]


def _section_titles() -> list[str]:
    return [
        translate("BeltGrinding", "Figure"),
        translate("BeltGrinding", "Designed, mm"),
        translate("BeltGrinding", "Before, mm"),
        translate("BeltGrinding", "After, mm"),
    ]


def _sections(found: Json) -> list[Any]:
    """[(texts, None)] of the sections that the job asks for."""
    states = {
        "round": translate("BeltGrinding", "round"),
        "sharp": translate("BeltGrinding", "sharp"),
        "not_round": translate("BeltGrinding", "not round"),
        "few_samples": translate("BeltGrinding", "too few samples"),
        "open": translate("BeltGrinding", "not all around"),
        "missed": translate("BeltGrinding", "stock missed"),
        "not_known": translate("BeltGrinding", "not known"),
    }
    what = {
        "chord_mm": translate("BeltGrinding", "chord"),
        "thickness_mm": translate("BeltGrinding", "greatest thickness"),
        "radius_mm": translate("BeltGrinding", "radius"),
        "thicknesses_mm": translate("BeltGrinding", "thickness at {} mm"),
    }
    edges = {
        None: "",
        "leading": translate("BeltGrinding", "leading edge") + ", ",
        "trailing": translate("BeltGrinding", "trailing edge") + ", ",
    }
    rows: list[Any] = []
    for one in found.get("sections", ()):
        shown = list(section_figures.rows(one)) or [("chord_mm", None, None, ["not_known"] * 3)]
        for key, edge, distance, cells in shown:
            name = what[key].format(figure(distance or 0.0, "g"))
            told = [figure(c, ".3f") if isinstance(c, float) else states[c] for c in cells]
            rows.append(([f"{one['name']}: {edges[edge]}{name}", *told], None))
    return rows


def _cluster_titles() -> list[str]:
    return [
        "",
        translate("BeltGrinding", "What"),
        translate("BeltGrinding", "Area, mm²"),
        _in_unit(translate("BeltGrinding", "Worst, {}")),
        translate("BeltGrinding", "Size, mm"),
        translate("BeltGrinding", "Line"),
        translate("BeltGrinding", "Faces"),
    ]


def _clusters(found: Json, face_name: FaceName) -> list[Any]:
    """[(texts, None)] of the clusters, largest first."""
    sides = {
        "above": translate("BeltGrinding", "too much left"),
        "below": translate("BeltGrinding", "cut too deep"),
    }
    rows = []
    for cluster in found["clusters"]:
        first = cluster["motions"][0] if cluster["motions"] else None
        line = ""
        if (cluster["untouched_share"] or 0.0) > 0.5:
            line = translate("BeltGrinding", "never touched")
        elif first is not None:
            line = str(first["line"] or "")
        rows.append(
            (
                [
                    str(cluster["number"]),
                    sides[cluster["side"]],
                    figure(cluster["area_mm2"], ".2f"),
                    length_number(cluster["worst"]["value_mm"]),
                    f"{figure(cluster['extent_mm'], '.1f')} × {figure(cluster['width_mm'], '.1f')}",
                    line,
                    ", ".join(face_name(face) for face in cluster["faces"]),
                ],
                None,
            )
        )
    return rows


def _motion_titles() -> list[str]:
    return [
        translate("BeltGrinding", "Share, %"),
        translate("BeltGrinding", "Line"),
        translate("BeltGrinding", "Pose"),
        _in_unit(translate("BeltGrinding", "Depth, {}")),
        translate("BeltGrinding", "Program"),
    ]


def _motions(cluster: Json, programs: Sequence[str]) -> list[Any]:
    """[(texts, None)] of a cluster's motions, largest share first."""
    rows = []
    for motion in cluster["motions"]:
        known = motion["program"] is not None
        rows.append(
            (
                [
                    figure(100 * motion["share"], ".1f"),
                    str(motion["line"] or ""),
                    str(motion["pose"] + 1) if known else "",
                    length_number(motion["depth_mm"], 0, ""),
                    programs[motion["program"]]["name"] if known else "",
                ],
                None,
            )
        )
    return rows


region_rows = _Rows(_regions, _region_titles)
section_rows = _Rows(_sections, _section_titles)
cluster_rows = _Rows(_clusters, _cluster_titles)
motion_rows = _Rows(_motions, _motion_titles)
