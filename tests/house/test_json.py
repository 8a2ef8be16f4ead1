"""No JSON that the program writes or hashes has NaN or infinity in it: readers of JSON refuse them."""

import ast
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2] / "Mod" / "BeltGrinding" / "beltgrinding"
HASHED = {"base/kept.py"}  # stages of a run, whose limits may be infinite


def calls(path):
    for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        function = getattr(call, "func", None)
        if isinstance(function, ast.Attribute) and function.attr in ("dump", "dumps"):
            if isinstance(function.value, ast.Name) and function.value.id == "json":
                yield call


def test_all_json_is_of_finite_numbers():
    lax = []
    for path in sorted(SOURCES.rglob("*.py")):
        name = path.relative_to(SOURCES).as_posix()
        for call in calls(path):
            given = {one.arg: ast.unparse(one.value) for one in call.keywords}
            if given.get("allow_nan") != "False" and name not in HASHED:
                lax.append(f"{name}:{call.lineno}")
    assert lax == []
