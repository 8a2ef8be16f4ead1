"""Pictures by matplotlib, without a window."""

from __future__ import annotations

import io
from typing import Any

from .. import engine

BLUE, ORANGE, GREY = "#1f5a96", "#d1701f", "#8a8f98"
GREEN, RED = "#2f7d46", "#b3261e"  # passed, failed
GRID = "#e3e5e8"


def figure(width: float, height: float) -> Any:
    """An empty matplotlib Figure, inches. Raises InputError without matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise engine.InputError(
            "calibration.no_matplotlib", "a plot needs matplotlib (Debian: python3-matplotlib)"
        ) from None
    made = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(made)
    return made


def saved(drawn: Any, kind: str = "png", dpi: float = 110) -> bytes:
    """The bytes of a file ("png", "svg" or "pdf") of a Figure."""
    target = io.BytesIO()
    # Who made it: such a file may be written over.
    made_by = {"Software" if kind == "png" else "Creator": "BeltGrinding"}
    drawn.savefig(target, format=kind, dpi=dpi, metadata=made_by)
    return target.getvalue()


def grid(axes: Any, axis: str = "both") -> None:
    """Thin lines behind what is drawn."""
    axes.grid(True, color=GRID, lw=0.6, axis=axis)
    axes.set_axisbelow(True)
