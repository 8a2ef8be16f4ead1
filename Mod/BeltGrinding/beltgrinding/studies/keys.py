"""A key of a job, such as ``programs[0].feed_mm_s`` or ``programs[*].poses[*].force_N``: found in the schema, checked,
and put into a job."""

from __future__ import annotations

import copy
import re
from functools import lru_cache
from typing import Any

from ..base import schemas
from ..base.kinds import Json
from ..base.schema_errors import hint
from ..engine import InputError, core

STEP = re.compile(r"([A-Za-z_]\w*)((?:\[(?:\d{1,9}|\*)\])*)")
INDEX = re.compile(r"\[(\d+|\*)\]")
EACH = "*"
MOST = 120  # characters of a value that are shown
WAYS = {"add": lambda old, value: old + value, "multiply": lambda old, value: old * value}


class Key:
    """``steps``: names, numbers from 0 and ``EACH``; ``rule``: what the job's schema says of the value."""

    def __init__(self, text: str, where: str = "key") -> None:
        """Raises InputError for what is no key of a job; ``where``: the place of the text in the study."""
        self.text, self.where = text, where
        self.steps = _steps(text, where)
        self.definitions = job_schema()["definitions"]
        self.rule = self._rule(job_schema())

    def _rule(self, whole: Json) -> Json:
        rule, so_far = whole, ""
        for step in self.steps:
            rule = self._followed(rule)
            if isinstance(step, str) and step != EACH:
                known = rule.get("properties")
                if not known:
                    raise self._error_of_kind(so_far, core.Fact("studies.no_keys", "has no keys"))
                if step not in known:
                    raise InputError(
                        "studies.unknown_key",
                        "{where}: a job has no key '{key}'; {hint}",
                        where=self.where,
                        key=f"{so_far}.{step}".lstrip("."),
                        hint=hint(step, list(known)),
                    )
                rule, so_far = known[step], f"{so_far}.{step}".lstrip(".")
            else:
                if "items" not in rule:
                    raise self._error_of_kind(so_far, core.Fact("studies.no_list", "is no list"))
                rule, so_far = rule["items"], f"{so_far}[{step}]"
        return self._followed(rule)

    def _followed(self, rule: Json) -> Json:
        if "$ref" in rule:
            return self.definitions[rule["$ref"].rpartition("/")[2]]
        return rule

    def _error_of_kind(self, key: str, reason: core.Fact) -> InputError:
        return InputError(
            "studies.key_leads_nowhere",
            "{where}: {wanted}: {key} {reason}",
            where=self.where,
            wanted=self.text,
            key=key,
            reason=reason,
        )

    def check(self, value: Any) -> None:
        """Raises InputError for a value that the schema forbids."""
        for _, error in schemas.problems(
            value, {**self.rule, "definitions": self.definitions}, self.text
        ):
            raise error

    def changed(self, job: Json, value: Any, how: str = "set") -> dict[str, Any]:
        """A copy of ``job`` with the value; what it does not touch is shared with ``job``. Raises InputError where there is
        nothing to add to, no such place in a list, or a value that the schema forbids."""
        return self._changed(job, job_schema(), 0, "", value, how)

    def _changed(self, held: Any, rule: Json, depth: int, so_far: str, value: Any, how: str) -> Any:
        if depth == len(self.steps):
            return self._value(held, value, how, so_far)
        step, rule = self.steps[depth], self._followed(rule)
        if isinstance(step, str) and step != EACH:
            inner = rule["properties"][step]
            name = f"{so_far}.{step}".lstrip(".")
            old = held.get(step, _first(self._followed(inner), depth + 1 == len(self.steps)))
            return {**held, step: self._changed(old, inner, depth + 1, name, value, how)}
        places = range(len(held or ())) if isinstance(step, str) else range(step, step + 1)
        if not held or places.stop > len(held):
            raise InputError(
                "studies.no_such_item",
                "{key}: the job's {list} has {count} entries, counted from 0",
                key=self.text,
                list=so_far,
                count=len(held),
            )
        made = list(held)
        for k in places:
            name = f"{so_far}[{k}]"
            made[k] = self._changed(held[k], rule["items"], depth + 1, name, value, how)
        return made

    def _value(self, old: Any, value: Any, how: str, name: str) -> Any:
        if how != "set":
            if isinstance(old, bool) or not isinstance(old, (int, float)):
                raise InputError(
                    "studies.nothing_to_change",
                    "{key}: the job has no number there that something could be added to or multiplied; give the job "
                    "one, or set the value",
                    key=name,
                )
            value = WAYS[how](old, value)
        self.check(value)
        return value


@lru_cache(maxsize=None)
def job_schema() -> dict[str, Any]:
    """The JSON Schema of a job, read once; not to be changed."""
    return schemas.schema("job")


def _first(rule: Json, last: bool) -> Any:
    """What stands where a job has nothing: an empty object or a list's default, to be filled on the way."""
    if last:
        return None
    return copy.deepcopy(rule.get("default", {} if rule.get("type") == "object" else []))


def _steps(text: str, where: str) -> list[str | int]:
    steps = []
    for part in text.split("."):
        found = STEP.fullmatch(part)
        if not found:
            raise InputError(
                "studies.no_key",
                "{where}: '{text}' is no key of a job; write it as belt_machine.force_N or programs[0].feed_mm_s",
                where=where,
                text=text[:MOST],
            )
        steps.append(found[1])
        steps += [EACH if one == EACH else int(one) for one in INDEX.findall(found[2])]
    return steps
