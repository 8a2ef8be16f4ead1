"""The C++ library as another project meets it: installed into an empty folder, found by CMake and by
pkg-config, or as a subdirectory."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("BELTGRINDING_BUILD", ROOT / "build" / "release"))
EXAMPLE = ROOT / "examples" / "plate.cpp"
PRESS = ROOT / "examples" / "press.cpp"
BELT = ROOT / "examples" / "belt.cpp"
PART = ROOT / "examples" / "part.cpp"
PAGE = (ROOT / "docs" / "library.md").read_text("utf-8")


def run(*command, **keys):
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, timeout=600, **keys
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """A prefix that holds nothing but the component `library`."""
    folder = tmp_path_factory.mktemp("installed") / "prefix"
    run("cmake", "--install", BUILD, "--component", "library", "--prefix", folder)
    return folder


def project(folder, text, *sources):
    """Writes a project of its own."""
    folder.mkdir()
    for source in sources:
        shutil.copy(source, folder)
    (folder / "CMakeLists.txt").write_text(text)
    return folder


def configure(folder, *options):
    return run("cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build", *options)


def check_depth(printed):
    """Against dh/dt = K V_b p: the wheel passes over the middle of its way once, so that the depth there
    is K V_b F / (w V_w), and all that is removed in the time t of its way is K V_b F t."""
    depth, volume = map(
        float, re.fullmatch(r"depth ([\d.]+) mm, volume ([\d.]+) mm3\n", printed).groups()
    )
    coefficient, speed, force, width, feed, way = 1e-4, 20e3, 40.0, 20.0, 50.0, 80.0
    assert depth == pytest.approx(coefficient * speed * force / (width * feed), rel=0.002)
    assert volume == pytest.approx(coefficient * speed * force * way / feed, rel=0.002)


FIND = """cmake_minimum_required(VERSION 3.22)
project(grind LANGUAGES CXX)
find_package(BeltGrinding {version} REQUIRED COMPONENTS core)
foreach(example plate press belt)
  add_executable(${{example}} ${{example}}.cpp)
  target_link_libraries(${{example}} PRIVATE beltgrinding::core)
endforeach()
"""


def test_the_page_opens_with_the_smallest_example():
    """And the README has it, with what it prints."""
    block = "".join(f"    {line}\n" if line else "\n" for line in PRESS.read_text().splitlines())
    assert PAGE.split("\n", 2)[2].startswith(block)
    readme = (ROOT / "README.md").read_text("utf-8")
    assert block in readme and re.search(r"    (\d+ mm2, .*)\n", PAGE)[0] in readme


def test_the_example_by_find_package(prefix, tmp_path):
    folder = project(tmp_path / "user", FIND.format(version=""), EXAMPLE, PRESS, BELT)
    configure(folder, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", folder / "build")
    printed = run(folder / "build" / "plate", cwd=tmp_path)
    check_depth(printed)
    assert f"    {printed}" in PAGE
    for example in ("press", "belt"):
        lines = run(folder / "build" / example, cwd=tmp_path).splitlines()
        assert "".join(f"    {line}\n" for line in lines) in PAGE, example


def test_the_example_by_pkg_config(prefix, tmp_path):
    files = next(prefix.rglob("beltgrinding.pc")).parent
    env = {**os.environ, "PKG_CONFIG_PATH": str(files)}
    flags = run("pkg-config", "--cflags", "--libs", "beltgrinding", env=env).split()
    run("c++", "-std=c++20", "-O2", EXAMPLE, "-o", tmp_path / "plate", *flags)
    check_depth(run(tmp_path / "plate", cwd=tmp_path))


def test_a_moved_prefix_is_still_found(prefix, tmp_path):
    moved = tmp_path / "elsewhere"
    shutil.copytree(prefix, moved)
    for path in moved.rglob("*"):
        if path.suffix in (".cmake", ".pc"):
            assert str(prefix) not in path.read_text() and str(ROOT) not in path.read_text(), path
    configure(
        project(tmp_path / "user", FIND.format(version=""), EXAMPLE, PRESS, BELT),
        f"-DCMAKE_PREFIX_PATH={moved}",
    )


READS = """cmake_minimum_required(VERSION 3.22)
project(reads LANGUAGES CXX)
find_package(BeltGrinding REQUIRED COMPONENTS core brep stock)
add_executable(part part.cpp)
target_link_libraries(part PRIVATE beltgrinding::brep beltgrinding::stock)
add_executable(mesh mesh.cpp)
target_link_libraries(mesh PRIVATE beltgrinding::stock)
"""
MESH = """#include <beltgrinding/mesh_reader.h>
#include <cstdio>
int main(int, char** words) {
    std::printf("%zu triangles\\n", beltgrinding::read_mesh(words[1]).triangles.size());
}
"""
FACET = "facet normal 0 0 0 outer loop vertex {} vertex {} vertex {} endloop endfacet\n"
CORNERS = "0 0 0", "10 0 0", "0 10 0", "0 0 10"


def test_a_static_library_finds_its_reader_in_any_prefix(prefix, tmp_path):
    moved = tmp_path / "a prefix"
    shutil.copytree(prefix, moved)
    folder = project(tmp_path / "user", READS, PART)
    (folder / "mesh.cpp").write_text(MESH)
    corners = [
        [CORNERS[k] for k in three] for three in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
    ]
    facets = "".join(FACET.format(*three) for three in corners)
    (tmp_path / "solid.stl").write_text(f"solid s\n{facets}endsolid s\n")
    configure(folder, f"-DCMAKE_PREFIX_PATH={moved}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", folder / "build")
    assert run(folder / "build" / "mesh", tmp_path / "solid.stl", env={}) == "4 triangles\n"
    printed = run(folder / "build" / "part", tmp_path / "solid.stl", "1", env={})
    assert re.fullmatch(r"face 1 of 4: .*\n.*\n", printed), printed
    unread = tmp_path / "damaged.step"
    unread.write_text("ISO-10303-21;")
    with pytest.raises(AssertionError, match="damaged.step"):
        run(folder / "build" / "part", unread, "1", env={})


@pytest.mark.parametrize("version, fits", [("0.0.1", False), ("99.0", False)])
def test_another_version_is_refused(prefix, tmp_path, version, fits):
    folder = project(tmp_path / "user", FIND.format(version=version), EXAMPLE, PRESS, BELT)
    with pytest.raises(AssertionError, match="compatible with requested version"):
        configure(folder, f"-DCMAKE_PREFIX_PATH={prefix}")


def test_an_unknown_part_is_refused(prefix, tmp_path):
    text = FIND.format(version="").replace("COMPONENTS core", "COMPONENTS core polishing")
    folder = project(tmp_path / "user", text, EXAMPLE, PRESS, BELT)
    with pytest.raises(AssertionError, match="polishing"):
        configure(folder, f"-DCMAKE_PREFIX_PATH={prefix}")


def test_every_header_compiles_alone(prefix, tmp_path):
    headers = sorted((prefix / "include" / "beltgrinding").glob("*.h"))
    assert 10 <= len(headers) <= 25
    files = next(prefix.rglob("beltgrinding.pc")).parent
    env = {**os.environ, "PKG_CONFIG_PATH": str(files)}
    flags = run("pkg-config", "--cflags", "beltgrinding", env=env).split()
    flags = [f.replace("-I/usr", "-isystem/usr") for f in flags]
    for header in headers:
        text = header.read_text()
        for name in ("hxx", "Inventor/", "pybind11/", "Python.h", "embree", "assimp", "hdf5"):
            assert not re.search(rf"#\s*include\s*[<\"].*{re.escape(name)}", text), header.name
        run(
            "c++", "-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only",
            "-x", "c++", "-", *flags, input=f'#include "beltgrinding/{header.name}"\n',
        )  # fmt: skip


PARTS = """cmake_minimum_required(VERSION 3.22)
project(parts LANGUAGES CXX)
find_package(BeltGrinding REQUIRED)
foreach(part core brep stock scan)
  if(TARGET beltgrinding::${part})
    add_executable(use_${part} ${part}.cpp)
    target_link_libraries(use_${part} PRIVATE beltgrinding::${part})
    message(STATUS "part ${part}")
  endif()
endforeach()
"""
USES = {
    "core": "beltgrinding/height_field.h beltgrinding::HeightField().resize(3);",
    "brep": "beltgrinding/shape.h beltgrinding::Shape::from_brep(argv[1]);",
    "stock": "beltgrinding/stock.h beltgrinding::HeightField f; f.resize(2); apply_allowance(f, 1);",
    "scan": "beltgrinding/registration.h",
}


def test_the_parts_link(prefix, tmp_path):
    folder = project(tmp_path / "user", PARTS)
    for part, use in USES.items():
        header, _, call = use.partition(" ")
        (folder / f"{part}.cpp").write_text(
            f"#include <{header}>\nint main(int argc, char** argv) {{\n"
            f"    (void)argv;\n    if (argc > 1) {{ {call} }}\n    return 0;\n}}\n"
        )
    parts = re.findall(r"part (\w+)", configure(folder, f"-DCMAKE_PREFIX_PATH={prefix}"))
    built = [p.stem.removeprefix("BeltGrinding-") for p in prefix.rglob("BeltGrinding-*.cmake")]
    assert set(parts) == {p for p in built if "-" not in p}
    run("cmake", "--build", folder / "build")
    for part in parts:
        run(folder / "build" / f"use_{part}")


INSIDE = """cmake_minimum_required(VERSION 3.22)
project(whole LANGUAGES CXX)
set(before "${CMAKE_CXX_STANDARD}|${CMAKE_CXX_FLAGS}|${CMAKE_BUILD_TYPE}|${CMAKE_CXX_COMPILER_LAUNCHER}")
add_subdirectory(${SOURCE} beltgrinding)
set(after "${CMAKE_CXX_STANDARD}|${CMAKE_CXX_FLAGS}|${CMAKE_BUILD_TYPE}|${CMAKE_CXX_COMPILER_LAUNCHER}")
if(NOT before STREQUAL after)
  message(FATAL_ERROR "${before} became ${after}")
endif()
foreach(target test_gap contact_bench translations beltgrinding_core package_source)
  if(TARGET ${target})
    message(FATAL_ERROR "there is a target ${target}")
  endif()
endforeach()
get_property(tests DIRECTORY ${SOURCE} PROPERTY TESTS)
if(tests OR DEFINED CPACK_PACKAGE_NAME)
  message(FATAL_ERROR "tests or packages")
endif()
add_executable(plate plate.cpp)
target_link_libraries(plate PRIVATE beltgrinding::core)
"""


def test_inside_another_project(tmp_path):
    folder = project(tmp_path / "user", INSIDE, EXAMPLE)
    configure(folder, f"-DSOURCE={ROOT}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    commands = (folder / "build" / "compile_commands.json").read_text()
    assert "-Werror" not in commands and "ccache" not in commands
    assert "libbeltgrinding.a" in (folder / "build" / "build.ninja").read_text()
    run(
        "cmake", "--build", folder / "build", "--target", "bg_removal"
    )  # one room, for the time it takes


def test_a_part_that_is_wanted_and_cannot_be_built_is_an_error(tmp_path):
    options = ["-G", "Ninja", "-S", str(ROOT), "-B", str(tmp_path / "build")]
    options += ["-DBELTGRINDING_TESTS=OFF", "-DBELTGRINDING_BENCHMARKS=OFF"]
    without = ["-DCMAKE_DISABLE_FIND_PACKAGE_OpenCASCADE=ON"]
    text = run("cmake", *options, *without)
    for part in ("beltgrinding::brep", "Python binding", "workbench"):
        assert re.search(rf"Not built: .*{part}.*; missing: .*(OpenCASCADE|the part)", text), part
    with pytest.raises(
        AssertionError, match=r"(?s)BELTGRINDING_BREP is ON.*missing:\s+OpenCASCADE"
    ):
        run("cmake", *options, *without, "-DBELTGRINDING_BREP=ON")
