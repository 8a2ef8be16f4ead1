"""Messages in the window's words: a key of the job file, or a property, is the label of its field there, an option of
the command line the field or the command that does the same."""

from __future__ import annotations

import re
from functools import lru_cache

from ...objects.properties import keys_of
from .compat import translate
from .field_labels import LABELS

KEY = re.compile(
    r"(?<![\w./\\\]-])('?)([a-z]\w*(?:\.\w+)+|[a-z]+(?:_\w+)+)(?:\[(\d)\])?\1(?![\w/(])"
)
PROPERTY = re.compile(r"(?<![\w.“])[A-Z][a-z]+(?:[A-Z][a-z]+)+(?!\w)")
OPTION = re.compile(r"(?<![\w-])(?:--[a-z][a-z-]*|beltgrind [a-z][a-z-]*)(?!\w)")
marked_there = translate  # of labels, which the panels mark as texts to be translated
UNIT = re.compile(r"\s*\([^)]*\)$|,\s[^,]*$")  # what a label says beside the field's name


def in_words(text: str) -> str:
    """The text with labels in place of keys, and what the window has in place of options and commands."""
    text = OPTION.sub(lambda found: _option(found.group()) or found.group(), text)
    text = PROPERTY.sub(lambda found: _of_property(found.group()) or found.group(), text)
    return KEY.sub(_label, text)


def _of_property(name: str) -> str:
    """The field of a property; '' where it has none, or there are several."""
    found = {named(key) for key in keys_of(name)}
    return found.pop() if len(found) == 1 else ""


def _label(found: re.Match[str]) -> str:
    key = found.group(2) + (f".{found.group(3)}" if found.group(3) else "")
    return named(key) or found.group()


def named(key: str) -> str:
    """The field of a key, or of its last part where that tells it: “Belt machine: Force”; '' of anything else."""
    found = label(key)
    return translate("BeltGrinding", "“{}”").format(found) if found else ""


def label(key: str) -> str:
    """The same without the quotation marks."""
    if key == "design.unit_mm":  # a document's parts are in millimetres
        return str(translate("BeltGrinding", "the part's size"))
    keys = [key] if key in LABELS else _ending(key)
    names = {(_title(LABELS[one][0]), _field(LABELS[one][1])) for one in keys}
    fields = {field for _, field in names}
    if len(fields) != 1:
        return ""  # none, or several that are not the same
    return ": ".join(names.pop()) if len(names) == 1 else fields.pop()


@lru_cache(maxsize=None)
def _ending(key: str) -> tuple[str, ...]:
    return () if "." in key else tuple(one for one in LABELS if one.endswith(f".{key}"))


def _field(label: str) -> str:
    return UNIT.sub("", marked_there("BeltGrinding", label))


def _title(module: str) -> str:
    """What the panel of an object is called, by the module of ``objects`` that makes it."""
    return {
        "belt": translate("BeltGrinding", "Belt"),
        "belt_machine": translate("BeltGrinding", "Belt machine"),
        "job_data": translate("BeltGrinding", "Belt-grinding job"),
        "plan": translate("BeltGrinding", "Plan"),
        "raster_path": translate("BeltGrinding", "Raster path"),
        "stock": translate("BeltGrinding", "Stock"),
        "study": translate("BeltGrinding", "Study"),
    }[module]


def _option(option: str) -> str:
    """What the window has in place of an option or a command of the command line; '' where nothing is."""
    found = {
        "--wheel-diameter": translate("BeltGrinding", "Drive wheel's diameter, mm"),
        "--wear-unit": translate("BeltGrinding", "Work of one unit of wear, J"),
        "--unit-mm": translate("BeltGrinding", "Unit"),
        "--units": translate("BeltGrinding", "Values"),
        "beltgrind calibrate": translate("BeltGrinding", "Calibrate removal law"),
        "beltgrind calibrate-finish": translate("BeltGrinding", "Fit..."),
        "beltgrind scan": translate("BeltGrinding", "Compare a scan"),
    }.get(option, "")
    return translate("BeltGrinding", "“{}”").format(UNIT.sub("", found)) if found else ""
