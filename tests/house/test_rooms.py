"""The rooms of src/: what CMake links, what the sources include, and what docs/architecture.md says are
the same; a room cannot reach what it has not declared."""

import html
import json
import os
import re
import shlex
import subprocess
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SRC = ROOT / "src"
BUILD = Path(os.environ.get("BELTGRINDING_BUILD", ROOT / "build" / "release"))

# What an include in angle brackets comes from; None: the language, or every room may have it.
PACKAGES = [
    (r"[a-z_]+", None),
    (r"(Eigen|unsupported/Eigen)/\w+", None),
    (r"(dlfcn|unistd|fcntl|malloc|poll|signal|setjmp|spawn|sys/\w+)\.h", None),
    (r"tbb/\w+\.h", "oneTBB"),
    (r"(hdf5|H5FDdevelop)\.h", "HDF5"),
    (r"embree[34]/.*", "Embree"),
    (r"assimp/.*", "assimp"),
    (r"lib3mf/.*|lib3mf_\w+\.hpp", "lib3mf"),
    (r"fcl/.*", "FCL"),
    (r"ompl/.*", "OMPL"),
    (r"fmt/\w+\.h", "fmt"),
    (r"libsvm/svm\.h", "libsvm"),
    (r"pocketfft(_hdronly|)\.(hpp|h)", "pocketfft"),
    (r"\w+\.hxx", "OpenCASCADE"),
    (r"nanoflann\.hpp", "nanoflann"),
    (r"Inventor/.*", "Coin"),
    (r"GL/\w+\.h", "OpenGL"),
    (r"pybind11/.*", "pybind11"),
]


def declared():
    """{room: (rooms, private rooms)} as CMake links them, in the order in which they are configured."""
    rooms = json.loads((BUILD / "rooms.json").read_text())
    return {name: (r["rooms"], r["private_rooms"]) for name, r in rooms.items()}


def sources(room):
    return sorted(p for p in (SRC / room).rglob("*") if p.suffix in (".h", ".cpp"))


def owners():
    """{what stands in an include: its room} of all headers that rooms show each other."""
    found = {}
    for header in SRC.glob("*/*/*/*.h"):
        room, kind, folder, name = header.relative_to(SRC).parts
        assert (kind, folder) in (("include", "beltgrinding"), ("internal", room)), header
        assert f"{folder}/{name}" not in found, f"two rooms have a {name}"
        found[f"{folder}/{name}"] = room
    return found


def shown(path):
    return path.suffix == ".h" and path.parent.parent.name in ("include", "internal")


def included(room):
    """(rooms that its shown headers include, rooms that its sources include, packages)"""
    mine = {p.name for p in (SRC / room).glob("*.h")}
    owner = owners()
    public, private, packages = set(), set(), set()
    for path in sources(room):
        text = path.read_text()
        for name in re.findall(r'^#\s*include "([^"]+)"', text, re.M):
            if name in owner:
                (public if shown(path) else private).add(owner[name])
            else:
                assert name in mine and not shown(path), f"{path.name} includes {name}"
        for name in re.findall(r"^#\s*include <([^>]+)>", text, re.M):
            origin = [p for pattern, p in PACKAGES if re.fullmatch(pattern, name)]
            assert origin, f"{path.name} includes <{name}>: which package is that?"
            packages.update(p for p in origin if p)
    return public - {room}, private - public - {room}, packages


def table():
    """{room: (rooms, packages)} of the table in docs/architecture.md, in its order."""
    text = (ROOT / "docs" / "architecture.md").read_text()
    rows = text.split("| room (src/) |")[1].split("\n\n")[0].splitlines()[2:]
    cells = [[c.strip() for c in row.strip("|").split("|")] for row in rows]
    names = lambda cell: {n.strip() for n in cell.split(",") if n.strip()}
    return {c[0]: (names(c[2]), names(c[3])) for c in cells}


ROOMS = sorted(p.parent.name for p in SRC.glob("*/CMakeLists.txt"))


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_declares_what_it_includes(room):
    if room not in declared():
        pytest.skip(f"{room} is not built here: its packages are missing")
    public, private, _ = included(room)
    rooms, private_rooms = map(set, declared()[room])
    if room == "python":  # optional bindings are linked only where they are built
        private &= private_rooms | ({"coin", "scan"} & set(declared()))
    assert (public, private) == (rooms, private_rooms)


def test_the_table_says_what_is_linked_and_included():
    rows = table()
    assert set(rows) == set(ROOMS)
    for room, (rooms, packages) in rows.items():
        public, private, used = included(room)
        expected = set(ROOMS) - {room} if rooms == {"all"} else rooms
        if room == "python":
            assert public | private <= expected
        else:
            assert public | private == expected, room
        assert used == packages, room


def test_the_picture_shows_the_rooms():
    tool = SourceFileLoader("rooms", str(ROOT / "tools" / "rooms"))
    rooms = module_from_spec(spec_from_loader("rooms", tool))
    tool.exec_module(rooms)
    titles = re.findall(r"<title>(.*?)</title>", rooms.PICTURE.read_text())
    drawn = {tuple(html.unescape(title).split("->")) for title in titles} - {("rooms",)}
    built = json.loads((BUILD / "rooms.json").read_text())
    if set(built) != set(ROOMS):
        pytest.skip("not every room is built here: its packages are missing")
    shown_rooms = {(name,) for name in built} - {(name,) for name in rooms.HIDDEN}
    assert drawn == shown_rooms | rooms.ways(built), "run tools/rooms"


def test_the_page_is_short():
    """Six headed sections between the rooms and the links, of at most 120 words each."""
    page = (ROOT / "docs" / "architecture.md").read_text()
    sections = dict(part.split("\n", 1) for part in page.split("\n## ")[1:])
    assert list(sections)[0] == "Rooms" and list(sections)[-1] == "Further pages"
    words = {name: len(text.split()) for name, text in list(sections.items())[1:-1]}
    assert len(words) == 6 and max(words.values()) <= 120, words


def test_no_circle():
    """The table's order is one in which every room stands below all that it includes."""
    above = set()
    for room in table():
        public, private, _ = included(room)
        assert public | private <= above, room
        above.add(room)


def include_flags(room):
    """{include flags of a target of the room}; empty: it has no sources."""
    found = set()
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        if Path(entry["file"]).parent == SRC / room:
            words = shlex.split(entry["command"])
            found.add(tuple(w for w in words if w.startswith("-I")))
    return found


def reachable(room):
    """The room and all that its declared rooms hand on."""
    rooms = declared()
    found, front = {room}, {*rooms[room][0], *rooms[room][1]}
    while front:
        one = front.pop()
        if one not in found:
            found.add(one)
            front |= set(rooms[one][0])
    return found


@pytest.mark.parametrize("room", ROOMS)
def test_an_undeclared_include_does_not_compile(room):
    targets = room in declared() and include_flags(room)
    if not targets:
        pytest.skip(f"{room} has no sources, or is not built here")
    headers = owners()
    private = {p.name: p.parent.name for p in SRC.glob("*/*.h")}
    text = "".join(
        f'#if __has_include("{name}")\n"reached" "{name}"\n#endif\n'
        for name in {**headers, **private}
    )
    reached = set()
    for flags in targets:
        run = subprocess.run(
            ["c++", "-std=c++20", "-nostdinc", *flags, "-E", "-P", "-x", "c++", "-"],
            input=text,
            capture_output=True,
            text=True,
            check=True,
        )
        reached |= set(re.findall(r'"reached" "([^"]+)"', run.stdout))
    assert reached == {name for name, owner in headers.items() if owner in reachable(room)}
