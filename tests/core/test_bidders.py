"""The core's offers against a plain evaluation of every place, and the rest of what it keeps while tasks are sold."""

import math
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission

import muster
from muster import core
from muster.allocation.problem import Problem


def compiled(seed, **kwargs):
    return Problem.compile(random_mission(seed, **kwargs)).ready()


class Plain:
    """What offers mean, place by place and without any bookkeeping."""

    def __init__(self, problem, routes, *, insert):
        self.problem, self.routes, self.insert = problem, routes, insert
        self.place = {j: (i, k) for i, route in enumerate(routes) for k, j in enumerate(route)}

    def walk(self, i, route):
        """Usages on arrival, and the usage of the whole route."""
        problem, usage, arrivals, place = self.problem, 0.0, [], self.problem.start(i)
        for j in route:
            usage += float(problem.legs(i, [place], [j])[0, 0])
            arrivals.append(usage)
            usage += float(problem.work_usage(i)[j])
            place = j
        if route and problem.robots[i].place_at_end(problem.mission.rules) is not None:
            usage += float(problem.legs(i, [place], [problem.end(i)])[0, 0])
        return arrivals, usage

    def best_place(self, i, j):
        """(place, growth) where the task lengthens the route least and nothing deadlocks; None if it fits nowhere."""
        route, found = self.routes[i], []
        if not self.problem.allowed[i, j]:
            return None
        for at in range(len(route) + 1) if self.insert else [len(route)]:
            longer = [*route[:at], j, *route[at:]]
            usage = self.walk(i, longer)[1]
            routes = [longer if k == i else other for k, other in enumerate(self.routes)]
            if core.Inspection(self.problem.core, routes).makespan is not None:
                found.append((usage - self.walk(i, route)[1], at, usage))
        if not found or not math.isfinite(min(found)[0]):
            return None
        growth = min(found)[0]
        at = min(at for g, at, _ in found if g <= growth + 1e-9)
        return None if min(found)[2] > self.problem.capacity[i] * (1 + 1e-12) else (at, growth)

    def growth(self, i, j):
        best = self.best_place(i, j)
        return math.inf if best is None else best[1]

    def arrivals(self, i, j):
        best = self.best_place(i, j)
        if best is None:
            return math.inf
        route = self.routes[i]
        longer = [*route[: best[0]], j, *route[best[0] :]]
        return sum(self.walk(i, longer)[0]) - sum(self.walk(i, route)[0])


def sold_in_random_order(problem, random, figure="growth", insert=True):
    """Bidders at every state of a random sale, with the prerequisites of open tasks in routes."""
    bidders = core.Bidders(problem.core, insert=insert, figure=figure)
    bidders.announce(list(range(len(problem.tasks))))
    while True:
        yield bidders
        offers = [
            (i, j) for i in range(len(problem.robots)) for j in np.flatnonzero(np.isfinite(bidders.offers(i))).tolist()
        ]
        if not offers:
            return
        bidders.award(*random.choice(offers))


@pytest.mark.parametrize("insert", [True, False])
@pytest.mark.parametrize("figure", ["growth", "arrivals"])
@given(seed=st.integers(0, 10**6))
def test_offers_are_those_of_a_plain_evaluation(figure, insert, seed):
    problem = compiled(seed, tasks=7)
    for bidders in sold_in_random_order(problem, Random(seed), figure, insert):
        plain = Plain(problem, bidders.routes, insert=insert)
        for i in range(len(problem.robots)):
            offers = bidders.offers(i)
            for j in range(len(problem.tasks)):
                expected = getattr(plain, figure)(i, j) if j in bidders.open else math.inf
                if math.isfinite(expected) or math.isfinite(offers[j]):
                    assert offers[j] == pytest.approx(expected, abs=1e-9)


@given(seed=st.integers(0, 10**6))
def test_an_end_is_when_the_robot_would_be_done(seed):
    problem = compiled(seed, tasks=7, return_to_start=False)
    random = Random(seed)
    bidders = core.Bidders(problem.core, insert=False, figure="end")
    bidders.announce(list(range(len(problem.tasks))))
    for _ in range(len(problem.tasks)):
        offers = [bidders.offers(i) for i in range(len(problem.robots))]
        choices = [(i, int(j)) for i, row in enumerate(offers) for j in np.flatnonzero(np.isfinite(row))]
        if not choices:
            break
        i, j = random.choice(choices)
        bidders.award(i, j)
        plan = muster.Plan(
            objective="makespan",
            routes=tuple(
                muster.Route(robot.id, tuple(problem.tasks[k].id for k in route))
                for robot, route in zip(problem.robots, bidders.routes, strict=True)
            ),
        )
        verdict = muster.verify(problem.mission, plan)
        visits = {route.robot: route.visits for route in verdict.routes}[problem.robots[i].id]
        assert offers[i][j] == pytest.approx(visits[-1].ends_s)


@given(seed=st.integers(0, 10**6), figure=st.sampled_from(["growth", "arrivals", "end"]), insert=st.booleans())
def test_the_lowest_offers_are_those_of_all_offers(seed, figure, insert):
    problem = compiled(seed, tasks=8)
    for bidders in sold_in_random_order(problem, Random(seed), figure, insert):
        tasks, figures = bidders.lowest()
        for i, (j, figure_i) in enumerate(zip(tasks, figures, strict=True)):
            offers = bidders.offers(i)
            assert figure_i == offers.min()
            assert j == (int(np.argmin(offers)) if np.isfinite(figure_i) else -1)


@given(seed=st.integers(0, 10**6))
def test_offers_for_a_task_are_the_robots_offers(seed):
    problem = compiled(seed)
    for bidders in sold_in_random_order(problem, Random(seed)):
        table = np.array([bidders.offers(i) for i in range(len(problem.robots))])
        for j in range(len(problem.tasks)):
            assert bidders.offers_for(j).tolist() == table[:, j].tolist()


@given(seed=st.integers(0, 10**6), figure=st.sampled_from(["growth", "arrivals", "end"]), insert=st.booleans())
def test_after_tasks_come_back_all_is_as_if_begun_with_these_routes(seed, figure, insert):
    problem = compiled(seed, tasks=9)
    random = Random(seed)
    bidders = core.Bidders(problem.core, insert=insert, figure=figure)
    bidders.announce(list(range(len(problem.tasks))))
    for state in sold_in_random_order(problem, random, figure, insert):
        bidders = state
    for _ in range(4):
        sold = [j for route in bidders.routes for j in route]
        if sold:
            bidders.announce(bidders.relinquish(random.choice(sold)))
    fresh = core.Bidders(problem.core, insert=insert, figure=figure)
    fresh.set_routes(bidders.routes)
    sold = {j for route in bidders.routes for j in route}
    fresh.announce([j for j in range(len(problem.tasks)) if j not in sold])
    assert sorted(bidders.open) == sorted(fresh.open)
    assert core.Inspection(problem.core, bidders.routes).admissible
    for i in range(len(problem.robots)):
        assert bidders.offers(i) == pytest.approx(fresh.offers(i))
    assert bidders.lowest()[0] == fresh.lowest()[0]


@given(seed=st.integers(0, 10**6))
def test_a_task_takes_with_it_what_waits_for_it(seed):
    problem = compiled(seed, tasks=9)
    *_, bidders = sold_in_random_order(problem, Random(seed))
    sold = {j for route in bidders.routes for j in route}
    for j in sorted(sold):
        returned = bidders.relinquish(j)
        left = {k for route in bidders.routes for k in route}
        assert left | set(returned) == sold
        assert all(set(problem.prerequisites[k]) <= left for k in left)
        bidders.set_routes([[k for k in route if k in left] for route in bidders.routes])
        sold = left
        if not sold or j not in sold:
            break


def test_a_task_on_a_short_cut_is_not_given_back():
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0), work_capacity=10),),
        tasks=(
            muster.Task(id="0", position=(1, 0), entry=(1, 0), exit=(99, 0)),  # carries the robot along
            muster.Task(id="1", position=(100, 0)),
        ),
    )
    problem = Problem.compile(mission).ready()
    bidders = core.Bidders(problem.core, insert=True, figure="growth")
    bidders.set_routes([[0, 1]])
    assert bidders.relinquish(0) == []
    assert bidders.routes == [[0, 1]]
    assert bidders.relinquish(1) == [1]


def test_routes_do_not_deadlock_when_a_place_is_filled_before_an_open_task_is_sold():
    """r: a; s: p. A task of s waits for a and comes before p; then t, which waits for p, may not come before a."""
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0)), muster.Robot(id="s", position=(0, 10))),
        tasks=(
            muster.Task(id="0", position=(5, 0)),  # a
            muster.Task(id="1", position=(5, 10)),  # p
            muster.Task(id="2", position=(1, 10), prerequisites=("0",)),
            muster.Task(id="3", position=(1, 0), prerequisites=("1",)),  # t
        ),
    )
    problem = Problem.compile(mission).ready()
    bidders = core.Bidders(problem.core, insert=True, figure="growth")
    bidders.announce([0, 1, 2, 3])
    bidders.award(0, 0)
    bidders.award(1, 1)
    assert bidders.offers(0)[3] == pytest.approx(0.0)  # before a
    bidders.award(1, 2)
    assert bidders.routes == [[0], [2, 1]]
    assert bidders.offers(0)[3] == pytest.approx(4.0)  # after it
    bidders.award(0, 3)
    assert bidders.routes == [[0, 3], [2, 1]]


def test_wrong_calls_are_refused():
    problem = Problem.compile(muster.load("6T-2R")).ready()
    bidders = core.Bidders(problem.core, insert=True, figure="growth")
    with pytest.raises(ValueError, match="no offer"):
        bidders.award(0, 0)
    bidders.announce([0])
    bidders.award(0, 0)
    with pytest.raises(ValueError, match="in a route"):
        bidders.announce([0])
    with pytest.raises(ValueError, match="no route"):
        bidders.relinquish(1)
    with pytest.raises(IndexError):
        bidders.offers(2)
    with pytest.raises(IndexError):
        bidders.announce([6])
    with pytest.raises(ValueError, match="figure"):
        core.Bidders(problem.core, insert=True, figure="length")
    with pytest.raises(ValueError, match="admissible"):
        core.Bidders(Problem.compile(muster.load("31T-6R50")).core, insert=True, figure="growth").set_routes(
            [list(range(31)), [], [], [], [], []]
        )


@given(seed=st.integers(0, 10**6))
def test_annealing_keeps_the_tasks_and_never_ends_worse(seed):
    mission = random_mission(seed, tasks=9)
    problem = Problem.compile(mission).ready()
    routes = [
        [problem.task_index[name] for name in route.tasks]
        for route in sorted(
            muster.solve(mission, "genetic", iterations=3, seed=seed).routes,
            key=lambda route: problem.robot_index[route.robot],
        )
    ]
    annealing = core.Annealing(problem.core, routes, seed)
    for robot in range(len(routes)):
        annealing.anneal(robot, 300)
    after = core.Inspection(problem.core, annealing.routes)
    assert after.admissible
    assert after.objective <= core.Inspection(problem.core, routes).objective
    assert [sorted(route) for route in annealing.routes] == [sorted(route) for route in routes]


def test_annealing_finds_the_shortest_order():
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0)),),
        tasks=tuple(muster.Task(id=str(k), position=(x, 0)) for k, x in enumerate([5, 1, 4, 2, 3, 6, 8, 7])),
    )
    problem = Problem.compile(mission).ready()
    annealing = core.Annealing(problem.core, [list(range(8))], 1)
    annealing.anneal(0, 5000)
    assert annealing.routes == [[1, 3, 4, 2, 0, 5, 7, 6]]
