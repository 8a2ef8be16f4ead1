"""The ground part as one closed mesh in the document."""

from __future__ import annotations

import io
import json
from typing import Any

import FreeCAD
import Mesh

from ..base.kinds import Context
from ..engine import InputError, core
from ..inspection import closed_mesh
from ..job import workpiece
from ..job.tolerances import colour_scale
from .kinds import DocumentObject
from .properties import Output, add_outputs
from .proxy import Proxy

OUTPUTS = (
    Output("VertexColors", "ColorList", "Mesh", "one colour per vertex", True),
    Output("ToleranceLower", "Distance", "Tolerance", "lower limit; set it at the job"),
    Output("ToleranceUpper", "Distance", "Tolerance", "upper limit; set it at the job"),
    Output("ColourLimit", "Distance", "Tolerance", "deviation at which the colour ramps end"),
    Output("OutOfDate", "Bool", "Mesh", "made from another result; make it again"),
    Output("Closed", "Bool", "Mesh", "without gaps, as the design is"),
    Output("Volume", "Volume", "Mesh", "of the ground part; 0: the mesh is open"),
    Output("DesignVolume", "Volume", "Mesh", "of the same triangles on the design"),
    Output("TurnedTriangles", "Integer", "Mesh", "that the displacement turned over"),
    Output("MissedVertices", "Integer", "Mesh", "left on the design: no stock was found there"),
    Output("Notes", "StringList", "Mesh", "what the user should know of the mesh"),
    Output("Shown", "String", "Mesh", "which result it was made from", True),
)


class GroundMesh(Proxy):
    """Proxy of the Mesh::FeaturePython. It is made on demand (``make``): that takes seconds."""

    TYPE = "BeltGrinding::GroundMesh"
    VIEW = "GroundMeshView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "Simulation" not in obj.PropertiesList:
            text = "the result that is meshed"
            obj.addProperty("App::PropertyLink", "Simulation", "Mesh", text)
            obj.setEditorMode("Simulation", 1)
        if "Deflection" not in obj.PropertiesList:
            text = "chord error on faces that are not ground"
            obj.addProperty("App::PropertyLength", "Deflection", "Mesh", text)
            obj.Deflection = closed_mesh.DEFLECTION
        add_outputs(obj, OUTPUTS)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def update(self, obj: DocumentObject) -> None:
        """Says whether the mesh is of the result that is there."""
        simulation = obj.Simulation
        if simulation is not None and obj.Shown:
            stale = simulation.OutOfDate or obj.Shown != _shown(obj)
            if obj.OutOfDate != stale:
                obj.OutOfDate = stale


def _shown(obj: DocumentObject) -> str:
    simulation = obj.Simulation
    return json.dumps(
        [simulation.Fingerprint, simulation.WallTime, obj.Deflection.Value], allow_nan=False
    )


def make(obj: DocumentObject) -> None:
    """Makes the mesh from the object's simulation. Raises InputError where that is out of date."""
    from . import job_data, job_inputs, waiting

    simulation, job = obj.Simulation, obj.getParentGroup()
    if simulation is None or job is None:
        raise InputError(
            "objects.no_simulation",
            "{object}: belongs to no simulation; make a new one",
            object=obj.Label,
        )
    if simulation.OutOfDate or job_inputs.fingerprint(job) != simulation.Fingerprint:
        raise InputError(
            "objects.out_of_date",
            "{object} is out of date; simulate again",
            object=simulation.Label,
        )
    field = simulation.Proxy.field(simulation)
    if field is None:
        raise InputError(
            "objects.no_field",
            "{object}: its height field is missing; simulate again",
            object=simulation.Label,
        )
    with job_inputs.scratch_folder() as folder:
        data = job_inputs.to_data(job, folder)
        shape = workpiece.read_design(data["design"])
    scale, deflection = colour_scale({"inspection": job_data.inspection(job)}), obj.Deflection.Value

    def work(_: Context) -> tuple[Any, ...]:
        mesh = core.ground_mesh(shape, field, True, deflection)
        made = Mesh.Mesh()
        made.read(Stream=io.BytesIO(mesh.ply()), Format="PLY")
        return mesh, closed_mesh.summary(mesh), made, mesh.colours(*scale).tolist()

    text = FreeCAD.Qt.translate("BeltGrinding", "Making the mesh of the ground part")
    mesh, figures, made, colours = waiting.wait(work, text)
    obj.Mesh = made  # drops the colours: it comes first
    obj.ToleranceLower, obj.ToleranceUpper, obj.ColourLimit = scale
    obj.VertexColors = colours
    obj.Closed = figures["closed"]
    obj.Volume, obj.DesignVolume = figures["volume_mm3"] or 0.0, figures["design_volume_mm3"] or 0.0
    obj.TurnedTriangles, obj.MissedVertices = (
        figures["turned_triangles"],
        figures["missed_vertices"],
    )
    obj.Notes = figures["warnings"]
    obj.Shown = _shown(obj)
    obj.OutOfDate = False
