"""Figures on standard output: lines for people, JSON for programs."""

import json
import sys

from .messages import print_text

MANY = 12  # of a list: more are counted
UNITS = {
    "mm": "mm", "mm2": "mm²", "mm3": "mm³", "um": "µm", "mm_s": "mm/s", "m_s": "m/s", "N": "N", "MPa": "MPa", "s": "s",
    "deg": "°", "J": "J", "MB": "MB", "percent": "%",
}  # fmt: skip


def add(parser):
    """Gives a command the option ``--json``."""
    parser.add_argument(
        "--json", action="store_true", help="print the figures as JSON, for programs"
    )


def tell(arguments, data, text=None, indent=None):
    """Prints ``data`` (plain, with strings as keys): as JSON where ``--json`` is given, or where no terminal reads it and
    there is no ``text``; else ``text``, or a line for each figure.
    """
    if arguments.json or (text is None and not sys.stdout.isatty()):
        print(json.dumps(data, indent=indent, allow_nan=False))
    else:
        print_text("\n".join(lines(data)) if text is None else text)


def lines(data, begin=""):
    """Lines that name each figure of a dict, with its unit and four digits."""
    names = {key: _name(key) for key in data}
    width = max((len(name) for name, _ in names.values()), default=0)
    found = []
    for key, value in data.items():
        name, unit = names[key]
        if isinstance(value, dict) and any(isinstance(one, (dict, list)) for one in value.values()):
            found += [f"{begin}{name}:", *lines(value, begin + "  ")]
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            found.append(f"{begin}{name}:")
            for one in value[:MANY]:
                found.append(f"{begin}  {_shown(one, '')}")
            if len(value) > MANY:
                found.append(f"{begin}  and {len(value) - MANY} more")
        else:
            found.append(f"{begin}{name:<{width}}  {_shown(value, unit)}".rstrip())
    return found


def _name(key):
    """What a key is called, and its unit."""
    words = str(key).split("_")
    for count in (2, 1):
        unit = UNITS.get("_".join(words[-count:]))
        if unit and len(words) > count:
            return " ".join(words[:-count]), unit
    return " ".join(words), "share" if words[-1] == "share" else ""


def _shown(value, unit):
    if isinstance(value, dict):
        parts = [(*_name(key), one) for key, one in value.items()]
        return ", ".join(f"{name} {_shown(one, own or unit)}" for name, own, one in parts)
    if isinstance(value, list):
        if len(value) > MANY:
            return f"{len(value)} values"
        return ", ".join(_shown(one, unit) for one in value) or "none"
    if value is None or isinstance(value, bool):
        return {None: "not known", True: "yes", False: "no"}[value]
    if not isinstance(value, (int, float)):
        return str(value)
    if unit == "share":
        return f"{100 * value:.1f} %"
    digits = f"{value:.4g}" if isinstance(value, float) else str(value)
    return f"{digits} {unit}".rstrip()
