"""The problems of a program in the order of what they do to its path."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .program import Problem

LOST, UNSURE, NOTE = range(
    3
)  # motions lost or perhaps wrong; speeds, zones and frames unknown; the rest

# Codes of problems that lose no motion and falsify none: a speed or a zone is taken in place of one that is not known.
OF_UNSURE = set(
    """
programs.apt.fedrat_not_positive programs.apt.fedrat_not_understood programs.apt.fedrat_unit
programs.apt.per_revolution programs.gcode.basic_feed programs.gcode.feed_mode
programs.gcode.feed_not_positive programs.fanuc.no_path_speed programs.fanuc.names_no_speed
programs.fanuc.short_time programs.inform.no_path_speed programs.inform.no_speed
programs.inform.speed_no_number programs.inform.speed_out_of_range programs.inform.speed_unit
programs.krl.home_frames programs.krl.speed_lost programs.krl.speed_no_number
programs.klartext.chamfer programs.path_speed_unknown programs.rapid.speed_unknown programs.rapid.zone_unknown
programs.speeds_assumed programs.speeds_assumed_since programs.urp.speed programs.urp.time_given
programs.urscript.blend_radius programs.urscript.speed_not_positive
programs.urscript.time_from_unknown programs.val3.no_tvel programs.val3.speed_not_positive
programs.val3.speed_unknown
""".split()
)
# Codes of problems that change nothing of the path.
OF_NOTE = set(
    """
programs.apt.units_of_feeds programs.inform.unknown_header
programs.inform.npos_differs programs.krl.many_lists programs.values.unused
programs.krl.circle_turn programs.krl.turning
""".split()
)


SPEEDS = ("$VEL", "$ACC", "$APO")  # of KRL: what they set is no place


def grade(problem: Problem) -> int:
    """LOST, UNSURE or NOTE, of a Problem by its code."""
    if problem.code == "programs.unknown_because":
        return UNSURE if str(problem.arguments["name"]).startswith(SPEEDS) else LOST
    if problem.code in OF_NOTE:
        return NOTE
    return UNSURE if problem.code in OF_UNSURE else LOST


def ordered(problems: Iterable[Problem]) -> list[Problem]:
    """A list of Problems, what matters most to the path first; those of a grade as they stand."""
    return sorted(problems, key=grade)
