"""Facts that arrive in parts: what names a task that is not known yet waits for that task, and ends no robot."""

from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.networks import agree, line_mission, owners, settled_team

from muster import Task
from muster.mission.errors import MissionError
from muster.model.problem import Problem
from muster_team.knowledge.epoch_base import agreed
from muster_team.knowledge.facts import AT_ONCE
from muster_team.knowledge.messages import Declaration, Fact
from muster_team.knowledge.new_tasks import content_of
from muster_team.negotiators.participation import rules_of

RULES = rules_of(Problem.compile(line_mission(robots=2, tasks=1)))


def new_task(name, *waits_for, x=1.0):
    return Task(id=name, position=(x, 1.0), prerequisites=waits_for)


def fact_of(task, order, kind="added", robot="r_0"):
    return Fact(task.id, robot, kind, order, content_of(task))


def added(*facts):
    return [fact.task for fact in agreed([Declaration("r_0", 1, 1, ("r_0",), facts=facts)], RULES).added]


@pytest.mark.long
@pytest.mark.parametrize("seed", [3, 6, 16, 17])
def test_a_link_that_flaps_while_more_facts_are_under_way_than_fit_a_message_ends_no_robot(seed):
    net = settled_team(line_mission(robots=3, tasks=2), seed=seed, loss=0.5, jitter_s=0.1)
    random, apart = Random(seed), (("r_0", "r_1"), ("r_2",))
    net.cut(*apart)
    net.run(net.now + 6)
    number = AT_ONCE + 20
    for k in range(number):
        net.nodes["r_0"].announce(new_task(f"n{k}", *([f"n{k - 1}"] if k else []), x=float(k)))
        net.run(net.now + 0.4)
    for _ in range(6):
        net.heal()
        net.run(net.now + random.uniform(0.02, 0.3))
        net.cut(*apart)
        net.run(net.now + random.uniform(4, 9))
    net.heal()
    agree(net, 90)
    assert all(len(node.facts) == number for node in net.nodes.values())
    assert {task: len(robots) for task, robots in owners(net).items()} == dict.fromkeys(
        ["0", "1", *(f"n{k}" for k in range(number))], 1
    )


def test_an_added_task_waits_until_all_that_it_waits_for_are_known():
    first, second, third = new_task("a"), new_task("b", "a", "0"), new_task("c", "b")
    facts = [fact_of(task, order) for order, task in enumerate((first, second, third), 1)]
    assert added(*facts) == ["a", "b", "c"]
    assert added(facts[0], facts[2]) == ["a"]
    assert added(facts[1], facts[2]) == []


def test_a_move_of_another_task_of_the_same_name_does_not_count():
    """Two sides of a cut add tasks of the same names, which wait for each other the other way round."""
    a, b = new_task("a"), new_task("b")
    waits_for_b, waits_for_a = replace(a, prerequisites=("b",)), replace(b, prerequisites=("a",))
    facts = [
        fact_of(a, 1),
        fact_of(waits_for_a, 2),
        fact_of(b, 1, robot="r_1"),
        fact_of(waits_for_b, 2, robot="r_1"),
        fact_of(replace(waits_for_a, position=(5.0, 5.0)), 3, "moved"),
        fact_of(replace(waits_for_b, position=(5.0, 5.0)), 3, "moved", robot="r_1"),
    ]
    base = agreed([Declaration("r_0", 1, 1, ("r_0",), facts=tuple(facts))], RULES)
    assert [(fact.task, fact.kind) for fact in base.added] == [("a", "added"), ("b", "added")]


def test_a_task_may_wait_for_one_that_was_announced_just_before():
    net = settled_team(line_mission(robots=2, tasks=1))
    net.nodes["r_0"].announce(new_task("a"))
    net.nodes["r_0"].announce(new_task("b", "a"))
    with pytest.raises(MissionError):
        net.nodes["r_0"].announce(new_task("c", "nowhere"))
    agree(net)
    assert owners(net).keys() == {"0", "a", "b"}
