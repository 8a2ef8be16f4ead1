"""What may be selected while a panel is open. FreeCAD has one gate, for all panels and documents."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

_gates: list[Any] = []  # the one that FreeCAD has, or none


def hold(gate: Any) -> None:
    """Lets nothing but what ``gate`` allows be selected, until it is released."""
    Gui.Selection.addSelectionGate(gate)
    _gates[:] = [gate]


def release(gate: Any) -> None:
    """Takes a gate away, unless another panel's has come in its place."""
    if gate in _gates:
        Gui.Selection.removeSelectionGate()
        _gates.clear()
