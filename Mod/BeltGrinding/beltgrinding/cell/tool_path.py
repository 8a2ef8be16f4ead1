"""The way of the wheel over the work that a job's program commands."""

from ..engine import InputError, core
from ..job.engine_input import time_law
from ..job.poses import program_arrays, program_name
from ..job.workpiece import frame_of
from ..presets import robot as robots

CELL_FRAMES = ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact")


def tool_path(job, index, warnings, count=None, gaps=None):
    """core.ToolPath of the job's program number ``index``; of its first ``count`` poses. ``gaps``: a list
    that its gaps are added to, as ``Program.path_arrays`` has them."""
    where = program_name(job, index)
    arrays = program_arrays(
        job["programs"][index],
        where,
        warnings,
        robots.pose_function(job["robot"]),
        job["cell"]["holding"],
    )
    left_out = arrays.pop("gaps")
    if gaps is not None:
        gaps.append(left_out)
    arrays = {name: values[:count] for name, values in arrays.items()}
    cell = {name: frame_of(job["cell"].get(name), f"cell.{name}") for name in CELL_FRAMES}
    try:
        return core.ToolPath(
            **arrays, holding=job["cell"]["holding"], **cell, time_law=time_law(job["simulation"])
        )
    except InputError as error:
        raise error.within("job.in_program", "{program}: ", program=where) from None
