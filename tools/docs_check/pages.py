"""Reads pages of Markdown: code blocks, pictures and regions, each with the markers that stand before it."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

_MARKER = re.compile(r"<!-- docs-check: (.*?)\s*-->", re.DOTALL)
_PICTURE = re.compile(r"!\[[^]]*\]\(([^)]+)\)")
_FENCE = re.compile(r"^( *)```(\w*)\s*$")


@dataclass(frozen=True)
class Marker:
    """A marker's first word, an optional pattern between slashes, and the rest."""

    word: str
    rest: str = ""
    pattern: str | None = None

    @classmethod
    def of(cls, text: str) -> Marker:
        """Parse what stands after `docs-check:`."""
        word, _, rest = text.strip().partition(" ")
        if "\n" in word:
            word, _, rest = text.strip().partition("\n")
        found = re.match(r"(.*?)/(.+)/(?::|$)(.*)", rest.strip(), re.DOTALL) if word in ("skip", "long") else None
        if found:
            return cls(word, (found[1] + found[3]).strip(), found[2])
        return cls(word.rstrip(":"), rest.strip())


@dataclass(frozen=True)
class Item:
    """Something on a page that is made or run.

    `kind` is block, picture, setup, background, region or rows; `text` its code, the picture's path, the commands, or
    the words of the region or the rows; `language` that of a block.
    """

    kind: str
    line: int
    text: str
    language: str = ""
    markers: tuple[Marker, ...] = field(default=())

    def marker(self, word: str) -> Marker | None:
        """The first marker of that word."""
        return next((marker for marker in self.markers if marker.word == word), None)


def read_page(path: Path) -> list[Item]:
    """Everything on a page that is made or run, in order.

    Raises
    ------
    ValueError
        if a marker stands before nothing, or a region has no end.
    """
    return list(_items(path.read_text(encoding="utf-8").splitlines()))


def _items(lines: list[str]) -> Iterator[Item]:
    pending: list[Marker] = []
    region: tuple[int, Marker] | None = None
    at = 0
    while at < len(lines):
        line, begin = lines[at], at
        if line.lstrip().startswith("<!-- docs-check:"):
            while "-->" not in lines[at]:
                at += 1
            match = _MARKER.search("\n".join(lines[begin : at + 1]))
            marker = Marker.of(match[1] if match else "")
            if marker.word in ("setup", "background"):
                yield Item(marker.word, begin + 1, marker.rest)
            elif marker.word in ("numbers", "rows"):
                region = (at + 1, marker)
            elif marker.word == "end" and region:
                kind = "rows" if region[1].word == "rows" else "region"
                yield Item(kind, region[0] + 1, "\n".join(lines[region[0] : begin]), markers=(region[1],))
                region = None
            else:
                pending.append(marker)
        elif fence := _FENCE.match(line):
            at = next(k for k in range(at + 1, len(lines)) if lines[k].strip() == "```")
            text = textwrap.dedent("\n".join(lines[begin + 1 : at]) + "\n")
            yield Item("block", begin + 1, text, fence[2], tuple(pending))
            pending = []
        elif picture := _PICTURE.search(line):
            yield Item("picture", begin + 1, picture[1], markers=tuple(pending))
            pending = []
        elif line.strip() and pending:
            raise ValueError(f"line {begin + 1}: a marker before neither block nor picture: {pending[0].word}")
        at += 1
    if pending or region:
        raise ValueError("the last marker stands before nothing, or a region has no end")
