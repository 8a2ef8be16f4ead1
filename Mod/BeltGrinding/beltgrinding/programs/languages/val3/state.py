"""What a VAL3 program knows while it is followed: its data, its motions, its problems."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from ...program import Fact, Motion, Program, ProgramError, Unknown, name_of, shortened
from .project import Project
from ..xml_tree import Element
from . import data, dtx
from .data import Array, Missing, Record
from . import expression as expressions
from ..core.expression import Call, Place
from ..core.telling import Telling

ASSIGNED = Fact("programs.assigned_at_run_time", "it is assigned at run time")
# Functions of the controller that change no argument, and those that change the last one alone.
READING = re.compile(
    r"is[A-Z]\w*|[ad]io\w+|here|herej|jointToPoint|to(?:String|Num)?|chr|asc|left|right|mid|len|find|replace|insert|"
    r"delete|clock|workingMode|esStatus|taskStatus|get(?:Speed|MonitorSpeed|PositionErr|JointForce|Date|Version|"
    r"Language|MoveId|UserLevel)|if|elseif|while|for|switch|case|until|and|or|not|xor|step"
)
OF_LAST = ("pointToJoint", "setFrame", "getLatch")
PER_VALUE = 6  # units of work in a loop that a value of the .dtx may take
ELEMENT = re.compile(r"([^\W\d]\w*)\[([0-9]{1,6})\]")
FATHER = re.compile(r"([^\W\d]\w*)\s*(?:\[\s*([0-9]{1,6})\s*\])?")


class State(Telling):
    """Data by name, in the application and in the running program."""

    changes: int
    tick: Callable[..., None]

    def __init__(self, project: Project) -> None:
        super().__init__()
        self.project = project
        self.program = Program("VAL3", name_of(project.path))
        self.globals: dict[str, Array] = {}
        self.scope: dict[str, Array] = {}  # of the running program
        self.file, self.line = name_of(project.path), 1
        self.made = 0  # elements of user types
        # (motion, six components), made poses all at once
        self.rows: list[tuple[Motion, data.Six]] = []
        # (line, Record) of the last change of a frame or tool, by its id
        self.lines: dict[int, tuple[int, Record]] = {}
        # Frames and tools in words; cleared when data change
        self.texts: dict[int, tuple[str, Record]] = {}
        # Of frames and tools in words, in the world or the flange
        self.places: dict[str, data.Six] = {}

    def array(self, name: str) -> Array:
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

    def key(self, array: Array, key: Any, name: str) -> Any:
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

    def item(self, array: Array, key: Any, name: str) -> Any:
        """A value of an Array, read from the .dtx when it is asked for. Raises Unknown."""
        items, at = array.items, self.key(array, key, name)
        value = items[at]
        if value is None:
            value = items[at] = self.named(self.initial(array.kind), name, at)
        elif isinstance(value, Element):
            items[at] = Missing("programs.val3.circle", "the frames hang on each other in a circle")
            try:
                value = self.named(self.parsed(array.kind, value, array.file), name, at)
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

    def initial(self, kind: str, element: Element | None = None, file: str = "") -> Any:
        """The value of data without one; of a user type with what the Fields of an element in a file give."""
        value = data.initial(kind)
        if not isinstance(value, Missing):
            return value
        try:
            fields = dict(self.project.fields(kind))
        except ProgramError as error:
            return Missing(error.fact)
        own = name_of(self.project.files_of_types[kind]) if fields else ""
        children = element.children if element is not None else ()
        given = {one.get("name", ""): one for one in children if one.tag == "Field"}
        fields.update(given)
        arrays: dict[str, Any] = {}
        for name, field in fields.items():
            count = dtx.product_of(field.get("size", "1"), dtx.MAX_SIZE + 1)
            self.made += max(count, len(field.children))
            if self.made > dtx.MAX_SIZE:
                raise Unknown("programs.val3.size", "the size is not sensible")
            arrays[name] = dtx.array_of(field, name, file if name in given else own, count, [])
        return Record(kind, arrays) if arrays else value

    def parsed(self, kind: str, element: Element, file: str) -> Any:
        """The value of a <Value> of a .dtx. Raises Unknown."""
        value = dtx.parsed(kind, element, file, self.father)
        return self.initial(kind, element, file) if isinstance(value, Missing) else value

    def part(self, value: Any, field: str, key: Any, name: str) -> Any:
        """A field of a value, where it is an array the element of a key, None: the first. Raises Unknown."""
        if not isinstance(value, Record):
            raise Unknown(
                "programs.val3.no_field", "{name} has no field {field}", name=name, field=field
            )
        value = value.get(field)
        if isinstance(value, Array):
            return self.item(value, 0.0 if key is None else key, f"{name}.{field}")
        if key is not None:
            raise Unknown(
                "programs.val3.field_with_index", "a field with an index is not understood"
            )
        return value

    def array_at(self, place: Place) -> Array:
        """The Array that a Place without an index at its end names. Raises Unknown."""
        (name, key), *fields = expressions.path_of(place, self)
        found = self.array(name)
        for field, inner in fields:
            holder = self.item(found, 0.0 if key is None else key, name)
            found, key, name = holder.get(field), inner, f"{name}.{field}"
            if not isinstance(found, Array):
                raise Unknown("programs.it_is_not_understood", "it is not understood")
        if key is not None:
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        return found

    @staticmethod
    def named(value: Any, name: str, at: Any) -> Any:
        if isinstance(value, Record) and value.kind in ("frame", "tool"):
            value.name = name if at == 0 else f"{name}[{at}]"
        return value

    def father(self, text: str, kind: str) -> Any:
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

    def value(self, text: str) -> Any:
        element = ELEMENT.fullmatch(text)
        if element:  # nearly all of a long program
            return self.item(self.array(element[1]), float(element[2]), element[1])
        return expressions.expression(text)(self)

    def read(self, place: Place) -> Any:
        return expressions.read(place, self)

    def function(self, call: Call) -> Any:
        """The value of a function. Raises Unknown; what the controller's own may change is not known then."""
        name, found = call.name, expressions.function(call, self)
        if found is not None:
            return found
        handed = [one.name for one in call.arguments if isinstance(one, Place)]
        if not READING.fullmatch(name):
            why = Fact(
                "programs.called_function_of_controller",
                "the function {name}() is known to the controller only",
                name=name,
            )
            for one in handed[-1:] if name in OF_LAST else handed:
                self.forget(one, why)
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

    def assign(self, target: str, value: Any) -> None:
        """Stores a value; a Missing one makes the place unknown. Raises Unknown if there is none."""
        place = expressions.place(target)
        self.changes += 1
        name = place.name
        if name not in self.scope and name not in self.globals:
            if place.steps or not isinstance(value, (float, str, bool)):
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
            (_, key), *fields = expressions.path_of(place, self)
            at = self.key(array, 0.0 if key is None else key, name)
        except Unknown as unknown:
            missing = Missing(
                "programs.val3.element_unknown",
                "which element of {name} is assigned is not known: {reason}",
                name=name,
                reason=unknown.fact,
            )
            self.forget(name, missing.why)
            array.items = missing
            raise
        for depth, (field, key) in enumerate(fields):  # into arrays of user types
            holder = self.item(array, at if isinstance(at, str) else float(at), name)
            inner = holder.fields.get(field) if isinstance(holder, Record) else None
            if not isinstance(inner, Array):
                self.assign_field(array, at, holder, fields[depth:], target, value)
                return
            try:
                name = f"{name}.{field}"
                array, at = inner, self.key(inner, 0.0 if key is None else key, name)
            except Unknown as unknown:
                inner.items = Missing(unknown.fact)
                raise
        if isinstance(value, Missing):
            self.lose_item(array, at, value)
            return
        value = data.as_kind(array.kind, value)
        self.tick(self.line, data.weight(value) // 8)
        self.replace(array, at, value, name)

    def assign_field(
        self, array: Array, at: Any, holder: Any, fields: list[list[Any]], target: str, value: Any
    ) -> None:
        """Stores a value in a field of a point, a tool and so on. Raises Unknown."""
        self.lines[id(holder)] = self.line, holder
        *outer, (last, key) = fields
        for field, _ in outer:
            holder = holder.get(field) if isinstance(holder, Record) else None
        if not isinstance(holder, Record) or last not in holder.fields or key is not None:
            self.lose_item(
                array,
                at,
                Missing(
                    "programs.val3.target_not_understood",
                    "{text} is not understood",
                    text=target[:40],
                ),
            )
            raise Unknown(
                "programs.val3.no_field",
                "{name} has no field {field}",
                name=expressions.place(target).name,
                field=last,
            )
        if not isinstance(value, Missing):
            value = self.field_value(holder, last, value)
        holder.fields[last] = value

    def lose_item(self, array: Array, at: Any, missing: Missing) -> None:
        """An item is not known from here on, nor are points in a frame that it was."""
        before = array.items[at]
        if array.kind == "frame" and isinstance(before, Record):
            before.fields["trsf"] = missing
            self.lines[id(before)] = self.line, before
        else:
            array.items[at] = missing

    def field_value(self, holder: Record, field: str, value: Any) -> Any:
        before = data.initial("trsf" if field == "trsf" else "config" if field == "config" else "")
        if isinstance(before, Record):
            return data.as_kind(before.kind, value)
        text = holder.kind == "config" or field == "blend"
        if isinstance(value, str) != text or isinstance(value, (bool, list, Record)):
            raise Unknown(
                "programs.val3.wrong_field_value",
                "the value does not fit the field {field}",
                field=field,
            )
        return value

    def replace(self, array: Array, at: Any, value: Any, name: str) -> None:
        """Points refer to frames: a frame that gets a new value stays the same Record."""
        before = array.items[at]
        if isinstance(before, Element) and array.kind == "frame":
            before = self.item(array, at if isinstance(at, str) else float(at), name)
        if isinstance(before, Record) and before.kind == "frame":
            before.fields, before.father = value.fields, value.father
            return
        array.items[at] = self.named(value, name, at)

    def forget(self, name: str, why: Fact = ASSIGNED) -> None:
        """Whoever uses the data from here on reports ``why``."""
        for holder in (self.scope, self.globals):  # which one is meant may not be known either
            array = holder.get(name)
            if array is None:
                continue
            self.changes += not isinstance(array.items, Missing)
            if array.kind == "frame" and isinstance(array.items, list):
                for item in array.items:
                    if isinstance(item, Record):
                        item.fields["trsf"] = Missing(why)
                        self.lines[id(item)] = self.line, item
            fact = Fact(
                "programs.not_known_since", "{name} is not known ({reason})", name=name, reason=why
            )
            array.items = Missing(shortened(fact, 200))
            self.texts.clear()

    def described(self, record: Any, root: str) -> str:
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
                if id(record) in self.lines:
                    text += f" after line {self.lines[id(record)][0]}"
            self.texts[id(record)] = (text, record)
        return self.texts[id(record)][0]

    def finish(self) -> Program:
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
