"""What a VAL3 program knows while it is followed: its data, its motions, its problems."""

import re

from ....base.stopping import check
from ...program import (
    MAX_UNROLLED,
    Fact,
    Program,
    ProgramError,
    Unknown,
    name_of,
    shortened,
)
from ..xml_tree import Element
from . import data
from .data import Array, Missing, Record
from .expression import expression, place

ASSIGNED = Fact("programs.assigned_at_run_time", "it is assigned at run time")
PER_VALUE = 6  # units of work in a loop that a value of the .dtx may take
MAX_MOTIONS = 1_000_000
ELEMENT = re.compile(r"([^\W\d]\w*)\[([0-9]{1,6})\]")
FATHER = re.compile(r"([^\W\d]\w*)\s*(?:\[\s*([0-9]{1,6})\s*\])?")


class State:
    """Data by name, in the application and in the running program."""

    def __init__(self, project):
        self.project = project
        self.program = Program("VAL3", name_of(project.path))
        self.globals = {}
        self.scope = {}  # of the running program
        self.file, self.line = name_of(project.path), 1
        self.rounds = 0  # units of work; below 0: as many as the files have
        self.said = set()
        self.rows = []  # (motion, six components), made poses all at once
        self.texts = {}  # frames and tools in words; cleared when data change
        self.places = {}  # of frames and tools in words, in the world or the flange

    def problem(self, line, told, text=None, /, once=None, **arguments):
        """Says something once, however often a loop comes by."""
        if once in self.said:
            return
        fact = told if text is None else Fact(told, text, **arguments)
        key = once or (self.file, line, fact)
        if key not in self.said:
            self.said.add(key)
            self.program.problem(self.file, line, fact)

    def tick(self, line, work=1):
        check()
        self.line = line
        self.rounds += work
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                self.file, line, "programs.val3.too_long", "the program is too long or does not end"
            )

    def gap(self, line):
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.program.gap(line, self.file, again=False)

    def array(self, name):
        """The Array of that name. Raises Unknown."""
        found = self.scope.get(name) or self.globals.get(name)
        if found is None:
            if name in ("world", "flange"):
                kind = "frame" if name == "world" else "tool"
                return Array(kind, [data.posed(kind, (0.0,) * 6)])
            if ":" in name:
                raise Unknown(
                    "programs.val3.name_of_library", "{name} belongs to a library", name=name
                )
            raise Unknown(
                "programs.val3.not_declared", "{name} is not declared in the files here", name=name
            )
        if isinstance(found.items, Missing):
            raise Unknown(found.items.why)
        return found

    def key(self, array, key, name):
        """Where an item is. Raises Unknown."""
        if isinstance(array.items, Missing):
            raise Unknown(array.items.why)
        if isinstance(array.items, dict):
            if isinstance(key, float) and key == 0.0 and "0" in array.items:
                return "0"
            if not isinstance(key, str) or key not in array.items:
                raise Unknown(
                    "programs.no_element",
                    "{name} has no element {index}",
                    name=name,
                    index=str(key)[:30],
                )
            return key
        index = data.number(key)
        if index != int(index) or not 0 <= index < len(array.items):
            raise Unknown(
                "programs.val3.no_number_element",
                "{name} has no element {index:g}",
                name=name,
                index=index,
            )
        return int(index)

    def item(self, array, key, name):
        """A value of an Array, read from the .dtx when it is asked for. Raises Unknown."""
        items, at = array.items, self.key(array, key, name)
        value = items[at]
        if value is None:
            value = items[at] = self.named(data.initial(array.kind), name, at)
        elif isinstance(value, Element):
            items[at] = Missing("programs.val3.circle", "the frames hang on each other in a circle")
            try:
                value = data.parsed(array.kind, value, self.project.data_file, self.father)
                value = self.named(value, name, at)
            except Unknown as unknown:
                value = Missing(unknown.fact)
            items[at] = value
        if isinstance(value, Missing):
            fact = Fact(
                "programs.unknown_because",
                "{name} is not known: {reason}",
                name=name,
                reason=value.why,
            )
            raise Unknown(shortened(fact, 300))
        return value

    @staticmethod
    def named(value, name, at):
        if isinstance(value, Record) and value.kind in ("frame", "tool"):
            value.name = name if at == 0 else f"{name}[{at}]"
        return value

    def father(self, text, kind):
        """The frame 'name[index]' of a point, frame or tool; None: world or flange."""
        root = "flange" if kind == "tool" else "world"
        match = FATHER.fullmatch(text.strip())
        if not text or (match and match[1] == root):
            return None
        if not match:
            return Missing(
                "programs.val3.frame_not_understood",
                "its frame '{text}' is not understood",
                text=text[:30],
            )
        try:
            name = match[1]
            array = self.globals.get(name)
            if array is None or array.kind != ("tool" if kind == "tool" else "frame"):
                raise Unknown(
                    "programs.val3.frame_not_declared",
                    "its frame {name} is not declared in the files here",
                    name=name,
                )
            return self.item(array, float(match[2] or 0), name)
        except Unknown as unknown:
            return Missing(unknown.fact)
        except RecursionError:
            return Missing(
                "programs.val3.circle_or_chain",
                "the frames hang on each other in a circle, or the chain is too long",
            )

    def value(self, text):
        element = ELEMENT.fullmatch(text)
        if element:  # nearly all of a long program
            return self.item(self.array(element[1]), float(element[2]), element[1])
        return expression(text)(self)

    def result(self, name, parts):
        if name in ("here", "herej", "jointToPoint", "pointToJoint", "getLatch"):
            raise Unknown(
                "programs.val3.place_of_robot",
                "{name}() depends on where the robot is, or on its geometry",
                name=name,
            )
        raise Unknown(
            "programs.called_function_of_controller",
            "the function {name}() is known to the controller only",
            name=name,
        )

    def assign(self, target, value):
        """Stores a value; a Missing one makes the place unknown. Raises Unknown if there is none."""
        name, key, fields = place(target)
        if name not in self.scope and name not in self.globals:
            if key is not None or fields or not isinstance(value, (float, str, bool)):
                raise Unknown(
                    "programs.val3.not_declared",
                    "{name} is not declared in the files here",
                    name=name,
                )
            kind = {float: "num", str: "string", bool: "bool"}[type(value)]
            self.globals[name] = Array(kind, [value])
            return
        array = self.array(name)
        self.texts.clear()
        try:
            at = self.key(array, 0.0 if key is None else key(self), name)
        except Unknown as unknown:
            array.items = Missing(
                "programs.val3.element_unknown",
                "which element of {name} is assigned is not known: {reason}",
                name=name,
                reason=unknown.fact,
            )
            raise
        if fields:
            holder = self.item(array, at if isinstance(at, str) else float(at), name)
            for field in fields[:-1]:
                holder = holder.get(field) if isinstance(holder, Record) else None
            if not isinstance(holder, Record) or fields[-1] not in holder.fields:
                array.items[at] = Missing(
                    "programs.val3.target_not_understood",
                    "{text} is not understood",
                    text=target[:40],
                )
                raise Unknown(
                    "programs.val3.no_field",
                    "{name} has no field {field}",
                    name=name,
                    field=fields[-1],
                )
            if not isinstance(value, Missing):
                value = self.field_value(holder, fields[-1], value)
            holder.fields[fields[-1]] = value
            return
        if not isinstance(value, Missing):
            value = data.as_kind(array.kind, value)
            self.replace(array, at, value, name)
            return
        array.items[at] = value

    def field_value(self, holder, field, value):
        before = data.initial("trsf" if field == "trsf" else "config" if field == "config" else "")
        if isinstance(before, Record):
            return data.as_kind(before.kind, value)
        text = holder.kind == "config" or field == "blend"
        if isinstance(value, str) != text or isinstance(value, (bool, list, Record)):
            raise Unknown(
                "programs.val3.wrong_field_value",
                "the value is none for the field {field}",
                field=field,
            )
        return value

    def replace(self, array, at, value, name):
        """Points refer to frames: a frame that gets a new value stays the same Record."""
        before = array.items[at]
        if isinstance(before, Element) and array.kind == "frame":
            before = self.item(array, at if isinstance(at, str) else float(at), name)
        if isinstance(before, Record) and before.kind == "frame":
            before.fields, before.father = value.fields, value.father
            return
        array.items[at] = self.named(value, name, at)

    def forget(self, name, why=ASSIGNED):
        """Whoever uses the data from here on reports ``why``."""
        for holder in (self.scope, self.globals):  # which one is meant may not be known either
            array = holder.get(name)
            if array is None:
                continue
            if array.kind == "frame" and isinstance(array.items, list):
                for item in array.items:
                    if isinstance(item, Record):
                        item.fields["trsf"] = Missing(why)
            fact = Fact(
                "programs.not_known_since", "{name} is not known ({reason})", name=name, reason=why
            )
            array.items = Missing(shortened(fact, 200))
            self.texts.clear()

    def described(self, record, root):
        """A frame or a tool in words, with its pose in the world or on the flange."""
        if record is None:
            return root
        if isinstance(record, Missing):
            return ""
        if id(record) not in self.texts:
            text = record.name or root
            try:
                place = data.in_world(record)
                text += " " + data.words(place)
                self.places[text] = place
            except Unknown:
                pass
            self.texts[id(record)] = (text, record)
        return self.texts[id(record)][0]

    def finish(self):
        """The Program with all poses."""
        if self.rows:
            frames = data.frames([row for _, row in self.rows])
            frames[:, :3, 3] *= self.project.unit
            for (motion, _), frame in zip(self.rows, frames):
                motion.pose = frame
        self.places.update(world=(0.0,) * 6, flange=(0.0,) * 6)
        known = data.frames(list(self.places.values()))
        known[:, :3, 3] *= self.project.unit
        for words, frame in zip(self.places, known):
            self.program.base_frames[words] = self.program.tool_frames[words] = frame
        return self.program
