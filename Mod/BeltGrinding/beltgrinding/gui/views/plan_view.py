"""View provider of a plan: what stays out of tolerance, in a colour for each reason."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ...objects.kinds import DocumentObject, ViewObject
from ...planning.pictures import COLOURS
from ..common.compat import translate
from ..common.icons import icon, stale_icon
from ..scene import left_out
from .view import View

RGB = {
    state: tuple((colour >> shift & 0xFF) / 255.0 for shift in (24, 16, 8))
    for state, colour in COLOURS.items()
}


class PlanView(View):
    """The icon says when the plan is out of date; a double click opens its panel."""

    ICON = "BeltGrinding_Plan"
    COMMANDS = ("BeltGrinding_Simulate", "BeltGrinding_Deviation")

    def attach(self, view: ViewObject) -> None:
        super().attach(view)
        self.left = coin.SoSwitch()
        view.addDisplayMode(self.left, "Left")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Left"]

    def getDefaultDisplayMode(self) -> str:
        return "Left"

    def getIcon(self) -> str:
        stale = getattr(self, "view", None) is not None and getattr(
            self.view.Object, "OutOfDate", False
        )
        return stale_icon(self.ICON) if stale else icon(self.ICON)

    def finishRestoring(self) -> None:
        self.draw()

    def updateData(self, obj: DocumentObject, name: str) -> None:
        if getattr(self, "view", None) is None:
            return
        if name == "OutOfDate":
            self.view.signalChangeIcon()
        if name in ("OutOfDate", "Fingerprint", "Applied"):
            self.draw()

    def onChanged(self, view: ViewObject, name: str) -> None:
        if name == "Visibility" and getattr(self, "left", None) is not None:
            self.draw()

    def draw(self) -> None:
        """Draws the places as they are; none of a plan that is out of date, or applied: then the deviation shows what is
        left, in the colours of its own legend."""
        obj = self.view.Object
        self.left.whichChild = coin.SO_SWITCH_NONE
        self.left.removeAllChildren()
        gone = obj.OutOfDate or obj.Applied or not self.view.Visibility
        if not getattr(obj, "Fingerprint", "") or gone:
            return
        corners = np.array(obj.LeftTriangles, dtype=int).reshape(-1, 3)
        points = np.array([tuple(point) for point in obj.LeftPoints]).reshape(-1, 3)
        self.left.addChild(left_out.left_out(points, corners, np.array(obj.LeftStates), RGB))
        self.left.whichChild = coin.SO_SWITCH_ALL

    def doubleClicked(self, view: ViewObject) -> bool:
        from ..panels.plan_panel import show

        show(view.Object)
        return True

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show plan")
