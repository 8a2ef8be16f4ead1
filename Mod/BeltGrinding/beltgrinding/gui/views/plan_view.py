"""View provider of a plan: what stays out of tolerance, in a colour for each reason."""

from __future__ import annotations

import numpy as np
from pivy import coin

from ...objects.kinds import DocumentObject, ViewObject
from ...planning import reasons
from ...planning.pictures import COLOURS
from ..common.compat import translate
from ..common.plan_runner import words
from ..common.redraw import Once
from ..scene import left_out
from ..scene.legend import Legend
from ..scene.legend_picture import Mark, Spec
from ..scene.part_context import points_of_part
from .coloured_mesh_view import name_of
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
        self.left, self.left_of = coin.SoSwitch(), Once()
        self.drawn = Legend()
        super().attach(view)
        view.addDisplayMode(self.left, "Left")

    def getDisplayModes(self, view: ViewObject) -> list[str]:
        return ["Left"]

    def getDefaultDisplayMode(self) -> str:
        return "Left"

    def draws(self) -> bool:
        """Whether the places are drawn: none of a plan that is out of date, or applied; then the deviation shows what
        is left, in the colours of its own legend."""
        obj = self.view.Object
        gone = getattr(obj, "OutOfDate", True) or obj.Applied or not obj.LeftStates
        return self.shown() and bool(obj.Fingerprint) and not gone

    def draw(self) -> None:
        super().draw()
        obj, there = self.view.Object, self.draws()
        if self.left_of.needed(*((obj.Fingerprint, len(obj.LeftStates)) if there else ())):
            self.left.removeAllChildren()
            if there:
                corners = np.array(obj.LeftTriangles, dtype=int).reshape(-1, 3)
                points = np.array([tuple(point) for point in obj.LeftPoints]).reshape(-1, 3)
                states = np.array(obj.LeftStates)
                self.left.addChild(left_out.left_out(points, corners, states, RGB))
                self.left.addChild(self.drawn.node)
            self.left.whichChild = coin.SO_SWITCH_ALL if there else coin.SO_SWITCH_NONE
        if there:
            self.drawn.show(self._spec())
            self.drawn.avoid(points_of_part(obj.getParentGroup()))

    def legends(self) -> list[Legend]:
        return [self.drawn] if self.draws() else []

    def _spec(self) -> Spec:
        """The legend of the reasons that are drawn, the most frequent first."""
        obj, said = self.view.Object, words()
        states, counts = np.unique(np.array(obj.LeftStates, dtype=int), return_counts=True)
        order = [int(state) for state in states[np.argsort(-counts)] if int(state) in COLOURS]
        marks = tuple(Mark(COLOURS[state], said[reasons.WORDS[state]]) for state in order)
        return Spec([], {}, said["why"], ("", ""), (False, False), "", name_of(obj), marks)

    def open(self, view: ViewObject) -> None:
        from ..panels.plan_panel import show

        show(view.Object)

    def setEdit(self, view: ViewObject, mode: int = 0) -> bool | None:
        return None

    def verb(self) -> str:
        return translate("BeltGrinding", "Show plan")
