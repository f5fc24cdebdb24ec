"""Files of keywords and sections: the form that TSPLIB [reinelt1991] and VRPLIB share."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.import_ledger import passed_over
from muster.mission.line_fates import LineFates
from muster.mission.number_rows import REMARKS, Row, row_numbers, without_remark
from muster.mission.text_files import read_text
from muster.mission.value_types import shown

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
    head: dict[str, tuple[int, str]] = {}
    sections: dict[str, list[Row]] = {}
    titles: dict[str, int] = {}
    rows: list[Row] | None = None
    title_of_rows = ""
    fates, ended = fates or LineFates(), False
    for line, text in enumerate(read_text(path).splitlines(), 1):
        words = text.split()
        if not words:
            continue
        if ended or words[0].startswith(REMARKS):
            fates.say(line, "line" if ended else "remark", _AT_END if ended else _A_TEXT)
            continue
        if words == ["EOF"]:
            ended = True
            fates.say(line, "EOF")
            continue
        is_text = any(text.lstrip().upper().startswith(keyword) for keyword in _TEXTS)
        text = text if is_text else without_remark(text)
        words = text.split()
        title = text.strip().rstrip(" :").upper()
        if title.endswith(_END) and len(title.split()) == 1:
            if title in titles:
                raise _refusal(path, line, title, "for the second time", "each section once")
            titles[title] = line
            title_of_rows = title
            fates.say(line, title, _UNREAD)
            rows = sections[title] = []
        elif ":" in text:
            name, _, value = text.partition(":")
            keyword = name.strip().upper()
            if keyword in head and keyword not in _TEXTS:
                raise _refusal(path, line, keyword, "for the second time", "each keyword once")
            fates.say(line, keyword, _A_TEXT if keyword in _TEXTS else _UNREAD)
            head.setdefault(keyword, (line, value.strip()))
        elif rows is not None and (words[0][0].isdigit() or words[0][0] in "+-."):
            rows.append(Row(line, words))
            fates.say(line, title_of_rows, _UNREAD)
        elif rows is None and words[0].isdigit():
            raise _refusal(path, line, "NODE_COORD_SECTION", "missing", "this line before the first node")
        else:
            raise _refusal(path, line, "", shown(text.strip()), f"{what}: KEYWORD : value, or a node")
    return KeywordFile(path, head, sections, titles, fates)


def _refusal(path: FilePath, line: int, field: str, value: str, expected: str) -> MissionError:
    return MissionError([Finding(str(path), line, field, value, expected)])
