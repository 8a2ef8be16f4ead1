"""XML of robot programs read safely: no DOCTYPE (so no entities), bounded size and depth, lines kept.

Namespaces are dropped. Text is kept only where it is asked for; programs have little of it.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO
from xml.parsers import expat

from ...base.files import cannot_be_read
from ...base.regular_files import open_regular, shown
from ...base.stopping import check
from ...engine import InputError
from ..program import MAX_FILE, ProgramError, name_of

MAX_UNPACKED = 64 << 20  # bytes that any packed file may unpack to; beyond, MAX_RATIO times its own
MAX_RATIO = 300  # even programs that say the same again and again are packed to no less
MAX_BYTES = MAX_FILE  # of XML, unpacked
MAX_ELEMENTS = 2_000_000
MAX_DEPTH = 200
MAX_TOKEN = 1 << 20  # bytes of a tag or a comment: the parser begins each anew with every chunk
CHUNK = 1 << 20  # bytes
INDEXED = 8  # children, from which on they are found by their tags
GZIP = b"\x1f\x8b"


class Element:
    """An element: ``tag`` without prefix, ``attributes``, ``line`` in the XML, ``children``,
    ``parent`` and, where asked for, ``text`` that begins in the line ``text_line``."""

    __slots__ = ("tag", "attributes", "line", "children", "parent", "text", "text_line", "first")

    def __init__(
        self, tag: str, attributes: dict[str, str], line: int, parent: Element | None
    ) -> None:
        self.tag, self.attributes, self.line, self.parent = tag, attributes, line, parent
        self.children: Any = ()
        self.text: Any = None
        self.text_line = line
        self.first: dict[str, Element] | None = None  # child of each tag, once asked for

    def get(self, name: str, default: Any = None) -> Any:
        return self.attributes.get(name, default)

    def find(self, tag: str) -> Element | None:
        """The first child of that tag, or None."""
        if len(self.children) >= INDEXED:
            if self.first is None:
                self.first = {child.tag: child for child in reversed(self.children)}
            return self.first.get(tag)
        for child in self.children:
            if child.tag == tag:
                return child
        return None


class _Builder:
    def __init__(
        self,
        name: str,
        text_of: frozenset[str],
        finished: Mapping[str, Callable[[Element], Any]],
        shared: frozenset[str],
    ) -> None:
        self.name, self.text_of, self.finished = name, text_of, finished
        self.most = MAX_BYTES
        self.shared = shared
        self.kept: dict[Any, dict[str, str]] = {}
        self.root: Element | None = None
        self.at: Any = None
        self.count = self.depth = self.bytes = self.line = 0
        self.parser = parser = expat.ParserCreate()
        parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        parser.StartDoctypeDeclHandler = self.doctype
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end

    def error(self, code: str, text: str) -> ProgramError:
        return ProgramError.at(self.name, self.parser.CurrentLineNumber, code, text)

    def doctype(self, *_: object) -> None:
        raise self.error(
            "programs.xml.doctype",
            "the XML has a DOCTYPE, which no robot's controller writes; remove it",
        )

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count, self.depth = self.count + 1, self.depth + 1
        if self.count > MAX_ELEMENTS or self.depth > MAX_DEPTH:
            raise self.error(
                "programs.xml.elements",
                "the XML has too many elements, or they are nested too deeply",
            )
        tag = tag[tag.find(":") + 1 :]
        if tag in self.shared:
            attributes = self.kept.setdefault(tuple(attributes.items()), attributes)
        element = Element(tag, attributes, self.parser.CurrentLineNumber, self.at)
        if self.at is None:
            self.root = element
        elif self.at.children:
            self.at.children.append(element)
        else:
            self.at.children = [element]
        self.at = element
        if tag in self.text_of:
            element.text = []
            self.parser.CharacterDataHandler = self.characters

    def characters(self, text: str) -> None:
        pieces, line = self.at.text, self.parser.CurrentLineNumber
        if pieces is None:
            return
        if not pieces:
            self.at.text_line = self.line = line
        if line > self.line:  # a comment or an element stood between: lines must stay true
            pieces.append("\n" * (line - self.line))
            self.line = line
        pieces.append(text)
        self.line += text.count("\n")

    def end(self, _: str) -> None:
        element = self.at
        self.depth -= 1
        if element.text is not None:
            element.text = "".join(element.text)
            self.parser.CharacterDataHandler = None
        self.at = element.parent
        if element.tag in self.finished:
            self.finished[element.tag](element)

    def feed(self, data: bytes, last: bool = False) -> None:
        check()
        self.bytes += len(data)
        if self.bytes > self.most:
            raise ProgramError(
                "programs.xml.too_large",
                "{file}: the XML is larger than {limit} MB",
                file=self.name,
                limit=self.most >> 20,
            )
        try:
            self.parser.Parse(data, last)
        except expat.ExpatError as error:
            raise ProgramError.at(
                self.name,
                error.lineno,
                "programs.xml.not_sound",
                "the XML is not sound ({reason}); is the file cut off?",
                reason=expat.errors.messages[error.code],
            ) from None
        except ProgramError:
            raise
        except (ValueError, LookupError):  # an encoding nobody knows
            raise ProgramError(
                "programs.xml.encoding", "{file}: the XML's encoding cannot be read", file=self.name
            ) from None
        if not last and self.bytes - self.parser.CurrentByteIndex > MAX_TOKEN:
            raise self.error(
                "programs.xml.token",
                "a tag or a comment of the XML does not end within 1 MB; is the file damaged?",
            )


def read_xml(
    path: Path | str,
    text_of: Iterable[str] = (),
    finished: Mapping[str, Callable[[Element], Any]] | None = None,
    shared: Iterable[str] = (),
) -> Any:
    """The root Element of an XML file, packed by gzip or not.

    ``text_of``: tags of elements whose text is kept. ``finished``: functions by tag, called with
    each such element when it is complete. ``shared``: tags whose attributes often are the same and
    are kept once. Raises ProgramError naming file and line.
    """
    builder = _Builder(name_of(path), frozenset(text_of), finished or {}, frozenset(shared))
    try:
        with open_regular(path, MAX_FILE) as file:
            packed = file.read(2) == GZIP
            size = file.seek(0, 2)
            file.seek(0)
            if packed:
                builder.most = min(MAX_BYTES, max(MAX_UNPACKED, MAX_RATIO * size))
                chunks = _unpacked(file, builder.name)
            else:
                chunks = iter(lambda: file.read(CHUNK), b"")
            for data in chunks:
                builder.feed(data)
    except ProgramError:
        raise
    except InputError as error:
        raise ProgramError.of(error) from None
    except OSError as error:
        raise ProgramError.of(cannot_be_read(shown(path), error)) from None
    builder.feed(b"", True)
    return builder.root


def _unpacked(file: BinaryIO, name: str) -> Iterator[bytes]:
    """Chunks of what a gzip file unpacks to, each of bounded size."""
    unpacker = zlib.decompressobj(wbits=31)
    try:
        while data := unpacker.unconsumed_tail or file.read(CHUNK):
            if not unpacker.eof:
                yield unpacker.decompress(data, CHUNK)
                data = unpacker.unused_data
            if unpacker.eof and data.strip(b"\0"):
                raise ProgramError(
                    "programs.xml.trailing",
                    "{file}: something follows the packed program; pack it anew",
                    file=name,
                )
        if not unpacker.eof:
            raise ProgramError(
                "programs.xml.packed_cut",
                "{file}: the packed file ends too early; is it cut off?",
                file=name,
            )
    except zlib.error as error:
        raise ProgramError(
            "programs.xml.packed_damaged",
            "{file}: the packed file is damaged ({reason})",
            file=name,
            reason=str(error),
        ) from None
