"""What the core says of an event, in the reader's language.

The core writes English: the forms below, a number in place of each {0}, {1}, a name in place of each
{a}, {b}. A message of which no form is known, as of an older result, stays as it is.
"""

import re
from functools import lru_cache

RAPID = " in a rapid motion"
FORMS = (
    "the wheel loses the work for {0} mm of its way",
    "{0} N in place of {1} N: the force control is at the end of its travel, {2} mm towards the work",
    "{0} N in place of {1} N: the force control is at the end of its travel, {2} mm away from the work",
    "the contact did not converge in {0} iterations",
    "the pressure reaches {0} MPa, above the limit of {1} MPa",
    "pressure times belt speed reaches {0} MPa m/s, above the limit of {1} MPa m/s",
    "the peak pressure of {0} MPa lies outside the measured {1} to {2} MPa",
    "the belt speed of {0} m/s lies outside the measured {1} to {2} m/s",
    "the feed of {0} mm/s lies outside the measured {1} to {2} mm/s",
    "the land share of {0} lies outside the measured {1} to {2}",
    "the curve's last value is used",
    "the belt has done more than its wear was measured for: {0} J",
    "the wheel touches {0} deg round its rim from the programmed contact point, along the belt's travel",
    "the wheel touches {0} deg round its rim from the programmed contact point, against it",
    "the wheel presses with its edge at +y: the outer tenth of its width carries {0} % of the force "
    "there, {1} % if it were even",
    "the wheel presses with its edge at -y: the outer tenth of its width carries {0} % of the force "
    "there, {1} % if it were even",
    "across the wheel, the surface is hollow with a radius of about {0} mm: the wheel spans {1} mm "
    "without touching",
    "along the belt, the surface is hollow with a radius of about {0} mm: the wheel spans {1} mm "
    "without touching",
    "ground to {0} mm, below the lower limit of {1} mm",
    "ground {0} mm below the design, deeper than the segments reach",
    "the tool turns by {0} deg from pose to pose",
    "{a} and {b} run into each other" + RAPID,
    "{a} and {b} run into each other",
    "{a} and {b} come within {0} mm of each other" + RAPID,
    "{a} and {b} come within {0} mm of each other",
    "the robot cannot reach it: {0} mm are missing",
    "the robot cannot reach it: {0} mm are missing and {1} deg",
    "joint {0} at {1} deg, {2} deg beyond its limit of {3} deg",
    "wound up: it would fit at {0} deg",
    "between two checks, joint {0} turns {1} deg, joint {2} turns {3} deg, joint {4} turns {5} deg",
    "joint {0} would have to turn at {1} deg/s, {2} times its greatest speed",
    "the robot will be slower than programmed or stop",
    "wrist: axes 4 and 6 are {0} deg off one line",
    "elbow: the arm is {0} deg off stretched out",
    "shoulder: the wrist is {0} deg off the plane over axis 1",
    "the least singular value of the Jacobian is that of {0} deg",
)
NUMBER = r"([-+]?(?:\d[\d.]*(?:e[-+]?\d+)?|inf|nan))"


def kind_text(kind):
    """An event's code in words: "force_not_reached" is "Force not reached"."""
    return kind.replace("_", " ").capitalize()


def body(name, words):
    """The name of a body of the cell: that of wheel and part is ours."""
    return words(name) if name in ("wheel", "part") else name


@lru_cache(maxsize=None)
def _patterns():
    def pattern(form):
        text = re.escape(form)
        text = re.sub(r"\\{\d\\}", lambda _: NUMBER, text)
        return re.compile(re.sub(r"\\{([ab])\\}", r"(?P<\1>.+?)", text), re.DOTALL)

    return [(form, pattern(form)) for form in FORMS]


def message(event, words):
    """The message of an event, a ``Language`` given."""
    text = event["message"]
    if words.code == "en":
        return text
    whole = _said(text, words)
    if whole is not None:
        return whole
    parts = [_said(part, words) for part in text.split("; ")]
    return text if None in parts else "; ".join(parts)


def _said(text, words):
    for form, pattern in _patterns():
        found = pattern.fullmatch(text)
        if found:
            named = pattern.groupindex.values()
            numbers = [g for i, g in enumerate(found.groups(), 1) if i not in named]
            names = {key: body(name, words) for key, name in found.groupdict().items()}
            return words(form).format(*map(words.decimal, numbers), **names)
    return None
