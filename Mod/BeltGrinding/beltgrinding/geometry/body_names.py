"""Names of the bodies that a cell has of itself, and what each is called in a sentence."""

from __future__ import annotations

PART, STOCK, WHEEL = "part", "stock", "wheel"
ROLLERS, PLATE = ("roller_before", "roller_behind"), "platen"  # of a belt without a wheel
RUNS = ("belt_before", "belt_behind")  # of the belt, from and to its pulleys
ARMS, FORK = "arms", "fork"  # what holds the rollers, or a small wheel
FOOT, LINK = "robot foot", "robot link "
LINKS = (FOOT, *(f"{LINK}{k}" for k in range(1, 7)))  # link k: what joint k carries
TOLD = {
    WHEEL: ("body.wheel", "wheel"),
    PART: ("body.part", "part"),
    STOCK: ("body.stock", "stock"),
    ROLLERS[0]: ("body.roller_before", "roller before the contact"),
    ROLLERS[1]: ("body.roller_behind", "roller behind the contact"),
    PLATE: ("body.platen", "platen"),
    RUNS[0]: ("body.belt_before", "belt before the contact"),
    RUNS[1]: ("body.belt_behind", "belt behind the contact"),
    ARMS: ("body.arms", "arms of the belt machine"),
    FORK: ("body.fork", "fork"),
    FOOT: ("body.robot_foot", "robot foot"),
    LINK: ("body.robot_link", "robot link"),
}


def told(name: str) -> tuple[str, str, str] | None:
    """(code, English words, what follows them) of a body's name; None of one that the user gave."""
    known, rest = (LINK, " " + name.removeprefix(LINK)) if name.startswith(LINK) else (name, "")
    return (*TOLD[known], rest) if known in TOLD else None
