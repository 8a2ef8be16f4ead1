"""What it costs to read a program grows in proportion to its size, in every language."""

from pathlib import Path

import pytest

import growing
from beltgrinding.programs.patch.patch import patch
from beltgrinding.programs.program import ProgramError
from beltgrinding.programs.registry import READERS, read_program
from support.cost import cost, growth

HERE = Path(__file__).resolve().parent

LEAST = 4e-3  # s of processor time; below, what does not grow would hide what does
MOST = 200_000  # the largest size: what takes less time than LEAST there is no trouble
TOLERATED = 3  # the square of a size would give 8
SHORT, LONG = 2_000, 16_000  # characters of a statement
DEAR = 40  # units of work for a statement of LONG characters; the square would be thousands


def reading(folder, files):
    """Reads a program; that it is refused is an answer, too."""
    for path in folder.iterdir():
        path.unlink()
    for suffix, text in files.items():
        data = text if isinstance(text, bytes) else text.encode()
        (folder / f"a{suffix}").write_bytes(data)
    main = next(suffix for suffix in files if suffix != ".dtx")
    try:
        return read_program(folder / f"a{main}")
    except ProgramError as error:
        assert "\n" not in str(error)
        return None


@pytest.mark.parametrize("name", growing.MANY)
def test_many_of_a_kind(tmp_path, name):
    program, size = growing.MANY[name], 50
    made = {}

    def work(n):
        if n not in made:
            made[n] = program(n)
        reading(tmp_path, made[n])

    while size < MOST and cost(lambda: work(size)) < LEAST:
        size *= 4
    assert growth(work, size) < TOLERATED


@pytest.mark.parametrize("name", growing.LANGUAGES)
def test_long_statements(tmp_path, name):
    language = growing.LANGUAGES[name]
    plain = "".join(map(str, range(LONG // 4)))  # nothing in it is read
    unit = cost(lambda: reading(tmp_path, language.program([plain])))
    for prefix in language.prefixes.split("|"):
        for piece in growing.REPEATED.values():
            files = growing.long_statement(language, prefix, piece, LONG)
            took = _once(tmp_path, files)
            if took > DEAR * unit:  # seldom: it may have been something else on the machine
                short = growing.long_statement(language, prefix, piece, SHORT)
                ratio = cost(lambda: reading(tmp_path, files)) / cost(
                    lambda: reading(tmp_path, short)
                )
                assert ratio < TOLERATED * LONG / SHORT, f"{prefix!r} and many {piece!r}"


@pytest.mark.parametrize("name", ["krl", "rapid", "urscript", "fanuc", "inform", "gcode"])
@pytest.mark.parametrize("change", [{"dx_mm": 0.1}, {"speed_mm_s": 20.0}])
def test_changes_written_back(tmp_path, name, change):
    def work(n):
        (suffix, text), *_ = growing.MANY[f"{name} motions"](n).items()
        (tmp_path / f"a{suffix}").write_text(text)
        lines = {motion.line for motion in read_program(tmp_path / f"a{suffix}").motions}
        changes = [{"line": line, **change} for line in lines]
        assert len(patch(tmp_path / f"a{suffix}", changes, tmp_path / f"b{suffix}")) == n

    assert growth(work, 150) < TOLERATED


def _once(folder, files):
    import time

    begin = time.process_time()
    reading(folder, files)
    return time.process_time() - begin


def test_every_reader_is_grown():
    suffixes = {language.suffix for language in growing.LANGUAGES.values()}
    assert {READERS[suffix] for suffix in suffixes} == set(READERS.values())
    for name in growing.LANGUAGES:
        assert sum(kind.startswith(name + " ") for kind in growing.MANY) >= 2


def test_what_grows_with_the_square_is_seen():
    def work(n):
        return [0 for _ in range(n) for _ in range(n)]

    assert growth(work, 200) > TOLERATED
