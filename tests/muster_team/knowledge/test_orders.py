"""Which orders count: it follows from all orders that are known, and from nothing else."""

from dataclasses import replace

import pytest
from tests.muster_team.networks import agree, line_mission, owners, settled_team

from muster import Task
from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.auctions.valuation import AuctionValuer
from muster_team.knowledge.messages import Fact
from muster_team.knowledge.new_tasks import content_of
from muster_team.knowledge.orders import orders_among
from muster_team.knowledge.verdicts import TAKEN, Refused, Waits
from muster_team.negotiators.participation import rules_of

MISSION = line_mission(robots=3, tasks=4)
PROBLEM = Problem.compile(MISSION).ready()
RULES = replace(rules_of(PROBLEM), misfit=AuctionValuer(PROBLEM, Parameters(), "r_0").misfit)


def order(task, number, robot="r_0", kind="added"):
    return Fact(task.id, robot, kind, number, content_of(task))


def new(name, **keys):
    return Task(id=name, position=(1.0, 1.0), **keys)


def verdict_of(*orders):
    """What becomes of the last of these orders."""
    return orders_among(orders, RULES).verdicts[orders[-1]]


def test_the_first_of_two_orders_that_contradict_each_other_counts_whoever_hears_it_first():
    one = order(new("x", prerequisites=("3",), starts_with=("2",)), 1, "r_0")
    other = order(new("y", prerequisites=("2",), starts_with=("3",)), 1, "r_2")
    for facts in ([one, other], [other, one]):
        found = orders_among(facts, RULES)
        assert found.taken == (one,)
        assert list(found.refused) == [other]
        assert "cycle" in found.refused[other] or "wait" in found.refused[other]


@pytest.mark.parametrize(
    ("task", "reason"),
    [
        (new("1"), 'there is a task "1"'),
        (Task(id="x", position=(1.0, 1.0, 4.0)), "position"),
        (new("x", load=2.0), "load"),
        (new("x", prerequisites=("x",)), None),
    ],
)
def test_an_order_that_does_not_fit_is_refused(task, reason):
    verdict = verdict_of(order(task, 1))
    assert isinstance(verdict, Waits if reason is None else Refused)
    assert reason is None or reason in verdict.reason


def test_an_order_waits_for_tasks_that_are_not_known_and_says_for_which():
    verdict = verdict_of(order(new("x", prerequisites=("a", "1"), same_robot_as=("b",)), 1))
    assert verdict == Waits(("a", "b"))
    assert verdict.reason == 'it waits for "a", "b", which there is not'


def test_one_order_that_several_robots_were_given_counts_once():
    facts = [order(new("x"), 1, robot) for robot in ("r_0", "r_1")]
    found = orders_among(facts, RULES)
    assert found.taken == (facts[0],)
    assert not found.refused


def test_a_name_is_free_again_after_its_order_was_refused():
    refused = order(new("x", load=2.0), 1)
    assert verdict_of(refused, order(new("x"), 2)) == TAKEN


def test_a_move_changes_the_place_alone():
    there = order(new("x"), 1)
    away = replace(new("x"), position=(7.0, 7.0))
    assert verdict_of(there, order(away, 2, kind="moved")) == TAKEN
    assert isinstance(verdict_of(there, order(replace(away, priority=9.0), 2, kind="moved")), Refused)
    given = MISSION.tasks[0]
    assert verdict_of(order(replace(given, position=(7.0, 7.0)), 1, kind="moved")) == TAKEN
    assert isinstance(verdict_of(order(replace(given, priority=9.0), 1, kind="moved")), Refused)


def test_operators_on_both_sides_of_a_cut_that_contradict_each_other_end_no_robot():
    net = settled_team(line_mission(robots=5, tasks=15), delay_s=0.02)
    net.cut(("r_0", "r_1"), ("r_2", "r_3", "r_4"))
    net.run(net.now + 8)
    net.nodes["r_0"].announce(new("x", prerequisites=("3",), starts_with=("2",)))
    net.nodes["r_4"].announce(new("y", prerequisites=("2",), starts_with=("3",)))
    net.run(net.now + 8)
    net.heal()
    agree(net, 60)
    found = [node.orders for node in net.nodes.values()]
    assert all(orders.verdicts == found[0].verdicts for orders in found)
    (lost,) = found[0].refused
    (kept,) = found[0].taken
    assert all(node.is_final(lost) and node.is_final(kept) for node in net.nodes.values())
    assert set(owners(net)) == {kept.task, *(str(k) for k in range(15))}


def test_operators_who_order_within_a_moment_end_no_robot():
    net = settled_team(line_mission(robots=5, tasks=15), delay_s=0.02)
    net.nodes["r_0"].announce(new("x", prerequisites=("3",), starts_with=("2",)))
    net.nodes["r_4"].announce(new("y", prerequisites=("2",), starts_with=("3",)))
    agree(net, 60)
    assert len(next(iter(net.nodes.values())).orders.refused) == 1
