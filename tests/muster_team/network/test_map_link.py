"""Pieces of maps between robots: lost, late, twice and garbled, they come to all in the end."""

from random import Random

import pytest

pytest.importorskip("msgpack")

import msgpack

from muster_team.knowledge.messages import Reach
from muster_team.network.map_link import AT_ONCE, MOST_EARLY, MapLink
from muster_team.network.plain_values import MalformedError

ROBOTS = ("a", "b", "c")
BEAT_S = 0.2


def team(*robots):
    return {robot: MapLink(robot, 1, ROBOTS, BEAT_S) for robot in robots or ROBOTS}


def run(links, rounds, drops=lambda sender, to: False, begin_s=0.0):
    """Let robots exchange messages for so many beats; how many were delivered."""
    delivered = 0
    for step in range(rounds):
        now = begin_s + step * BEAT_S
        queue = [(robot, *said) for robot, link in links.items() for said in link.tick(now)]
        while queue:
            sender, data, to = queue.pop(0)
            for other in links if to is None else [to]:
                if other != sender and other in links and not drops(sender, other):
                    delivered += 1
                    queue += [(other, *said) for said in links[other].handle(data, now)]
    return delivered


def test_pieces_come_to_all_in_the_order_of_each_robot():
    links = team()
    links["a"].add([b"1", b"2"])
    links["b"].add([b"3"])
    run(links, 1)
    for link in links.values():
        came = link.take_new()
        assert [content for track, content in came if track == ("a", 1)] == [b"1", b"2"]
        assert [content for track, content in came if track == ("b", 1)] == [b"3"]
        assert link.reach == (Reach("a", 1, 2), Reach("b", 1, 1))
        assert link.take_new() == []


@pytest.mark.parametrize("loss", [0.3, 0.6])
def test_what_is_lost_is_sent_again(loss):
    links, random = team(), Random(1)
    for k in range(40):
        links["a"].add([bytes([k])])
        links["c"].add([bytes([k]), b"more"])
        run(links, 1, lambda *_: random.random() < loss, begin_s=k * BEAT_S)
    run(links, 120, lambda *_: random.random() < loss, begin_s=40 * BEAT_S)
    assert {link.reach for link in links.values()} == {(Reach("a", 1, 40), Reach("c", 1, 80))}
    assert [content for track, content in links["b"].take_new() if track == ("a", 1)] == [bytes([k]) for k in range(40)]


def test_a_robot_that_comes_late_gets_all_and_the_pieces_of_its_earlier_life():
    links = team("a", "b")
    links["a"].add([bytes([k]) for k in range(3 * AT_ONCE)])
    run(links, 2)
    links["a"] = MapLink("a", 2, ROBOTS, BEAT_S)
    links["a"].add([b"new"])
    links["c"] = team("c")["c"]
    run(links, 40, begin_s=1.0)
    assert {link.reach for link in links.values()} == {(Reach("a", 1, 3 * AT_ONCE), Reach("a", 2, 1))}


def test_pieces_go_over_robots_that_stand_between():
    links = team()
    links["a"].add([b"1", b"2"])
    run(links, 30, lambda sender, to: {sender, to} == {"a", "c"})
    assert links["c"].reach == (Reach("a", 1, 2),)


def test_when_all_have_all_nothing_but_beats_is_sent():
    links = team()
    links["a"].add([b"1"] * 5)
    run(links, 5)
    assert run(links, 10, begin_s=2.0) == 10 / 2 * len(ROBOTS) * (len(ROBOTS) - 1)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xc1",
        b"nothing",
        msgpack.packb([]),
        msgpack.packb(["a", True, []]),
        msgpack.packb([0, 1, [], []]),
        msgpack.packb([7, True, [], []]),
        msgpack.packb(["stranger", True, [], []]),
        msgpack.packb([0, True, [0, 1], []]),
        msgpack.packb([0, True, [0, -1, 1], []]),
        msgpack.packb([0, False, [], [[0, 1, 0]]]),
        msgpack.packb([0, False, [], [[0, 1, 0, "text"]]]),
        msgpack.packb([0, False, [], [["x", 1, 0, b""]]]),
        msgpack.packb([0, True, {}, None]),
    ],
)
def test_what_is_no_message_changes_nothing(data):
    link = team("b")["b"]
    link.add([b"1"])
    with pytest.raises(MalformedError):
        link.handle(data, 0.0)
    assert link.reach == (Reach("b", 1, 1),)


def test_random_bytes_and_garbled_messages_raise_nothing_else():
    link, random = team("b")["b"], Random(2)
    other = team("a")["a"]
    other.add([b"some piece", b"another"])
    messages = [data for data, _ in other.tick(0.0)]
    for _ in range(2000):
        data = bytearray(random.choice(messages))
        data[random.randrange(len(data))] = random.randrange(256)
        try:
            link.handle(bytes(data), 0.0)
        except MalformedError:
            continue


def test_numbers_far_ahead_fill_no_memory():
    link = team("b")["b"]
    for number in range(10, 10 + 3 * MOST_EARLY):
        link.handle(msgpack.packb([0, False, [], [[0, 1, number, b"x"]]]), 0.0)
    assert sum(map(len, link._early.values())) <= MOST_EARLY
    assert link.take_new() == []
