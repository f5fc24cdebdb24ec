"""What a stranger cannot do, and what is told apart from a stranger."""

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from muster_team.network import encryption as sealing
from muster_team.network.encryption import OVERHEAD, WINDOW, Seal, Window, new_key

KEY = bytes(range(32))
HEADER = 25


def pair(key=KEY, context=b"mission", other=None):
    return Seal(key, context, "r_0", 1), Seal(other or KEY, b"mission", "r_1", 1)


@given(st.binary(max_size=300))
def test_what_is_closed_opens_for_those_who_have_the_key(data):
    sender, receiver = pair()
    closed = sender.close(data)
    assert len(closed) == len(data) + OVERHEAD
    assert receiver.open(closed) == data
    assert not receiver.counts


def test_it_is_not_readable():
    sender, _ = pair()
    closed = sender.close(b"r_0 bids 12.5 for the gate")
    assert all(word not in closed for word in (b"r_0", b"gate", b"12.5", b"mission"))


@given(st.data())
def test_every_changed_bit_is_noticed(data):
    sender, receiver = pair()
    closed = bytearray(sender.close(b"something"))
    bit = data.draw(st.integers(0, 8 * len(closed) - 1))
    closed[bit // 8] ^= 1 << bit % 8
    assert receiver.open(bytes(closed)) is None
    assert receiver.counts == {"foreign": 1}


@given(st.binary(max_size=100))
def test_a_stranger_is_not_heard(data):
    _, receiver = pair()
    assert receiver.open(data) is None
    assert receiver.counts == {"foreign": 1}


def test_a_part_of_a_message_is_foreign():
    sender, receiver = pair()
    closed = sender.close(b"something")
    assert all(receiver.open(closed[:end]) is None for end in range(len(closed)))
    assert receiver.counts == {"foreign": len(closed)}


def test_strangers_leave_nothing_behind():
    _, receiver = pair()
    for k in range(50):
        receiver.open(bytes((1, *receiver._tag)) + k.to_bytes(40, "big"))
    assert receiver.counts == {"foreign": 50}
    assert not receiver._peers


def test_another_key_is_foreign():
    sender, receiver = pair(key=new_key())
    assert receiver.open(sender.close(b"x")) is None
    assert receiver.counts == {"foreign": 1}


def test_another_mission_is_told_from_a_stranger():
    sender, receiver = pair(context=b"another mission")
    assert receiver.open(sender.close(b"x")) is None
    assert receiver.counts == {"other_mission": 1}


def test_another_version_is_told_from_a_stranger(monkeypatch):
    sender, receiver = pair()
    monkeypatch.setattr(sealing, "PROTOCOL", 9)
    closed = sender.close(b"x")
    monkeypatch.undo()
    assert receiver.open(closed) is None
    assert receiver.counts == {"other_version": 1}
    forged = bytes((9,)) + sender.close(b"x")[1:]
    assert receiver.open(forged) is None
    assert receiver.counts == {"other_version": 1, "foreign": 1}


def test_what_comes_back_is_ones_own():
    sender, _ = pair()
    assert sender.open(sender.close(b"x")) is None
    assert sender.counts == {"own": 1}


@given(st.permutations(range(40)), st.lists(st.integers(0, 39), max_size=20))
def test_each_message_opens_once_in_whatever_order(order, again):
    sender, receiver = pair()
    closed = [sender.close(bytes((k,))) for k in range(40)]
    assert [receiver.open(closed[k]) for k in order] == [bytes((k,)) for k in order]
    assert [receiver.open(closed[k]) for k in again] == [None] * len(again)
    assert receiver.counts["replayed"] == len(again)


@given(st.lists(st.integers(0, 3 * WINDOW), max_size=60))
def test_a_window_takes_each_counter_once_and_none_that_is_too_late(counters):
    window, taken = Window(), set()
    for counter in counters:
        late = bool(taken) and counter <= max(taken) - WINDOW
        assert window.take(counter) == (counter not in taken and not late)
        taken |= set() if late else {counter}
        assert window.seen < 1 << WINDOW


def test_processes_of_one_name_and_incarnation_share_no_nonce():
    """Key and nonce are session and counter; each process, and each start, has a session of its own."""
    seals = [Seal(KEY, b"mission", "r_0", 1) for _ in range(200)]
    headers = {seal.close(b"the same")[9:HEADER] for seal in seals for _ in range(5)}
    assert len(headers) == 1000


def test_the_same_is_never_closed_alike():
    seals = [Seal(KEY, b"mission", "r_0", 1) for _ in range(3)]
    assert len({seal.close(b"the same")[HEADER:] for seal in seals for _ in range(100)}) == 300


def test_a_session_ends_before_its_counter_does():
    sender, receiver = pair()
    before = sender.close(b"x")
    sender._counter = 2**32 - 1
    last, after = sender.close(b"last"), sender.close(b"after")
    assert last[9:21] == before[9:21] != after[9:21]
    assert [receiver.open(m) for m in (before, last, after)] == [b"x", b"last", b"after"]


def test_a_forked_process_draws_a_session_of_its_own(monkeypatch):
    sender, receiver = pair()
    before = sender.close(b"parent")
    monkeypatch.setattr(os, "getpid", lambda: -1)
    forked = sender.close(b"child")
    assert before[9:21] != forked[9:21]
    assert receiver.open(forked) == b"child"
