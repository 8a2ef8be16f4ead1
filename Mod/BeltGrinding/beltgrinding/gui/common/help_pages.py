"""Which page of the manual tells of a command, a panel or a dock: F1 there opens it."""

from __future__ import annotations

from .keyboard import space_presses
from .kinds import Widget

PROPERTY = "beltGrindingPage"  # of a panel's form, or a dock
PAGES = {  # name of a command, whose icon a panel bears: page of docs/
    "Belt": "workbench-machine.md",
    "BeltMachine": "workbench-machine.md",
    "BeltPlan": "belt-plan.md",
    "Calibrate": "calibration.md",
    "Cell": "workbench-cell.md",
    "CheckSettings": "convergence.md",
    "Contact": "contact.md",
    "Deviation": "workbench-results.md",
    "Examples": "examples.md",
    "ExportJob": "workbench-export.md",
    "ExportProgram": "workbench-programs.md",
    "Figures": "workbench-export.md",
    "FiguresPage": "workbench-export.md",
    "FollowPath": "workbench-programs.md",
    "GrindFaces": "planning.md",
    "GroundMesh": "ground-mesh.md",
    "ImportProgram": "workbench-programs.md",
    "ExportTemplate": "workbench-export.md",
    "ApplyTemplate": "workbench-export.md",
    "ImportResult": "workbench-export.md",
    "Job": "workbench-job.md",
    "Manual": "index.md",
    "OpenJob": "workbench-export.md",
    "Plan": "planning.md",
    "Playback": "workbench-run.md",
    "RasterPath": "raster.md",
    "ReadAgain": "workbench-programs.md",
    "Report": "report.md",
    "RobotPath": "workbench-programs.md",
    "RobotProgram": "robot.md",
    "Scan": "scan.md",
    "Section": "section.md",
    "Simulate": "workbench-run.md",
    "Stock": "workbench-job.md",
    "Study": "study.md",
    "Verdict": "verification.md",
    "Zones": "verification.md",
}


def helped(widget: Widget, icon_name: str) -> None:
    """Gives a panel's form, or a dock, its page; Space presses its buttons."""
    space_presses(widget)
    widget.setProperty(PROPERTY, PAGES[icon_name.partition("_")[2]])


def page_of(widget: Widget) -> str:
    """The page of what a widget is part of; '' if it has none."""
    while widget is not None:
        page = widget.property(PROPERTY)
        if page:
            return str(page)
        widget = widget.parentWidget()
    return ""
