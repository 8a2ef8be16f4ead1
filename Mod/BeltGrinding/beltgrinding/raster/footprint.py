"""How wide the contact is across the passes."""

import math

import numpy as np

from ..base.quantile import weighted_quantile
from ..engine import InputError, core
from ..job import contact_extents, engine_input
from .sheets import curvature_along_and_across

FLAT = 1e4  # mm; a larger radius of curvature is a plane


def contact_width(job, settings, surfaces, warnings):
    """Width of the contact across the pass, mm: the job's wheel under the force, by the job's model
    of elasticity, on a cylinder with the faces' median curvature across the passes.
    """
    wheel, compliance, _, options = engine_input.engine_arguments(job)
    if compliance["model"] == "geometric":
        raise InputError(
            "raster.rigid_step_over",
            "{key}: a rigid tool has no contact width; give a step-over in mm",
            key="raster.step_over_mm",
        )
    across, areas = zip(*(curvature_along_and_across(s)[1:] for s in surfaces))
    curvature = weighted_quantile(np.concatenate(across), np.concatenate(areas), 0.5)
    force = settings["force_N"] or options["force"]
    angle = -settings["belt_angle_deg"]  # of the pass against the belt

    def width_on(workpiece):
        spacing, turned = options["contact_spacing"], math.radians(angle)
        found = contact_extents.single(wheel, workpiece, compliance, force, spacing, turned)
        return found[1]

    workpiece = {"shape": "plane"}
    if abs(curvature) * FLAT > 1:
        workpiece = {"shape": "cylinder", "radius": 1.0 / curvature, "axis_angle_deg": angle}
    try:
        return width_on(workpiece)
    except InputError as error:
        if workpiece["shape"] == "plane":  # it is not the surface's curvature
            raise
        warnings.append(
            core.Fact(
                "raster.width_on_a_plane",
                "the contact's width is that on a plane: on a cylinder of {radius:.4g} mm radius "
                "it cannot be found ({reason})",
                radius=1.0 / curvature,
                reason=error,
            )
        )
        return width_on({"shape": "plane"})
