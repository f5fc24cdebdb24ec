"""Messages as bytes: MessagePack, one table of forms, small.

The first byte is the version of the protocol. Then follows one MessagePack array, of arrays, numbers, texts and byte
strings alone. Robots and tasks of the mission are their numbers in it; others are texts. Rows (claims, bids, pulses)
have no brackets of their own. What has its default value is left out: after the fields that every message has come pairs
of a field's number and its value, in ascending order.

A message of another version is refused, and so is a field that is not in the table: robots that understand half of what
is said would find different bases and never agree. Whoever changes the table, or what a robot bids, raises PROTOCOL.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import MISSING, dataclass, fields, replace
from operator import attrgetter
from typing import Any

from muster.mission.errors import MissingExtraError
from muster.negotiation.messages import Claim, Declaration, Fact, Message, Pulse, RoundBids, Sold, Stage

try:
    import msgpack
except ImportError:
    raise MissingExtraError("net", "an auction over a network") from None

PROTOCOL = 1
"""The version of the protocol, 0 to 255: of this table, and of the rules by which robots bid and agree."""

_MOST = 2**63


class Garbled(Exception):  # noqa: N818 - what was received, not what went wrong here
    """Bytes that are no message."""


class OtherVersion(Garbled):
    """A message of another version of the protocol."""


@dataclass(frozen=True)
class Form:
    """How a value is written: `pack` makes it plain, `unpack` checks what came and makes it a value again.

    `width` is how many values it takes in a row; 1 but for rows.
    """

    pack: Callable[[Any], Any]
    unpack: Callable[[Any], Any]


def _count(value: Any) -> int:
    if type(value) is not int or not 0 <= value < _MOST:
        raise Garbled("not a count")
    return value


def _number(value: Any) -> float:
    if type(value) is not float or math.isnan(value):
        raise Garbled("not a number")
    return value


def _flag(value: Any) -> bool:
    if type(value) is not bool:
        raise Garbled("not a flag")
    return value


def _data(value: Any) -> bytes:
    if type(value) is not bytes:
        raise Garbled("not bytes")
    return value


def _array(value: Any) -> list[Any]:
    if type(value) is not list:
        raise Garbled("not an array")
    return value


def _same(value: Any) -> Any:
    return value


COUNT, FLAG, DATA = Form(_same, _count), Form(_same, _flag), Form(_same, _data)
NUMBER = Form(float, _number)


def name_of(ids: Sequence[str]) -> Form:
    """An id: its number among these, else its text."""
    numbers = {name: k for k, name in enumerate(ids)}

    def unpack(value: Any) -> str:
        if type(value) is int and 0 <= value < len(ids):
            return ids[value]
        if type(value) is str and value not in numbers:
            return value
        raise Garbled("not an id")

    return Form(lambda name: numbers.get(name, name), unpack)


def many(form: Form) -> Form:
    """A tuple of values of one form."""
    return Form(
        lambda values: [form.pack(value) for value in values],
        lambda values: tuple(form.unpack(value) for value in _array(values)),
    )


def record(cls: Callable[..., Any], **forms: Form) -> Form:
    """A dataclass: an array of its fields, in their order."""
    row = _Row(cls, forms)
    return Form(lambda value: list(row.pack(value)), lambda values: row.unpack(_array(values)))


def rows(cls: Callable[..., Any], **forms: Form) -> Form:
    """A tuple of dataclasses of few fields: one array, row after row."""
    row = _Row(cls, forms)
    width = len(forms)

    def unpack(values: Any) -> tuple[Any, ...]:
        if len(_array(values)) % width:
            raise Garbled("not whole rows")
        return tuple(row.unpack(values[k : k + width]) for k in range(0, len(values), width))

    return Form(lambda several: [plain for value in several for plain in row.pack(value)], unpack)


class Codec:
    """Messages of one mission.

    Parameters
    ----------
    robots, tasks
        the ids of the mission, in the order that all robots know.
    """

    def __init__(self, robots: Sequence[str], tasks: Sequence[str]) -> None:
        raise NotImplementedError

    def encode(self, message: Message) -> bytes:
        raise NotImplementedError

    def decode(self, data: bytes) -> Message:
        raise NotImplementedError

    def parts(self, message: Message, room: int) -> list[bytes]:
        """The message as one piece, or as several messages that say the same, each of at most `room` bytes if it can."""
        raise NotImplementedError
