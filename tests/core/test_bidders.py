"""The core's offers against a plain evaluation of every place, and the rest of what it keeps while tasks are sold."""

import math
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster import core
from muster.model.problem import Problem

FIGURES = ("growth", "arrivals", "end")
seeds = st.integers(0, 10**6)


def compiled(seed, *, tables=False, **kwargs):
    mission = random_mission(seed, **kwargs)
    return Problem.compile(with_travel_tables(mission, seed) if tables else mission).ready()


class Plain:
    """What offers mean, place by place and without any bookkeeping."""

    def __init__(self, problem, routes, *, insert):
        self.problem, self.routes, self.insert = problem, routes, insert
        self.ends = self.carried_out(routes)

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

    def fits(self, i, route):
        usage = self.walk(i, route)[1]
        return math.isfinite(usage) and usage <= self.problem.capacity[i] * (1 + 1e-12)

    def after(self, i, time, place, j, ends):
        """When robot i ends task j, which comes after a place that it leaves at a time."""
        robot, task = self.problem.robots[i], self.problem.tasks[j]
        way = float(self.problem.legs(i, [place], [j])[0, 0]) / (1 if self.problem.in_time else robot.speed_mps)
        begins = max(time + way, *(ends.get(k, 0.0) for k in self.problem.prerequisites[j]), 0.0)
        timed = task.duration_s is not None
        return begins + (task.duration_s / robot.efficiency if timed else task.actuation_cost / robot.speed_mps)

    def carried_out(self, routes):
        """When each task ends; those are missing whose turn never comes."""
        ends, left = {}, [list(route) for route in routes]
        times, places = [r.available_from_s for r in self.problem.robots], [*map(self.problem.start, range(len(left)))]
        while ready := [
            i for i, r in enumerate(left) if r and all(k in ends for k in self.problem.prerequisites[r[0]])
        ]:
            for i in ready:
                j = left[i].pop(0)
                ends[j] = times[i] = self.after(i, times[i], places[i], j, ends)
                places[i] = j
        return ends

    def with_task(self, i, j, at):
        return [*self.routes[i][:at], j, *self.routes[i][at:]]

    def deadlocks(self, i, longer):
        routes = [longer if k == i else other for k, other in enumerate(self.routes)]
        return len(self.carried_out(routes)) < sum(map(len, routes))

    def best_places(self, i, j):
        """Where the task lengthens the route least and nothing deadlocks, in quanta; none if it fits nowhere."""
        if not self.problem.allowed[i, j]:
            return []
        places = range(len(self.routes[i]) + 1) if self.insert else [len(self.routes[i])]
        usages = {at: self.walk(i, self.with_task(i, j, at))[1] for at in places}
        usages = {at: usage for at, usage in usages.items() if not self.deadlocks(i, self.with_task(i, j, at))}
        least = min(usages.values(), default=math.inf)
        return [at for at in usages if usages[at] <= least + core.QUANTUM and self.fits(i, self.with_task(i, j, at))]

    def growth(self, i, longer):
        return self.walk(i, longer)[1] - self.walk(i, self.routes[i])[1]

    def arrivals(self, i, longer):
        return sum(self.walk(i, longer)[0]) - sum(self.walk(i, self.routes[i])[0])

    def end(self, i, longer):
        """When the robot is done, if the others' tasks end as they do without this one."""
        time, place = self.problem.robots[i].available_from_s, self.problem.start(i)
        others = {j: end for j, end in self.ends.items() if j not in longer}
        for j in longer:
            time, place = self.after(i, time, place, j, others), j
        return time

    def offers(self, figure, i, j):
        """What the robot may offer: more than one figure where places are as good."""
        return [getattr(self, figure)(i, self.with_task(i, j, at)) for at in self.best_places(i, j)] or [math.inf]


def assert_offers_are_plain(bidders, problem, figure, insert):
    plain = Plain(problem, bidders.routes, insert=insert)
    for i in range(len(problem.robots)):
        for j, offer in enumerate(bidders.offers(i)):
            offers = plain.offers(figure, i, j) if j in bidders.open else [math.inf]
            assert any(offer == pytest.approx(expected, abs=core.QUANTUM) for expected in offers)


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


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("insert", [True, False])
@pytest.mark.parametrize("figure", FIGURES)
@given(seed=seeds, tables=st.booleans())
def test_offers_are_those_of_a_plain_evaluation(figure, insert, seed, tables):
    problem = compiled(seed, tables=tables, tasks=7)
    for bidders in sold_in_random_order(problem, Random(seed), figure, insert):
        assert_offers_are_plain(bidders, problem, figure, insert)


@given(seed=seeds, tables=st.booleans(), figure=st.sampled_from(FIGURES), insert=st.booleans())
def test_offers_are_so_too_after_tasks_came_back(seed, tables, figure, insert):
    problem, random = compiled(seed, tables=tables, tasks=7), Random(seed)
    for bidders, _ in zip(sold_in_random_order(problem, random, figure, insert), range(12), strict=False):
        before = bidders.routes
        sold = [j for route in before for j in route]
        if not sold or random.random() < 0.5:
            continue
        returned = bidders.relinquish(random.choice(sold))
        assert bidders.routes == [[j for j in route if j not in returned] for route in before]
        assert_offers_are_plain(bidders, problem, figure, insert)
        bidders.announce(returned)
        assert_offers_are_plain(bidders, problem, figure, insert)


@given(seed=seeds, tables=st.booleans())
def test_a_task_comes_back_with_all_that_waits_for_it_if_the_rest_can_be_done(seed, tables):
    problem = compiled(seed, tables=tables, tasks=9)
    *_, bidders = sold_in_random_order(problem, Random(seed))
    routes = bidders.routes
    for j in sorted(j for route in routes for j in route):
        gone = {j}
        while more := {k for r in routes for k in r if gone & set(problem.prerequisites[k])} - gone:
            gone |= more
        rest = [[k for k in route if k not in gone] for route in routes]
        possible = all(Plain(problem, rest, insert=True).fits(i, route) for i, route in enumerate(rest))
        assert set(bidders.relinquish(j)) == (gone if possible else set())
        bidders.set_routes(routes)


@given(seed=seeds)
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
        verdict = muster.verify(problem.mission, plan, problem.ignored, problem.objective)
        visits = {route.robot: route.visits for route in verdict.routes}[problem.robots[i].id]
        assert offers[i][j] == pytest.approx(visits[-1].ends_s)


@given(seed=seeds, tables=st.booleans(), figure=st.sampled_from(FIGURES), insert=st.booleans())
def test_the_lowest_offers_are_those_of_all_offers(seed, tables, figure, insert):
    problem = compiled(seed, tables=tables, tasks=8)
    for bidders in sold_in_random_order(problem, Random(seed), figure, insert):
        tasks, figures = bidders.lowest()
        for i, (j, figure_i) in enumerate(zip(tasks, figures, strict=True)):
            offers = bidders.offers(i)
            assert figure_i == offers.min()
            assert j == (int(np.argmin(offers)) if np.isfinite(figure_i) else -1)


@given(seed=seeds)
def test_offers_for_a_task_are_the_robots_offers(seed):
    problem = compiled(seed)
    for bidders in sold_in_random_order(problem, Random(seed)):
        table = np.array([bidders.offers(i) for i in range(len(problem.robots))])
        for j in range(len(problem.tasks)):
            assert bidders.offers_for(j).tolist() == table[:, j].tolist()


@given(seed=seeds, tables=st.booleans(), figure=st.sampled_from(FIGURES), insert=st.booleans())
def test_after_tasks_come_back_all_is_as_if_begun_with_these_routes(seed, tables, figure, insert):
    problem = compiled(seed, tables=tables, tasks=9)
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


def test_of_equally_good_places_the_first_is_taken():
    """Here, a round trip past two places can be made both ways."""
    mission = muster.Mission(
        rules=muster.Rules(return_to_start=True),
        robots=(muster.Robot(id="r", position=(0, 0)),),
        tasks=(muster.Task(id="0", position=(4, 0)), muster.Task(id="1", position=(4, 3))),
    )
    bidders = core.Bidders(Problem.compile(mission).core, insert=True, figure="arrivals")
    bidders.announce([0, 1])
    bidders.award(0, 0)
    assert bidders.offers(0)[1] == 5 + 8 - 4
    bidders.award(0, 1)
    assert bidders.routes == [[1, 0]]


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
