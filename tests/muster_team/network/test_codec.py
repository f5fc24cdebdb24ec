"""Messages as bytes and back, and bytes that are none."""

from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

msgpack = pytest.importorskip("msgpack", reason="the extra `net` is not installed")

from tests.muster_team.messages import ROBOTS, TASKS, messages  # noqa: E402

from muster_team.knowledge.messages import Claim, Declaration, Heartbeat, Message, RoundBids, Sold, Stage  # noqa: E402
from muster_team.network.codec import PARTED, PROTOCOL, Codec, OtherVersionError  # noqa: E402
from muster_team.network.plain_values import MalformedError  # noqa: E402

CODEC = Codec(ROBOTS, TASKS)
BID = Message("r_1", 7, 12, Stage(1, b"12345678", 3), bids=(RoundBids("r_1", 3, (("t_2", 0.1 + 0.2),)),))


@given(messages)
def test_what_is_read_is_what_was_written(message):
    read = CODEC.decode(CODEC.encode(message))
    assert read == message
    assert [sold.price.hex() for sold in read.sales] == [sold.price.hex() for sold in message.sales]


def read_or_garbled(data):
    try:
        message = CODEC.decode(data)
    except MalformedError:
        return
    assert isinstance(message, Message)
    assert CODEC.decode(CODEC.encode(message)) == message


@given(st.binary(max_size=200))
def test_any_bytes_are_a_message_or_garbled(data):
    read_or_garbled(data)
    read_or_garbled(bytes((PROTOCOL,)) + data)


@pytest.mark.long
@given(messages, st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255), st.integers(0, 3)), max_size=4))
def test_a_message_with_bytes_changed_lost_or_added_is_a_message_or_garbled(message, changes):
    data = bytearray(CODEC.encode(message))
    for where, byte, how in changes:
        at = where % (len(data) or 1)
        data[at : at + (0, 1, 1, 5)[how]] = () if how == 3 else (byte,)
    read_or_garbled(bytes(data))


plain = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats()
    | st.text(max_size=4)
    | st.binary(max_size=4),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
)


@given(messages, st.integers(0, 30), plain)
def test_a_message_with_any_value_in_place_of_one_of_its_own_is_a_message_or_garbled(message, where, value):
    values = msgpack.unpackb(CODEC.encode(message)[1:])
    values[where % len(values)] = value
    read_or_garbled(bytes((PROTOCOL,)) + msgpack.packb(values))


@pytest.mark.parametrize(
    "values",
    [
        b"\xdd\xff\xff\xff\xff",  # an array of four billion, of which nothing comes
        b"\xc6\xff\xff\xff\xff",
        b"\x91" * 5000,
        b"\xc7\x0c\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",  # no time that there is
        b"\xd4\x05\x00",
        b"\x81\x91\x01\x01",
    ],
)
def test_what_is_no_plain_array_is_garbled(values):
    with pytest.raises(MalformedError):
        CODEC.decode(bytes((PROTOCOL,)) + values)


def test_another_version_is_told():
    with pytest.raises(OtherVersionError):
        CODEC.decode(bytes((PROTOCOL + 1,)) + CODEC.encode(BID)[1:])


@pytest.mark.parametrize("more", [[len(fields(Message)), []], [5, [], 5, []], [5, [], 4, []], [5]])
def test_fields_of_the_future_twice_or_out_of_order_are_refused(more):
    values = msgpack.unpackb(CODEC.encode(Message("r_1", 7, 12, Stage(1)))[1:])
    with pytest.raises(MalformedError):
        CODEC.decode(bytes((PROTOCOL,)) + msgpack.packb(values + more))


def test_not_a_number_is_garbled():
    with pytest.raises(MalformedError):
        CODEC.decode(CODEC.encode(Message("r_1", 7, 12, Stage(1), sales=(Sold("r_0", "t_0", float("nan")),))))


def test_messages_are_small():
    robots, tasks = [f"r_{k}" for k in range(100)], [f"t_{k}" for k in range(200)]
    codec, start = Codec(robots, tasks), 1_795_000_000_000
    stage = Stage(1, b"12345678", 17)
    bid = Message("r_3", start, 240, stage, bids=(RoundBids("r_3", 17, (("t_9", 1.1),)),))
    route = tuple(Claim(task, 1.1, 7) for task in tasks[:20])
    own = Declaration("r_3", start, 2, tuple(robots[:20]), route, rounds=50)
    heartbeats = tuple(Heartbeat(robot, start + 800 * k, 240 + k) for k, robot in enumerate(robots))
    assert len(codec.encode(bid)) <= 44
    assert len(codec.encode(Message("r_3", start, 240, Stage(2), (own,)))) <= 320
    assert len(codec.encode(Message("r_3", start, 240, stage, heartbeats=heartbeats[:20]))) <= 180
    assert len(codec.encode(Message("r_3", start, 240, stage, heartbeats=heartbeats))) <= 1000


@given(messages, st.integers(30, 400))
def test_parts_say_together_what_the_whole_says(message, room):
    parts = [CODEC.decode(piece) for piece in CODEC.parts(message, room)]
    for name in PARTED:
        assert sum((getattr(part, name) for part in parts), ()) == getattr(message, name)
    first, rest = parts[0], parts[1:]
    assert (first.lacks, first.agreed) == (message.lacks, message.agreed)
    assert {(part.sender, part.incarnation, part.number, part.stage) for part in parts} == {
        (message.sender, message.incarnation, message.number, message.stage)
    }
    assert not any(part.lacks or part.agreed for part in rest)


@given(messages)
def test_each_sale_keeps_its_number_in_parts(message):
    numbered = [
        (part.sales_from + k, sold)
        for part in map(CODEC.decode, CODEC.parts(message, 30))
        for k, sold in enumerate(part.sales)
    ]
    assert numbered == list(enumerate(message.sales, message.sales_from))


def test_parts_keep_to_the_room_where_they_can():
    sales = tuple(Sold("r_1", "t_1", 1.5) for _ in range(500))
    pieces = CODEC.parts(Message("r_1", 7, 12, Stage(1), sales=sales), 300)
    assert max(map(len, pieces)) <= 300
    assert len(pieces) < 50
