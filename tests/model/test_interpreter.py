"""An interpreter that knows primitives alone says of each plan what the judge says, which knows rules alone."""

from collections import Counter
from random import Random

import pytest
from tests.carried_missions.missions import carried_mission
from tests.model.interpreter import is_admissible
from tests.timed_missions.missions import ignored_in, timed_mission

import muster
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem

PLANS = 6
"""Random ones of each mission, beside that of greedy."""


def random_routes(problem, random):
    """Routes with some of the tasks, each by about as many robots as it needs."""
    routes = [[] for _ in problem.robots]
    for j in random.sample(range(len(problem.tasks)), random.randint(0, len(problem.tasks))):
        for i in random.sample(range(len(routes)), min(len(routes), problem.model.least_members(j))):
            routes[i].append(j)
    return routes


def compared(mission, ignored, seed):
    """How often the interpreter and the judge call a plan valid, and where they differ."""
    problem, random, counts = Problem.compile(mission, ignored=ignored), Random(f"plans {seed}"), Counter()
    by_robot = {route.robot: route.tasks for route in muster.solve(mission, "greedy", ignore=ignored).routes}
    planned = [[problem.task_index[name] for name in by_robot.get(robot.id, ())] for robot in problem.robots]
    for routes in (planned, *(random_routes(problem, random) for _ in range(PLANS))):
        named = zip(problem.robots, routes, strict=True)
        plan = Plan(routes=tuple(Route(r.id, tuple(problem.tasks[j].id for j in route)) for r, route in named))
        verdict, mine = muster.verify(mission, plan, ignored), is_admissible(problem, routes)
        assert verdict.valid == mine, (seed, routes, verdict.violations)
        counts[mine] += 1
    return counts


def of_seeds(seeds, mission_of, ignored_of):
    return sum((compared(mission_of(seed), ignored_of(seed), seed) for seed in seeds), Counter())


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, 400, 50))
def test_times_teams_and_relations(first):
    counts = of_seeds(range(first, first + 50), timed_mission, ignored_in)
    assert min(counts.values()) > 30


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("first", range(0, 200, 50))
def test_goods_and_energy(first):
    """Without stations, at which robots may call."""

    def of(seed):
        mission = carried_mission(seed)
        return muster.Mission(**{f: getattr(mission, f) for f in mission.__dataclass_fields__} | {"stations": ()})

    assert min(of_seeds(range(first, first + 50), of, lambda _: ()).values()) > 30
