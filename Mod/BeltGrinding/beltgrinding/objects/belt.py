"""A belt in the document: what it has done, and what is left of its cut. Jobs may share one."""

from __future__ import annotations

import json
from typing import Any

from ..engine import InputError
from ..job import law, law as laws
from .kinds import DocumentObject
from .properties import Key, Output, add_keys, add_outputs, from_job, to_job
from .proxy import Proxy

KEYS = (
    Key("WorkDone", "Float", "Belt", "belt_machine.belt.work_J"),
    Key("RemovedVolume", "Float", "Belt", "belt_machine.belt.removed_mm3"),
    Key("Hours", "Float", "Belt", "belt_machine.belt.hours"),
    Key("Loading", "Float", "Belt", "belt_machine.belt.loading"),
)
OUTPUTS = (
    Output("RemainingCut", "Float", "Belt", "share of a fresh belt's cut, percent"),
    Output("Counted", "StringList", "Belt", "results whose use has been counted", True),
)


class Belt(Proxy):
    """Proxy. ``RemainingCut`` is that of the last run counted."""

    TYPE = "BeltGrinding::Belt"
    VIEW = "BeltView"

    def add_properties(self, obj: DocumentObject) -> None:
        add_keys(obj, KEYS)
        if "RemainingCut" not in obj.PropertiesList:
            add_outputs(obj, OUTPUTS)
            obj.RemainingCut = 100.0

    def state(self, obj: DocumentObject) -> dict[str, Any]:
        """What a job has under belt_machine.belt."""
        data: dict[str, Any] = {}
        to_job(obj, KEYS, data)
        return data["belt_machine"]["belt"]

    def reset(self, obj: DocumentObject) -> None:
        """A new belt of the same kind."""
        obj.WorkDone = obj.RemovedVolume = obj.Hours = obj.Loading = 0.0
        obj.RemainingCut, obj.Counted = 100.0, []

    def count(self, obj: DocumentObject, simulation: DocumentObject) -> None:
        """Adds what the belt did in a simulation. Raises InputError for one that was counted."""
        run = f"{simulation.Fingerprint} {simulation.WallTime}"
        if not simulation.BeltUse:
            raise InputError(
                "objects.no_result",
                "{object} has no result yet; simulate first",
                object=simulation.Label,
            )
        if run in obj.Counted:
            raise InputError(
                "objects.counted",
                "{object}: the use of this result has been counted already",
                object=obj.Label,
            )
        use = json.loads(simulation.BeltUse)
        state = {key: value + use["during"].get(key, 0.0) for key, value in self.state(obj).items()}
        state["loading"] = use.get("loading", 0.0)  # as the grind leaves it, whatever was before
        from_job(obj, KEYS, {"belt_machine": {"belt": state}})
        obj.RemainingCut = 100.0 * laws.remaining_cut(use["job"], law.engine_belt(state))
        obj.Counted = [*obj.Counted, run]
