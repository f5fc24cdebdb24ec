"""The ledger of an import: every element of a source file ends as read, passed over because ..., or refused.

An element is a member of a JSON object, an element or attribute of XML, a cell of a table that is not empty, a column
of a database row that is not null, a line of an instance file. A reader marks what it takes as it takes it; then the
whole source is enumerated, without knowing what was read. What nobody took is passed over, so nothing is left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

How = Literal["read", "passed over", "refused"]


class Fate(NamedTuple):
    """The end of an element: how it ended, and what it was read as, or why it was not read.

    What is `minor` says nothing that could be missed: it is empty, or stands elsewhere too. What is `noted` stands in a
    note of the reader as well.
    """

    how: How
    said: str
    minor: bool = False
    noted: bool = False


def read_as(what: str) -> Fate:
    """Return the fate of an element that is read as something."""
    return Fate("read", what)


def passed_over(because: str, *, minor: bool = False, noted: bool = False) -> Fate:
    """Return the fate of an element that is not read, with the reason."""
    return Fate("passed over", because, minor, noted)


MOST_KINDS = 2_000
_OTHERS = "other kinds"
_LONGEST = 60
UNKNOWN = passed_over("has no meaning here")
EMPTY = passed_over("is empty", minor=True)


@dataclass(frozen=True)
class LedgerRow:
    """Elements of one file that are of one kind and ended alike.

    Parameters
    ----------
    file
        the source file.
    kind
        what the elements are in the terms of the file: `properties.height`, `<ele>`, `DO_SET_ROI`.
    how, said, minor, noted
        their fate.
    count
        the number of elements.
    first
        where the first of them is, as far as the reader knows.
    """

    file: str
    kind: str
    how: How
    said: str
    count: int
    first: str = ""
    minor: bool = False
    noted: bool = False

    @property
    def told(self) -> str:
        """The kind as lines for people have it: short, and without characters that cannot be printed."""
        plain = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in self.kind[:_LONGEST])
        return plain if len(self.kind) <= _LONGEST else f"{plain} ..."

    def as_dict(self) -> dict[str, Any]:
        """Return the row as JSON has it."""
        how = "read_as" if self.how == "read" else "because"
        row: dict[str, Any] = {"file": self.file, "kind": self.kind, "fate": self.how, how: self.said}
        return row | {"count": self.count} | ({"first": self.first} if self.first else {})


@dataclass(frozen=True)
class Ledger:
    """The fates of all elements of one or more files, grouped by file, kind and reason."""

    rows: tuple[LedgerRow, ...] = ()

    def __add__(self, other: Ledger) -> Ledger:
        return Ledger((*self.rows, *other.rows))

    def count(self, how: How, file: str | None = None) -> int:
        """Return the number of elements that ended so, of all files or of one."""
        return sum(row.count for row in self.rows if row.how == how and file in (None, row.file))

    @property
    def read(self) -> int:
        """The number of elements that were read."""
        return self.count("read")

    @property
    def passed_over(self) -> int:
        """The number of elements that were passed over."""
        return self.count("passed over")

    @property
    def refused(self) -> int:
        """The number of elements that were refused."""
        return self.count("refused")

    @property
    def files(self) -> tuple[str, ...]:
        """The files, in the order in which they were read."""
        return tuple(dict.fromkeys(row.file for row in self.rows))

    @property
    def not_read(self) -> tuple[LedgerRow, ...]:
        """The rows of what was passed over or refused."""
        return tuple(row for row in self.rows if row.how != "read")

    def as_dict(self) -> dict[str, Any]:
        """Return the ledger as JSON has it: the sums, those of each file, and all rows."""
        files = {
            file: {
                "read": self.count("read", file),
                "passed_over": self.count("passed over", file),
                "refused": self.count("refused", file),
            }
            for file in self.files
        }
        sums = {"read": self.read, "passed_over": self.passed_over, "refused": self.refused}
        return {**sums, "files": files, "rows": [row.as_dict() for row in self.rows]}


class LedgerBook:
    """Gathers the fates of the elements of one file.

    Parameters
    ----------
    file
        the source file.
    """

    def __init__(self, file: str) -> None:
        self._file = file
        self._counts: Counter[tuple[str, Fate]] = Counter()
        self._first: dict[tuple[str, Fate], str] = {}

    def add(self, kind: str, fate: Fate, where: str = "", count: int = 1) -> None:
        """Count elements of a kind, of which the first is at `where`.

        A file may have any number of kinds: those beyond `MOST_KINDS` are counted together.
        """
        key = kind, fate
        if key not in self._counts and len(self._counts) >= MOST_KINDS:
            key = _OTHERS, fate
        self._counts[key] += count
        self._first.setdefault(key, where)

    def ledger(self) -> Ledger:
        """Return what was gathered."""
        return Ledger(
            tuple(
                LedgerRow(self._file, kind, fate.how, fate.said, count, self._first[kind, fate], fate.minor, fate.noted)
                for (kind, fate), count in self._counts.items()
                if count
            )
        )


class Source:
    """The values of one feature of a site file, by heading, with the fate of each.

    Several features may be made of one: a multi-point, a placemark of several shapes. A value is read if it is read for
    one of them, and a feature is kept if one of them is.
    """

    __slots__ = ("_dropped", "_fates", "_kept", "needs_height")

    def __init__(self) -> None:
        self.needs_height = False
        """Whether the feature is of a flight, whose height must not be left out."""
        self._fates: Mapping[str, Fate] | None = None
        self._kept = False
        self._dropped: Fate | None = None

    def keep(self, fates: Mapping[str, Fate]) -> None:
        """Mark the feature as one of which something is made, and its values by heading.

        The mapping may be shared by many features, and may have headings that the feature has not.
        """
        self._kept = True
        if self._fates is None or self._fates is fates:
            self._fates = fates
        else:
            read = {heading: fate for heading, fate in self._fates.items() if fate.how == "read"}
            self._fates = {**self._fates, **fates, **read}

    def pass_over(self, because: str) -> None:
        """Mark the feature as one of which nothing is made, unless something is made of another part of it."""
        self._dropped = self._dropped or passed_over(because, noted=True)

    def drop(self, because: str) -> None:
        """Mark the feature as one of which nothing is made after all."""
        self._kept = False
        self._dropped = passed_over(because, noted=True)

    def lose(self, because: str, *headings: str) -> None:
        """Mark values that were read as passed over after all."""
        self._fates = {**(self._fates or {}), **dict.fromkeys(headings, passed_over(because, noted=True))}

    @property
    def key(self) -> int:
        """A number that is the same for sources whose values have the same fates."""
        return id(self._fates)

    @property
    def whole(self) -> Fate | None:
        """The fate of the whole feature where nothing is made of it, else None."""
        if self._kept:
            return None
        return self._dropped or passed_over("nothing is made of it")

    def fate(self, heading: str, value: object) -> Fate:
        """Return the fate of a value."""
        whole = self.whole
        if whole is not None:
            return whole
        if value is None or value == "":
            return EMPTY
        return (self._fates or {}).get(heading, UNKNOWN)


def summary_lines(ledger: Ledger, most: int = 8) -> Iterator[str]:
    """Yield for each file and reason one line on what was not read, is not minor, and no note of a reader says."""
    for file in ledger.files:
        reasons: dict[tuple[str, str], dict[str, int]] = {}
        for row in ledger.not_read:
            if row.file == file and not row.minor and not row.noted:
                reasons.setdefault((row.how, row.said), {})[row.told] = row.count
        for (how, because), kinds in reasons.items():
            told = [
                kind if count == 1 else f"{kind} ({count:,} elements)" for kind, count in list(kinds.items())[:most]
            ]
            more = f", and {len(kinds) - most} more" if len(kinds) > most else ""
            yield f"{file}: {how}: {', '.join(told)}{more}: it {because}"


def joined(ledgers: Iterable[Ledger]) -> Ledger:
    """Return the ledger of all files of several."""
    return Ledger(tuple(row for ledger in ledgers for row in ledger.rows))
