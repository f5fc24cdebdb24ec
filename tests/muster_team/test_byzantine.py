"""The first seeds of the Byzantine campaign; `make campaign-byzantine` runs thousands. And its parts one by one."""

from dataclasses import replace

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.byzantine.orders import orders_trial
from tests.muster_team.byzantine.trial import byzantine_trial, keys_of
from tests.muster_team.networks import agree, line_mission, owners

from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.knowledge.effects import Notice
from muster_team.knowledge.messages import Birth, Claim, Fact, Heartbeat, Message, RoundBids, Stage
from muster_team.knowledge.signatures import Signatures
from muster_team.knowledge.verdicts import TAKEN
from muster_team.negotiators import participant
from muster_team.negotiators.participation import negotiator_of
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

ROBOTS = [f"r_{k}" for k in range(5)]
KEYS = keys_of(ROBOTS)


@pytest.mark.long
@pytest.mark.parametrize("first", [0, 15, 30])
def test_no_robot_harms_the_others_by_what_it_states(first):
    reports = [byzantine_trial(seed) for seed in range(first, first + 15)]
    assert {report.seed: report.failures for report in reports if report.failures} == {}
    assert sum(report.counts["mutated"] for report in reports) > 100
    assert sum(report.counts["refused"] for report in reports) > 50


@pytest.mark.long
@pytest.mark.parametrize("first", [0, 12])
def test_robots_take_the_same_orders_and_each_operator_is_answered(first):
    reports = [orders_trial(seed) for seed in range(first, first + 12)]
    assert {report.seed: report.failures for report in reports if report.failures} == {}


def test_without_proofs_the_campaign_finds_harm(monkeypatch):
    monkeypatch.setattr(type(KEYS["r_0"]), "holds", Signatures.holds)
    assert any(byzantine_trial(seed).failures for seed in range(40))


def team(**conditions):
    """A team whose robots have keys; it agrees."""
    problem = Problem.compile(line_mission(robots=5, tasks=15)).ready()

    def make(robot, incarnation):
        return negotiator_of(problem, Parameters(), robot, incarnation=incarnation, signatures=KEYS[robot])

    net = MemoryNetwork(make, ROBOTS, conditions=LinkConditions(delay_s=0.02, **conditions))
    net.start()
    agree(net)
    return net


def hear(net, robot, **parts):
    """Let a robot hear these parts from r_4."""
    said = Message("r_4", 1, 10**6, net.nodes["r_4"].stage, **parts)
    return net.nodes[robot].handle(said, net.now)


def test_robots_with_keys_agree_as_those_without():
    net = team()
    assert {task: len(robots) for task, robots in owners(net).items()} == {str(k): 1 for k in range(15)}
    net.crash("r_0")
    net.start(["r_0"])
    agree(net)
    assert all(node.members.incarnation("r_0") == 2 for name, node in net.nodes.items() if name != "r_0")


@pytest.mark.parametrize("births", [(), (Birth("r_1", 7),), (KEYS["r_4"].sign(Birth("r_1", 7)),)])
def test_nobody_can_pretend_that_another_robot_has_started_again(births):
    net = team()
    for robot in ("r_0", "r_1"):
        hear(net, robot, heartbeats=(Heartbeat("r_4", 1, 10**6), Heartbeat("r_1", 7, 1)), births=births)
    assert not net.nodes["r_1"].superseded
    assert net.nodes["r_0"].members.incarnation("r_1") == 1


def test_a_later_start_that_is_proven_silences_the_earlier_process():
    net = team()
    births = (KEYS["r_1"].sign(Birth("r_1", 7)),)
    hear(net, "r_1", heartbeats=(Heartbeat("r_4", 1, 10**6), Heartbeat("r_1", 7, 1)), births=births)
    assert net.nodes["r_1"].superseded


@pytest.mark.parametrize(
    "lie",
    [
        lambda node: {"facts": (Fact("3", "r_1", "done", 5),)},
        lambda node: {"facts": (KEYS["r_4"].sign(Fact("3", "r_1", "done", 5)),)},
        lambda node: {"bids": (RoundBids("r_1", 0, (("3", 0.0),)),)},
        lambda node: {"declarations": (replace(node.epoch.own, robot="r_1", route=(Claim("3", 0.0, 1),)),)},
    ],
)
def test_what_another_robot_has_not_stated_is_refused_and_told_with_its_sender(lie):
    net = team()
    node = net.nodes["r_0"]
    known = node.known
    assert hear(net, "r_0", **lie(net.nodes["r_4"])) == []
    assert node.known == known
    assert [sender for sender, _ in node.counts.refused.elements()] == ["r_4"]
    assert Notice("refused", ("r_4",), reason='a statement that "r_1" has not made') in node.notices


def test_who_declares_two_different_things_is_excluded_by_all_for_good():
    net = team()
    own = net.nodes["r_4"].epoch.own
    other = KEYS["r_4"].sign(replace(own, route=(Claim("3", -9.0, 1),)))
    hear(net, "r_0", declarations=(other,))
    net.run(net.now + 3)
    honest = [node for name, node in net.nodes.items() if name != "r_4"]
    assert all(node.convicted == {"r_4"} for node in honest)
    assert all("r_4" not in node.epoch.own.members for node in honest)
    assert net.nodes["r_4"].superseded
    net.crash("r_4")
    agree(net)
    assert {task: len(robots) for task, robots in owners(net).items()} == {str(k): 1 for k in range(15)}


def test_an_epoch_far_above_all_others_leaves_room_for_more():
    net = team()
    for _ in range(5):
        net.nodes["r_0"].handle(Message("r_4", 1, 10**6, Stage(2**53)), net.now)
    net.run(net.now + 1)
    agree(net, 60)
    assert max(node.stage.epoch for node in net.nodes.values()) < 2**24


def test_what_is_not_admitted_changes_nothing(monkeypatch):
    net = team()
    node = net.nodes["r_0"]
    before = node.memory, node.stage, node.known
    hear(net, "r_0", facts=(KEYS["r_4"].sign(Fact("x", "r_4", "added", 5, b"no task")),))
    assert (node.memory, node.stage, node.known) == before
    monkeypatch.setattr(participant, "admit", lambda *said: TAKEN)
    hear(net, "r_0", facts=(KEYS["r_4"].sign(Fact("x", "r_4", "added", 5, b"no task")),))
    assert node.known != before[2]
