"""What is said of a program for the whole robot. ``named``: the arguments that the text has in braces."""

from __future__ import annotations

from ..engine import Fact


def lone_poses(**named: object) -> Fact:
    return Fact(
        "robot_program.lone_poses",
        "{program}: {count} rapid poses that begin no pass are left out: the links find their own way",
        **named,
    )


def no_closed_form(**named: object) -> Fact:
    return Fact(
        "robot_program.no_closed_form",
        "{robot}: there is no solution in closed form for the axes of this arm; postures are searched for "
        "numerically, slower, and some may be missed",
        **named,
    )


def no_link(**named: object) -> Fact:
    return Fact(
        "robot_program.no_link",
        "{program}: no way is found to {place}: {body} and {other} are in the way; give safe places "
        "(robot.program.safe_joints_deg), or make room",
        **named,
    )


def meets(**named: object) -> Fact:
    return Fact(
        "robot_program.meets",
        "{program}: {body} and {other} run into each other on the way to {place}",
        **named,
    )


def corner_meets(**named: object) -> Fact:
    return Fact(
        "robot_program.corner_meets",
        "{program}: {body} and {other} run into each other where the controller rounds the corner at {place}; give it a "
        "smaller zone",
        **named,
    )


def external_meets(**named: object) -> Fact:
    return Fact(
        "robot_program.external_meets",
        "{program}: {body} and {other} run into each other while {axis} goes from {begin:g} to {end:g}; choose another "
        "home of robot or axis",
        **named,
    )


def cut(**named: object) -> Fact:
    return Fact(
        "robot_program.cut",
        "{program}: pass {number} is cut at {place}: the arm cannot do it in one posture",
        **named,
    )


def broken(**named: object) -> Fact:
    return Fact(
        "robot_program.broken",
        "{program}: the arm cannot go straight to {place}: a joint would jump or pass its limit on the way",
        **named,
    )


def out_of_reach(**named: object) -> Fact:
    return Fact(
        "robot_program.out_of_reach",
        "{program}: {count} poses, first {place}, are out of the robot's reach",
        **named,
    )


def beyond_limits(**named: object) -> Fact:
    return Fact(
        "robot_program.beyond_limits",
        "{program}: {count} poses, first {place}, are reached beyond the joints' limits only",
        **named,
    )


def slower(**named: object) -> Fact:
    return Fact(
        "robot_program.slower",
        "{program}: at {count} motions the joints' speeds or accelerations lower the feed",
        **named,
    )


def meet_there(**named: object) -> Fact:
    return Fact("robot_program.meet_there", "{body} and {other} are in each other", **named)


def near_there(**named: object) -> Fact:
    return Fact(
        "robot_program.near_there",
        "{body} and {other} are {distance:.1f} mm from each other",
        **named,
    )
