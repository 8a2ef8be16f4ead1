"""HDF5 files of a result, kept inside the document's file, known by their SHA-256."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import tempfile
import weakref
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ..base.files import cannot_be_read, cannot_be_written, sum_of, write_new
from ..base.regular_files import open_regular, read_regular
from ..engine import InputError
from .kinds import DocumentObject
from .properties import Output, add_outputs

LARGEST = 1 << 40  # bytes
SUMS = "FileSums"
OUTPUTS = (Output(SUMS, "String", "Result", "SHA-256 of the files of the result, as JSON", True),)


def stored(obj: DocumentObject, name: str) -> bool:
    """Whether the property ``name`` is there and once held a file of the result."""
    return name in obj.PropertiesList and name in _sums(obj)


def read(obj: DocumentObject, name: str) -> bytes | None:
    """The bytes of the property ``name``; as ``sound`` else."""
    path = sound(obj, name)
    return None if path is None else read_regular(path, LARGEST)


def sound(obj: DocumentObject, name: str) -> str | None:
    """The path of the file of the property ``name`` (App::PropertyFileIncluded); None where it holds none, or one
    without bytes. Raises InputError where its bytes are not those that were stored with the result.
    """
    path = getattr(obj, name, "")
    if not path or not os.path.exists(path):
        return None
    with open_regular(path, LARGEST) as file:
        try:
            found = sum_of(file.fileno())
        except OSError as error:
            raise cannot_be_read(path, error) from None
    if _sums(obj).get(name) not in (None, found["sha256"]):
        raise InputError(
            "objects.not_as_stored",
            "{object}: the file of {property} is not the one of this result: the document is damaged; "
            "simulate again",
            object=obj.Label,
            property=name,
        )
    return path if found["bytes"] else None


class Written:
    """Contents (as ``files.write_to`` takes them), by name of property, written to files that go when nobody holds it; may
    be made in any thread. ``folder``: a document's ``TransientDir``, from which FreeCAD takes them as they are; from
    elsewhere it copies them. Raises InputError."""

    def __init__(self, contents: Mapping[str, Any], folder: str | None = None) -> None:
        self._own = None
        if folder is None or not os.path.isdir(folder):
            self._own = tempfile.TemporaryDirectory(prefix="beltgrinding-")
            folder = self._own.name
        self.folder = folder
        mark = secrets.token_hex(4)
        self.paths = {name: Path(folder, f"{name.lower()}-{mark}.h5") for name in contents}
        self._mine = set(self.paths.values())
        self._gone = weakref.finalize(self, _remove, self._mine)
        self.sums = {}
        for name, data in contents.items():
            with _written(folder):
                write_new(self.paths[name], data, onto_disk=False)  # FreeCAD moves or copies it
                with open(self.paths[name], "rb") as file:
                    self.sums[name] = sum_of(file.fileno())["sha256"]

    def taken(self, obj: DocumentObject, name: str) -> None:
        """The object's property has got the file: the one that was written, maybe."""
        if os.path.realpath(getattr(obj, name)) == os.path.realpath(self.paths[name]):
            self._mine.discard(self.paths[name])

    def discard(self) -> None:
        """Removes what is left of the files."""
        self._gone()
        if self._own is not None:
            self._own.cleanup()


def store(obj: DocumentObject, contents: Mapping[str, Any] | Written) -> None:
    """Puts contents, by name of property, or what is ``Written`` of them, into the document. Raises InputError;
    nothing is then changed unless FreeCAD itself fails to take a file.
    """
    add_outputs(obj, OUTPUTS)
    written: Any = contents
    if not isinstance(contents, Written):
        written = Written(contents, obj.Document.TransientDir)
    try:
        for name, path in written.paths.items():
            with _written(written.folder):
                setattr(obj, name, str(path))
            written.taken(obj, name)
    finally:
        written.discard()
    setattr(obj, SUMS, json.dumps({**_sums(obj), **written.sums}, allow_nan=False))


def _remove(paths: Iterable[Path]) -> None:
    for path in paths:
        with contextlib.suppress(OSError):
            path.unlink()


@contextlib.contextmanager
def _written(folder: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise cannot_be_written(folder, error) from None


def _sums(obj: DocumentObject) -> dict[str, Any]:
    """Of a document of an older version, none."""
    try:
        found = json.loads(getattr(obj, SUMS, "") or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
