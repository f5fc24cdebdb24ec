"""Files of keywords and sections: the form that TSPLIB [reinelt1991] and VRPLIB share."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import passed_over
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import shown
from muster_files.instances.line_fates import LineFates
from muster_files.number_rows import REMARKS, Row, row_numbers, without_remark

_END = "_SECTION"
_TEXTS = ("COMMENT", "NAME")
"""Keywords that say nothing of the mission, and may stand several times."""
_A_TEXT, _AT_END = passed_over("is a text for people", minor=True), passed_over("stands after EOF")
_UNREAD = passed_over("is not read")
_FIRST_BYTES = 8192


@dataclass(frozen=True)
class KeywordFile:
    """The head, by keyword the line and value; and the sections, by title the rows that hold something."""

    path: FilePath
    head: Mapping[str, tuple[int, str]]
    sections: Mapping[str, list[Row]]
    titles: Mapping[str, int]
    """The line of each section's title."""
    fates: LineFates = field(default_factory=LineFates, compare=False)

    def value(self, keyword: str) -> str | None:
        """The value of a keyword of the head, which is marked as read; None where it is absent."""
        if keyword not in self.head:
            return None
        line, value = self.head[keyword]
        self.fates.say(line, keyword)
        return value

    def rows(self, title: str) -> list[Row]:
        """The rows of a section, which are marked as read; none where it is absent."""
        if title not in self.sections:
            return []
        self.fates.say(self.titles[title], title)
        self.fates.read(title, self.sections[title])
        return self.sections[title]

    def line(self, keyword: str) -> int | None:
        """The line of a keyword or of a section's title."""
        return self.head[keyword][0] if keyword in self.head else self.titles.get(keyword)

    def wrong(self, keyword: str, expected: str) -> Finding:
        """What to say of a keyword whose value is wrong or missing."""
        return Finding(str(self.path), self.line(keyword), keyword, self.value(keyword) or "missing", expected)

    def number(self, keyword: str, *, above: float = 0.0) -> float | None:
        """The number after a keyword; None where the keyword is absent.

        Raises
        ------
        MissionError
            if the value is no finite number above `above`.
        """
        if keyword not in self.head:
            return None
        line, text = self.head[keyword]
        self.fates.say(line, keyword)
        value = row_numbers([text])
        if value is None or not value[0] > above:
            raise MissionError(
                [Finding(str(self.path), line, keyword, shown(text), f"a finite number above {above:g}")]
            )
        return value[0]

    def require_known_sections(self, known: Collection[str]) -> None:
        """Refuse sections that would change what the file asks for.

        Raises
        ------
        MissionError
            with each of them.
        """
        expected = f"the sections {', '.join(known)}"
        unknown = {title: line for title, line in self.titles.items() if title not in known}
        if unknown:
            found = [Finding(str(self.path), line, title, "not supported", expected) for title, line in unknown.items()]
            raise MissionError(found)


def is_keyword_file(path: FilePath) -> bool:
    """Whether a file says of what type its edge weights are; False where it cannot be read."""
    try:
        with path.open("rb") as file:
            return re.search(rb"^EDGE_WEIGHT_TYPE\s*:", file.read(_FIRST_BYTES), re.MULTILINE) is not None
    except (OSError, ValueError):
        return False


def read_keyword_file(path: FilePath, what: str = "TSPLIB", fates: LineFates | None = None) -> KeywordFile:
    """Read the head and the sections of a file; `fates` takes what becomes of its lines.

    Raises
    ------
    MissionError
        if the file cannot be read, or a line is neither a keyword with its value, nor a section's title or row.
    """
    reading = _Reading(path, what, fates or LineFates())
    for line, text in enumerate(read_text(path).splitlines(), 1):
        if text.strip():
            reading.read(line, text)
    return KeywordFile(path, reading.head, reading.sections, reading.titles, reading.fates)


class _Reading:
    """Reads the lines of one file."""

    def __init__(self, path: FilePath, what: str, fates: LineFates) -> None:
        self._path, self._what, self.fates = path, what, fates
        self.head: dict[str, tuple[int, str]] = {}
        self.sections: dict[str, list[Row]] = {}
        self.titles: dict[str, int] = {}
        self._title = ""
        self._ended = False

    def read(self, line: int, text: str) -> None:
        """Read a line that is not blank."""
        if self._ended or text.lstrip().startswith(REMARKS):
            self.fates.say(line, "line" if self._ended else "remark", _AT_END if self._ended else _A_TEXT)
            return
        text = text.strip() if text.lstrip().upper().startswith(_TEXTS) else without_remark(text).strip()
        title = text.rstrip(" :").upper()
        if text == "EOF":
            self._ended = True
            self.fates.say(line, "EOF")
        elif title.endswith(_END) and len(title.split()) == 1:
            self._begin(line, title)
        elif ":" in text:
            self._keyword(line, text)
        else:
            self._row(line, text)

    def _begin(self, line: int, title: str) -> None:
        if title in self.titles:
            raise self._refusal(line, title, "for the second time", "each section once")
        self.titles[title], self.sections[title], self._title = line, [], title
        self.fates.say(line, title, _UNREAD)

    def _keyword(self, line: int, text: str) -> None:
        name, _, value = text.partition(":")
        keyword = name.strip().upper()
        if keyword in self.head and keyword not in _TEXTS:
            raise self._refusal(line, keyword, "for the second time", "each keyword once")
        self.fates.say(line, keyword, _A_TEXT if keyword in _TEXTS else _UNREAD)
        self.head.setdefault(keyword, (line, value.strip()))

    def _row(self, line: int, text: str) -> None:
        words = text.split()
        if self._title and (words[0][0].isdigit() or words[0][0] in "+-."):
            self.sections[self._title].append(Row(line, words))
            self.fates.say(line, self._title, _UNREAD)
        elif not self._title and words[0].isdigit():
            raise self._refusal(line, "NODE_COORD_SECTION", "missing", "this line before the first node")
        else:
            raise self._refusal(line, "", shown(text), f"{self._what}: KEYWORD : value, or a node")

    def _refusal(self, line: int, field: str, value: str, expected: str) -> MissionError:
        return MissionError([Finding(str(self._path), line, field, value, expected)])
