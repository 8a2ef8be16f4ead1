"""The commands, a module a topic. What a button does, it does by beltgrinding.objects.api."""

import FreeCADGui as Gui

from . import files, measure, paths, report, results, set_up, verification

WORK = (  # in the order of work: toolbar and menu
    set_up.NewJob,
    set_up.Stock,
    set_up.BeltMachine,
    paths.ImportProgram,
    paths.RasterPath,
    set_up.Cell,
    results.Simulate,
    results.Deviation,
    verification.Verdict,
    results.Section,
    results.Playback,
    report.Report,
)
MORE = (  # menu only
    paths.FollowPath,
    set_up.Belt,
    verification.Zones,
    files.Calibrate,
    results.Contact,
    measure.GroundMesh,
    measure.Scan,
    report.CheckSettings,
    report.Figures,
    paths.ReadAgain,
    files.OpenJob,
    paths.ExportProgram,
    files.ExportJob,
    files.ImportResult,
    files.ExampleBlade,
)


def register():
    """Tells FreeCAD the commands, if it does not know them; returns (names in the order of work, other names)."""
    known = set(Gui.listCommands())
    for command in WORK + MORE:
        if command.NAME not in known:
            Gui.addCommand(command.NAME, command())
    return [c.NAME for c in WORK], [c.NAME for c in MORE]
