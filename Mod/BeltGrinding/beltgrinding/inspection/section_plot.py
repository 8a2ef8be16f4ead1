"""What a section looks like on paper: curves and bands in millimetres, and an SVG of them.

Two modes: ``unrolled`` plots heights over the arc length, the design being the zero line; ``shape``
shows the true outline in the plane, the heights enlarged by a factor (``exaggeration``).
"""

from __future__ import annotations

import math
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core
from . import edge_profile

UNROLLED, SHAPE = "unrolled", "shape"
SHARE = 0.12  # of the outline's extent that the enlarged heights take
SURE = 0.95  # of what may be lies in the band
# Told apart by the colour-blind: blue against orange, and dashes.
LOOKS = {
    "tolerance": ("tolerance", "#c3d3c3", 0.0, ()),
    "uncertainty": ("95 % uncertainty", "#a9c4e4", 0.0, ()),
    "design": ("design", "#40454d", 1.1, (5, 3)),
    "stock": ("stock", "#d1701f", 1.4, (2, 2)),
    "ground": ("ground", "#1f5a96", 2.0, ()),
}
WIDTH, HEIGHT, TALLEST = 960, 440, 900  # pixels of the SVG
EDGE_LINE, MOST_EDGES = 18, 6  # pixels of a line of text on an edge, and how many lines
LEFT, RIGHT, TOP, BOTTOM = 74, 18, 58, 50  # its margins


def axes_of(section: Json) -> Floats:
    """(3, 2): unit vectors of a section's plane: along it, and out of the part."""
    normal = np.asarray(section["normal"])
    mean = np.zeros(3)
    for piece in section["pieces"]:  # the mean outward normal, by length
        step = np.diff(piece["s"])
        mean += (0.5 * (piece["normal"][1:] + piece["normal"][:-1]) * step[:, None]).sum(axis=0)
    mean -= mean.dot(normal) * normal
    if np.linalg.norm(mean) < 1e-3 * sum(p["s"][-1] - p["s"][0] for p in section["pieces"]):
        # All round: the coordinate axis that lies best in the plane is up, z before y before x.
        k = max((2, 1, 0), key=lambda k: round(1.0 - abs(float(normal[k])), 6))
        mean = np.eye(3)[k] - normal[k] * normal
    out = mean / np.linalg.norm(mean)
    return np.column_stack([np.cross(normal, out), out])


def auto_exaggeration(section: Json) -> float:
    """A factor of 1, 2, 5, 10... that lets heights of ``SHARE`` of the outline's extent be seen."""
    axes = axes_of(section)
    points = np.vstack([piece["point"] for piece in section["pieces"]]) @ axes
    extent = np.ptp(points, axis=0).max()
    heights = [np.abs(section["tolerance"]).max()]
    for piece in section["pieces"]:
        for name in ("height", "stock_height"):
            heights.append(np.nanmax(np.abs(piece[name]), initial=0.0))
    wanted = SHARE * extent / max(*heights, 1e-9)
    power = 10.0 ** math.floor(math.log10(max(wanted, 1.0)))
    return max(step * power for step in (1, 2, 5) if step * power <= max(wanted, 1.0))


def plot(section: Json, mode: str = UNROLLED, exaggeration: float | None = None) -> dict[str, Any]:
    """The plot of a section as plain data, mm.

    Returns a dict: ``mode``, ``exaggeration``, ``equal`` (whether both axes have one scale),
    ``x_label``, ``y_label``, ``bounds`` (x0, y0, x1, y1), ``layers``: in drawing order dicts of
    ``key`` and ``label``, ``colour``, ``width``, ``dash`` and ``lines`` or, of a band,
    ``polygons``: lists of (n, 2) arrays; ``ground``: one (n, 2) array a piece, NaN where not known.
    Raises InputError for an unknown mode or a factor that is none.
    """
    if mode not in (UNROLLED, SHAPE):
        raise InputError(
            "inspection.section_mode",
            "section: no mode '{mode}'; choose {first} or {second}",
            mode=mode,
            first=UNROLLED,
            second=SHAPE,
        )
    usual = auto_exaggeration(section) if mode == SHAPE and exaggeration is None else 1.0
    factor = usual if exaggeration is None else exaggeration
    if not (math.isfinite(factor) and factor > 0):
        raise InputError("inspection.exaggeration", "section: the exaggeration is a factor above 0")
    axes = axes_of(section)

    def place(piece: Json, height: Floats | float) -> Floats:
        height = np.broadcast_to(height, len(piece["s"]))
        if mode == UNROLLED:
            return np.column_stack([piece["s"], height])
        return (piece["point"] + factor * height[:, None] * piece["ray"]) @ axes

    lower, upper = section["tolerance"]
    half = float(core.student_quantile(0.5 + 0.5 * SURE, section.get("sd_freedom", math.inf)))
    lines: dict[str, list[Floats]] = {key: [] for key in LOOKS}
    ground = []
    for piece in section["pieces"]:
        lines["tolerance"].append(_between(place(piece, lower), place(piece, upper)))
        lines["design"].append(place(piece, 0.0))
        lines["stock"] += _runs(place(piece, piece["stock_height"]))
        ground.append(place(piece, piece["height"]))
        lines["ground"] += _runs(ground[-1])
        if "height_sd" in piece:
            band = half * piece["height_sd"]
            low, high = place(piece, piece["height"] - band), place(piece, piece["height"] + band)
            known = ~np.isnan(low[:, 0] + low[:, 1])
            for a, b in _spans(known):
                lines["uncertainty"].append(_between(low[a:b], high[a:b]))
    layers = []
    for key, (label, colour, width, dash) in LOOKS.items():
        if lines[key]:
            layer: dict[str, Any] = {
                "key": key,
                "label": label,
                "colour": colour,
                "width": width,
                "dash": dash,
            }
            layers.append({**layer, "lines" if width else "polygons": lines[key]})
    every = np.vstack([line for group in lines.values() for line in group])
    (x0, y0), (x1, y1) = every.min(axis=0), every.max(axis=0)
    margin = 0.06 * max(y1 - y0, 1e-3)
    by = "" if factor == 1.0 else f" (heights ×{factor:g})"
    return {
        "mode": mode,
        "exaggeration": factor,
        "equal": mode == SHAPE,
        "x_label": "arc length, mm" if mode == UNROLLED else f"in the plane, mm{by}",
        "y_label": "height above the design, mm" if mode == UNROLLED else "mm",
        "bounds": (float(x0), float(y0 - margin), float(x1), float(y1 + margin)),
        "layers": layers,
        "ground": ground,
    }


def _between(low: Floats, high: Floats) -> Floats:
    return np.vstack([low, high[::-1]])


def _spans(known: Array) -> list[tuple[int, int]]:
    """Begin and end of each run of True that has two values or more."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    return [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b - a > 1]


def _runs(line: Floats) -> list[Floats]:
    """The parts of a line without NaN."""
    return [line[a:b] for a, b in _spans(~np.isnan(line).any(axis=1))]


def ticks(low: float, high: float, count: int = 8) -> tuple[list[float], int]:
    """Round values from ``low`` to ``high``, about ``count``, and the decimals that they need."""
    span = max(high - low, 1e-12)
    power = 10.0 ** math.floor(math.log10(span / count))
    step = next(k * power for k in (1, 2, 5, 10) if k * power >= 0.999 * span / count)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return [k * step for k in range(first, last + 1)], decimals


def title(section: Json) -> str:
    """The section's plane in words."""

    def three(vector: ArrayLike) -> str:
        return ", ".join(f"{value + 0.0:.4g}" for value in np.round(np.asarray(vector), 6))

    return f"Section at ({three(section['point'])}) mm, normal ({three(section['normal'])})"


def svg(section: Json, mode: str = UNROLLED, exaggeration: float | None = None) -> str:
    """The plot as the text of an SVG file, with axes in millimetres and a legend."""
    drawn = plot(section, mode, exaggeration)
    x0, y0, x1, y1 = drawn["bounds"]
    width, height = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
    scale_x, scale_y = width / max(x1 - x0, 1e-9), height / max(y1 - y0, 1e-9)
    if drawn["equal"]:
        height = min(max(height, (y1 - y0) * scale_x), TALLEST)
        scale_x = scale_y = min(scale_x, height / max(y1 - y0, 1e-9))
        x0 -= 0.5 * (width / scale_x - (x1 - x0))
        y0 -= 0.5 * (height / scale_y - (y1 - y0))
        x1, y1 = x0 + width / scale_x, y0 + height / scale_y

    def at(points: Floats) -> str:
        x = LEFT + (points[:, 0] - x0) * scale_x
        y = TOP + height - (points[:, 1] - y0) * scale_y
        return " ".join(f"{a:.2f},{b:.2f}" for a, b in zip(x, y))

    edges = edge_profile.edges(section)[:MOST_EDGES]
    whole = TOP + height + BOTTOM + EDGE_LINE * len(edges)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{whole:.0f}" '
        f'viewBox="0 0 {WIDTH} {whole:.0f}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{whole:.0f}" fill="white"/>',
        f'<text x="{LEFT}" y="20" font-size="14">{escape(title(section))}</text>',
    ]
    for value, label in _labels(x0, x1, 9):
        x = LEFT + (value - x0) * scale_x
        out.append(_line(x, TOP, x, TOP + height))
        out.append(_text(x, TOP + height + 17, label, "middle"))
    for value, label in _labels(y0, y1, 7):
        y = TOP + height - (value - y0) * scale_y
        out.append(_line(LEFT, y, LEFT + width, y))
        out.append(_text(LEFT - 6, y + 4, label, "end"))
    for layer in drawn["layers"]:
        for polygon in layer.get("polygons", ()):
            out.append(
                f'<polygon class="{layer["key"]}" points="{at(polygon)}" '
                f'fill="{layer["colour"]}" fill-opacity="0.7"/>'
            )
        for line in layer.get("lines", ()):
            out.append(
                f'<polyline class="{layer["key"]}" points="{at(line)}" fill="none" {_pen(layer)} '
                'stroke-linejoin="round"/>'
            )
    out.append(
        f'<rect x="{LEFT}" y="{TOP}" width="{width}" height="{height:.1f}" fill="none" '
        'stroke="#6b7078"/>'
    )
    below = TOP + height + BOTTOM - 12
    out.append(_text(LEFT + width / 2, below, drawn["x_label"], "middle"))
    for edge in edges:
        below += EDGE_LINE
        out.append(_text(LEFT, below, edge_profile.text(edge), "start"))
    middle = TOP + height / 2
    out.append(
        f'<text transform="translate(18 {middle:.1f}) rotate(-90)" text-anchor="middle">'
        f'{escape(drawn["y_label"])}</text>'
    )
    x = LEFT
    for layer in drawn["layers"]:
        if "polygons" in layer:
            out.append(f'<rect x="{x}" y="34" width="26" height="11" fill="{layer["colour"]}"/>')
        else:
            out.append(f'<path d="M{x} 40h26" fill="none" {_pen(layer)}/>')
        out.append(_text(x + 32, 44, layer["label"], "start"))
        x += 54 + 7 * len(layer["label"])
    return "\n".join([*out, "</svg>", ""])


def _labels(low: float, high: float, count: int) -> list[tuple[float, str]]:
    values, decimals = ticks(low, high, count)
    return [(value, f"{value + 0.0:.{decimals}f}") for value in values]


def _line(x0: float, y0: float, x1: float, y1: float) -> str:
    return f'<path d="M{x0:.2f} {y0:.2f}L{x1:.2f} {y1:.2f}" stroke="#e3e5e8"/>'


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.2f}" y="{y:.2f}" text-anchor="{anchor}">{escape(text)}</text>'


def _pen(layer: Json) -> str:
    dash = f' stroke-dasharray="{" ".join(map(str, layer["dash"]))}"' if layer["dash"] else ""
    return f'stroke="{layer["colour"]}" stroke-width="{layer["width"]}"{dash}'
