"""Events in words, in the language of the window."""

from ..reporting import event_messages
from .compat import translate
from .spoken import words


def titles():
    """{code: title} of every kind."""
    return {
        "loss_of_contact": translate("BeltGrinding", "Loss of contact"),
        "force_not_reached": translate("BeltGrinding", "Force not reached"),
        "force_exceeded": translate("BeltGrinding", "Force exceeded"),
        "over_pressure": translate("BeltGrinding", "Over-pressure"),
        "edge_contact": translate("BeltGrinding", "Wheel's edge presses"),
        "wheel_too_large": translate("BeltGrinding", "Wheel too large"),
        "tilted_contact": translate("BeltGrinding", "Tilted contact"),
        "burn_risk": translate("BeltGrinding", "Burn risk"),
        "law_out_of_range": translate("BeltGrinding", "Law out of range"),
        "belt_out_of_range": translate("BeltGrinding", "Belt out of range"),
        "gouge": translate("BeltGrinding", "Gouge"),
        "depth_exceeded": translate("BeltGrinding", "Depth exceeded"),
        "orientation_jump": translate("BeltGrinding", "Orientation jump"),
        "collision": translate("BeltGrinding", "Collision"),
        "near_miss": translate("BeltGrinding", "Near miss"),
        "out_of_reach": translate("BeltGrinding", "Out of reach"),
        "joint_limit": translate("BeltGrinding", "Joint limit"),
        "singularity": translate("BeltGrinding", "Singularity"),
        "wrist_flip": translate("BeltGrinding", "Wrist flip"),
        "arm_flip": translate("BeltGrinding", "Arm flip"),
        "joint_speed": translate("BeltGrinding", "Joint speed"),
        "not_converged": translate("BeltGrinding", "Not converged"),
    }


def severities():
    """{severity: (its name, the name of several)}, the worst first."""
    return {
        "error": (translate("BeltGrinding", "Error"), translate("BeltGrinding", "Errors")),
        "warning": (translate("BeltGrinding", "Warning"), translate("BeltGrinding", "Warnings")),
        "info": (translate("BeltGrinding", "Note"), translate("BeltGrinding", "Notes")),
    }


def title(code):
    """The title of a kind; of one that is not known, its code in words."""
    return titles().get(code) or code.replace("_", " ").capitalize()


def message(event):
    """What happened, as the core says it."""
    return event_messages.message(event, words())


def bodies(event):
    """The bodies that are concerned."""
    return ", ".join(event_messages.body(name, words()) for name in event["bodies"])


def advice(event):
    """What to try, "" if nothing is known."""
    return words()(event["advice"])
