"""Conversion of dataclasses to plain values (arrays, numbers, texts, byte strings) and back, with checks on reading."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

_MOST = 2**63


class MalformedError(Exception):
    """Bytes that are no message."""


@dataclass(frozen=True)
class Form:
    """The conversion of one value: `pack` makes it plain; `unpack` checks and restores it (MalformedError)."""

    pack: Callable[[Any], Any]
    unpack: Callable[[Any], Any]


def count(value: Any) -> int:
    if type(value) is int and 0 <= value < _MOST:
        return value
    raise MalformedError("not a count")


def array(value: Any) -> list[Any]:
    if type(value) is list:
        return value
    raise MalformedError("not an array")


def _number(value: Any) -> float:
    if type(value) is float and not math.isnan(value):
        return value
    raise MalformedError("not a number")


def _flag(value: Any) -> bool:
    if type(value) is bool:
        return value
    raise MalformedError("not a flag")


def _data(value: Any) -> bytes:
    if type(value) is bytes:
        return value
    raise MalformedError("not bytes")


def _itself(value: Any) -> Any:
    return value


COUNT, FLAG = Form(_itself, count), Form(_itself, _flag)
DATA = Form(_itself, _data)
NUMBER = Form(float, _number)
"""A float, exactly; any but NaN, which is not equal to itself."""


def name_of(ids: Sequence[str]) -> Form:
    """An id: its number in this list, else its text."""
    numbers = {name: k for k, name in enumerate(ids)}

    def unpack(value: Any) -> str:
        if type(value) is int and 0 <= value < len(ids):
            return ids[value]
        if type(value) is str and value not in numbers:
            return value
        raise MalformedError("not an id")

    return Form(lambda name: numbers.get(name, name), unpack)


def choice(*words: str) -> Form:
    """One of a few words: its number in this list."""
    numbers = {word: k for k, word in enumerate(words)}

    def unpack(value: Any) -> str:
        number = count(value)
        if number < len(words):
            return words[number]
        raise MalformedError("not one of the words")

    return Form(numbers.__getitem__, unpack)


def many(form: Form) -> Form:
    """A tuple of values of one form."""
    pack, unpack = form.pack, form.unpack
    return Form(
        lambda values: [pack(value) for value in values],
        lambda values: tuple([unpack(value) for value in array(values)]),
    )


def record(cls: Callable[..., Any], **forms: Form) -> Form:
    """A dataclass: an array of its fields, in the order in which it takes them."""
    parts = attrgetter(*forms)
    packs, unpacks = [form.pack for form in forms.values()], [form.unpack for form in forms.values()]

    def unpack(values: Any) -> Any:
        if len(array(values)) != len(unpacks):
            raise MalformedError("not that record")
        return cls(*[read(value) for read, value in zip(unpacks, values, strict=True)])

    return Form(lambda value: [write(part) for write, part in zip(packs, parts(value), strict=True)], unpack)


def rows(form: Form, width: int) -> Form:
    """A tuple of records of one width: one flat array, row after row."""
    pack, unpack = form.pack, form.unpack

    def read(values: Any) -> tuple[Any, ...]:
        if len(array(values)) % width:
            raise MalformedError("not whole rows")
        return tuple([unpack(values[k : k + width]) for k in range(0, len(values), width)])

    return Form(lambda several: [plain for value in several for plain in pack(value)], read)
