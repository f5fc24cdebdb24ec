"""An operator's signed order that revokes the key of a robot: who may give it, and what becomes of the team."""

from dataclasses import replace

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.byzantine.trial import keys_of, secret
from tests.muster_team.networks import agree, line_mission, owners

from muster.allocation.auctions.auction import Parameters
from muster.mission.errors import ParameterError
from muster.model.problem import Problem
from muster_team.knowledge.messages import AUTHORITY, Fact, Heartbeat, Message
from muster_team.knowledge.signatures import NO_KEYS
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork
from muster_team.network.robot_keys import order_line, order_of, revocation
from muster_team.processes.memory_file import Kept, kept_in

ROBOTS = [f"r_{k}" for k in range(5)]
KEYS = keys_of(ROBOTS)
ORDER = revocation("r_4", secret(AUTHORITY), b"a mission")
ONCE = ("3", "8", "42")


class Team:
    """A team with keys, and what its robots remember; it agrees."""

    def __init__(self, keys=KEYS):
        self._problem = Problem.compile(line_mission(robots=5, tasks=45, once=ONCE)).ready()
        self.memories, self._keys = {}, keys
        self.net = MemoryNetwork(self._make, ROBOTS, conditions=LinkConditions(delay_s=0.02, loss=0.1))
        self.net.start()
        agree(self.net)

    def _make(self, robot, incarnation):
        memory, signatures = self.memories.pop(robot, None), self._keys[robot]
        how = {"remembered": memory, "forgot": memory is None and incarnation > 1, "signatures": signatures}
        return negotiator_of(self._problem, Parameters(), robot, incarnation=incarnation, **how)

    def others(self):
        return [node for robot, node in self.net.nodes.items() if robot != "r_4"]

    def is_without_it(self):
        return all(node.settled and node.epoch.own.members == tuple(ROBOTS[:4]) for node in self.others())

    def goes_on_without_it(self):
        return self.net.run(self.net.now + 30.0, self.is_without_it)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("told", ["r_0", "r_3"])
def test_all_count_it_out_and_do_its_tasks_and_it_falls_silent(told):
    team = Team()
    assert team.net.nodes["r_4"].route
    team.net.nodes[told].revoke(ORDER)
    assert team.goes_on_without_it()
    assert team.net.run(team.net.now + 5.0, lambda: team.net.nodes["r_4"].superseded)
    assert not team.net.nodes["r_4"].route
    assert {task: len(robots) for task, robots in owners(team.net).items()} == {str(k): 1 for k in range(45)}
    assert all(node.revoked == {"r_4"} for node in team.others())
    assert all(any(n.kind == "revoked" and n.robots == ("r_4",) for n in node.notices) for node in team.others())


def test_whoever_has_its_key_is_heard_no_more_also_as_a_later_start():
    team = Team()
    team.net.nodes["r_0"].revoke(ORDER)
    assert team.goes_on_without_it()
    node = team.net.nodes["r_1"]
    known = node.known
    stated = KEYS["r_4"].sign(Fact("3", "r_4", "done", 50))
    later = Message("r_4", 9, 1, node.stage, facts=(stated,), heartbeats=(Heartbeat("r_4", 9, 1),))
    assert [(sent.to, sent.message.facts) for sent in node.handle(later, team.net.now)] == [("r_4", (ORDER,))]
    assert node.known == known
    team.net.crash("r_4")
    team.net.start(["r_4"])  # without memory it does not know
    assert team.net.run(team.net.now + 10.0, lambda: team.net.nodes["r_4"].superseded)
    assert team.is_without_it()


def test_what_it_has_begun_for_good_nobody_begins_again():
    team = Team()
    liar = team.net.nodes["r_4"]
    once = next(claim.task for claim in liar.route if claim.task in ONCE)
    assert team.net.run(team.net.now + 10.0, lambda: liar.begin(once))
    team.net.nodes["r_0"].revoke(ORDER)
    assert team.goes_on_without_it()
    assert not any(once in {claim.task for claim in node.route} for node in team.others())
    rest = {claim.task for node in team.others() for claim in node.route}
    assert rest == {str(k) for k in range(45)} - {once}


def test_on_two_sides_of_a_cut_it_holds_when_they_meet():
    team = Team()
    team.net.cut(("r_0", "r_1"), ("r_2", "r_3", "r_4"))
    team.net.run(team.net.now + 8.0)
    team.net.nodes["r_0"].revoke(ORDER)
    team.net.run(team.net.now + 2.0)
    assert not team.net.nodes["r_4"].superseded
    team.net.heal()
    assert team.goes_on_without_it()
    assert team.net.nodes["r_4"].superseded


def test_it_is_remembered_by_robots_that_start_again(tmp_path):
    team = Team()
    team.net.nodes["r_0"].revoke(ORDER)
    assert team.goes_on_without_it()
    for robot in ROBOTS[:4]:
        node = team.net.crash(robot)
        Kept(auction="ab", robot=robot, incarnation=1, memory=node.memory).save(tmp_path / robot)
        team.memories[robot] = kept_in(tmp_path / robot, "ab", robot).memory
    team.net.crash("r_4")
    team.net.start(["r_4"])  # the only one that does not know
    team.net.start(ROBOTS[:4])
    assert all("r_4" not in node.epoch.own.members for node in team.others())
    assert team.goes_on_without_it()


def test_an_order_given_afterwards_is_final_without_it():
    team = Team()
    team.net.nodes["r_0"].revoke(ORDER)
    assert team.goes_on_without_it()
    node = team.net.nodes["r_1"]
    node.cancel("9")
    (order,) = (fact for fact in node.facts if fact.kind == "cancelled")
    assert team.net.run(team.net.now + 10.0, lambda: all(other.is_final(order) for other in team.others()))


def forged_by(robot):
    return KEYS[robot].sign(Fact("r_4", AUTHORITY, "revoked"))


REFUSED = [
    forged_by("r_1"),
    KEYS["r_1"].sign(Fact("r_4", "r_1", "revoked")),
    replace(ORDER, task="r_3"),
    replace(ORDER, proof=b""),
    revocation("r_4", secret(AUTHORITY), b"another mission"),
    revocation("nobody", secret(AUTHORITY), b"a mission"),
    revocation("3", secret(AUTHORITY), b"a mission"),
    KEYS["r_4"].sign(Fact("3", "r_4", "done", 4)),
]


@pytest.mark.parametrize("order", REFUSED)
def test_who_may_not_revoke_is_refused_here_and_by_those_that_hear_it(order):
    team = Team()
    node = team.net.nodes["r_0"]
    with pytest.raises(ParameterError, match=r"^revocation: .*; expected one signed by the key of @operator in the"):
        node.revoke(order)
    if order.kind == "revoked":
        known = node.known
        node.handle(Message("r_1", 1, 10**6, node.stage, facts=(order,)), team.net.now)
        assert node.known == known
        assert [sender for sender, _ in node.counts.refused.elements()] == ["r_1"]
    assert node.revoked == frozenset()


def test_without_keys_nobody_may_revoke():
    team = Team(dict.fromkeys(ROBOTS, NO_KEYS))
    node = team.net.nodes["r_0"]
    with pytest.raises(ParameterError, match="has not stated"):
        node.revoke(ORDER)
    node.handle(Message("r_1", 1, 10**6, node.stage, facts=(ORDER,)), team.net.now)
    assert node.revoked == frozenset()


def test_an_order_as_a_line_of_text():
    assert order_of(order_line(ORDER)) == ORDER
    for line in ("", "{}", "[]", "null", '{"revoked": 3, "proof": ""}', '{"revoked": "a", "proof": "zz"}', "[" * 9000):
        assert order_of(line) is None
