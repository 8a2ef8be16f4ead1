"""Called by `tools/package portable`: portable.py STAGE BUILT OUT.

STAGE is the workbench as the component `portable` installs it; BUILT/modules has the modules for each Python. Their
libraries are laid beside them under names of their own, so that those of a FreeCAD in the same process, of other
versions perhaps, are neither used nor replaced. Writes the zip and the wheels into OUT.
"""

from __future__ import annotations

import json
import re
import shutil
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

from PIL import Image

READER = "beltgrinding-cad-reader"
# Of the system, wherever it runs: glibc; the compiler's libraries, which are backward compatible; Python.
HOST = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+|python3.*))\.so.*")
# FreeCAD's own, in the process already: a second Coin could not draw into its scene.
FREECADS = re.compile(r"lib(Coin|GL|GLX|OpenGL|GLU|EGL|X11|Xext|Xi)\.so.*")
# Never called: HDF5 would read from the net by them, lib3mf's libzip encrypted files. They bring fourteen megabytes.
ABSENT = ("libcurl.so.4", "libcrypto.so.3")
PURE = ("jsonschema", "attr", "attrs", "pyrsistent", "_pyrsistent_version.py")
THREE = Path("/usr/share/javascript/three/three.min.js")
REPORT = "docs/images/tap-report.html"
MOST_MB = 60
TRIAL = "import beltgrinding_core, beltgrinding_scan"
WHEEL = """Wheel-Version: 1.0
Generator: belt-grinding
Root-Is-Purelib: false
Tag: cp{digits}-cp{digits}-{platform}
"""
METADATA = """Metadata-Version: 2.1
Name: beltgrinding
Version: {version}
Summary: Simulation of robotic belt grinding: what the belt will leave on a part, and where it will cut too deep
License: LGPL-2.1-or-later
Requires-Python: =={python}.*
Requires-Dist: numpy
Requires-Dist: matplotlib
Requires-Dist: Pillow
Description-Content-Type: text/markdown

{readme}"""


def output(*command: object) -> str:
    """What a command prints; the process ends with its words where it fails."""
    done = subprocess.run([str(one) for one in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{command[0]}: {done.stderr.strip()}")
    return done.stdout


def paths_of_libraries(binaries: list[Path]) -> dict[str, Path]:
    """Where the loader finds each library that they need, directly or not, by its name."""
    found = {}
    for binary in binaries:
        for name, path in re.findall(r"(\S+) => (\S+)", output("ldd", binary)):
            if path == "not":
                sys.exit(f"{binary} needs {name}, which is not installed")
            found[name] = Path(path)
    return found


def own_name(name: str) -> str:
    """libtbb.so.12 -> libtbb.so.12-beltgrinding.so: no loader takes it for another's."""
    return f"{name}-beltgrinding.so"


def bundle(binaries: list[Path], folder: Path) -> list[Path]:
    """Lays the libraries of the binaries into a folder and leads both to each other. Returns the libraries' origins."""
    libraries = {
        name: path
        for name, path in paths_of_libraries(binaries).items()
        if not HOST.fullmatch(name) and not FREECADS.fullmatch(name)
    }
    folder.mkdir(parents=True)
    absent = {name: stand_in(name, libraries, folder) for name in ABSENT if name in libraries}
    libraries.update(absent)
    wanted = needed(binaries, libraries)
    copies = []
    for name in sorted(wanted):
        copy = folder / own_name(name)
        shutil.copyfile(libraries[name], copy)
        copy.chmod(0o755)
        output("patchelf", "--set-soname", copy.name, copy)
        copies.append(copy)
    for one in [*binaries, *copies]:
        output("strip", "--strip-unneeded", one)  # first: it breaks what patchelf has moved
        for name in output("patchelf", "--print-needed", one).split():
            if name in wanted:
                output("patchelf", "--replace-needed", name, own_name(name), one)
            elif FREECADS.fullmatch(name):
                output("patchelf", "--remove-needed", name, one)
        rpath = "$ORIGIN" if one in copies else "$ORIGIN/" + folder.name
        output(
            "patchelf", "--set-rpath", rpath, one
        )  # alone: with others patchelf 0.14 leaves those out
        make_unique_symbols_plain(one)
    for made in absent.values():
        made.unlink()
    left = {
        name
        for one in [*binaries, *copies]
        for name in output("patchelf", "--print-needed", one).split()
    }
    foreign = {one for one in left if not one.endswith(own_name("")) and not HOST.fullmatch(one)}
    if foreign:
        sys.exit(f"still needed by their own names: {', '.join(sorted(foreign))}")
    return [libraries[name].resolve() for name in sorted(wanted - set(absent))]


def stand_in(name: str, libraries: dict[str, Path], folder: Path) -> Path:
    """A library of that name whose functions, those that the others want, do nothing and return 0: no handle."""
    own = {one.replace("@@", "@") for one in symbols(libraries[name], "--defined-only")}
    others = [path for path in libraries.values() if path != libraries[name]]
    wanted = {one for path in others for one in symbols(path, "--undefined-only")}
    versions: dict[str, list[str]] = {}
    for symbol in sorted(own & wanted):
        function, version = symbol.split("@")
        versions.setdefault(version, []).append(function)
    source, script, made = folder / "absent.c", folder / "absent.map", folder / name
    functions = [one for many in versions.values() for one in many]
    source.write_text("".join(f"void* {one}(void) {{ return 0; }}\n" for one in functions))
    script.write_text(
        "".join(
            f"{version} {{ global: {'; '.join(many)}; }};\n" for version, many in versions.items()
        )
    )
    options = (
        "-shared",
        "-fPIC",
        "-O2",
        "-w",
        "-fno-builtin",
        f"-Wl,--version-script={script}",
        f"-Wl,-soname,{name}",
    )
    output("gcc", *options, source, "-o", made)
    source.unlink()
    script.unlink()
    return made


def symbols(path: Path, which: str) -> set[str]:
    """Dynamic symbols as NAME@VERSION, or NAME@@VERSION where they are defined."""
    return {line.split()[-1] for line in output("nm", "-D", which, path).splitlines()}


def needed(binaries: list[Path], libraries: dict[str, Path]) -> set[str]:
    """Names of the libraries that are reached, not by way of FreeCAD's."""
    names: set[str] = set()
    rest = list(binaries)
    while rest:
        for name in output("patchelf", "--print-needed", rest.pop()).split():
            if name in libraries and name not in names:
                names.add(name)
                rest.append(libraries[name])
    return names


def make_unique_symbols_plain(path: Path) -> None:
    """STB_GNU_UNIQUE symbols are one in a process, whichever library has them: ours would be taken for those of another
    OpenCASCADE. They become global ones, which a library that Python loads keeps to itself."""
    data = bytearray(path.read_bytes())
    at, size, count = (
        struct.unpack_from(form, data, where)[0]
        for form, where in (("<Q", 40), ("<H", 58), ("<H", 60))
    )
    for index in range(count):
        head = at + index * size
        kind = struct.unpack_from("<I", data, head + 4)[0]
        if kind != 11:  # SHT_DYNSYM
            continue
        start, length = struct.unpack_from("<QQ", data, head + 24)
        for symbol in range(start, start + length, 24):
            if data[symbol + 4] >> 4 == 10:
                data[symbol + 4] = 1 << 4 | data[symbol + 4] & 15
    path.write_bytes(data)


def newest_needed(binaries: list[Path], prefix: str) -> str:
    """The newest version of glibc (GLIBC) or libstdc++ (GLIBCXX) that they ask for."""
    found = {(0,)}
    for one in binaries:
        for text in re.findall(rf"\b{prefix}_([0-9.]+)", output("objdump", "-T", one)):
            found.add(tuple(map(int, text.split("."))))
    return ".".join(map(str, max(found)))


def licences(origins: list[Path], folder: Path) -> None:
    """Copies what Debian says of the copyright of each package from which a file comes; the same text once."""
    folder.mkdir(parents=True, exist_ok=True)
    first: dict[bytes, str] = {}
    for package in sorted({owner(path) for path in origins}):
        text = Path(f"/usr/share/doc/{package}/copyright").read_bytes()
        same = first.setdefault(text, package)
        if same != package:
            text = f"The same as {same}.txt\n".encode()
        (folder / f"{package}.txt").write_bytes(text)


def owner(path: Path) -> str:
    """The package of a file, which dpkg may know without the /usr before."""
    for one in (path, Path(str(path).removeprefix("/usr"))):
        done = subprocess.run(["dpkg", "-S", str(one)], capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout.split(":")[0]
    sys.exit(f"no package has {path}")


def vendor(folder: Path) -> None:
    """Lays the pure Python packages and three.js into a folder, with their licences."""
    folder.mkdir()
    site = Path("/usr/lib/python3/dist-packages")
    origins = [THREE.resolve()]
    for name in PURE:
        source = site / name
        if source.is_dir():
            ignored = shutil.ignore_patterns("__pycache__", "tests", "*.so")
            shutil.copytree(source, folder / name, ignore=ignored)
            origins.append(source / "__init__.py")
        else:
            shutil.copyfile(source, folder / name)
    shutil.copyfile(THREE, folder / THREE.name)
    licences(origins, folder / "licences")


def stage_portable(stage: Path, built: Path) -> tuple[list[Path], list[str]]:
    """Turns the installed workbench into one that brings its libraries. Returns its binaries and the Pythons' digits."""
    modules = sorted((built / "modules").glob("*.so"))
    reader = next(stage.glob(f"{READER}*"))
    reader.rename(stage / READER)
    for one in stage.glob("*.so.json"):  # of the module for this Python
        one.unlink()
    for module in modules:
        shutil.copy(module, stage)
    binaries = [stage / one.name for one in modules] + [stage / READER]
    origins = bundle(binaries, stage / "libs")
    licences(origins, stage / "libs" / "licences")
    digits = []
    for core in stage.glob("beltgrinding_core*.so"):
        digits += re.findall(r"cpython-(\d+)", core.name)
        told = json.dumps({"system": "any Linux", "python": f"3.{digits[-1][1:]}"})
        core.with_name(core.name + ".json").write_text(told + "\n")
    vendor(stage / "beltgrinding" / "vendored")
    for picture in (stage / "docs" / "images").glob("*.png"):
        Image.open(picture).convert("RGB").quantize(256).save(
            picture, optimize=True
        )  # a third of the bytes
    without_report(stage)
    package_xml = stage / "package.xml"
    text = package_xml.read_text()
    package_xml.write_text(re.sub(r"\s*<depend [^>]*>jsonschema</depend>", "", text))
    return [*binaries, *(stage / "libs").glob("*.so")], sorted(digits)


def without_report(stage: Path) -> None:
    """Leaves out the report that README.md shows to strangers, three megabytes, with what leads there."""
    (stage / REPORT).unlink()
    readme = stage / "README.md"
    paragraphs = readme.read_text(encoding="utf-8").split("\n\n")
    kept = [one for one in paragraphs if REPORT not in one]
    readme.write_text("\n\n".join(kept), encoding="utf-8")


def write_zip(stage: Path, path: Path) -> None:
    """A zip that keeps the modes of files."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for one in sorted(stage.rglob("*")):
            if one.is_file() and "__pycache__" not in one.parts:
                archive.write(one, one.relative_to(stage))


def write_wheel(stage: Path, work: Path, digits: str, version: str, out: Path) -> Path:
    """The package alone, with its modules, libraries, resources and pages inside, for one Python."""
    root = work / f"wheel-{digits}"
    package = root / "beltgrinding"
    shutil.copytree(stage / "beltgrinding", package, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("Resources", "docs", "libs"):
        shutil.copytree(stage / name, package / name)
    for one in [*stage.glob(f"*cpython-{digits}*"), stage / READER, stage / "LICENSE"]:
        if "_coin." not in one.name:  # draws inside FreeCAD
            shutil.copy(one, package)
    glibc = newest_needed(
        list(package.glob("*.so")) + list((package / "libs").glob("*.so")), "GLIBC"
    )
    platform = f"manylinux_{glibc.replace('.', '_')}_x86_64"
    about = root / f"beltgrinding-{version}.dist-info"
    about.mkdir()
    python = f"{digits[0]}.{digits[1:]}"
    readme = (stage / "README.md").read_text(encoding="utf-8")
    (about / "METADATA").write_text(METADATA.format(version=version, python=python, readme=readme))
    (about / "WHEEL").write_text(WHEEL.format(digits=digits, platform=platform))
    (about / "entry_points.txt").write_text(
        "[console_scripts]\nbeltgrind = beltgrinding.cli:process\n"
    )
    shutil.copyfile(stage / "LICENSE", about / "LICENSE")
    output(sys.executable, "-m", "wheel", "pack", root, "--dest-dir", out)
    return next(out.glob(f"*cp{digits}-*.whl"))


def main(stage: Path, built: Path, out: Path) -> None:
    binaries, digits = stage_portable(stage, built)
    subprocess.run(["/usr/bin/python3", "-c", TRIAL], cwd=stage, check=True)
    version = re.findall(r"<version>(.*)</version>", (stage / "package.xml").read_text())[0]
    path = out / f"BeltGrinding-{version}-linux-x86_64.zip"
    write_zip(stage, path)
    made = [path]
    for one in digits:
        made.append(write_wheel(stage, built / "wheels", one, version, out))
    for one in made:
        print(f"{one.stat().st_size / 1e6:6.1f} MB  {one}")
    pythons = " and ".join(f"{one[0]}.{one[1:]}" for one in digits)
    print(
        f"For Python {pythons}; glibc {newest_needed(binaries, 'GLIBC')} or newer, "
        f"libstdc++ with GLIBCXX_{newest_needed(binaries, 'GLIBCXX')} or newer"
    )
    if any(one.stat().st_size > MOST_MB * 1e6 for one in made):
        sys.exit(f"A package is larger than {MOST_MB} MB")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
