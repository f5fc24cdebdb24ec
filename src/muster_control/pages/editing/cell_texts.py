"""What is typed into the cells of a form, and the values of a mission's text that it stands for.

Every kind of cell has a form that is typed on one line. What is shown for a value reads back to it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from muster.mission.errors import ParameterError

_AMBIGUOUS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_LAG = re.compile(r"(?P<task>.+)\((?P<after>[^()]*)\.\.(?P<within>[^()]*)\)")
_AMOUNT = re.compile(r"(?P<name>.+?)(?:\s*[:=])?\s+(?P<amount>\S+)")
_BETWEEN = re.compile(r"[,;]\s+|;")  # a comma may be that of a decimal
_PART_KEYS = ("type", "kind", "requires")


def value_of(typed: str, where: str, kind: str) -> object:
    """A typed value as in the mission's text; None for an empty cell. `where` stands in errors.

    Raises
    ------
    ParameterError
        if it is none of that kind.
    """
    typed = typed.strip()
    if not typed:
        return None
    if kind == "choice" and typed in ("true", "false"):
        return typed == "true"
    return _READERS[kind](typed, where) if kind in _READERS else typed


def text_of(value: object, kind: str = "text") -> str:
    """A value of the mission's text as a cell shows it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return ""
    if kind in _WRITERS and isinstance(value, list | dict):
        return _WRITERS[kind](value)
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


def number_of(typed: str, where: str) -> float:
    """A number with a decimal point or comma; 1,000 is ambiguous and refused."""
    try:
        number = math.nan if "_" in typed or _AMBIGUOUS.fullmatch(typed) else float(typed.replace(",", "."))
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ParameterError(f"{where}: {typed!r}; expected a number, as 1000 or 1.5")
    return int(number) if number.is_integer() and abs(number) < 1e15 else number


def _words(typed: str, where: str) -> list[str]:
    return typed.replace(",", " ").split()


def _lagged(typed: str, where: str) -> list[object]:
    """`30 31(5..60)`: ids, some with at least and at most so many seconds after their ends."""
    return [_prerequisite(word, where) for word in _words(re.sub(r"\s*\.\.\s*", "..", typed), where)]


def _prerequisite(word: str, where: str) -> object:
    found = _LAG.fullmatch(word)
    if found is None:
        return word
    ends = {"after_s": found["after"], "within_s": found["within"]}
    return {"task": found["task"]} | {key: number_of(text, where) for key, text in ends.items() if text.strip()}


def _lagged_text(value: Any) -> str:
    def one(item: object) -> str:
        if not isinstance(item, Mapping):
            return str(item)
        after, within = (text_of(item.get(key)) for key in ("after_s", "within_s"))
        return f"{item.get('task', '')}({after}..{within})" if after or within else str(item.get("task", ""))

    return " ".join(map(one, value))


def _spans(typed: str, where: str, end_of: Callable[[str, str], object]) -> list[Any]:
    """`600 to 1200; 2000 to`: one span as a pair, several as a list of pairs; an end that is missing is open."""
    spans = []
    for part in _pieces(typed):
        begins, word, ends = (end.strip() for end in re.split(r"(\bto\b|$)", part, maxsplit=1))
        if word != "to":
            raise ParameterError(f"{where}: {part!r}; expected spans, as 600 to 1200; 2000 to")
        spans.append([end_of(end, where) if end else None for end in (begins, ends)])
    return spans[0] if len(spans) == 1 else spans


def _spans_text(value: Any) -> str:
    pairs = [value] if len(value) == 2 and not any(isinstance(end, list) for end in value) else value
    if not all(isinstance(pair, list) and len(pair) == 2 for pair in pairs):
        return " ".join(map(str, value))
    return "; ".join(f"{text_of(begins)} to {text_of(ends)}".strip() for begins, ends in pairs)


def _pieces(typed: str) -> Iterator[str]:
    return filter(None, (piece.strip() for piece in _BETWEEN.split(typed)))


def _amounts(typed: str, where: str) -> dict[str, float]:
    """`lift_kg 20, water_l 3`: names and amounts."""
    amounts = {}
    for part in _pieces(typed):
        found = _AMOUNT.fullmatch(part)
        if found is None:
            raise ParameterError(f"{where}: {part!r}; expected a name and an amount, as lift_kg 20, water_l 3")
        amounts[found["name"]] = number_of(found["amount"], where)
    return amounts


def _loads(typed: str, where: str) -> float | dict[str, float]:
    """`3`, or `parcels 2, water_l 1.5`: of the only commodity, or by commodity."""
    return _amounts(typed, where) if any(map(_AMOUNT.fullmatch, _pieces(typed))) else number_of(typed, where)


def _amounts_text(value: Any) -> str:
    return ", ".join(f"{name} {text_of(amount)}" for name, amount in value.items())


def _parts(typed: str, where: str) -> list[dict[str, object]]:
    """`2 type=rover; 1 kind=air requires=camera+gripper`: the parts of a team."""
    return [_part(piece.split(), where) for piece in typed.split(";") if piece.strip()]


def _part(words: Sequence[str], where: str) -> dict[str, object]:
    part: dict[str, object] = {}
    for word in words:
        key, sign, value = word.partition("=")
        if word.isascii() and word.isdecimal():
            part["count"] = int(word)
        elif sign and key in _PART_KEYS and value:
            part[key] = value.split("+") if key == "requires" else value
        else:
            raise ParameterError(f"{where}: {word!r}; expected parts, as 2 type=rover; 1 kind=air requires=camera")
    return part


def _parts_text(value: Any) -> str:
    def one(part: Any) -> str:
        if not isinstance(part, Mapping):
            return str(part)
        shown = {key: part[key] for key in _PART_KEYS if part.get(key)}
        words = [f"{key}={'+'.join(map(str, v)) if isinstance(v, list) else v}" for key, v in shown.items()]
        return " ".join([str(part.get("count", 1)), *words])

    return "; ".join(map(one, value))


def _any_text(typed: str, where: str) -> str:
    return typed


_READERS: Mapping[str, Callable[[str, str], object]] = {
    "words": _words,
    "number": number_of,
    "lagged": _lagged,
    "spans": lambda typed, where: _spans(typed, where, number_of),
    "clock spans": lambda typed, where: _spans(typed, where, _any_text),
    "amounts": _amounts,
    "loads": _loads,
    "parts": _parts,
}
_WRITERS: Mapping[str, Callable[[Any], str]] = {
    "lagged": _lagged_text,
    "spans": _spans_text,
    "clock spans": _spans_text,
    "amounts": _amounts_text,
    "loads": _amounts_text,
    "parts": _parts_text,
}
