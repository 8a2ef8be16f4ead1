"""The job in the document: a group that holds the settings and everything that belongs to it."""

from __future__ import annotations

from ..engine import InputError
from ..job import tolerances
from . import report_data
from .deviation import Deviation
from .ground_mesh import GroundMesh
from .job_data import KEYS, child, children, design, inspection, zones
from .job_inputs import fingerprint
from .kinds import DocumentObject
from .properties import add_keys, check_limits
from .proxy import Proxy
from .section import Section
from .simulation import Simulation
from .verdict import Verdict, renew_events


class BeltGrindingJob(Proxy):
    """Proxy of the App::DocumentObjectGroupPython."""

    TYPE = "BeltGrinding::Job"
    VIEW = "JobView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "DesignFaces" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyLinkSubListGlobal", "DesignFaces", "Design", "the faces to be ground"
            )
        if "FlipFaces" not in obj.PropertiesList:
            text = "loose faces whose normals are reversed"
            obj.addProperty("App::PropertyLinkSubListGlobal", "FlipFaces", "Design", text)
        add_keys(obj, KEYS)

    def onDocumentRestored(self, obj: DocumentObject) -> None:
        super().onDocumentRestored(obj)
        # A job that was copied without its members claims those of the job it is a copy of, and FreeCAD
        # lets none be in two groups.
        own = [member for member in obj.Group if member.getParentGroup() in (None, obj)]
        if len(own) < len(obj.Group):
            obj.Group = own

    def onChanged(self, obj: DocumentObject, name: str) -> None:
        """Passes lie on the outside of the faces; the job depends on its paths, not they on it."""
        super().onChanged(obj, name)
        if name in ("FlipFaces", "FlipNormals") and "Restore" not in obj.State:
            for path in obj.Group:
                if "PassCount" in path.PropertiesList:  # a RasterPath, whose module knows this one
                    path.touch()

    def execute(self, obj: DocumentObject) -> None:
        """Marks the result out of date or up to date, and recolours it; never simulates. Raises
        InputError for settings that cannot be, so that the tree shows where the mistake is.
        """
        simulation, judged = child(obj, Simulation), _can_be_judged(obj)
        if simulation is not None and simulation.Fingerprint:
            try:
                stale = fingerprint(obj) != simulation.Fingerprint
            except InputError:
                stale = True
            simulation.OutOfDate = stale
            report_data.update(simulation, inspection(obj))
            if judged:
                renew_events(simulation, inspection(obj))
        for mesh in children(obj, GroundMesh):
            mesh.Proxy.update(mesh)
        for deviation in children(obj, Deviation):
            deviation.Proxy.update(deviation)
        for section in children(obj, Section):
            section.Proxy.update(section)
        for verdict in children(obj, Verdict):
            if judged:
                verdict.Proxy.update(verdict)
            elif simulation is not None:
                verdict.OutOfDate = simulation.OutOfDate
        for member in obj.Group:
            # A Plan, a Study or a RobotProgram, whose modules know this one.
            if {"NewFeeds", "RunsInAll", "RobotMoves"} & set(member.PropertiesList):
                member.Proxy.update(member)
        check_limits(obj, KEYS)
        if obj.ToleranceLower > obj.ToleranceUpper:
            raise InputError(
                "objects.limits_swapped",
                "{object}: the lower limit lies above the upper limit",
                object=obj.Label,
            )
        tolerances.check_zones(zones(obj), design(obj)[1], bool(obj.Finish))


def _can_be_judged(obj: DocumentObject) -> bool:
    """Whether the zones of a job can be: none that call for what nothing can be compared with."""
    try:
        tolerances.check_zones(zones(obj), (), bool(obj.Finish))
    except InputError:
        return False
    return True
