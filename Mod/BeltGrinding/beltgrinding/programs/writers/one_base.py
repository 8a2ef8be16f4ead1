"""The poses of a program that changes between bases in one of them, for languages that have but one, and where one
is set for all."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...base.frames import in_words
from ...base.kinds import Floats, known
from .. import one_frame
from ..program import Fact, ProgramError
from .frames import AS_KNOWN, NOT_TOLD, WHAT, frame_in_words

if TYPE_CHECKING:
    from ..program import Motion, Program
    from .frames import Given


def in_one_base(program: Program, given: Given, language: str) -> tuple[list[Motion], list[Fact]]:
    """(motions, Facts): the motions of a Program with all poses in the base that most is ground in, each of
    its own tool.

    given: ``bases`` as ``write_program`` takes them. Where the bases lie to each other: by the 4 x 4 of a dict
    given for them (robot_from_base, mm), else by what the program knows, else by the words of its motions. The
    Facts say which poses are in another base than in the source. Raises ProgramError where a base lies nobody
    knows where to the other: left out, the program would skip what it grinds.
    """
    used = list(dict.fromkeys(m.base for m in program.motions if m.pose is not None))
    if len(used) < 2:
        return program.motions, []
    chosen, _ = one_frame.reference(program)
    numbers = {words: _numbers(program, given, words) for words in used}
    found: list[Motion] = []
    counts = dict.fromkeys(used, 0)
    for motion in program.motions:
        if motion.pose is not None and motion.base != chosen:
            counts[motion.base] += not motion.aux
            way = _way(numbers, program.held, chosen, motion.base, language)
            motion = replace(motion, pose=way @ motion.pose, base=chosen)
        found.append(motion)
    facts = []
    for words in used:
        if words != chosen:
            pose = _way(numbers, program.held, chosen, words, language)
            facts.append(
                Fact(
                    "programs.writers.in_one_base",
                    "{count} poses of the base {base} are written in the base {reference}, in which it lies at "
                    "{pose}",
                    count=counts[words],
                    base=words or NOT_TOLD["base"],
                    reference=chosen or NOT_TOLD["base"],
                    pose=in_words(pose),
                )
            )
    return found, facts


def one_for_all(program: Program, given: Given, what: str) -> list[Fact]:
    """[Fact] where one tool or base (``what``) is set for the poses of several."""
    used = {getattr(m, what): 0 for m in program.motions if m.pose is not None}
    as_known = isinstance(given, str) and given == AS_KNOWN
    if len(used) < 2 or given is None or as_known or isinstance(given, dict):
        return []
    return [
        Fact(
            "programs.writers.one_for_all",
            "the {what} that is given is set for all poses; the source has them in several ({names}): if these "
            "are not the same, give each its own, or as-known",
            what=WHAT[what],
            names=", ".join(f"'{words or NOT_TOLD[what]}'" for words in list(used)[:5]),
        )
    ]


def all_known(program: Program, given: Given) -> bool:
    """Whether it is known where all bases of a Program lie."""
    used = {m.base for m in program.motions if m.pose is not None}
    return all(_numbers(program, given, words) is not None for words in used)


def comments(facts: Iterable[Fact]) -> list[str]:
    """What the program's head says of the facts of ``in_one_base``."""
    lines = []
    for fact in facts:
        told = fact.arguments
        lines.append(f"{told['count']} poses of the source are in another base: {told['base']}")
        lines.append(
            f"  here they are written in this one, in which that one lies at {told['pose']}"
        )
    return lines


def _numbers(program: Program, given: Given, words: str) -> Floats | None:
    """4 x 4 robot_from_base in mm, or None."""
    told = given.get(words) if isinstance(given, dict) else None
    if told is not None and not isinstance(told, (str, int)):
        pose = np.asarray(told, dtype=float)
        if pose.shape == (4, 4):  # what is none is refused with the frames
            return pose
    return program.base_frames.get(words, frame_in_words(words))


def _way(
    frames: Mapping[str, Floats | None],
    held: Collection[str],
    chosen: str,
    words: str,
    language: str,
) -> Floats:
    """4 x 4 from a base's poses to the chosen one's."""
    there, here = frames[chosen], frames[words]
    for one, frame in ((chosen, there), (words, here)):
        if frame is None:
            raise ProgramError(
                "programs.writers.bases_not_known",
                "the program changes between bases ({names}), and {language} programs are written with one, but "
                "where the base '{base}' lies is not known; give its numbers in a values file beside the "
                "program, or write one program each",
                names=", ".join(f"'{name or NOT_TOLD['base']}'" for name in list(frames)[:5]),
                language=language,
                base=one or NOT_TOLD["base"],
            )
    if (chosen in held) != (words in held):
        raise ProgramError(
            "programs.writers.held_and_not",
            "the program holds the part in some poses (base '{held}') and the tool in others (base '{other}'); "
            "{language} programs are written with one base: write one program each",
            held=words if words in held else chosen,
            other=chosen if words in held else words,
            language=language,
        )
    return np.linalg.inv(known(there)) @ known(here)
