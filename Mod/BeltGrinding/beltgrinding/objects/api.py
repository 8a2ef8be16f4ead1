"""What a macro and every button call; ``import beltgrinding`` offers those of DOCUMENT_FUNCTIONS too.

Keyword arguments set properties by name; a plain number is in FreeCAD's unit (mm, mm/s, degree), a
text may carry its unit: ``Force="40 N"``. Every function raises InputError for what the user must
mend, and leaves the document as it was.
"""

from __future__ import annotations

from . import job_object
from .first_settings import set_up
from .exchange import export_job, open_example, open_job
from .inspection import (
    compare_scan,
    learn_scan,
    make_deviation,
    make_ground_mesh,
    make_section,
    make_verdict,
    set_sections,
    set_zones,
)
from .kinds import DocumentObject
from .planning_runs import apply_plan, make_plan, write_plan
from .preferences import apply_threads
from .proxy import type_of
from .robot_program import make_robot_program, write_robot_program
from .reports import make_figures, make_figures_page, write_report
from .runs import check_settings, import_result, simulate, store_result
from .set_up import (
    export_program,
    follow_path,
    import_program,
    make_belt,
    make_belt_machine,
    make_job,
    make_raster,
    make_stock,
    wear_belt,
)
from .stock_scan import lay_stock
from .templates import apply_template, export_template
from .study_runs import make_study, open_study_run

apply_threads()  # before anything computes, whoever calls: a button or a macro


def is_job(obj: DocumentObject) -> bool:
    """True for a BeltGrindingJob."""
    return type_of(obj) == job_object.BeltGrindingJob.TYPE
