"""Task panel of the deviation: the tolerance and the figures."""

from __future__ import annotations

from ...engine import InputError
from ...objects.kinds import DocumentObject
from ...objects.simulation import is_coarse
from ..common.compat import QtGui, translate
from ..common.figures import figure, length_text
from ..common.kinds import Quantity
from ..common.messages import error_text
from ..scene.probe import Probe
from ..widgets.figure_table import FigureTable
from ..widgets.form import Form
from .job_panel import check_tolerance, mark_tolerance
from .panel import Panel

TABLE_HEIGHT = 300  # pixels: all rows


class DeviationPanel(Panel):
    """Edits the job's tolerance; the colours and the figures follow."""

    def __init__(self, obj: DocumentObject) -> None:
        title = translate("BeltGrinding", "Deviation")
        super().__init__(obj, title, "BeltGrinding_Deviation")
        form = Form(obj.getParentGroup(), translate("BeltGrinding", "Tolerance"))
        form.add("ToleranceLower", translate("BeltGrinding", "Lower limit"))
        form.add("ToleranceUpper", translate("BeltGrinding", "Upper limit"))
        form.add("ColourLimit", translate("BeltGrinding", "Colours end at"))
        form.changed = self.update
        self.tolerance = form
        self.body.addWidget(form)
        colours = Form(obj, translate("BeltGrinding", "Colours"))
        colours.changed = self.update
        ends = {
            "by hand": translate("BeltGrinding", "by hand"),
            "by tolerance": translate("BeltGrinding", "by tolerance"),
            "by percentile": translate("BeltGrinding", "by percentile"),
        }
        colours.add("Bounds", translate("BeltGrinding", "Colours end"), ends)
        colours.add("TimesTolerance", translate("BeltGrinding", "Times the limit"))
        colours.add("Percentile", translate("BeltGrinding", "Percentile"), unit="%")
        colours.add("Bands", translate("BeltGrinding", "Steps of each ramp"))
        self.colours, self.tolerance = colours, form
        self.body.addWidget(colours)
        shown = self._shown()
        if len(shown) > 1:
            colours.add("ColourBy", translate("BeltGrinding", "Show"), shown)
        self.table = FigureTable("statistics", TABLE_HEIGHT)
        self.body.addWidget(self.table, 1)
        self.probe = Probe(obj)
        self.body.addWidget(self.probe)
        self.finish()
        self.update()

    def _shown(self) -> dict[str, str]:
        """{name: text} of what the result has to colour by, and of what is chosen: without it, the deviation is shown."""
        obj = self.obj
        scanned = bool(getattr(obj.Simulation, "ScanFigures", ""))
        modes = (
            ("deviation", translate("BeltGrinding", "Deviation"), True),
            (
                "uncertainty",
                translate("BeltGrinding", "Uncertainty (1 sd)"),
                obj.ExpectedInTolerance > 0.0,
            ),
            ("measured", translate("BeltGrinding", "Scan"), scanned),
            ("difference", translate("BeltGrinding", "Scan less prediction"), scanned),
            (
                "temperature",
                translate("BeltGrinding", "Greatest temperature"),
                obj.GreatestTemperature > 0.0,
            ),
            ("roughness", translate("BeltGrinding", "Roughness"), obj.GreatestRoughness > 0.0),
            (
                "error of the cells",
                translate("BeltGrinding", "Error of the cells"),
                obj.CellError95.Value > 0.0,
            ),
        )
        return {name: text for name, text, there in modes if there or name == obj.ColourBy}

    def update(self) -> None:
        """Colours and figures anew."""
        obj = self.obj
        used = {"by tolerance": ["TimesTolerance"], "by percentile": ["Percentile"]}
        always = [
            name for name in self.colours.rows if name not in ("TimesTolerance", "Percentile")
        ]
        self.colours.show_rows([*always, *used.get(obj.Bounds, [])])
        by_hand = ["ColourLimit"] if obj.Bounds == "by hand" else []
        self.tolerance.show_rows(["ToleranceLower", "ToleranceUpper", *by_hand])
        mark_tolerance(self.tolerance, obj.getParentGroup())
        try:
            self.check()
        except InputError as error:
            self.tell(error_text(error), True)
            return
        obj.Proxy.update(obj)
        self.tell(_doubt(obj), True)

        def mm(value: Quantity, sign: str = "+") -> str:
            return length_text(value.Value, 1, sign)

        rows: tuple[tuple[str, str], ...] = (
            (translate("BeltGrinding", "In tolerance"), f"{figure(obj.InTolerance, '.2f')} %"),
            (translate("BeltGrinding", "Too much left"), f"{figure(obj.AboveTolerance, '.2f')} %"),
            (translate("BeltGrinding", "Cut too deep"), f"{figure(obj.BelowTolerance, '.2f')} %"),
            (translate("BeltGrinding", "Minimum"), mm(obj.Minimum)),
            (translate("BeltGrinding", "Maximum"), mm(obj.Maximum)),
            (translate("BeltGrinding", "Mean"), mm(obj.Mean)),
            (translate("BeltGrinding", "Root mean square"), mm(obj.RootMeanSquare, "")),
            (translate("BeltGrinding", "5 % lie below"), mm(obj.Percentile05)),
            (translate("BeltGrinding", "Median"), mm(obj.Percentile50)),
            (translate("BeltGrinding", "95 % lie below"), mm(obj.Percentile95)),
            (
                translate("BeltGrinding", "Removed"),
                f"{figure(obj.RemovedVolume.Value, ',.1f')} mm³",
            ),
            (translate("BeltGrinding", "Area"), f"{figure(obj.DesignArea.Value, ',.1f')} mm²"),
        )
        if obj.ExpectedInTolerance > 0.0:
            rows += (
                (
                    translate("BeltGrinding", "In tol., expected"),
                    f"{figure(obj.ExpectedInTolerance, '.2f')} %",
                ),
                (
                    translate("BeltGrinding", "Uncertainty, mean"),
                    mm(obj.UncertaintyMean, ""),
                ),
                (
                    translate("BeltGrinding", "Uncertainty, 95 %"),
                    mm(obj.Uncertainty95, ""),
                ),
            )
        if obj.CellError95.Value > 0.0:
            name = translate("BeltGrinding", "Cell error, 95 %")
            rows += ((name, mm(obj.CellError95, "")),)
        if obj.GreatestTemperature > 0.0:  # never without its range
            most = f"{figure(obj.GreatestTemperatureAtMost, '.0f')} °C"
            rows += (
                (
                    translate("BeltGrinding", "Hottest"),
                    f"{figure(obj.GreatestTemperature, '.0f')} °C",
                ),
                (translate("BeltGrinding", "Hottest, at most"), most),
            )
        if obj.GreatestRoughness > 0.0:  # never without how much of it is known
            known = f"{figure(obj.RoughnessKnown, '.1f')} %"
            rows += (
                (translate("BeltGrinding", "Ra, mean"), f"{figure(obj.MeanRoughness, '.2f')} µm"),
                (
                    translate("BeltGrinding", "Ra, greatest"),
                    f"{figure(obj.GreatestRoughness, '.2f')} µm",
                ),
                (translate("BeltGrinding", "Ra known"), known),
            )
        if obj.CrossedArea >= 0.0:
            rows += (
                (
                    translate("BeltGrinding", "Crossed scratches"),
                    f"{figure(obj.CrossedArea, '.1f')} %",
                ),
            )
        self.table.show_rows(rows)

    def close(self) -> None:
        self.probe.release()

    def check(self) -> None:
        check_tolerance(self.obj.getParentGroup())


def _doubt(obj: DocumentObject) -> str:
    """What must be known of a Deviation's figures; "" for sound ones."""
    if obj.OutOfDate:
        return translate("BeltGrinding", "Out of date: simulate again.")
    if is_coarse(obj.Simulation):
        return translate("BeltGrinding", "Coarse resolution: for searching, no verdict.")
    return ""
