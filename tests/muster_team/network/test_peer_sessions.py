"""Messages of an earlier run under the same key are not taken in; those of this run are, whatever is lost."""

from itertools import count
from random import Random

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from muster_team.network.encryption import OVERHEAD, Seal
from muster_team.network.peer_sessions import KEPT, REST_S, STRANGERS, PeerSessions

KEY = bytes(32)
ROOM = 1200


def robot(name, key=KEY):
    return PeerSessions(Seal(key, b"mission", name, 1))


def exchanged(robots, now, lost=lambda: False):
    """Let robots send their greetings to all; what they could read then, by robot."""
    read = {k: [] for k in range(len(robots))}
    sent = [(one, greeting) for one in robots for greeting in one.greetings(now, ROOM)]
    for one, greeting in sent:
        for k, other in enumerate(robots):
            if other is not one and not lost():
                read[k] += other.open(greeting)
    return read


def test_two_that_hear_each_other_meet_and_nothing_is_lost():
    a, b = robot("a"), robot("b")
    first, second = a.close(b"first"), a.close(b"second")
    assert b.open(first) == b.open(second) == []
    assert b.counts == {"unproven": 2}
    exchanged([a, b], 0.0)
    assert exchanged([a, b], 0.0) == {0: [], 1: [b"first", b"second"]}
    assert b.open(a.close(b"third")) == [b"third"]
    assert a.open(b.close(b"answer")) == [b"answer"]  # who asks proves itself, too
    assert not a.counts + b.counts
    assert exchanged([a, b], 1.0) == {0: [], 1: []}


def test_what_was_recorded_in_an_earlier_run_is_never_taken_in():
    a, b = robot("a"), robot("b")
    recorded = [a.close(b"old")]
    b.open(recorded[0])
    for one in (b, a):
        recorded += one.greetings(0.0, ROOM)
    recorded.append(a.close(b"older"))
    newer = robot("b")
    for _ in range(3):
        assert [newer.open(message) for message in recorded] == [[]] * len(recorded)
        newer.greetings(1.0, ROOM)
    assert newer.counts["unproven"] == 2
    assert newer.counts["replayed"] == 2 * len(recorded)


@pytest.mark.parametrize("seed", range(20))
def test_all_meet_through_loss_when_they_go_on_speaking(seed):
    random, robots = Random(seed), [robot(f"r_{k}") for k in range(5)]
    met = {(i, j) for i in range(5) for j in range(5) if i == j}
    for now in (0.2 * k for k in count()):
        for i, one in enumerate(robots):
            said = one.close(b"heartbeat")
            met |= {(i, j) for j, other in enumerate(robots) if j != i and random.random() > 0.5 and other.open(said)}
        exchanged(robots, now, lost=lambda: random.random() < 0.5)
        if len(met) == 25:
            break
        assert now < 20.0
    assert not sum(one.counts["unproven"] for one in robots)


def test_who_is_not_known_is_asked_when_it_speaks_and_not_too_often():
    a, b = robot("a"), robot("b")
    b.open(a.close(b"x"))
    assert len(b.greetings(0.0, ROOM)) == 1
    assert b.greetings(10.0, ROOM) == []  # it has not spoken since
    b.open(a.close(b"x"))
    assert len(b.greetings(10.0, ROOM)) == 1
    b.open(a.close(b"x"))
    assert b.greetings(10.0 + 0.9 * REST_S, ROOM) == []


def test_strangers_take_no_more_room_than_is_set_apart_for_them():
    b = robot("b")
    for k in range(STRANGERS + 50):
        a = robot(f"a{k}")
        for _ in range(KEPT + 5 if k < 3 else 1):
            b.open(a.close(b"x"))
    assert len(b._strangers) == STRANGERS
    assert max(len(one.kept) for one in b._strangers.values()) <= KEPT
    greetings = b.greetings(0.0, 300)
    assert len(greetings) > 1
    assert max(map(len, greetings)) <= 300


def test_greetings_of_another_key_mean_nothing():
    a, b = robot("a"), robot("b", key=bytes(31) + b"1")
    b.open(a.close(b"x"))
    a.open(b.close(b"x"))
    assert exchanged([a, b], 0.0) == {0: [], 1: []}
    assert set(a.counts) == {"foreign"}
    assert OVERHEAD > 0
