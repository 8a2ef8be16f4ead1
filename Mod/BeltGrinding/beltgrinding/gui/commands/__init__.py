"""The commands, a module a topic. What a button does, it does by beltgrinding.objects.api."""

import FreeCAD
import FreeCADGui as Gui

from . import files, measure, paths, report, results, set_up, verification

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
TOOLBARS = {  # by step, in the order of work
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: set up"): (
        set_up.NewJob,
        set_up.Stock,
        set_up.BeltMachine,
        set_up.Cell,
    ),
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: paths"): (
        paths.ImportProgram,
        paths.RasterPath,
    ),
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: run"): (
        results.Simulate,
        results.Playback,
        results.Plan,
    ),
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: judge"): (
        results.Deviation,
        verification.Verdict,
        results.Section,
        report.Report,
    ),
}
MENU = (  # the same steps and what else belongs to each, divided
    (set_up.NewJob, set_up.Stock, set_up.BeltMachine, set_up.Belt, set_up.Cell, files.Calibrate),
    (
        paths.ImportProgram,
        paths.RasterPath,
        paths.FollowPath,
        paths.ReadAgain,
        paths.ExportProgram,
    ),
    (
        results.Simulate,
        results.Playback,
        results.Contact,
        results.Plan,
        results.GrindFaces,
        results.BeltPlan,
        results.Study,
        report.CheckSettings,
    ),
    (
        results.Deviation,
        verification.Verdict,
        verification.Zones,
        results.Section,
        measure.GroundMesh,
        measure.Scan,
        report.Report,
        report.Figures,
    ),
)
SUBMENUS = {
    QT_TRANSLATE_NOOP("Workbench", "Exchange"): (
        files.OpenJob,
        files.ExportJob,
        files.ImportResult,
    ),
    QT_TRANSLATE_NOOP("Workbench", "Examples"): (
        files.ExampleBlade,
        files.ExampleTap,
        files.ExampleTapBelt,
        files.ExampleVane,
        files.ExampleKnife,
    ),
}


def register():
    """Tells FreeCAD the commands, if it does not know them; returns ({toolbar: names}, the menu's names with
    "Separator" between groups, {submenu: names}).
    """
    known = set(Gui.listCommands())
    for command in (one for group in (*MENU, *SUBMENUS.values()) for one in group):
        if command.NAME not in known:
            Gui.addCommand(command.NAME, command())
    menu = [name for group in MENU for name in (*_names(group), "Separator")]
    return _all_names(TOOLBARS), menu[:-1], _all_names(SUBMENUS)


def _names(commands):
    return [command.NAME for command in commands]


def _all_names(groups):
    return {title: _names(commands) for title, commands in groups.items()}
