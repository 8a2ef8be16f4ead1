"""What is dropped onto a job in the tree."""

from __future__ import annotations

import FreeCADGui as Gui

from ...objects import freecad_path, scan_source
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...objects.robot_path import RobotPath
from ..common.command_registry import action
from ..common.compat import QtCore


def drop(job: DocumentObject, dropped: DocumentObject) -> None:
    """Follows a path, compares a mesh or points as a scan, as the commands do; all else joins the job's group."""
    followed = freecad_path.is_path(dropped) and type_of(dropped) != RobotPath.TYPE
    scanned = dropped in scan_source.offered(job) and not hasattr(dropped, "Shape")
    if not followed and not scanned:
        job.addObject(dropped)
        return
    command = "BeltGrinding_FollowPath" if followed else "BeltGrinding_Scan"
    # FreeCAD is at the drop, which is an undo step of its own.
    QtCore.QTimer.singleShot(0, lambda: _run(command, job, dropped))


def _run(command: str, job: DocumentObject, dropped: DocumentObject) -> None:
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(dropped)
    Gui.Selection.addSelection(job)
    for one in action(command):
        one.trigger()
