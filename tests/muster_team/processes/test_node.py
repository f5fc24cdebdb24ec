"""A node on a clock of the test's own, alone with a transport of the test's own."""

from itertools import pairwise

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.teams import Team

from muster.mission.system.clock import VirtualClock
from muster_team.network.codec import PROTOCOL
from muster_team.processes.node import Node

TEAM = Team("auction-2", bid="total")
FIRST, SECOND = TEAM.robots[:2]


class Scripted:
    """Hands out what is put into `coming`, (when, data); waiting makes time go by."""

    room, lost_here = 1200, 0

    def __init__(self, clock):
        self.clock, self.coming, self.sent, self.waits = clock, [], [], []
        self.datagrams = self.bytes_sent = 0
        self.closed = False

    def send(self, data, to=None):
        self.sent.append((self.clock.now(), data, to))
        self.datagrams += 1
        self.bytes_sent += len(data)

    def receive(self, wait_s):
        self.waits.append(wait_s)
        until = self.clock.now() + wait_s
        if self.coming and self.coming[0][0] <= until:
            self.clock.advance(max(0.0, self.coming[0][0] - self.clock.now()))
            came = [data for when, data in self.coming if when <= self.clock.now()]
            self.coming = [(when, data) for when, data in self.coming if when > self.clock.now()]
            return came
        self.clock.advance(wait_s)
        return []

    def close(self):
        self.closed = True


@pytest.fixture
def alone():
    clock = VirtualClock()
    transport = Scripted(clock)
    return clock, transport, Node(TEAM.negotiator(FIRST), transport, TEAM.codec, None, clock)


def said(robot=SECOND):
    """What another robot says first, as it travels."""
    return [TEAM.codec.encode(outgoing.message) for outgoing in TEAM.negotiator(robot).start(0.0)]


def test_it_waits_until_due_and_never_in_vain(alone):
    clock, transport, node = alone
    node.start()
    assert not node.run(lambda _: False, 3.0)
    assert clock.now() == pytest.approx(3.0)
    retry_s = node.negotiator.timeouts.retry_s
    assert len(transport.waits) <= 3.0 / retry_s + 2
    times = [when for when, _, _ in transport.sent]
    assert all(later - sooner == pytest.approx(retry_s) for sooner, later in pairwise(times))


def test_what_came_counts_before_absence_does(alone):
    clock, transport, node = alone
    node.start()
    clock.advance(100.0)  # the process stood still; meanwhile the others spoke
    transport.coming = [(50.0, data) for robot in TEAM.robots[1:] for data in said(robot)]
    node.step(0.1)
    status = node.status()
    assert (status.silent, status.epoch, status.members) == ((), 1, tuple(TEAM.robots))


def test_who_keeps_silent_is_left_out(alone):
    _, _, node = alone
    node.start()
    assert node.run(lambda node: node.status().members == (FIRST,), 60.0)
    assert set(node.status().silent) == set(TEAM.robots[1:])
    assert node.status().epoch > 1


def test_messages_are_counted_by_kind_as_they_travel(alone):
    _, transport, node = alone
    with node:
        node.run(lambda _: False, 2.0)
    status = node.status()
    assert status.sent["news"] == 1
    assert status.sent["heartbeats"] == len(transport.sent) - 1
    assert sum(status.sent_bytes.values()) == transport.bytes_sent
    assert transport.closed


def test_what_is_no_message_is_counted_and_dropped(alone):
    _, transport, node = alone
    node.start()
    transport.coming = [
        (0.0, b""),
        (0.0, bytes((PROTOCOL,)) + b"malformed"),
        (0.0, bytes((PROTOCOL + 1,))),
        *((0.0, data) for data in said()),
    ]
    node.step(0.1)
    assert node.status().refused == {"malformed": 2, "other_version": 1}
    assert node.status().received == len(said())


def test_a_later_robot_of_the_same_name_silences_this_one_which_then_waits(alone):
    _, transport, node = alone
    node.start()
    other = TEAM.negotiator(FIRST)
    other.incarnation = 5
    transport.coming = [(0.0, TEAM.codec.encode(outgoing.message)) for outgoing in other.start(0.0)]
    node.step(0.1)
    assert node.status().rivals == (5,)
    assert node.status().superseded
    before, transport.waits = len(transport.sent), []
    node.run(lambda _: False, 5.0)
    assert len(transport.sent) == before
    assert len(transport.waits) <= 22


def test_what_the_robot_does_is_told_at_the_next_step(alone):
    _, transport, node = alone
    node.start()
    assert node.run(lambda node: node.negotiator.route and node.negotiator.settled, 60.0)
    before = len(transport.sent)
    node.negotiator.finish(node.negotiator.route[0].task)
    node.step(0.0)
    assert len(transport.sent) == before + 1


def test_the_transport_is_closed_when_something_goes_wrong(alone):
    _, transport, node = alone
    with pytest.raises(KeyboardInterrupt), node:
        raise KeyboardInterrupt
    assert transport.closed


def test_nothing_is_sent_before_it_is_kept(alone):
    _, transport, node = alone
    sent_by_then = []
    node.keep = lambda: sent_by_then.append(len(transport.sent))
    node.start()
    assert sent_by_then == list(range(len(transport.sent)))
    assert sent_by_then
