"""The fields of the law of removal and of the belt's wear."""

from __future__ import annotations

from ...objects.kinds import DocumentObject
from ..common.compat import QtGui, translate
from ..widgets.form import SIGNED, Form


class LawForms(QtGui.QWidget):
    """Edits a job's law; shows what the chosen law uses."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__()
        self.obj = obj
        self.changed = lambda: None
        self.law = Form(obj, translate("BeltGrinding", "Removal"))
        texts = {
            "local_linear": translate("BeltGrinding", "Local linear"),
            "local": translate("BeltGrinding", "Local with exponents"),
            "hammann": translate("BeltGrinding", "Hammann, global"),
            "geometric": translate("BeltGrinding", "Geometric (rigid tool)"),
        }
        self.law.add("Law", translate("BeltGrinding", "Law"), texts)
        self.law.add("LawCoefficient", translate("BeltGrinding", "K"), unit="mm²/N")
        # Above the rows that come and go: hidden ones leave a gap.
        self.law.add("HeatLimit", translate("BeltGrinding", "Heat limit"), unit="MPa m/s")
        self.law.add("PressureLimit", translate("BeltGrinding", "Pressure limit (0: none)"))
        self.law.add("PressureExponent", translate("BeltGrinding", "Exponent of pressure"))
        self.law.add("ReferencePressure", translate("BeltGrinding", "Reference pressure"))
        self.law.add("PressureThreshold", translate("BeltGrinding", "Threshold pressure"))
        self.law.add("SaturationPressure", translate("BeltGrinding", "Saturation (0: none)"))
        self.law.add("SpeedExponent", translate("BeltGrinding", "Exponent of belt speed"), SIGNED)
        self.law.add("ReferenceSpeed", translate("BeltGrinding", "Reference speed"))
        self.law.add("FeedExponent", translate("BeltGrinding", "Exponent of feed"), SIGNED)
        self.law.add("ReferenceFeed", translate("BeltGrinding", "Reference feed"))
        self.law.add("LandShare", translate("BeltGrinding", "Lands of a serrated wheel (share)"))
        self.wear = Form(obj, translate("BeltGrinding", "Belt wear"))
        models = {
            "none": translate("BeltGrinding", "None"),
            "exponential": translate("BeltGrinding", "Exponential"),
            "two_stage": translate("BeltGrinding", "Two stages"),
            "power": translate("BeltGrinding", "Power of the wear"),
            "curve": translate("BeltGrinding", "By a curve"),
        }
        self.wear.add("WearModel", translate("BeltGrinding", "Model"), models)
        variables = {
            "work": translate("BeltGrinding", "Work, J"),
            "volume": translate("BeltGrinding", "Removed volume, mm³"),
        }
        self.wear.add("WearVariable", translate("BeltGrinding", "Falls with"), variables)
        self.wear.add("WearScale", translate("BeltGrinding", "Falls to 1/e in"))
        self.wear.add("WearRest", translate("BeltGrinding", "Share that stays"))
        self.wear.add("WearFirstShare", translate("BeltGrinding", "Share that goes at first"))
        self.wear.add("WearFirstScale", translate("BeltGrinding", "falls to 1/e in"))
        self.wear.add("WearExponent", translate("BeltGrinding", "Exponent of the fall"))
        self.wear.add("LoadingShare", translate("BeltGrinding", "Loading takes (share; 0: none)"))
        self.wear.add("LoadingScale", translate("BeltGrinding", "loads in"))
        self.wear.add(
            "LoadingRecovery", translate("BeltGrinding", "recovers in (0: never)"), unit="s"
        )
        self.wear.add("DressingRest", translate("BeltGrinding", "Share after a dressing"))
        layout = QtGui.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for form in (self.law, self.wear):
            form.changed = self._arrange_and_tell
            layout.addWidget(form)
        self.arrange()

    def _arrange_and_tell(self) -> None:
        self.arrange()
        self.changed()

    def arrange(self) -> None:
        """Shows the fields of the chosen law, and of the curves' alternatives those in use."""
        obj, rows = self.obj, {"Law", "HeatLimit", "PressureLimit"}
        if obj.Law != "geometric":
            rows.add("LawCoefficient")
        if obj.Law == "local":
            rows |= {"LandShare"}
            pressure = {"PressureExponent", "PressureThreshold", "SaturationPressure"}
            rows |= {"ReferencePressure"} | (set() if obj.PressureCurve else pressure)
            rows |= {"ReferenceSpeed"} | (set() if obj.SpeedCurve else {"SpeedExponent"})
            rows |= set() if obj.FeedCurve else {"FeedExponent"}
            if obj.FeedExponent != 0.0 or obj.FeedCurve:
                rows.add("ReferenceFeed")
        self.law.show_rows(rows)
        wear = {"WearModel", "LoadingShare"}
        if obj.WearModel != "none" or obj.LoadingShare > 0.0:
            wear.add("WearVariable")
        if obj.WearModel in ("exponential", "two_stage"):
            wear |= {"WearScale", "WearRest"}
        if obj.WearModel == "two_stage":
            wear |= {"WearFirstShare", "WearFirstScale"}
        if obj.WearModel == "power":
            wear |= {"WearScale", "WearExponent"}
        if obj.LoadingShare > 0.0:
            wear |= {"LoadingScale", "LoadingRecovery", "DressingRest"}
        self.wear.show_rows(wear)
        unit = "J" if obj.WearVariable == "work" else "mm³"
        scale = translate("BeltGrinding", "Falls to 1/e in")
        if obj.WearModel == "power":
            scale = translate("BeltGrinding", "Scale of the fall")
        first = translate("BeltGrinding", "falls to 1/e in")
        loads = translate("BeltGrinding", "loads in")
        for name, text in (
            ("WearScale", scale),
            ("WearFirstScale", first),
            ("LoadingScale", loads),
        ):
            self.wear.rows[name][0].setText(f"{text}, {unit}")
