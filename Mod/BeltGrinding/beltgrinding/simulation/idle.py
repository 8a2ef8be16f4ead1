"""Settings with which nothing can be ground: allowed, and hardly meant."""

from ..engine import core
from ..job.poses import program_name


def warnings(job):
    """Facts, one for each reason that the job's settings give for grinding nothing."""
    machine, law = job["belt_machine"], job["law"]
    found = []
    if law["model"] != "geometric":
        if law["coefficient_mm2_per_N"] == 0.0:
            found.append(
                core.Fact(
                    "idle.coefficient",
                    "law.coefficient_mm2_per_N is 0: nothing is removed; measured belts have 1e-6 to "
                    "2e-4 mm2/N",
                )
            )
        if machine["belt_wear"] == 0.0:
            found.append(
                core.Fact(
                    "idle.belt_wear",
                    "belt_machine.belt_wear is 0: a belt that cuts no more removes nothing; a new one "
                    "has 1",
                )
            )
    if machine["control"] == "force":
        found += [
            core.Fact(
                "idle.force",
                "{program}: the force is 0 at every pose: nothing is pressed and nothing removed; "
                "set the program's force or belt_machine.force_N",
                program=program_name(job, index),
            )
            for index, program in enumerate(job["programs"])
            if not any(_forces(program, machine["force_N"]))
        ]
    return found


def _forces(program, default):
    """N, of a program's poses."""
    if "force_N" in program:
        return [program["force_N"]]
    return (pose.get("force_N", default) for pose in program["poses"])
