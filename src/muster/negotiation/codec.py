"""Messages as bytes: MessagePack, one table of forms, small.

The first byte is the version of the protocol. Then follows one MessagePack array, of arrays, numbers, texts and byte
strings alone. Robots and tasks of the mission are their numbers in it; others are texts. Rows (claims, bids, pulses)
have no brackets of their own. What has its default value is left out: after the fields that every message has come
pairs of a field's number and its value, in ascending order.

A message of another version is refused, and so is a field that is not in the table: robots that understand half of what
is said would find different bases and never agree. Whoever changes the table, or what a robot bids, raises PROTOCOL.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import MISSING, fields, replace
from typing import Any

from muster.negotiation.messages import Claim, Declaration, Fact, Message, Pulse, RoundBids, Sold, Stage
from muster.negotiation.optional_parts import require_net
from muster.negotiation.plain_values import (
    COUNT,
    DATA,
    FLAG,
    NUMBER,
    Form,
    Garbled,
    array,
    choice,
    count,
    many,
    name_of,
    record,
    rows,
)

PROTOCOL = 2
"""The version of the protocol, 0 to 255: of this table, and of the rules by which robots bid and agree."""


class OtherVersion(Garbled):
    """A message of another version of the protocol."""


FACTS = ("done", "begun", "waived", "added", "moved", "cancelled")
"""Kinds of facts."""


def _message_forms(robot: Form, task: Form) -> dict[str, Form]:
    """The table: the form of each field of a message, in the order of `Message`."""
    claim = record(Claim, task=task, price=NUMBER, round=COUNT, begun=FLAG)
    fact = record(Fact, task=task, robot=robot, kind=choice(*FACTS), order=COUNT, content=DATA)
    sold = record(Sold, robot=robot, task=task, price=NUMBER)
    declaration = record(
        Declaration,
        robot=robot,
        incarnation=COUNT,
        epoch=COUNT,
        members=many(robot),
        route=rows(claim, 4),
        facts=rows(fact, 5),
        rounds=COUNT,
        incarnations=_incarnations(),
        knows=FLAG,
    )
    return {
        "sender": robot,
        "incarnation": COUNT,
        "number": COUNT,
        "stage": record(Stage, epoch=COUNT, base=DATA, round=COUNT, ended=FLAG),
        "declarations": many(declaration),
        "bids": many(record(RoundBids, robot=robot, round=COUNT, bids=rows(_pair(task, NUMBER), 2))),
        "sales": rows(sold, 3),
        "sales_from": COUNT,
        "lacks": many(robot),
        "pulses": _pulses(robot),
        "agreed": many(robot),
        "facts": rows(fact, 5),
        "known": COUNT,
        "misses": many(robot),
    }


PARTED = ("declarations", "bids", "sales", "pulses", "facts")
"""Fields of which a message may say one part, and another message the rest."""


def _pair(first: Form, second: Form) -> Form:
    return Form(
        lambda pair: (first.pack(pair[0]), second.pack(pair[1])),
        lambda pair: (first.unpack(pair[0]), second.unpack(pair[1])),
    )


def _incarnations() -> Form:
    """Incarnations, as in pulses; nil for none (-1)."""

    def pack(incarnations: Sequence[int]) -> list[int | None]:
        least = min((k for k in incarnations if k >= 0), default=0)
        return [least, *(k - least if k >= 0 else None for k in incarnations)]

    def unpack(plain: Any) -> tuple[int, ...]:
        if not array(plain):
            raise Garbled("not incarnations")
        least = count(plain[0])
        return tuple([-1 if k is None else count(least + count(k)) for k in plain[1:]])

    return Form(pack, unpack)


def _pulses(robot: Form) -> Form:
    """Pulses: the least incarnation, then rows with what is above it, as robots that start together have like ones."""
    number_of, name = robot.pack, robot.unpack

    def pack(pulses: Sequence[Pulse]) -> list[Any]:
        least = min((pulse.incarnation for pulse in pulses), default=0)
        plain: list[Any] = [least]
        for pulse in pulses:
            plain += number_of(pulse.robot), pulse.incarnation - least, pulse.number
        return plain

    def unpack(plain: Any) -> tuple[Pulse, ...]:
        if len(array(plain)) % 3 != 1:
            raise Garbled("not pulses")
        least = count(plain[0])
        return tuple(
            [
                Pulse(name(plain[k]), count(least + count(plain[k + 1])), count(plain[k + 2]))
                for k in range(1, len(plain), 3)
            ]
        )

    return Form(pack, unpack)


class Codec:
    """Messages of one mission.

    Parameters
    ----------
    robots, tasks
        the ids of the mission, in the order that all robots know.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    """

    def __init__(self, robots: Sequence[str], tasks: Sequence[str]) -> None:
        require_net("msgpack")
        import msgpack

        self._packb, self._unpackb = msgpack.packb, msgpack.unpackb
        forms = _message_forms(name_of(robots), name_of(tasks))
        assert list(forms) == [f.name for f in fields(Message)], "the table has the fields of a message, in their order"
        self._forms = tuple(forms.items())
        self._always = [name for name, form in self._forms if _DEFAULTS[name] is MISSING]

    def encode(self, message: Message) -> bytes:
        """The message as bytes."""
        plain: list[Any] = []
        for number, (name, form) in enumerate(self._forms):
            value, default = getattr(message, name), _DEFAULTS[name]
            if default is MISSING:
                plain.append(form.pack(value))
            elif value != default:
                plain += number, form.pack(value)
        packed: bytes = self._packb(plain)
        return bytes((PROTOCOL,)) + packed

    def decode(self, data: bytes) -> Message:
        """The message that bytes are.

        Raises
        ------
        OtherVersion
            if they are of another version.
        Garbled
            if they are no message.
        """
        if not data:
            raise Garbled("nothing")
        if data[0] != PROTOCOL:
            raise OtherVersion(f"version {data[0]}")
        try:
            plain = self._unpackb(memoryview(data)[1:], raw=False)
        except (ValueError, TypeError) as error:
            raise Garbled(str(error)) from None
        return Message(**self._said(array(plain)))

    def _said(self, plain: list[Any]) -> dict[str, Any]:
        """The fields of a message, checked."""
        always = len(self._always)
        if len(plain) < always or (len(plain) - always) % 2:
            raise Garbled("not the fields of a message")
        said = {name: form.unpack(plain[k]) for k, (name, form) in enumerate(self._forms[:always])}
        last = always - 1
        for k in range(always, len(plain), 2):
            number = count(plain[k])
            if not last < number < len(self._forms):
                raise Garbled(f"field {number}")
            name, form = self._forms[number]
            said[name], last = form.unpack(plain[k + 1]), number
        return said

    def parts(self, message: Message, room: int) -> list[bytes]:
        """The message, in pieces of at most `room` bytes: several messages that say together what it says.

        Each piece is of use without the others, so that a loss costs one piece, not all. What cannot be parted (one
        declaration, with all its claims) stays whole, and is longer.
        """
        data = self.encode(message)
        if len(data) <= room:
            return [data]
        first, second = halves(message)
        if second is None:
            return [data]
        return self.parts(first, room) + self.parts(second, room)


_DEFAULTS = {f.name: f.default for f in fields(Message)}


def halves(message: Message) -> tuple[Message, Message | None]:
    """Two messages that say what one says; None: it cannot be parted."""
    middle = {name: (len(getattr(message, name)) + 1) // 2 for name in PARTED}
    first = {name: getattr(message, name)[:half] for name, half in middle.items()}
    rest = {name: getattr(message, name)[half:] for name, half in middle.items()}
    if not any(rest.values()):
        return message, None
    second = replace(message, **rest, sales_from=message.sales_from + len(first["sales"]), lacks=(), agreed=())
    return replace(message, **first), second
