"""The commands as a table. What a button does, it does by beltgrinding.objects.api."""

from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from . import files, measure, paths, report, results, set_up, verification
from .base import PREFIX, Command, always, no_document, no_result

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
SEPARATOR: tuple[str, tuple[Command, ...]] = ("", ())
MENU = (  # (title of a submenu, or "" for the menu itself, its commands), in the order of work
    (
        "",
        (
            Command(
                "Job",
                "New job",
                "Makes a grinding job of the selected faces or part",
                "G, J",
                set_up.edit_new_job,
                no_document,
            ),
            Command(
                "Stock",
                "Stock",
                "Says what stock lies on the design faces",
                "G, T",
                set_up.edit_stock,
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("Workbench", "Machine"),
        (
            Command(
                "BeltMachine",
                "Belt machine",
                "Describes contact wheel, belt, force control and cell",
                "G, M",
                set_up.edit_machine,
            ),
            Command(
                "Belt",
                "Belt",
                "Puts a belt on the machine that carries its wear from run to run",
                "G, B",
                set_up.edit_belt,
            ),
            Command(
                "Cell",
                "Cell",
                "Says who holds what, and where; shows the wheel at every pose",
                "G, C",
                set_up.show_cell,
            ),
            Command(
                "Calibrate",
                "Calibrate removal law...",
                "Fits the law of removal to a table of measured grinds",
                "G, K",
                files.calibrate,
            ),
        ),
    ),
    SEPARATOR,
    (
        "",
        (
            Command(
                "ImportProgram",
                "Import robot program...",
                "Reads a robot program into the job",
                "G, I",
                paths.choose_program,
            ),
            Command(
                "RasterPath",
                "Raster path...",
                "Lays contact passes side by side on the selected faces, or on all faces of the job",
                "G, R",
                paths.make_raster,
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("Workbench", "Programs"),
        (
            Command(
                "FollowPath",
                "Follow selected path",
                "Grinds along the selected CAM path or robot trajectory of FreeCAD, and follows its changes",
                "G, F",
                paths.follow_selected,
            ),
            Command(
                "ReadAgain",
                "Read programs again",
                "Reads the job's robot programs from their files again",
                "G, A",
                paths.read_again,
            ),
            Command(
                "ExportProgram",
                "Export robot program...",
                "Writes the selected robot path as KRL, RAPID, URScript or CSV",
                "G, E",
                paths.export_program,
                paths.no_path,
            ),
            Command(
                "RobotProgram",
                "Robot program...",
                "Plans the program of the whole robot, from home by all passes and back, and writes it",
                "G, O",
                paths.plan_robot,
            ),
        ),
    ),
    SEPARATOR,
    (
        "",
        (
            Command(
                "Simulate",
                "Simulate",
                "Grinds the job; FreeCAD stays usable",
                "G, S",
                results.simulate,
            ),
            Command(
                "Playback",
                "Playback",
                "Shows the recorded simulation at any moment, under the 3D view",
                "G, P",
                results.play,
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("Workbench", "Plan and study"),
        (
            Command(
                "Plan",
                "Plan feeds...",
                "Looks for the feeds and forces with which the programs bring the part into tolerance",
                "G, L",
                results.plan_feeds,
            ),
            Command(
                "GrindFaces",
                "Grind these faces...",
                "Lays passes on the selected faces, or the job's, and plans their feeds and forces, until they are in tolerance, or says why not",
                "G, G",
                results.grind_faces,
                no_document,
            ),
            Command(
                "BeltPlan",
                "Belt plan...",
                "When to change the belt over a batch of parts, and how feed or force follow its wear",
                "G, W",
                results.plan_belts,
            ),
            Command(
                "Study",
                "Study...",
                "Simulates the job many times with other values: yield, what matters most, the best setting",
                "G, U",
                results.show_study,
            ),
            Command(
                "CheckSettings",
                "Check settings...",
                "Are spacing and steps fine enough? Simulates coarser, as given and finer",
                "G, H",
                report.check_settings,
            ),
        ),
    ),
    SEPARATOR,
    (
        "",
        (
            Command(
                "Deviation",
                "Deviation",
                "Lays the deviation from the design over the part in colour",
                "G, D",
                results.show_deviation,
                no_result,
            ),
            Command(
                "Verdict",
                "Verdict",
                "In tolerance or not, where not, and which motion of the program did it",
                "G, V",
                verification.show_verdict,
                no_result,
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("Workbench", "Results"),
        (
            Command(
                "Zones",
                "Tolerance zones...",
                "Gives faces, edges and the thickness tolerances of their own",
                "G, Z",
                verification.edit_zones,
            ),
            Command(
                "Section",
                "Cross-section",
                "Cuts the result: design, stock and ground profile along a plane or between two points",
                "G, X",
                results.show_section,
                no_result,
            ),
            Command(
                "Contact",
                "Contact at a pose...",
                "Shows the pressure on the wheel's footprint at any pose",
                "G, N",
                results.show_contact,
            ),
            Command(
                "GroundMesh",
                "Ground part as mesh",
                "Makes the whole part as ground, one closed mesh, to measure or export; once more after a new simulation",
                "G, Shift+M",
                measure.make_ground_mesh,
                no_result,
            ),
            Command(
                "Scan",
                "Compare a scan...",
                "Lays a scan of the ground part on the design and compares it with the prediction",
                "G, Shift+S",
                measure.compare_scan,
                no_result,
            ),
            Command(
                "Report",
                "Report...",
                "Writes verdict, pictures, events and the job itself into one HTML or PDF file",
                "G, Shift+R",
                report.write_report,
                report.no_report,
            ),
            Command(
                "Figures",
                "Figures in a spreadsheet",
                "Makes a spreadsheet of the figures that follows the result",
                "G, Shift+F",
                report.make_figures,
                no_result,
            ),
            Command(
                "FiguresPage",
                "Figures in a drawing",
                "Makes a drawing page with a table of the figures that follows the result",
                "G, Shift+D",
                report.make_figures_page,
                no_result,
            ),
        ),
    ),
    SEPARATOR,
    (
        QT_TRANSLATE_NOOP("Workbench", "Exchange"),
        (
            Command(
                "OpenJob",
                "Open job file...",
                "Makes document objects of a job.json",
                "G, Shift+O",
                files.open_job,
                always,
            ),
            Command(
                "ExportJob",
                "Export job file...",
                "Writes the job as JSON, for beltgrind on another machine",
                "G, Shift+E",
                files.export_job,
            ),
            Command(
                "ExportTemplate",
                "Save as template...",
                "Writes tolerance, law, machine, cell and robot of the job, without part and programs, for other jobs",
                "G, Shift+T",
                files.export_template,
            ),
            Command(
                "ApplyTemplate",
                "Apply template...",
                "Gives the job tolerance, law, machine, cell and robot of a template",
                "G, Shift+A",
                files.apply_template,
            ),
            Command(
                "ImportResult",
                "Import result...",
                "Brings back what beltgrind computed on another machine",
                "G, Shift+I",
                files.import_result,
            ),
        ),
    ),
    (
        "",
        (
            Command(
                "Examples",
                "Examples...",
                "Shows examples by topic: parts with stock, machine and program, to set up or to run",
                "G, Shift+X",
                files.show_examples,
                always,
            ),
        ),
    ),
)
TOOLBARS = {  # what each step needs most
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: set up"): "Job Stock BeltMachine Cell",
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: paths"): "ImportProgram RasterPath",
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: run"): "Simulate Playback Plan",
    QT_TRANSLATE_NOOP("Workbench", "Belt grinding: judge"): "Deviation Verdict Section Report",
}


def register() -> tuple[dict[str, list[str]], list[tuple[str, list[str]]]]:
    """Tells FreeCAD the commands, if it does not know them; returns ({toolbar: names}, [(submenu, or "" for the menu
    itself, names with "Separator" between groups)], in their order).
    """
    known = set(Gui.listCommands())
    for command in (one for _, group in MENU for one in group):
        if command.name not in known:
            Gui.addCommand(command.name, command)
    toolbars = {title: [PREFIX + name for name in row.split()] for title, row in TOOLBARS.items()}
    menu = [(title, [one.name for one in group] or ["Separator"]) for title, group in MENU]
    return toolbars, menu
