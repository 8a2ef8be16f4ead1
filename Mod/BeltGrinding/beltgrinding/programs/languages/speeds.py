"""What is told of path speeds that a program does not give: once, with the speed that is taken."""

from __future__ import annotations

from ..program import Problem, Program

PER_MOTION = {  # what readers tell at each motion
    "programs.path_speed_unknown",
    "programs.inform.no_path_speed",
    "programs.inform.no_speed",
    "programs.inform.speed_no_number",
    "programs.inform.speed_out_of_range",
    "programs.inform.speed_unit",
    "programs.rapid.speed_unknown",
    "programs.urp.time_given",
}
OWN_DEFAULT = ("CSV",)  # languages that say what an empty speed means


def told(program: Program, speed_mm_s: float | None) -> list[Problem]:
    """The Problems of a Program whose motions without a speed take ``speed_mm_s``: one in place of those at
    each motion, at the first of them. With None the program's speeds do not matter: none is told.
    """
    others = [problem for problem in program.problems if problem.code not in PER_MOTION]
    without = [
        motion
        for motion in program.motions
        if motion.kind != "PTP"
        and motion.pose is not None
        and not motion.aux
        and not motion.speed_mm_s
    ]
    if speed_mm_s is None:
        return others
    if not without or program.language in OWN_DEFAULT:
        return list(program.problems)
    reasons = [problem for problem in program.problems if problem.code in PER_MOTION]
    first, count = without[0], len(without)
    if reasons:
        note = Problem(
            first.file,
            first.line,
            "programs.speeds_assumed_since",
            "{count} motions have no known path speed, this the first of them; {speed:g} mm/s is taken "
            "(line {line}: {reason})",
            count=count,
            speed=speed_mm_s,
            line=reasons[0].line,
            reason=reasons[0].message,
        )
    else:
        note = Problem(
            first.file,
            first.line,
            "programs.speeds_assumed",
            "{count} motions have no path speed, this the first of them; {speed:g} mm/s is taken",
            count=count,
            speed=speed_mm_s,
        )
    at = next((k for k, problem in enumerate(others) if problem.line > first.line), len(others))
    return [*others[:at], note, *others[at:]]
