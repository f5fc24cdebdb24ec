"""Robots agree without a centre on tasks of teams and on tasks that are tied to each other."""

from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.networks import agree, all_agree, network, owners, settled_team
from tests.muster_team.trials.random_missions import random_mission, with_times

from muster import Mission, Robot, Task
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster.verification import verify
from muster_team.negotiators.participation import plan_of


def lifting(robots=4, **more):
    """Robots on a line, a task for two of them, and one for any."""
    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(10.0 * k, 0.0)) for k in range(robots)),
        tasks=(
            Task(id="lift", position=(0.0, 5.0), robots_needed=2, **more),
            Task(id="look", position=(30.0, 5.0)),
        ),
    )


@pytest.mark.long(keep=8)
@pytest.mark.parametrize("seed", range(30))
def test_the_plan_is_that_of_coalitions_in_one_process(seed):
    random = Random(seed)
    mission = with_times(random_mission(random, robots=random.randint(2, 5), tasks=7, once=0.0), random)
    problem, terms = Problem.compile(mission).ready(), Parameters(placement=random.choice(("append", "insert")))
    central = AUCTION.solve(problem, Stop(), params=terms)
    net = network(problem, terms, delay_s=0.02)
    net.start()
    agree(net)
    plans = [plan_of(problem, node) for node in net.nodes.values()]
    assert all(plan.routes == central.routes for plan in plans)
    assert plans[0].book.awards == central.book.awards
    assert plans[0].book.bids == central.book.bids
    assert not [found for found in verify(mission, plans[0]).violations if found.kind != "reason"]


def test_those_that_win_together_own_the_task_and_none_begins_it_alone():
    net = settled_team(lifting())
    assert {task: set(names) for task, names in owners(net).items()} == {"lift": {"r_0", "r_1"}, "look": {"r_3"}}
    assert not any(net.nodes[robot].begin("lift") for robot in ("r_0", "r_1"))
    assert net.nodes["r_3"].begin("look")


def test_a_team_that_loses_a_robot_forms_anew():
    net = settled_team(lifting())
    net.crash("r_0")
    agree(net)
    assert set(owners(net)["lift"]) == {"r_1", "r_2"}


def test_a_task_for_more_robots_than_are_left_is_given_up():
    net = settled_team(lifting(robots=2))
    net.crash("r_0")
    agree(net)
    assert owners(net) == {"look": ["r_1"]}


def test_a_robot_that_gives_a_task_back_is_in_no_team_for_it():
    net = settled_team(lifting())
    net.nodes["r_0"].release("lift")
    assert net.run(net.now + 30.0, lambda: all_agree(net) and "r_0" not in owners(net).get("lift", ["r_0"]))
    assert set(owners(net)["lift"]) == {"r_1", "r_2"}


def test_of_two_teams_on_two_sides_of_a_cut_one_is_left():
    net = settled_team(lifting())
    net.cut(["r_0", "r_1"], ["r_2", "r_3"])
    assert net.run(net.now + 30.0, lambda: len(set(owners(net)["lift"])) == 4)
    net.heal()
    agree(net)
    assert set(owners(net)["lift"]) == {"r_0", "r_1"}


@pytest.mark.parametrize(
    ("keys", "same"), [({"same_robot_as": ("lift",)}, True), ({"other_robot_than": ("lift",)}, False)]
)
def test_relations_are_kept(keys, same):
    mission = lifting(robots=2)
    lift, look = mission.tasks
    alone = replace(mission, tasks=(replace(lift, robots_needed=None), replace(look, **keys)))
    by_task = owners(settled_team(alone))
    assert (by_task["lift"] == by_task["look"]) == same


def test_tasks_that_begin_together_are_won_together():
    mission = lifting()
    lift, look = mission.tasks
    tied = replace(mission, tasks=(replace(lift, robots_needed=None), replace(look, starts_with=("lift",))))
    net = settled_team(tied)
    assert owners(net) == {"lift": ["r_0"], "look": ["r_3"]}
    assert len(net.nodes["r_0"].epoch.sales) == 1
    assert not net.nodes["r_0"].begin("lift")
