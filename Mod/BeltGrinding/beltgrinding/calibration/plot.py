"""The picture of a calibration: measured against predicted, and residuals against each input."""

import math
from pathlib import Path

import numpy as np

from ..base.files import write_whole
from ..charts import svg

from ..charts.model import (
    BLUE, END, GREY, LOGARITHMIC, ORANGE, PAPER, START,
    Axis, Band, Chart, Line, Markers, Panel, Sheet, Text,
)  # fmt: skip
from ..engine import InputError

FORMATS = (".png", ".svg", ".pdf")
INPUTS = {  # column of a table of grinds: text, unit
    "force_N": ("force", "N"),
    "belt_speed_m_s": ("belt speed", "m/s"),
    "time_s": ("grind time", "s"),
    "feed_mm_s": ("feed", "mm/s"),
    "area_mm2": ("contact area", "mm²"),
    "pressure_MPa": ("mean pressure", "MPa"),
    "work_J": ("belt's work so far", "J"),
    "removed_so_far_mm3": ("belt's removal so far", "mm³"),
    "wear": ("belt's wear number", ""),
}
TITLE = "Measured against predicted; band: 95 % of new grinds"
SURE = 1.96  # standard deviations: 95 % of a normal distribution
RATIOS = (1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 6.5, 8.0)  # of each decade, where residuals have lines
WIDTH, FONT = 720.0, 10.0  # points
SIDE = 282.0  # of the square that compares
LEFT, TOP = 62.0, 28.0  # margins
COLUMNS = 4  # of residuals
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
WIDE, TALL = 148.0, 118.0  # of a chart of residuals
BETWEEN, BELOW = 18.0, 44.0  # them
LINE = 19.0  # points from one row of the table to the next


def draw(report, path):
    """Draws a calibration's report into a PNG, SVG or PDF. Raises InputError."""
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path}: a plot is a file {', '.join(FORMATS)}")
    content = render(report, path.suffix.lower()[1:])
    try:
        write_whole(path, content)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def render(report, kind="png", dpi=110):
    """The picture as bytes of a file. Raises InputError without matplotlib."""
    return svg.picture(sheet(report), kind, dpi)


def render_small(report):
    """Measured against predicted alone, a small square PNG. Raises InputError."""
    panel = Panel(comparison(report, gap=(24.0, 32.0)), 42.0, 8.0, 138.0, 138.0)
    return svg.picture(
        Sheet("comparison", 187.0, 187.0, [panel], font=8.0, paper=PAPER), "png", 160
    )


def sheet(report):
    """The whole picture as a ``Sheet``."""
    rows = report["rows"]
    panels = [Panel(comparison(report), LEFT, TOP, SIDE, SIDE)]
    texts = [Text(LEFT, TOP - 8.0, TITLE), *_table(report)]
    top = TOP + SIDE + BELOW
    inputs = [name for name in INPUTS if _drawn(rows.get(name))]
    ratio = ratios(rows)
    for k, name in enumerate(inputs):
        column = k % COLUMNS
        left = LEFT + column * (WIDE + BETWEEN)
        y = Axis(
            *ratio,
            "" if column else "measured / predicted",
            LOGARITHMIC,
            decade=RATIOS,
            labelled=not column,
            gap=42.0,
        )
        panels.append(Panel(residuals(rows, name, y), left, top, WIDE, TALL))
        if column == COLUMNS - 1 or k == len(inputs) - 1:
            top += TALL + BELOW
    return Sheet("calibration", WIDTH, top, panels, texts, FONT, PAPER)


def _drawn(values):
    """Whether an input has two values to draw."""
    values = np.asarray([] if values is None else values, dtype=float)
    values = values[np.isfinite(values)]
    return len(values) > 1 and np.ptp(values) > 1e-6 * np.abs(values).max()


def _split(rows, x, y):
    """(n, 2) points of the grinds that count, and of the outliers."""
    outlier = np.asarray(rows["outlier"], dtype=bool)
    points = np.column_stack([np.asarray(x, float), np.asarray(y, float)])
    return points[~outlier], points[outlier]


def comparison(report, gap=(28.0, 42.0)):
    """Measured against predicted removal as a ``Chart``."""
    rows = report["rows"]
    unit = rows["unit"].replace("3", "³")
    inside, outside = _split(rows, rows["predicted"], rows["measured"])
    low = min(inside.min(), outside.min(initial=math.inf)) / 1.3
    high = max(inside.max(), outside.max(initial=0.0)) * 1.3
    wide = math.exp(SURE * float(np.median(rows["ln_deviation"])))
    # From predicted / wide to predicted * wide, as far as the axes go.
    begin, end = min(low * wide, high), max(high / wide, low)
    band = [[low, low], [begin, low], [high, end]]
    band += [[high, high], [end, high], [low, begin]]
    return Chart(
        Axis(low, high, f"predicted removal, {unit}", LOGARITHMIC, gap=gap[0]),
        Axis(low, high, f"measured removal, {unit}", LOGARITHMIC, gap=gap[1]),
        [
            Band([np.array(band)], BLUE, 0.13, key="band"),
            Line([np.array([[low, low], [high, high]])], BLUE, key="equal"),
            Markers(inside, BLUE, rim=PAPER, key="grinds"),
            Markers(outside, ORANGE, 5.5, "diamond", PAPER, key="outliers"),
        ],
    )


def ratios(rows):
    """The range of measured over predicted that the residuals' charts share."""
    found = np.asarray(rows["measured"], float) / np.asarray(rows["predicted"], float)
    low, high = min(found.min(), 1.0), max(found.max(), 1.0)
    margin = max((high / low) ** 0.06, 1.02)
    return low / margin, high * margin


def residuals(rows, name, y):
    """Measured over predicted against an input as a ``Chart``; ``y``: its upright ``Axis``."""
    values = np.asarray(rows[name], float)
    inside, outside = _split(rows, values, np.asarray(rows["measured"]) / rows["predicted"])
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    low, high = low - 0.05 * (high - low), high + 0.05 * (high - low)
    thousands = _thousands(np.nanmax(np.abs(values)))
    text, unit = INPUTS[name]
    unit = f"10{str(thousands).translate(RAISED)} {unit}".strip() if thousands else unit
    label = f"{text}, {unit}" if unit else text
    return Chart(
        Axis(low, high, label, size=10.0**thousands, count=4, gap=28.0),
        y,
        [
            Line([np.array([[low, 1.0], [high, 1.0]])], GREY, 1.0),
            Markers(inside, BLUE, 3.0, opacity=0.75, key="grinds"),
            Markers(outside, ORANGE, 4.0, "diamond", key="outliers"),
        ],
    )


def _thousands(most):
    """The power of ten, a multiple of three, that leaves short numbers; 0 if they are short as is."""
    if 1e-3 <= most < 1e5 or not math.isfinite(most) or most <= 0.0:
        return 0
    return 3 * math.floor(math.log10(most) / 3.0)


def _table(report):
    """The parameters as texts right of the comparison."""
    rows = []
    for one in report["parameters"]:
        name = one["name"].replace("_", " ")
        name = f"{name}, {one['unit'].replace('mm2', 'mm²')}" if one["unit"] else name
        interval = f"{one['low']:.3g} to {one['high']:.3g}" if one["free"] else "fixed"
        rows.append((name, f"{one['value']:.3g}", interval))
    left = report["leave_one_out"]
    at = report["references"]
    rows += [
        ("", "", ""),
        ("the coefficient holds at", "", ", ".join(f"{at[key]:.3g} {key}" for key in at)),
        ("grinds", str(report["grinds"]), ""),
        ("left-out error, median", f"{100 * left['median']:.1f} %", ""),
        ("left-out error, 90 %", f"{100 * left['p90']:.0f} %", ""),
        ("R² of the logarithms", f"{report['r2']:.3f}", ""),
        ("outliers", str(len(report["outliers"])), ""),
    ]
    texts, begin = [], LEFT + SIDE + 42.0
    for k, row in enumerate([("parameter", "value", "95 % interval"), *rows]):
        for x, text, anchor in zip((0.0, 188.0, 204.0), row, (START, END, START)):
            if text:
                y = TOP + 14.0 + LINE * k
                texts.append(Text(begin + x, y, text, anchor, FONT - 1.0, bold=k == 0))
    return texts
