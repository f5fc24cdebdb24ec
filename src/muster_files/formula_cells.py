"""Texts as cells that no spreadsheet runs as a formula, and back.

Spreadsheets run a cell that begins with =, +, - or @ as a formula, even in quotes. Such an id gets a leading
apostrophe, which marks text (OWASP, "CSV Injection").
"""

from __future__ import annotations

_BEGIN_FORMULAS = ("=", "+", "-", "@", "\t", "\r")


def cell(name: str) -> str:
    """An id as a cell that no spreadsheet runs as a formula."""
    return f"'{name}" if name.startswith(_BEGIN_FORMULAS) else name


def text_in(told: str) -> str:
    """What a cell says, without that apostrophe."""
    return told[1:] if told[:1] == "'" and told[1:].startswith(_BEGIN_FORMULAS) else told
