"""XML as a tree of elements with their lines, safe to read from anywhere.

By expat, which names the line of an error. A document type is refused, and with it all entities of its own: no file
grows in memory, or has others read. Names of elements are without their namespaces.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from dataclasses import field as member
from xml.parsers import expat

from muster.mission.import_ledger import UNKNOWN, Fate, LedgerBook, Source, passed_over, read_as
from muster_files.sites.features import HEIGHT, refused
from muster_files.sites.file_sizes import DEEPEST_XML, require_few

_READ = read_as("itself")
_LOOKS = passed_over("says how things look", minor=True)
_TEXT = passed_over("is a text for people")
_NOT_THE_MAP = passed_over("is not the map")
_NONE: Mapping[str, str] = {}
_OF_LOOKS = (
    "Style",
    "StyleMap",
    "styleUrl",
    "visibility",
    "open",
    "LookAt",
    "Camera",
    "Region",
    "tessellate",
    "extrude",
)
_REASONS = {
    **dict.fromkeys(_OF_LOOKS, _LOOKS),
    **dict.fromkeys(("description", "desc", "cmt", "Snippet", "snippet", "author", "link", "metadata"), _TEXT),
}
"""Why elements are not read, where more can be said than that they have no meaning here."""
_NO_DOCUMENT_TYPE = "no document type, which these files do not need"


@dataclass(slots=True)
class Element:
    """An element: its name, attributes, children, and the text that stands directly in it.

    Attributes
    ----------
    fate
        of the element, where it was taken or said to be passed over.
    taken
        the names of the attributes that were taken.
    whole
        the feature of the site that the element and all within it are made to.
    value
        the feature and the heading of which the element and all within it are the value.
    """

    name: str
    line: int
    attributes: Mapping[str, str]
    children: list[Element] = member(default_factory=list)
    text: str = ""
    fate: Fate | None = None
    taken: tuple[str, ...] = ()
    whole: Source | None = None
    value: tuple[Source, str] | None = None

    def first(self, *names: str) -> Element | None:
        """The first child by these names, one within the other."""
        here: Element | None = self
        for name in names:
            here = None if here is None else next((child for child in here.children if child.name == name), None)
            if here is not None:
                here.take()
        return here

    def take(self, fate: Fate = _READ) -> Element:
        """Mark the element as read, or with another fate, unless it has one."""
        self.fate = self.fate or fate
        return self

    def attribute(self, name: str) -> str:
        """The value of an attribute, empty where there is none; it is marked as read."""
        self.taken = (*self.taken, name)
        return self.attributes.get(name, "")

    def all(self, name: str) -> list[Element]:
        """The children of that name."""
        return [child.take() for child in self.children if child.name == name]

    def told(self, *names: str) -> str:
        """The text of the first child by these names, without spaces around it; empty where there is none.

        As `first` and `all` do, it marks as read what it finds.
        """
        found = self.first(*names)
        return "" if found is None else found.text.strip()

    def within(self) -> Iterator[Element]:
        """The element, and all within it."""
        yield self
        for child in self.children:
            yield from child.within()


class XmlDocument:
    """The elements and attributes of a file; for one of an archive, the other files there by name."""

    def __init__(self, root: Element, others: Sequence[str] = ()) -> None:
        self._root, self._others = root, others

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every element and attribute, however deep it is nested.

        What is within an element that is passed over is counted with that element.
        """
        for name in self._others:
            book.add("file in the archive", _NOT_THE_MAP, name)
        rest: list[tuple[Element, str, Fate | None]] = [(self._root, "", None)]
        while rest:
            element, parent, inherited = rest.pop()
            within = inherited is not None and inherited.how != "read"
            if inherited is None and element.whole is not None:
                inherited = element.whole.whole
            if inherited is None and element.value is not None:
                source, heading = element.value
                inherited = source.fate(heading, heading)
                parent = parent if heading == HEIGHT else f"{_PROPERTY}{heading}"
            is_value = inherited is not None and inherited.how == "read"
            left_out = element.fate is not None and element.fate.how != "read" and is_value
            fate = (None if left_out else inherited) or element.fate or _REASONS.get(element.name, UNKNOWN)
            where = f"line {element.line}"
            kind = parent if within or parent.startswith(_PROPERTY) else f"{parent}<{element.name}>"
            book.add(kind, fate, where)
            if fate.how != "read":
                inherited = fate
            for name in element.attributes:
                own = _READ if name in element.taken else UNKNOWN
                own = own if inherited is None or inherited.how == "read" else inherited
                book.add(kind if inherited or kind.startswith(_PROPERTY) else f"{kind} {name}", own, where)
            around = "" if element.name in _GROUPS else f"<{element.name}> "
            around = kind if kind.startswith(_PROPERTY) else around
            rest += [
                (child, kind if inherited and inherited.how != "read" else around, inherited)
                for child in reversed(element.children)
            ]


_PROPERTY = "property "
_GROUPS = ("kml", "Document", "Folder", "gpx")
"""Elements that the ledger does not name before what is in them."""


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
        self._count = 0
        self._text: list[list[str]] = [[]]
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = lambda text: self._text[-1].append(text)
        self.parser.StartDoctypeDeclHandler = self._document_type

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        if len(self._open) > DEEPEST_XML:
            expected = f"at most {DEEPEST_XML} elements in another"
            raise refused(self._file, line, _local(name), "nested too deep", expected)
        self._count += 1 + len(attributes)
        require_few(self._count, "elements and attributes", self._file, line)
        element = Element(_local(name), line, _by_name(attributes) if attributes else _NONE)
        self._open[-1].children.append(element)
        self._open.append(element)
        self._text.append([])

    def _end(self, _: str) -> None:
        self._open.pop().text = "".join(self._text.pop())

    def _document_type(self, name: str, *_: object) -> None:
        raise refused(self._file, self.parser.CurrentLineNumber, "", f"<!DOCTYPE {name}>", _NO_DOCUMENT_TYPE)


def _by_name(attributes: Mapping[str, str]) -> Mapping[str, str]:
    """Attributes by their local names; of two with the same one keeps its namespace."""
    found: dict[str, str] = {}
    for key, value in attributes.items():
        found[key if _local(key) in found else _local(key)] = value
    return found


def _local(name: str) -> str:
    return name.rpartition(" ")[2]
