"""FreeCAD runs this at start when there is a window."""

import FreeCADGui


class BeltGrindingWorkbench(FreeCADGui.Workbench):
    """Simulation of robotic belt grinding."""

    def __init__(self):
        from beltgrinding.gui import workbench

        workbench.describe(self.__class__)
        self.work = []

    def Initialize(self):
        from beltgrinding.gui import workbench

        self.work = workbench.fill(self)

    def Activated(self):
        from beltgrinding.gui import workbench

        workbench.activated()

    def ContextMenu(self, recipient):
        from beltgrinding.gui import workbench

        if self.work:
            self.appendContextMenu(workbench.NAME, self.work)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


try:
    FreeCADGui.addWorkbench(BeltGrindingWorkbench())
    from beltgrinding.gui import workbench

    workbench.at_start()
except ImportError as error:
    import FreeCAD

    FreeCAD.Console.PrintError(f"The belt-grinding workbench cannot start: {error}\n")
