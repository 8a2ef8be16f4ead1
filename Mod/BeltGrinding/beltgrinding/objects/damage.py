"""Damage in a document's file: found before FreeCAD makes room for what a damaged length claims, and told by object and
property.

FreeCAD reads Document.xml, whose Python objects come to life then, and after it the files beside it: lists, meshes,
shapes. So the first of our proxies that comes to life (``look``) can see whether those files are as long as they claim.
"""

from __future__ import annotations

import contextlib
import math
import struct
import threading
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib
from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD

from ..engine import InputError
from .kinds import Document, DocumentObject

ITEMS = {"VectorList": 24, "FloatList": 8, "PlacementList": 56, "ColorList": 4}  # bytes of an entry
WHOLE = ("ColorList",)  # that are as long in files of single precision
MESH_HEAD, MESH_END = (
    struct.Struct("<2I256x2I"),
    24,
)  # bytes: numbers of points, 12 each, facets, 24
ROOM = 256 << 20  # bytes that reading a damaged document may take beyond what it takes already
NOT_SAVED = 1 << 4  # of a property's status: FreeCAD writes that it is there, and not what it holds
MOST = 1 << 30  # bytes of Document.xml that are looked at
STEADY = ("Proxy", "Label", "ExpressionEngine")  # FreeCAD's own

_found: dict[
    str, dict[str, Any]
] = {}  # name of a document that is being restored: {name of an object: {property: reason}}
_held: dict[str, Any] = {}  # while memory is held: the limit that there was


def look() -> None:
    """Looks at the files of the documents that are being restored, once each."""
    for document in FreeCAD.listDocuments().values():
        if getattr(document, "Restoring", False) and document.Name not in _found:
            found: dict[str, Any] = {}
            _found[document.Name] = found
            try:
                most = _look_at(document.FileName, found)
            except (OSError, ValueError, zipfile.BadZipFile, zlib.error, ElementTree.ParseError):
                continue  # FreeCAD says what it is
            if most > ROOM:
                _hold()


def _look_at(path: str, found: dict[Any, Any]) -> int:
    """Fills ``found``; the bytes that the longest of the lists claims to have."""
    claimed = 0
    with zipfile.ZipFile(path) as file:
        if file.getinfo("Document.xml").file_size > MOST:
            return 0
        root = ElementTree.fromstring(file.read("Document.xml"))
        names = {one.get("name") for one in root.iterfind("Objects/Object")}
        single = root.get("FileVersion") == "0"
        for one in root.iterfind("ObjectData/Object"):
            wrong: dict[str | None, Any] = {}
            ours = any(
                (held.get("module") or "").startswith("beltgrinding.")
                for held in one.iter("Python")
            )
            for held in one.iterfind("Properties/Property"):
                name, kind = held.get("name"), (held.get("type") or "").rpartition("::Property")[2]
                bytes_, sound = _file_of(file, held, kind, single)
                claimed = max(claimed, bytes_)
                if not sound or ours and not _sound(held, kind, names):
                    wrong[name] = kind
            if ours:
                wrong[None] = {held.get("name") for held in one.iterfind("Properties/Property")}
            if wrong:
                found[one.get("name")] = wrong
    return claimed


def _file_of(
    file: zipfile.ZipFile, held: ElementTree.Element, kind: str, single: bool
) -> tuple[int, bool]:
    """(bytes that a property's file claims to have, whether it has them)"""
    name = next((one.get("file") for one in held if one.get("file")), None)
    if name is None or kind not in ITEMS and kind != "MeshKernel":
        return 0, True
    try:
        size = file.getinfo(name).file_size
        with file.open(name) as opened:
            if kind == "MeshKernel":
                head = opened.read(MESH_HEAD.size)
                if len(head) < MESH_HEAD.size:
                    return 0, size == 0
                points, facets = MESH_HEAD.unpack(head)[-2:]
                claimed = MESH_HEAD.size + 12 * points + 24 * facets + MESH_END
            else:
                each = ITEMS[kind] // (2 if single and kind not in WHOLE else 1)
                claimed = 4 + each * int.from_bytes(opened.read(4), "little")
            while opened.read(1 << 20):  # to its end, where its checksum is compared
                pass
    except (KeyError, OSError, zipfile.BadZipFile, zlib.error, EOFError):
        return 0, False
    return claimed, claimed == size


def _sound(held: ElementTree.Element, kind: str, names: set[str | None]) -> bool:
    """Whether what stands in Document.xml of a property can be what was written."""
    first = next(iter(held), None)
    if first is None:
        status = held.get("status") or ""
        return status.isdigit() and bool(int(status) & NOT_SAVED)
    value: Any = first.get("value")
    if first.tag == "Float":
        try:
            return math.isfinite(float(value))
        except (TypeError, ValueError):
            return False
    if first.tag == "Integer" or kind in ("Integer", "Enumeration"):
        return value is not None and value.lstrip("-").isdigit()
    if kind == "Bool":
        return value in ("true", "false")
    if kind == "String":
        return value is not None
    if kind.startswith("Link"):
        told = [one.get("value") or one.get("obj") for one in held.iter("Link")]
        return all(name in names for name in told if name)
    return True


def _hold() -> None:
    """Lets allocations fail that would take much more than there is now; FreeCAD leaves out what it cannot read."""
    try:
        import resource

        with open("/proc/self/statm", encoding="ascii") as file:
            size = int(file.read().split()[0]) * resource.getpagesize()
        before = resource.getrlimit(resource.RLIMIT_AS)
        if not _held and (before[0] == resource.RLIM_INFINITY or before[0] > size + ROOM):
            resource.setrlimit(resource.RLIMIT_AS, (size + ROOM, before[1]))
            _held["limit"] = before
            threading.Timer(60.0, _release).start()  # should nothing be restored
    except (ImportError, OSError, ValueError):
        pass  # not Linux


def _release() -> None:
    if _held:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, _held.pop("limit"))


def restored(
    obj: DocumentObject, before: set[str], add_properties: Callable[[DocumentObject], None]
) -> None:
    """Tells what of a restored object is damaged, gives it its default, and keeps its names in ``Damaged``. ``before``:
    names of its properties as FreeCAD restored them; ``add_properties(obj)``: adds those that it lacks, which was done.
    """
    _release()
    wrong = dict(_found.get(obj.Document.Name, {}).get(obj.Name, {}))
    written, now = wrong.pop(None, before), set(obj.PropertiesList)
    names = set(wrong) & now
    names |= (written - before) & now  # of a damaged type
    names |= {one for one in now - written if any(_one_bit(one, other) for other in before)}
    names -= set(STEADY)
    for name in names:
        with contextlib.suppress(Exception):  # FreeCAD's own properties stay
            obj.removeProperty(name)
    if names:
        add_properties(obj)
        keep(obj, names)


def _one_bit(one: str, other: str) -> bool:
    if len(one) != len(other):
        return False
    differ = [ord(a) ^ ord(b) for a, b in zip(one, other) if a != b]
    return len(differ) == 1 and differ[0] & (differ[0] - 1) == 0


def keep(obj: DocumentObject, names: Iterable[str]) -> None:
    """Notes and tells that properties of an object are damaged."""
    if "Damaged" not in obj.PropertiesList:
        text = "what was damaged in the file and has its default now; it leaves the list when it is set"
        obj.addProperty("App::PropertyStringList", "Damaged", "Base", text)
    obj.Damaged = sorted({*obj.Damaged, *names})
    FreeCAD.Console.PrintWarning(f"{_error(obj)}\n")


def changed(obj: DocumentObject, name: str) -> None:
    """A property was set: it is damaged no more."""
    if name in getattr(obj, "Damaged", ()) and not obj.Document.Restoring:
        obj.Damaged = [one for one in obj.Damaged if one != name]


def check(obj: DocumentObject) -> None:
    """Raises InputError for an object of which something is damaged and was not set again."""
    if getattr(obj, "Damaged", None):
        raise _error(obj)


def check_job(job: DocumentObject) -> None:
    """Raises InputError where the job, or a member of it, is damaged."""
    for obj in (job, *job.Group):
        check(obj)
        if "Proxy" in obj.PropertiesList and obj.Proxy is None:
            raise InputError(
                "objects.damaged_object",
                "{object}: damaged in the document's file, which does not tell what it is; delete it and make it anew",
                object=obj.Label,
            )


def _error(obj: DocumentObject) -> InputError:
    return InputError(
        "objects.damaged",
        "{object}: {names}: damaged in the document's file, and at the default now; set it again, or empty Damaged",
        object=obj.Label,
        names=", ".join(obj.Damaged),
        key=obj.Damaged[0],
    )


def forget(name: str) -> None:
    """A document is closed: another may come by its name."""
    _found.pop(name, None)


class _Closing:
    def slotDeletedDocument(self, document: Document) -> None:  # called by FreeCAD
        forget(document.Name)
        _release()


FreeCAD.addDocumentObserver(_Closing())
