"""The belt machine in short, in the job's panel; all there is to it is in its own panel."""

from __future__ import annotations

from ...objects import belt_machine as machines
from ...objects.kinds import DocumentObject
from ..common.compat import translate
from ..common.figures import figure
from ..widgets.form import Form

OF_WHEEL, OF_BELT = {"WheelRadius", "WheelWidth"}, {"RunLength", "RunWidth"}


def kinds() -> dict[str, str]:
    """What the kinds of machines are called."""
    return {
        machines.WHEEL: translate("BeltGrinding", "Contact wheel"),
        machines.FREE_BELT: translate("BeltGrinding", "Free belt"),
        machines.PLATEN: translate("BeltGrinding", "Platen"),
        machines.SMALL_WHEEL: translate("BeltGrinding", "Small wheel in a fork"),
    }


class MachineForm(Form):
    """Of a BeltMachine."""

    def __init__(self, machine: DocumentObject) -> None:
        super().__init__(machine, "")
        self.add("Kind", translate("BeltGrinding", "Kind"), kinds())
        self.add("WheelRadius", translate("BeltGrinding", "Wheel radius"))
        self.add("WheelWidth", translate("BeltGrinding", "Wheel width"))
        self.add("RunLength", translate("BeltGrinding", "Free length"))
        self.add("RunWidth", translate("BeltGrinding", "Belt's width"))
        self.add("Force", translate("BeltGrinding", "Force"))
        self.add("BeltSpeed", translate("BeltGrinding", "Belt speed"))
        self.arrange()

    def arrange(self) -> None:
        """Shows the rows of the machine's kind."""
        of_kind = OF_WHEEL if self.obj.Kind in machines.WHEELS else OF_BELT
        self.show_rows({"Kind", "Force", "BeltSpeed"} | of_kind)

    def summary(self) -> str:
        """What the machine is, in a few words."""
        if self.obj.Kind in machines.WHEELS:
            return f"R {figure(self.obj.WheelRadius.Value, 'g')} × {figure(self.obj.WheelWidth.Value, 'g')} mm"
        return (
            f"{figure(self.obj.RunLength.Value, 'g')} × {figure(self.obj.RunWidth.Value, 'g')} mm"
        )
