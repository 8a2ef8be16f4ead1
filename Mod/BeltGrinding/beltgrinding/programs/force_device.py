"""How a robot program sets the pressing force: the statement for a force, and the force that a statement sets.

A device of kind ``analog``, ``call`` or ``template`` is one statement with one number in it, another in each
language. ``controller`` is the robot's own force control: ``force_mode`` of URScript, ``FCPress`` of RAPID; their
readers follow it as it is, their writers write it.
"""

from __future__ import annotations

import contextlib
import json
import math
import re
import string
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, is_dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from ..base import records, schemas
from ..base.files import in_file
from ..base.frames import from_data
from ..base.kinds import Floats, Json, known
from ..engine import InputError
from .program import ProgramError, Unknown

KRL, RAPID, URSCRIPT, FANUC, INFORM = (
    "KUKA KRL",
    "ABB RAPID",
    "URScript",
    "Fanuc TP",
    "Yaskawa INFORM",
)
KEY = "belt_machine.force_device"
FINEST = 3  # decimals of N that are kept where resolution_N is 0
TRIED = (0.0, 0.5, 7.25, 30.0, 123.4, 1000.0)  # N, with which a template is tried
CRUDEST = 0.5001  # N by which a template may round
MOST = 200  # characters of a template
# {value}: the number, with at least so many decimals.
STATEMENTS = {
    ("analog", KRL): ("$ANOUT[{output}]={value}", 1),
    ("analog", RAPID): ("SetAO {name},{value};", 0),
    ("analog", URSCRIPT): ("set_standard_analog_out({output}, {value})", 1),
    ("analog", FANUC): ("AO[{output}]={value}", 0),
    ("analog", INFORM): ("AOUT AO#({output}) {value}", 2),
    ("call", KRL): ("{name}({value})", 1),
    ("call", RAPID): ("{name} {value};", 0),
    ("call", URSCRIPT): ("{name}({value})", 1),
    ("call", FANUC): ("CALL {name}({value})", 0),
    ("call", INFORM): ("CALL JOB:{name} ARGF{value}", 1),
}
# What an analog output takes, by the manuals: shares of its range.
RANGES = {KRL: (-1.0, 1.0), URSCRIPT: (0.0, 1.0)}
CONTROLLERS = (RAPID, URSCRIPT)
NAME = re.compile(r"[A-Za-z]\w{0,31}", re.ASCII)
TOKEN = re.compile(r"\w+|\S")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
COMMENT_IN_BRACKETS = re.compile(r"(\[\s*\d+)\s*:[^\]]*\]")  # AO[1:Force]
ASSIGNMENT = re.compile(r"\s*[$\w.\[\]]+\s*=")
# Where the force changes when the next motion begins, as the KRL writer says it.
TRIGGER = re.compile(
    r"TRIGGER\s+WHEN\s+(?:(?:PATH)\s*=\s*0(?:\.0*)?\s+ONSTART|DISTANCE\s*=\s*0)\s+DELAY\s*=\s*[-+]?\d+\s+DO\s+"
    r"(.+?)(?:\s+PRIO\s*=.*)?$",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class ForceDevice:
    """``belt_machine.force_device`` of a job. ``force_N``: of motions that have none; ``contact``: 4 x 4 in
    mm of the contact frame, in the tool, or, where the robot holds the part (``held``), in the base.
    """

    kind: str = "none"
    name: str = ""
    output: int = 1
    template: str = ""
    scale_per_N: float = 1.0
    offset: float = 0.0
    least_N: float = 0.0
    greatest_N: float = 0.0
    ramp_N_s: float = 0.0
    dead_time_s: float = 0.0
    resolution_N: float = 0.0
    force_N: Optional[float] = None
    contact: Optional[Floats] = field(default=None, compare=False)
    held: bool = False

    def check(self, where: str = KEY) -> None:
        """Raises InputError naming the key that cannot be."""
        if self.kind == "call" and not NAME.fullmatch(self.name):
            raise InputError(
                "programs.force_device.name",
                "{key}.name: '{name}' is no name of a subprogram: a letter, then at most 31 letters, digits or _",
                key=where,
                name=self.name,
            )
        if self.kind == "analog" and self.name and not NAME.fullmatch(self.name):
            raise InputError(
                "programs.force_device.signal",
                "{key}.name: '{name}' is no name of a signal: a letter, then at most 31 letters, digits or _",
                key=where,
                name=self.name,
            )
        if self.kind in ("analog", "call") and self.scale_per_N == 0.0:
            raise InputError(
                "programs.force_device.scale",
                "{key}.scale_per_N: it is 0: no force could be set; give what the output changes by per newton",
                key=where,
            )
        if 0.0 < self.greatest_N < self.least_N:
            raise InputError(
                "programs.force_device.span",
                "{key}.least_N: {least:g} N is more than greatest_N, {greatest:g} N",
                key=where,
                least=self.least_N,
                greatest=self.greatest_N,
            )
        if self.kind == "template":
            _check_template(self.template, where)

    def settable(self, newton: float) -> float:
        """The force in N that the device sets for one that is wanted: within its range, a multiple of its
        resolution."""
        step = self.resolution_N or 10.0**-FINEST
        least, greatest = self.least_N, self.greatest_N or math.inf
        steps = round(min(max(newton, least), greatest) / step)
        if steps * step < least * (1.0 - 1e-12):
            steps += 1
        elif steps * step > greatest * (1.0 + 1e-12):
            steps -= 1
        force = round(steps * step, 6)
        if self.kind == "template":  # which rounds as its format says
            force = known(self.force_of("", self.statement("", force)))
        return force

    def statement(self, language: str, newton: float) -> str:
        """The statement that sets a force of the device (``settable``) in N. Raises ProgramError."""
        if self.kind == "template":
            return self.template.format(newton=newton)
        text, decimals = self._form(language)
        value = self.offset + self.scale_per_N * newton
        least, most = RANGES.get(language, (-math.inf, math.inf))
        if self.kind == "analog" and not least - 1e-9 <= value <= most + 1e-9:
            raise ProgramError(
                "programs.force_device.output_range",
                "{newton:g} N would be {value:g} on the output, and {language} takes {least:g} to {most:g}: change "
                "{key}.scale_per_N or .offset",
                newton=newton,
                value=value,
                language=language,
                least=least,
                most=most,
                key=KEY,
            )
        digits = min(9, max(decimals, FINEST + 1 - math.floor(math.log10(abs(self.scale_per_N)))))
        number = np.format_float_positional(
            round(value, digits) + 0.0, min_digits=decimals, trim="k" if decimals else "-"
        )
        return text.format(name=self.name, output=self.output, value=number)

    def triggered(self, statement: str, in_spline: bool) -> str:
        """A KRL statement as it may stand between motions that pass into each other: an assignment would stop the
        advance run in which a corner is rounded, and is not allowed in a spline block."""
        priority = "" if ASSIGNMENT.match(statement) else " PRIO=-1"  # of a subprogram
        if not in_spline:
            return f"TRIGGER WHEN DISTANCE=0 DELAY=0 DO {statement}{priority}"
        delay = -round(1000.0 * self.dead_time_s)
        return f"TRIGGER WHEN PATH=0 ONSTART DELAY={delay} DO {statement}{priority}"

    def force_of(self, language: str, statement: str) -> float | None:
        """The force in N that a statement with a number sets; None where it is no statement of the device."""
        operand = self.operand(language, statement)
        if operand is None or not NUMBER.fullmatch(operand):
            return None
        try:
            return self.newton(float(operand))
        except Unknown:
            return None

    def operand(self, language: str, statement: str) -> str | None:
        """What stands in a statement of the device in place of the number; None: it is another statement."""
        pattern = self._pattern(language)
        if pattern is None:
            return None
        text = statement.strip()
        if language == KRL:
            trigger = TRIGGER.match(text)
            text = trigger[1] if trigger else text
        elif language == FANUC:
            text = COMMENT_IN_BRACKETS.sub(r"\1]", text)
        match = pattern.fullmatch(text)
        return match[1].strip() if match else None

    def newton(self, value: float) -> float:
        """The force in N by the value of an operand. Raises Unknown for one that is none."""
        given = self.kind == "template"
        force = value if given else (value - self.offset) / self.scale_per_N
        if not math.isfinite(force) or force < -0.5 * 10.0**-FINEST:
            raise Unknown(
                "programs.force_device.below_zero",
                "{value:g} would be {force:.4g} N by scale_per_N and offset of the force device",
                value=value,
                force=force,
            )
        return abs(round(force, FINEST))

    def _form(self, language: str) -> tuple[str, int]:
        found = STATEMENTS.get((self.kind, language))
        if found is None:
            kinds = [kind for kind, of in STATEMENTS if of == language]
            kinds += ["controller"] if language in CONTROLLERS else []
            raise ProgramError(
                "programs.force_device.language",
                "{key}.kind: {language} has no '{kind}'; take {kinds}",
                key=KEY,
                language=language,
                kind=self.kind,
                kinds=", ".join([*kinds, "template"]),
            )
        if "{name}" in found[0] and not self.name:
            raise ProgramError(
                "programs.force_device.no_name",
                "{key}.name: {language} sets its analog outputs by the name of the signal; give it",
                key=KEY,
                language=language,
            )
        return found

    def _pattern(self, language: str) -> re.Pattern[str] | None:
        """Of a statement of the device; its group is the operand."""
        if self.kind == "template":
            before, _, after = _pieces(self.template)
        else:
            form, _ = STATEMENTS.get((self.kind, language), ("", 0))
            if not form or "{name}" in form and not self.name:
                return None
            form = form.format(name=self.name, output=self.output, value="\0")
            before, _, after = form.partition("\0")
        key = before, after
        if key not in _patterns:
            after = after.rstrip("; ")
            _patterns[key] = re.compile(
                rf"{_loose(before)}\s*(\S.*?)\s*{_loose(after)}\s*;?", re.IGNORECASE
            )
        return _patterns[key]


_patterns: dict[tuple[str, str], re.Pattern[str]] = {}
_here = threading.local()
Given = Union[ForceDevice, Json, Path, str, None]


@contextlib.contextmanager
def reading(device: ForceDevice | None) -> Iterator[None]:
    """In this thread, the readers take the statements of a device as forces."""
    before = getattr(_here, "device", None)
    _here.device = device
    try:
        yield
    finally:
        _here.device = before


def in_use() -> ForceDevice | None:
    """The device of ``reading``."""
    found: ForceDevice | None = getattr(_here, "device", None)
    return found


def device_of(given: Given, **more: Any) -> ForceDevice | None:
    """The ForceDevice of a job's key, or of a file that holds it or a whole job; None where nothing is given, or of
    kind none. ``more``: what the job knows beside it. Raises InputError."""
    if given is None or isinstance(given, ForceDevice):
        return given if given is None or given.kind != "none" else None
    if isinstance(given, (str, Path)) and not str(given).lstrip().startswith("{"):
        try:
            return device_of(schemas.read_json(Path(given)), **more)
        except InputError as error:
            raise in_file(error, given) from None
    if isinstance(given, (str, Path)):
        try:
            given = json.loads(str(given))
        except ValueError as error:
            raise InputError(
                "programs.force_device.no_json",
                "the force device is no JSON: {reason}",
                reason=str(error),
            ) from None
    assert isinstance(given, Mapping)
    machine = given.get("belt_machine")
    if isinstance(machine, Mapping):  # a whole job
        given = machine.get("force_device", {})
    rule = schemas.schema("job")["properties"]["belt_machine"]["properties"]["force_device"]
    checked = schemas.checked(given, rule, KEY)
    device = ForceDevice(**checked, **more)
    device.check()
    return device if device.kind != "none" else None


def of_job(job: Any) -> ForceDevice | None:
    """The ForceDevice of a validated job (Json or a record), which knows its cell; None where it has none. Raises InputError."""
    whole = vars(job) if is_dataclass(job) else job
    machine, cell = (records.plain(whole[key]) for key in ("belt_machine", "cell"))
    if machine.get("force_device", {}).get("kind", "none") == "none":
        return None
    held = cell["holding"] == "part_in_hand"
    frame = from_data(cell.get("base_from_contact" if held else "tcp_from_contact"))
    force = float(machine["force_N"])
    return device_of(machine["force_device"], force_N=force, contact=frame, held=held)


def _loose(text: str) -> str:
    """A pattern of a text in which blanks between words do not matter."""
    return r"\s*".join(re.escape(token) for token in TOKEN.findall(text))


def _pieces(template: str) -> tuple[str, str, str]:
    """(text before the field, its format, text behind it). Raises ValueError."""
    parts = list(string.Formatter().parse(template))
    named = [part for part in parts if part[1] is not None]
    if len(named) != 1 or named[0][1] != "newton" or named[0][3] or "{" in str(named[0][2]):
        raise ValueError
    at = parts.index(named[0])
    before = "".join(part[0] for part in parts[: at + 1])
    after = "".join(part[0] for part in parts[at + 1 :])
    return before, named[0][2] or "", after


def _check_template(template: str, where: str) -> None:
    """Raises InputError for a template that is no statement with a force that can be read back."""
    field = "{newton:.1f}"
    if (
        not template.strip()
        or len(template) > MOST
        or not (template.isascii() and template.isprintable())
    ):
        raise InputError(
            "programs.force_device.template_text",
            "{key}.template: give one statement in one line of at most {most} ASCII characters, as FORCE({field})",
            key=where,
            field=field,
            most=MOST,
        )
    try:
        before, _, after = _pieces(template)
    except ValueError:
        before = after = ""
    if not TOKEN.search(before + after):
        raise InputError(
            "programs.force_device.template_field",
            "{key}.template: '{template}' must have the field newton once, as FORCE({field}), and no other",
            key=where,
            template=template[:80],
            field=field,
        )
    device = ForceDevice("template", template=template)
    try:
        again = [device.force_of("", device.statement("", force)) for force in TRIED]
        read = all(
            found is not None and abs(found - force) <= CRUDEST
            for force, found in zip(TRIED, again)
        )
    except (ValueError, TypeError, LookupError):
        read = False
    if not read:
        raise InputError(
            "programs.force_device.template_read",
            "{key}.template: the force cannot be read back from '{template}'; write its number as {field}",
            key=where,
            template=template[:80],
            field=field,
        )
