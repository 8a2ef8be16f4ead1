"""FreeCAD runs this at start when there is a window."""

import FreeCADGui


class BeltGrindingWorkbench(FreeCADGui.Workbench):
    """Simulation of robotic belt grinding."""

    MenuText = "Belt grinding"
    ToolTip = "What a robot's belt grinding will leave, before any metal is ground"

    def __init__(self):
        from beltgrinding.gui.icons import icon

        self.__class__.Icon = icon("BeltGrinding_Workbench")
        self.work = []

    def Initialize(self):
        from beltgrinding.gui import start

        self.work, more = start.register()
        if self.work:
            self.appendToolbar("Belt grinding", self.work)
            more = [*self.work, "Separator", *more]
        self.appendMenu("&Belt grinding", more)

    def ContextMenu(self, recipient):
        if self.work:
            self.appendContextMenu("Belt grinding", self.work)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


try:
    FreeCADGui.addWorkbench(BeltGrindingWorkbench())
except ImportError as error:
    import FreeCAD

    FreeCAD.Console.PrintError(f"The belt-grinding workbench cannot start: {error}\n")
