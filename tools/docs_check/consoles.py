"""Compares what a console block shows with what its command prints."""

from __future__ import annotations

import difflib
import re

from tools.docs_check.commands import Ran

_TIME = re.compile(r"\d[\d,]*(\.\d+)?\s*(ms|s|min|h|Hz)\b")


def compare_console(shown: list[str], ran: Ran, *, masks: bool) -> str:
    """What differs; "" if nothing does. Blank lines and spaces at the end of a line do not count.

    With `masks` durations are equal to each other. A line `...` stands for any lines. What is shown is standard output,
    and standard error after it where a command fails.
    """
    printed = ran.out if ran.code == 0 or ran.out else ran.err
    want, got = _lines(shown, masks), _lines(printed.splitlines(), masks)
    if _matches(want, got):
        return ""
    return "\n".join(difflib.unified_diff(want, got, "page", "command", lineterm="", n=1)) or ran.err


def elided_lines(printed: str) -> list[str]:
    """Return the rows of printed tables in which a column of dots stands for figures that did not fit."""
    return [line for line in printed.splitlines() if re.search(r"\S\s+\.\.\.(?! and )(\s|$)", line)]


def _lines(lines: list[str], masks: bool) -> list[str]:
    kept = [line.rstrip() for line in lines if line.strip()]
    return [_TIME.sub("#", line) for line in kept] if masks else kept


def _matches(want: list[str], got: list[str]) -> bool:
    pattern = "".join("(?:.*\n)*" if line.strip() == "..." else re.escape(line) + "\n" for line in want)
    return re.fullmatch(pattern, "".join(line + "\n" for line in got)) is not None
