"""Rows of a page that say what a document describes and where it is, with commands and the figures that these print.

A row has five cells: section, what is described, where it is, what shows it, and its state. What shows it is

    `muster VERB ...` → `figure`, `figure`
    `muster VERB ...` (long, 4 min) → `figure`
    `tests/FOLDER/test_NAME.py`

or several of these, separated by semicolons. A figure is words of one printed line. `...` stands for any words between,
and `18.04±0.5` for a number within 0.5 of 18.04.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from zlib import crc32

from tools.docs_check.commands import LIMIT_S, ROOT, Ran

SHARES = 10
"""Turns in a row that run every row."""
_BASES = ("", "src", "src/muster")
_PROOF = re.compile(
    r"`(?P<command>muster [^`]+)`(?: \(long, (?P<minutes>\d+) min\))?(?: → (?P<figures>`[^`]+`(?:, `[^`]+`)*))?"
    r"|`(?P<test>tests/[^`]+)`"
)
_STATE = re.compile(r"done(: .+)?|(differs|not): \S+ .+")
_TOLERANCE = re.compile(r"(?P<before>.*?)(?P<number>[-+]?\d[\d,]*(?:\.\d+)?)±(?P<within>[\d.]+)(?P<after>.*)")


@dataclass(frozen=True)
class Shown:
    """A command of a row, the figures that it prints, and how many minutes it takes where that is long."""

    command: str
    figures: tuple[str, ...]
    minutes: int | None = None

    @property
    def limit_s(self) -> float:
        """Return the seconds after which the command counts as failed: generous, as machines are busy."""
        return LIMIT_S if self.minutes is None else max(LIMIT_S, 240.0 * self.minutes)


@dataclass(frozen=True)
class Row:
    """One row, with its line on the page and its cells."""

    line: int
    text: str
    cells: tuple[str, ...]

    @property
    def state(self) -> str:
        """Return `done`, `differs` or `not`."""
        return self.cells[4].partition(":")[0]

    @property
    def places(self) -> list[str]:
        """Return the paths at which what is described is, and those of the tests that show it."""
        tests = [found["test"] for found in _PROOF.finditer(self.cells[3]) if found["test"]]
        return [*re.findall(r"`([\w./-]+/[\w./-]*)`", self.cells[2]), *tests]

    @property
    def commands(self) -> list[Shown]:
        """Return the commands that show what is described."""
        return [
            Shown(
                found["command"],
                tuple(re.findall(r"`([^`]+)`", found["figures"] or "")),
                int(found["minutes"]) if found["minutes"] else None,
            )
            for found in _PROOF.finditer(self.cells[3])
            if found["command"]
        ]

    def problems(self) -> Iterator[str]:
        """Yield what is wrong with the row before any command is run."""
        if len(self.cells) != 5:
            yield f"{len(self.cells)} cells where five are expected: {self.text}"
            return
        if not _STATE.fullmatch(self.cells[4]):
            yield f"no state with a reason: {self.cells[4]!r}; expected done, differs: REASON, or not: REASON"
        if re.sub(r"[;,\s]", "", _PROOF.sub("", self.cells[3])):
            yield f"neither commands with figures nor tests: {self.cells[3]}"
        if self.state != "not" and not (self.cells[2] and _PROOF.search(self.cells[3])):
            yield f"{self.cells[0]} {self.cells[1]}: no place, or no command or test that shows it"
        for shown in self.commands:
            if not shown.figures:
                yield f"no figure of what it prints: {shown.command}"
        for path in self.places:
            if not any((ROOT / base / path).exists() for base in _BASES):
                yield f"no such path: {path}"


@dataclass(frozen=True)
class Due:
    """Which rows are run: all short ones, or those of a turn, of a change, or all.

    turn : int, optional
        Number of a turn, which runs a tenth of the rows, long ones too.
    changed : frozenset of str
        Changed files: rows that name one of them as a place, or a folder of it, are run.
    added : frozenset of str
        Changed lines of pages: rows that are such a line are run.
    every : bool
        All rows are run.
    """

    turn: int | None = None
    changed: frozenset[str] = field(default=frozenset())
    added: frozenset[str] = field(default=frozenset())
    every: bool = False

    @classmethod
    def since(cls, turn: int, commit: str) -> Due:
        """Return what is due at a turn after a change that began at a commit."""
        names = _git("diff", "--name-only", "--no-renames", commit)
        lines = _git("diff", "--unified=0", commit, "--", "docs")
        return cls(turn, frozenset(names), frozenset(line[1:].strip() for line in lines if line.startswith("+")))

    def has(self, row: Row) -> bool:
        """Return whether the commands of a row are run."""
        if self.every:
            return True
        if self.turn is None:
            return not any(shown.minutes for shown in row.commands)
        share = crc32(" ".join(row.cells[:2]).encode()) % SHARES
        return share == self.turn % SHARES or row.text in self.added or self._touches(row)

    def _touches(self, row: Row) -> bool:
        names = {f"{base}/{place}".lstrip("/") for base in _BASES for place in row.places}
        return any(
            file in names or file.startswith(tuple(n for n in names if n.endswith("/"))) for file in self.changed
        )


def read_rows(text: str, first_line: int = 1) -> list[Row]:
    """Return the rows of the tables in a text; headings and rules of tables are left out."""
    found = []
    for line, words in enumerate(text.splitlines(), start=first_line):
        if words.startswith("|") and not re.match(r"\|(-|:| section )", words):
            cells = tuple(cell.strip() for cell in words.strip().strip("|").split("|"))
            found.append(Row(line, words.strip(), cells))
    return found


def wrong_figures(shown: Shown, ran: Ran) -> str:
    """Return what is wrong: that the command has failed, or figures that it did not print; "" if nothing is."""
    if ran.code:
        return f"{shown.command}\nexit code {ran.code}\n{ran.out[-2000:]}{ran.err[-2000:]}"
    lines = [line.split() for line in f"{ran.out}\n{ran.err}".splitlines()]
    missing = [figure for figure in shown.figures if not any(_has(line, figure.split()) for line in lines)]
    if not missing:
        return ""
    printed = "\n".join(line for line in ran.out.splitlines() if line.strip())
    return f"{shown.command}\nnot printed: {'; '.join(missing)}\nprinted:\n{printed[-6000:]}"


def _has(line: list[str], figure: list[str]) -> bool:
    """Return whether the words of a figure stand in a line, one after the other from some word on."""
    return any(_begins(line[at:], figure) for at in range(len(line)))


def _begins(line: list[str], figure: list[str]) -> bool:
    if not figure:
        return True
    if figure[0] == "...":
        return any(_begins(line[at:], figure[1:]) for at in range(len(line) + 1))
    return bool(line) and _same(line[0], figure[0]) and _begins(line[1:], figure[1:])


def _same(word: str, wanted: str) -> bool:
    near = _TOLERANCE.fullmatch(wanted)
    if near is None:
        return word == wanted
    number = (
        word.removeprefix(near["before"]).removesuffix(near["after"])
        if near["after"]
        else word.removeprefix(near["before"])
    )
    try:
        return abs(_number(number) - _number(near["number"])) <= float(near["within"]) + 1e-9
    except ValueError:
        return False


def _number(text: str) -> float:
    return float(text.replace(",", ""))


def _git(*arguments: str) -> list[str]:
    done = subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout.splitlines()
