"""XML as a tree of elements with their lines, safe to read from anywhere.

By expat, which names the line of an error. A document type is refused, and with it all entities of its own: no file
grows in memory, or has others read. Names of elements are without their namespaces.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from muster.exchange.sites.features import refused

_DEEPEST = 100
_NO_DOCUMENT_TYPE = "no document type, which these files do not need"


@dataclass
class Element:
    """An element: its name, attributes, children, and the text that stands directly in it."""

    name: str
    line: int
    attributes: Mapping[str, str]
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def first(self, *names: str) -> Element | None:
        """The first child by these names, one within the other."""
        here: Element | None = self
        for name in names:
            here = None if here is None else next((child for child in here.children if child.name == name), None)
        return here

    def all(self, name: str) -> list[Element]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]

    def told(self, *names: str) -> str:
        """The text of the first child by these names, without spaces around it; empty where there is none."""
        found = self.first(*names)
        return "" if found is None else found.text.strip()

    def within(self) -> Iterator[Element]:
        """The element, and all within it."""
        yield self
        for child in self.children:
            yield from child.within()


def titled(element: Element) -> str:
    """An element as messages name it: by its kind, and its name if it has one."""
    return " ".join([element.name, *element.told("name").split()])


def parse_xml(data: bytes, file: str, root: str, what: str) -> Element:
    """The root element of a document, which must have that name.

    Raises
    ------
    MissionError
        with the line at which it is no XML, has a document type, or is another document than `what`.
    """
    reading = _Reading(file)
    try:
        reading.parser.Parse(data, True)
    except expat.ExpatError as error:
        told = expat.errors.messages.get(error.code, str(error))
        raise refused(file, error.lineno, "", f"no XML: {told}", what) from None
    except (ValueError, LookupError) as error:  # an encoding that nobody knows
        raise refused(file, 1, "", f"no XML: {error}", what) from None
    (found,) = reading.top.children
    if found.name != root:
        raise refused(file, found.line, "", f"<{found.name}>", f"{what}: <{root}>")
    return found


class _Reading:
    def __init__(self, file: str) -> None:
        self._file = file
        self.top = Element("", 0, {})
        self._open = [self.top]
        self._text: list[list[str]] = [[]]
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = lambda text: self._text[-1].append(text)
        self.parser.StartDoctypeDeclHandler = self._document_type

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        if len(self._open) > _DEEPEST:
            raise refused(self._file, line, _local(name), "nested too deep", f"at most {_DEEPEST} elements in another")
        element = Element(_local(name), line, {_local(key): value for key, value in attributes.items()})
        self._open[-1].children.append(element)
        self._open.append(element)
        self._text.append([])

    def _end(self, _: str) -> None:
        self._open.pop().text = "".join(self._text.pop())

    def _document_type(self, name: str, *_: object) -> None:
        raise refused(self._file, self.parser.CurrentLineNumber, "", f"<!DOCTYPE {name}>", _NO_DOCUMENT_TYPE)


def _local(name: str) -> str:
    return name.rpartition(" ")[2]
