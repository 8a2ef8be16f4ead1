"""The numeric registers R[n] of a Fanuc TP program, as far as the program itself sets them."""

import re

from ...program import Unknown
from ..taught import NUMBER, TaughtPath

INDEX = r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]"
CONDITION = re.compile(rf"\(?\s*R{INDEX}\s*(<>|<=|>=|=|<|>)\s*(R{INDEX}|{NUMBER})\s*\)?$")
COMPARE = {
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}


class Registers(TaughtPath):
    """Values of registers; what the program does not set raises Unknown."""

    def __init__(self, language, path, values=None):
        """``values``: what a person gives, {NAME: number, or six of a frame}."""
        super().__init__(language, path)
        self.registers = {}
        self.values = values or {}

    def index(self, text):
        """The number in P[3], P[3:name], P[R[2]]."""
        match = re.match(r"\s*(?:R\[\s*(\d{1,6})[^\]]*\]|(\d{1,6})\s*(?::|$))", text, re.ASCII)
        if not match:
            raise Unknown("programs.fanuc.no_index", "[{text}] is no number", text=text)
        return int(match.group(2)) if match.group(2) else int(self.register(match.group(1)))

    def register(self, text):
        n = self.index(text)
        if n not in self.registers:
            value = self.ask(f"R[{n}]", "")
            if isinstance(value, float):
                return value
            raise Unknown(
                "programs.fanuc.no_register_value",
                "R[{text}] has no value that this file gives",
                text=text,
            )
        return self.registers[n]

    def ask(self, name, kind):
        """What a person gives for a name; None: nothing."""
        self.program.asked.setdefault(name, kind)
        return self.values.get(name)

    def number(self, text):
        """The value of a number or register, or of two with + - * / between them."""
        text = text.strip()
        if text.startswith("(") and text.endswith(")"):
            text = text[1:-1].strip()
        operand = rf"(?:R{INDEX}|{NUMBER})"
        match = re.match(rf"({operand})\s*(?:([-+*/])\s*({operand}))?$", text, re.ASCII)
        if not match:
            raise Unknown(
                "programs.fanuc.not_known_before", "'{text}' is not known before it runs", text=text
            )
        first, operator, second = match.group(1), match.group(3), match.group(4)
        values = []
        for part in (first, second) if operator else (first,):
            if part.startswith("R"):
                values.append(self.register(part[2:-1]))
            else:
                values.append(float(part))
        a, b = (values + [0.0])[:2]
        if operator == "/" and b == 0.0:
            raise Unknown("programs.fanuc.divides_by_zero", "it divides by zero")
        value = {None: a, "+": a + b, "-": a - b, "*": a * b}.get(operator)
        value = a / b if value is None else value
        if not abs(value) < 1e12:
            raise Unknown("programs.fanuc.out_of_range", "'{text}' is out of range", text=text)
        return value

    def condition(self, text):
        match = CONDITION.match(text.strip())
        if not match:
            raise Unknown("programs.fanuc.condition", "the condition is known at run time only")
        left, operator, right = match.group(1), match.group(2), match.group(3)
        return COMPARE[operator](self.register(left), self.number(right))
