"""HDF5 files of a result, kept inside the document's file, known by their SHA-256."""

import contextlib
import json
import os
import tempfile
from pathlib import Path

from ..base.files import cannot_be_read, cannot_be_written, sum_of, write_new
from ..base.regular_files import open_regular, read_regular
from ..engine import InputError
from .properties import Output, add_outputs

LARGEST = 1 << 40  # bytes
SUMS = "FileSums"
OUTPUTS = (Output(SUMS, "String", "Result", "SHA-256 of the files of the result, as JSON", True),)


def read(obj, name):
    """The bytes of the property ``name``; as ``sound`` else."""
    path = sound(obj, name)
    return None if path is None else read_regular(path, LARGEST)


def sound(obj, name):
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
    """Contents (as ``files.write_to`` takes them), by name of property, written to files of a folder of their own, which
    goes when nobody holds it; may be made in any thread. Raises InputError."""

    def __init__(self, contents):
        self.folder = tempfile.TemporaryDirectory(prefix="beltgrinding-")
        self.paths = {name: _path(self.folder.name, name) for name in contents}
        self.sums = {}
        for name, data in contents.items():
            with _written(self.folder.name):
                write_new(self.paths[name], data, onto_disk=False)  # FreeCAD copies it
                with open(self.paths[name], "rb") as file:
                    self.sums[name] = sum_of(file.fileno())["sha256"]


def store(obj, contents):
    """Puts contents, by name of property, or what is ``Written`` of them, into the document. Raises InputError;
    nothing is then changed unless FreeCAD itself fails to copy a file.
    """
    add_outputs(obj, OUTPUTS)
    written = contents if isinstance(contents, Written) else Written(contents)
    with written.folder as folder:
        for name, path in written.paths.items():
            with _written(folder):
                setattr(obj, name, str(path))
    setattr(obj, SUMS, json.dumps({**_sums(obj), **written.sums}))


def _path(folder, name):
    return Path(folder, name.lower() + ".h5")


@contextlib.contextmanager
def _written(folder):
    try:
        yield
    except OSError as error:
        raise cannot_be_written(folder, error) from None


def _sums(obj):
    """Of a document of an older version, none."""
    try:
        found = json.loads(getattr(obj, SUMS, "") or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
