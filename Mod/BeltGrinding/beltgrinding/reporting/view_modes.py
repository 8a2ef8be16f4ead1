"""What the colours of the 3D view can show: the deviation and all else that a result holds by sample.

A mode is a dict for the page's script: ``key``, ``label``, ``unit``, ``decimals``, ``sign``; ``values``: name of
the packed array with ``low`` and ``high`` (what its least and greatest code stand for); ``scale``: ``low``,
``high`` and ``colours`` ("rrggbb" each, evenly spaced); ``ticks`` ([value, text]) and ``words`` ([value, text])
of its legend, or ``swatches`` ([colour, text]); ``missing``: what it means where there is no value.
"""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

import numpy as np

from ..base.kinds import Array, Context, Json
from ..engine import core
from ..inspection import finish, heat
from ..inspection import verdict as verdicts
from ..inspection.section_plot import ticks
from . import view_mesh

if TYPE_CHECKING:
    from ..cell.motions import Motions
    from .content import Content
    from .language import Language
    from .view_mesh import Packed

TEXELS = 1024  # of a colour scale
TAIL = 99.5  # % of the values lie below the end of a ramp without a sign
MOST_SWATCHES = 12


def modes(
    content: Content,
    scale: tuple[float, float, float],
    packed: Packed,
    chosen: Array,
    words: Language,
    context: Context = None,
) -> list[dict[str, Any]]:
    """List of the modes of a report's ``Content``, their values of the samples ``chosen`` (k,) added to
    ``packed``. ``scale``: (lower, upper, limit) of the deviation, mm. The first is the deviation.
    """
    result, field = content.result, content.result.field
    made = _Maker(field, scale, packed, chosen, words)
    found = [made.deviation(), made.verdict(result.job)]
    removed = np.maximum(field.stock_height - field.height, 0.0)
    found.append(made.ramp("removed", words("Removed depth"), "mm", 3, removed))
    found.append(made.ramp("stock", words("Stock before"), "mm", 3, field.stock_height))
    trace = field.trace
    if trace is not None:
        pressure = trace["peak_pressure"]
        found.append(made.ramp("pressure", words("Largest pressure"), "MPa", 3, pressure))
        found.append(made.motion(trace["dominant"], result.motions))
    hot = heat.temperatures(result.job, field)
    if hot is not None:
        start = result.job["heat"]["start_temperature_C"]
        found.append(made.ramp("temperature", words("Greatest temperature"), "°C", 0, hot, start))
    rough = finish.roughness(field)
    if rough is not None:
        found.append(made.ramp("roughness", words("Roughness Ra"), "µm", 2, rough))
    across = finish.crossed_of(result.job, field)
    if across is not None and across.any():
        angle = np.degrees(np.asarray(field.finish["crossing"], dtype=float))
        shown = np.where(across, angle, 0.0)
        found.append(made.ramp("crossing", words("Angle of crossed scratches"), "°", 0, shown))
    if len(field.height_sd) == field.size:
        found.append(
            made.ramp(
                "sd",
                words("Uncertainty (one standard deviation)"),
                "mm",
                4,
                field.height_sd,
            )
        )
    if len(field.height_error) == field.size:
        label = words("Error of the cells: what their size leaves open")
        found.append(made.ramp("cells", label, "mm", 4, field.height_error))
    if len(field.measured) == field.size:
        measured = np.array(field.measured, dtype=float)
        found.append(
            made.signed("measured", words("Scan: measured deviation"), measured, scale, True)
        )
        found.append(
            made.signed(
                "difference",
                words("Scan less prediction"),
                measured - field.height,
                scale,
            )
        )
    thick = verdicts.thickness_deviation(result.job, field, content.shape, context)
    if thick is not None:
        bands = [
            z["thickness_mm"] for z in result.job["inspection"]["zones"] if "thickness_mm" in z
        ]
        lower, upper = min(bands, key=lambda band: band[1] - band[0])
        known = np.abs(thick[np.isfinite(thick)])
        most = float(np.percentile(known, TAIL)) if len(known) else 0.0
        limit = max(1.5 * abs(lower), 1.5 * abs(upper), most, 1e-4)
        mode = made.signed(
            "thickness",
            words("Thickness against the design"),
            thick,
            (lower, upper, limit),
        )
        found.append({**mode, "missing": words("not measured")})
    if len(np.unique(field.faces)) > 1:
        found.append(made.faces())
    return [mode for mode in found if mode is not None]


class _Maker:
    def __init__(
        self,
        field: core.HeightField,
        scale: tuple[float, float, float],
        packed: Packed,
        chosen: Array,
        words: Language,
    ) -> None:
        self.field, self.scale, self.packed = field, scale, packed
        self.chosen, self.words = chosen, words
        self.seen = (field.flags & core.MISSED) == 0

    def _mode(
        self,
        key: str,
        label: str,
        unit: str,
        decimals: int,
        sign: bool,
        values: Array,
        known: Array,
        **more: Any,
    ) -> dict[str, Any]:
        codes, low, high = view_mesh.quantised(values[self.chosen], known[self.chosen])
        self.packed.add(f"mode.{key}", codes, "u2")
        return {
            "key": key,
            "label": label,
            "unit": unit,
            "decimals": decimals,
            "sign": sign,
            "values": f"mode.{key}",
            "low": low,
            "high": high,
            "missing": self.words("no stock"),
            **more,
        }

    def deviation(self) -> dict[str, Any]:
        label = self.words("Deviation from the design")
        return self.signed("deviation", label, self.field.height, self.scale, True)

    def signed(
        self,
        key: str,
        label: str,
        values: Array,
        scale: tuple[float, float, float],
        judged: bool = False,
    ) -> dict[str, Any]:
        """In the colours of the deviation; ``judged``: with its words."""
        lower, upper, limit = scale
        middles = limit * (2.0 * (np.arange(TEXELS) + 0.5) / TEXELS - 1.0)
        colours = core.colour_scale(lower, upper, limit, middles.tolist())
        words = []
        if judged:
            words = [
                [0.5 * (lower - limit), self.words("cut too deep")],
                [0.5 * (lower + upper), self.words("good")],
                [0.5 * (upper + limit), self.words("too much left")],
            ]
        marks = [[v, self.words.number(v, 3, True)] for v in (-limit, lower, upper, limit)]
        marks[0][1], marks[-1][1] = "≤ " + marks[0][1], "≥ " + marks[-1][1]
        return self._mode(
            key,
            label,
            "mm",
            3,
            True,
            values,
            self.seen & np.isfinite(values),
            scale={"low": -limit, "high": limit, "colours": _hex(colours)},
            ticks=marks,
            words=words,
        )

    def verdict(self, job: Json) -> dict[str, Any]:
        """Where every sample lies in the band of its own zone: below 0, from 0 to 1, above 1."""
        lower, upper, limit = self.scale
        low, high = verdicts.limits(job, self.field)
        place = (self.field.height - low) / np.maximum(high - low, 1e-9)
        told = (
            self.words("cut too deep"),
            self.words("good"),
            self.words("too much left"),
        )
        samples = [0.5 * (lower - limit), 0.5 * (lower + upper), 0.5 * (upper + limit)]
        colours = _hex(core.colour_scale(lower, upper, limit, samples))
        return self._mode(
            "verdict",
            self.words("Good or not, by the zones' limits"),
            "",
            0,
            False,
            np.clip(place, -1.0, 2.0),
            self.seen,
            scale={"low": -1.0, "high": 2.0, "colours": colours},
            swatches=[[colour, text] for colour, text in zip(colours[::-1], told[::-1])],
        )

    def ramp(
        self, key: str, label: str, unit: str, decimals: int, values: Array, low: Any = 0.0
    ) -> dict[str, Any] | None:
        """What has no sign: light at ``low``, dark where all but a few values lie below."""
        values = np.asarray(values, dtype=float)
        known = self.seen & np.isfinite(values)
        if not known.any():
            return None
        most = float(values[known].max())
        limit = float(np.percentile(values[known], TAIL))
        limit = max(limit, low + 1e-3 * (most - low), low + 1e-9)
        marks, digits = ticks(low, limit, 4)
        marks = [value for value in marks if value < low + 0.93 * (limit - low)]
        told = [[value, self.words.number(value, digits)] for value in marks]
        beyond = "≥ " if most > limit else ""
        told.append([limit, beyond + self.words.number(limit, max(digits, decimals - 1))])
        return self._mode(
            key,
            label,
            unit,
            decimals,
            False,
            values,
            known,
            scale={"low": low, "high": limit, "colours": _ramp()},
            ticks=told,
            words=[],
        )

    def motion(self, dominant: Array, motions: Motions | None) -> dict[str, Any] | None:
        """The motion that removed most, from the first to the last one that did."""
        known = self.seen & (dominant != core.NEVER)
        if not known.any():
            return None
        values = np.where(known, dominant, 0).astype(float)
        first, last = int(values[known].min()), int(values[known].max())
        last = max(last, first + 1)
        told = []
        for share in np.linspace(0.0, 1.0, 5):
            number = int(round(first + share * (last - first)))
            told.append([float(number), self._line(number, motions)])
        return self._mode(
            "motion",
            self.words("Motion that removed most"),
            "",
            0,
            False,
            values,
            known,
            scale={"low": float(first), "high": float(last), "colours": _ramp()},
            ticks=told,
            words=[],
            missing=self.words("never touched"),
        )

    def _line(self, number: int, motions: Motions | None) -> str:
        line = 0
        if motions is not None and number < len(motions["line"]):
            line = int(motions["line"][number])
        if line:
            return self.words("line {line}", line=line)
        return self.words("motion {number}", number=number + 1)

    def faces(self) -> dict[str, Any]:
        """Another colour for every face."""
        faces, number = np.unique(self.field.faces, return_inverse=True)
        colours = _hex(core.face_colours(faces.astype(np.uint32)))
        told = [[colour, f"Face{face + 1}"] for colour, face in zip(colours, faces.tolist())]
        left = len(told) - MOST_SWATCHES
        if left > 0:
            more = self.words("{count} more", count=self.words.whole(left))
            told = [*told[:MOST_SWATCHES], [None, more]]
        return self._mode(
            "face",
            self.words("Faces"),
            "",
            0,
            False,
            number.reshape(-1).astype(float),
            np.ones(len(number), dtype=bool),
            scale={"low": -0.5, "high": len(faces) - 0.5, "colours": colours},
            swatches=told,
        )


def _ramp() -> list[str]:
    shares = ((np.arange(TEXELS) + 0.5) / TEXELS).tolist()
    return _hex(core.uncertainty_scale(1.0, shares))


def _hex(packed: Any) -> list[str]:
    return [f"{int(colour) >> 8:06x}" for colour in packed]
