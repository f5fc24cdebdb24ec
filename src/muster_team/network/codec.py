"""Encodes messages as bytes: compact MessagePack, defined by one table of fields.

The first byte is the version of the protocol. Then follows one MessagePack array of arrays, numbers, texts and byte
strings. Robots and tasks of the mission are encoded as their numbers, others as texts. Rows (claims, bids, heartbeats)
are flattened. Fields with their default value are left out: after the fields that every message has come pairs of a
field's number and its value, in ascending order.

Messages of another version are refused, and so are fields that are not in the table: robots that understand part of a
message would find different bases and never agree. A change of the table, or of what a robot bids, raises PROTOCOL.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import MISSING, fields, replace
from typing import Any

from muster_team.knowledge.messages import (
    FACTS,
    Birth,
    Claim,
    Declaration,
    Evidence,
    Fact,
    Heartbeat,
    Message,
    Reach,
    RoundBids,
    Sold,
    Stage,
)
from muster_team.network.optional_parts import require_net
from muster_team.network.plain_values import (
    COUNT,
    DATA,
    FLAG,
    NUMBER,
    Form,
    MalformedError,
    array,
    choice,
    count,
    many,
    name_of,
    record,
    rows,
)

PROTOCOL = 8
"""The version of the protocol, 0 to 255: of this table, and of the rules by which robots bid and agree."""


class OtherVersionError(MalformedError):
    """A message of another version of the protocol."""


def _message_forms(robot: Form, task: Form) -> dict[str, Form]:
    """The table: the encoding of each field of a message, in the order of `Message`."""
    bids = _proved(record(RoundBids, robot=robot, round=COUNT, bids=rows(_pair(task, NUMBER), 2)))
    claim = record(Claim, task=task, price=NUMBER, round=COUNT, begun=FLAG)
    fact = _proved(record(Fact, task=task, robot=robot, kind=choice(*FACTS), order=COUNT, content=DATA))
    sold = _sold(robot, task)
    declaration = _proved(
        record(
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
            seen=rows(record(Reach, robot=robot, life=COUNT, pieces=COUNT), 3),
        )
    )
    return {
        "sender": robot,
        "incarnation": COUNT,
        "number": COUNT,
        "stage": _stage(),
        "declarations": many(declaration),
        "bids": many(bids),
        "sales": rows(sold, 3),
        "sales_from": COUNT,
        "lacks": many(robot),
        "heartbeats": _heartbeats(robot),
        "agreed": many(robot),
        "facts": rows(fact, 5),
        "known": COUNT,
        "unheard": many(robot),
        "births": rows(record(Birth, robot=robot, incarnation=COUNT, proof=DATA), 3),
        "evidence": many(_evidence(declaration, bids)),
    }


_WITHOUT_ROUTES = 4  # values of a stage

PARTED = ("declarations", "bids", "sales", "heartbeats", "facts", "births", "evidence")
"""Fields that can be divided between several messages."""


def _pair(first: Form, second: Form) -> Form:
    return Form(
        lambda pair: (first.pack(pair[0]), second.pack(pair[1])),
        lambda pair: (first.unpack(pair[0]), second.unpack(pair[1])),
    )


def _stage() -> Form:
    """Progress: a digest of routes stands at its end where there is one."""
    whole = record(Stage, epoch=COUNT, base=DATA, round=COUNT, ended=FLAG, routes=DATA)

    def pack(stage: Stage) -> list[Any]:
        plain: list[Any] = whole.pack(stage)
        return plain if stage.routes else plain[:-1]

    return Form(pack, lambda plain: whole.unpack([*plain, b""] if len(array(plain)) == _WITHOUT_ROUTES else plain))


def _proved(form: Form) -> Form:
    """A statement with its proof, if it has one: then an array of both takes the place of the last value."""

    def pack(statement: Any) -> list[Any]:
        plain: list[Any] = form.pack(statement)
        return [*plain[:-1], [plain[-1], statement.proof]] if statement.proof else plain

    def unpack(plain: Any) -> Any:
        last = array(plain)[-1] if array(plain) else None
        if type(last) is not list or len(last) != 2 or type(last[1]) is not bytes:
            return form.unpack(plain)
        return replace(form.unpack([*plain[:-1], last[0]]), proof=last[1])

    return Form(pack, unpack)


def _evidence(declaration: Form, bids: Form) -> Form:
    """Evidence: its context, whether it is of declarations, and both statements."""

    def pack(evidence: Evidence) -> list[Any]:
        declared = isinstance(evidence.first, Declaration)
        form = declaration if declared else bids
        return [evidence.context, declared, form.pack(evidence.first), form.pack(evidence.second)]

    def unpack(plain: Any) -> Evidence:
        if len(array(plain)) != 4:
            raise MalformedError("not evidence")
        form = declaration if FLAG.unpack(plain[1]) else bids
        return Evidence(DATA.unpack(plain[0]), form.unpack(plain[2]), form.unpack(plain[3]))

    return Form(pack, unpack)


def _sold(robot: Form, task: Form) -> Form:
    """A sale; where several robots won, an array of them takes the place of the robot, with the others' tasks."""

    def pack(sold: Sold) -> list[Any]:
        others = [form.pack(name) for pair in sold.others for form, name in zip((robot, task), pair, strict=True)]
        won = robot.pack(sold.robot)
        return [[won, *others] if others else won, task.pack(sold.task), NUMBER.pack(sold.price)]

    def unpack(plain: Any) -> Sold:
        if len(array(plain)) != 3:
            raise MalformedError("not a sale")
        won, *others = plain[0] if type(plain[0]) is list and len(plain[0]) % 2 and len(plain[0]) > 1 else [plain[0]]
        pairs = zip(map(robot.unpack, others[::2]), map(task.unpack, others[1::2]), strict=True)
        return Sold(robot.unpack(won), task.unpack(plain[1]), NUMBER.unpack(plain[2]), tuple(pairs))

    return Form(pack, unpack)


def _incarnations() -> Form:
    """Incarnations, as offsets from the least; nil for none (-1)."""

    def pack(incarnations: Sequence[int]) -> list[int | None]:
        least = min((k for k in incarnations if k >= 0), default=0)
        return [least, *(k - least if k >= 0 else None for k in incarnations)]

    def unpack(plain: Any) -> tuple[int, ...]:
        if not array(plain):
            raise MalformedError("not incarnations")
        least = count(plain[0])
        return tuple([-1 if k is None else count(least + count(k)) for k in plain[1:]])

    return Form(pack, unpack)


def _heartbeats(robot: Form) -> Form:
    """Heartbeats: the least incarnation, then rows with offsets, which are small for robots that start together."""
    number_of, name = robot.pack, robot.unpack

    def pack(heartbeats: Sequence[Heartbeat]) -> list[Any]:
        least = min((heartbeat.incarnation for heartbeat in heartbeats), default=0)
        plain: list[Any] = [least]
        for heartbeat in heartbeats:
            plain += number_of(heartbeat.robot), heartbeat.incarnation - least, heartbeat.number
        return plain

    def unpack(plain: Any) -> tuple[Heartbeat, ...]:
        if len(array(plain)) % 3 != 1:
            raise MalformedError("not heartbeats")
        least = count(plain[0])
        return tuple(
            [
                Heartbeat(name(plain[k]), count(least + count(plain[k + 1])), count(plain[k + 2]))
                for k in range(1, len(plain), 3)
            ]
        )

    return Form(pack, unpack)


class Codec:
    """Encodes and decodes messages of one mission.

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
        """The message encoded in bytes.

        Raises
        ------
        OtherVersionError
            if it is of another version.
        MalformedError
            if the bytes are no message.
        """
        if not data:
            raise MalformedError("nothing")
        if data[0] != PROTOCOL:
            raise OtherVersionError(f"version {data[0]}")
        try:
            plain = self._unpackb(memoryview(data)[1:], raw=False)
        except (ValueError, TypeError) as error:
            raise MalformedError(str(error)) from None
        return Message(**self._said(array(plain)))

    def _said(self, plain: list[Any]) -> dict[str, Any]:
        """The fields of a message, checked."""
        always = len(self._always)
        if len(plain) < always or (len(plain) - always) % 2:
            raise MalformedError("not the fields of a message")
        said = {name: form.unpack(plain[k]) for k, (name, form) in enumerate(self._forms[:always])}
        last = always - 1
        for k in range(always, len(plain), 2):
            number = count(plain[k])
            if not last < number < len(self._forms):
                raise MalformedError(f"field {number}")
            name, form = self._forms[number]
            said[name], last = form.unpack(plain[k + 1]), number
        return said

    def parts(self, message: Message, room: int) -> list[bytes]:
        """The message in pieces of at most `room` bytes: several messages that together contain it.

        Each piece is useful without the others, so that a loss costs one piece. What cannot be divided (one declaration
        with all its claims) stays whole and is longer.
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
    """Two messages that together contain one; (message, None) if it cannot be divided."""
    middle = {name: (len(getattr(message, name)) + 1) // 2 for name in PARTED}
    first = {name: getattr(message, name)[:half] for name, half in middle.items()}
    rest = {name: getattr(message, name)[half:] for name, half in middle.items()}
    if not any(rest.values()):
        return message, None
    second = replace(message, **rest, sales_from=message.sales_from + len(first["sales"]), lacks=(), agreed=())
    return replace(message, **first), second
