"""CBBA: what the paper proves of it, its plans and their books."""

import math
from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster.allocation.allocator import make_parameters, routes_of
from muster.allocation.auctions.consensus import TOPOLOGIES, Beliefs, diameter, neighbours
from muster.allocation.auctions.consensus_bundle import CONSENSUS_BUNDLE, Parameters, extent, layers
from muster.allocation.stop import Stop
from muster.model.problem import Problem

every_topology = pytest.mark.parametrize("topology", TOPOLOGIES)
seeds = st.integers(0, 10**6)


def solved(mission, *, start=None, stop=None, ignored=(), **params):
    problem = Problem.compile(mission, ignored=ignored).ready()
    return CONSENSUS_BUNDLE.solve(problem, stop or Stop(), params=Parameters(**params), start=start)


def papers_mission(seed, *, tasks=12, robots=4):
    """A mission within the paper's: the reward of a task only falls as a path grows, and nothing limits a robot."""
    mission = random_mission(seed, tasks=tasks, robots=robots)
    alike = {"priority": 1, "actuation_cost": 0, "duration_s": None, "prerequisites": (), "entry": None, "exit": None}
    return replace(
        mission,
        tasks=tuple(replace(task, **alike) for task in mission.tasks),
        robots=tuple(replace(robot, work_capacity=None) for robot in mission.robots),
    )


def row(*robots, tasks, capacity=None, **rules):
    """A mission along a line: robots and tasks by their places."""
    return muster.Mission(
        robots=tuple(muster.Robot(id=f"r{k}", position=(x, 0), work_capacity=capacity) for k, x in enumerate(robots)),
        tasks=tuple(muster.Task(id=f"t{k}", position=(x, 0)) for k, x in enumerate(tasks)),
        rules=muster.Rules(**rules),
    )


# What the paper proves.


def sequential_greedy(mission, limit):
    """Routes of the paper's centralised algorithm with time-discounted rewards, worked out the plain way."""
    problem = Problem.compile(mission)
    unit = 50 / (extent(problem) / min(robot.speed_mps for robot in mission.robots))

    def score(i, path):
        robot, place, total = problem.robots[i], problem.start(i), 0.0
        time = robot.available_from_s
        for j in path:
            usage = problem.legs(i, [place], [j])[0, 0]
            time += usage if problem.in_time else usage / robot.speed_mps
            total += 0.95 ** (unit * time) * problem.tasks[j].priority
            place = j
        return total

    paths = [[] for _ in problem.robots]
    scores = [0.0] * len(paths)
    left = set(range(len(problem.tasks)))
    while True:
        best = None
        for i, path in enumerate(paths):
            for j in sorted(left) if len(path) < limit else ():
                for at in range(len(path) + 1) if problem.allowed[i, j] else ():
                    gain = score(i, [*path[:at], j, *path[at:]]) - scores[i]
                    if best is None or gain > best[0] * (1 + 1e-9):
                        best = gain, i, j, at
        if best is None:
            return paths
        gain, i, j, at = best
        paths[i].insert(at, j)
        scores[i] += gain
        left.remove(j)


@every_topology
@given(seed=seeds, robots=st.integers(1, 6))
def test_with_one_task_each_the_outcome_is_the_sequential_greedy_one(topology, seed, robots):
    mission = papers_mission(seed, tasks=7, robots=robots)
    plan = solved(mission, bundle_size=1, topology=topology)
    assert routes_of(Problem.compile(mission), plan) == sequential_greedy(mission, 1)


@pytest.mark.long
def test_with_bundles_it_is_so_too_but_for_exceptions():
    """Mission 10: a robot that took another task for one that seemed lost keeps it when that comes free."""
    missions = [papers_mission(seed, tasks=10, robots=5) for seed in range(40)]
    others = [
        seed
        for seed, mission in enumerate(missions)
        if routes_of(Problem.compile(mission), solved(mission, bundle_size=10)) != sequential_greedy(mission, 10)
    ]
    assert others == [10]


@pytest.mark.long
@given(seed=seeds, robots=st.integers(1, 8))
def test_agreement_takes_at_most_tasks_times_diameter_rounds(seed, robots):
    mission = papers_mission(seed, robots=robots)
    for topology in TOPOLOGIES:
        plan = solved(mission, topology=topology, bundle_size=12)
        assert plan.book.rounds <= 12 * diameter(topology, robots)
        assert plan.book.messages == plan.book.rounds * sum(map(len, neighbours(topology, robots)))


@given(seed=seeds, robots=st.integers(1, 8))
def test_with_one_task_each_the_network_does_not_matter(seed, robots):
    mission = papers_mission(seed, robots=robots)
    plans = [solved(mission, topology=topology, bundle_size=1) for topology in TOPOLOGIES]
    assert plans[0].routes == plans[1].routes == plans[2].routes


# Plans.


@pytest.mark.long(keep=20)
@pytest.mark.parametrize("seed", range(60))
def test_every_plan_is_admissible(seed):
    mission = random_mission(seed, tasks=seed % 13, robots=1 + seed % 5)
    topology = TOPOLOGIES[seed % 3]
    plan = solved(mission, topology=topology)
    assert muster.verify(mission, plan).violations == ()
    again = solved(mission, topology=topology)
    assert (again.routes, again.book) == (plan.routes, plan.book)


@every_topology
@given(seed=seeds, robots=st.integers(1, 5), tasks=st.integers(0, 15))
def test_no_task_is_left_out_that_a_robot_could_take(topology, seed, robots, tasks):
    mission = random_mission(seed, tasks=tasks, robots=robots)
    mission = replace(mission, tasks=tuple(replace(task, prerequisites=()) for task in mission.tasks))
    plan = solved(mission, topology=topology)
    assert {reason.reason for item in plan.unassigned for reason in item.reasons} <= {
        *("skill", "suitability", "lock", "capacity", "unreachable")
    }


def test_an_automatic_bundle_grows_until_no_task_is_left_out():
    """Only the first robot can do more than the even share."""
    mission = row(0, 0, 0, 0, tasks=range(1, 21))
    busy = tuple(replace(robot, work_capacity=0.0) for robot in mission.robots[1:])
    mission = replace(mission, robots=(mission.robots[0], *busy))
    assert solved(mission).complete
    assert solved(mission, bundle_size=5).tasks_completed == 5


@pytest.mark.parametrize("topology", TOPOLOGIES)
def test_a_bundle_size_is_kept(topology):
    plan = solved(row(0, 100, tasks=range(9)), bundle_size=2, topology=topology)
    assert [len(route.tasks) for route in plan.routes] == [2, 2]


def test_a_task_goes_where_it_adds_most():
    """The second task taken lies on the way to the first."""
    mission = row(0, tasks=(10, 6))
    mission = replace(mission, tasks=(replace(mission.tasks[0], priority=9), mission.tasks[1]))
    plan = solved(mission)
    assert [bid.task for bid in plan.book.bids] == ["t0", "t1"]
    assert plan.routes[0].tasks == ("t1", "t0")
    assert plan.book.awards[0].price == pytest.approx(9 * 0.95**50)
    assert plan.book.awards[1].price == pytest.approx(0.95**30)


def test_arrival_counts_from_when_a_robot_is_available_and_holds_work():
    mission = row(0, tasks=(5, 10))
    mission = replace(
        mission,
        robots=(replace(mission.robots[0], available_from_s=1, speed_mps=2),),
        tasks=(replace(mission.tasks[0], duration_s=3), mission.tasks[1]),
    )
    prices = [award.price for award in solved(mission).book.awards]
    assert prices == pytest.approx([0.95 ** (10 * 3.5), 0.95 ** (10 * 9)])


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_scale_does_not_matter(factor):
    def scaled(things, factor):
        places = [tuple(c * factor for c in thing.position) for thing in things]
        return tuple(replace(thing, position=place) for thing, place in zip(things, places, strict=True))

    mission = papers_mission(3)
    robots = tuple(replace(robot, end_position=None, available_from_s=0) for robot in mission.robots)
    one, other = (
        solved(replace(mission, robots=scaled(robots, f), tasks=scaled(mission.tasks, f))) for f in (1.0, factor)
    )
    assert [route.tasks for route in one.routes] == [route.tasks for route in other.routes]
    assert [award.price for award in other.book.awards] == pytest.approx([award.price for award in one.book.awards])


def test_the_latest_task_is_worth_taking():
    """Work takes a million times as long as travel: rewards fall below what float64 holds."""
    mission = row(0, 1, tasks=range(10))
    mission = replace(mission, tasks=tuple(replace(task, duration_s=1e6) for task in mission.tasks))
    plan = solved(mission)
    assert plan.complete
    assert min(award.price for award in plan.book.awards) == 0.0


def test_a_task_is_taken_where_only_room_is_left_before_a_more_precious_one():
    """Behind the precious task it would be too far to get home; before it, it costs more reward than it brings."""
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(0, 0), end_position=(10, 0), work_capacity=14.5),),
        tasks=(
            muster.Task(id="near", position=(0, 2)),
            muster.Task(id="precious", position=(10, 0), priority=1e6),
        ),
    )
    assert solved(mission).routes[0].tasks == ("near", "precious")


@pytest.mark.parametrize("seed", range(20))
def test_later_layers_come_later(seed):
    mission = random_mission(seed, tasks=14)
    problem = Problem.compile(mission)
    depth = {j: k for k, layer in enumerate(layers(problem, set())) for j in layer}
    assert sorted(depth) == list(range(14))
    assert all(depth[j] == 1 + max((depth[k] for k in problem.prerequisites[j]), default=-1) for j in depth)
    for route in routes_of(problem, solved(mission)):
        assert [depth[j] for j in route] == sorted(depth[j] for j in route)


@pytest.mark.parametrize("seed", range(20))
def test_a_start_plan_is_kept_in_front(seed):
    mission = random_mission(seed, tasks=12)
    half = replace(mission, robots=tuple(replace(robot, work_capacity=15.0) for robot in mission.robots))
    start = muster.solve(half, "greedy")
    if not muster.verify(mission, start).valid:
        return
    plan = solved(mission, start=start)
    assert muster.verify(mission, plan).violations == ()
    for before, after in zip(start.routes, plan.routes, strict=True):
        assert after.tasks[: len(before.tasks)] == before.tasks
    begun = {task for route in start.routes for task in route.tasks}
    assert {award.task for award in plan.book.awards} == {task for r in plan.routes for task in r.tasks} - begun


def test_a_delivery_may_shorten_the_way_to_what_comes_after_it():
    mission = row(0, tasks=(0, 50), capacity=10)
    mission = replace(mission, tasks=(replace(mission.tasks[0], exit=(49, 0)), mission.tasks[1]))
    plan = solved(mission)
    assert plan.routes[0].tasks == ("t0", "t1")
    assert muster.verify(mission, plan).valid


def test_a_route_may_fill_a_capacity_exactly():
    mission = row(0, tasks=(0.1, 0.3, 0.7, 1.1, 1.3), capacity=1.3)
    assert solved(mission).complete
    assert solved(row(0, tasks=(0.1, 0.3, 0.7, 1.1, 1.3), capacity=1.3 - 1e-9)).tasks_completed == 4


def mission_with_tables(seed):
    """Only capacities and missing ways keep a robot from a task."""
    mission = with_travel_tables(random_mission(seed, tasks=9, robots=4), seed)
    free = {"prerequisites": (), "requires": (), "only_robots": None}
    return replace(mission, suitability=None, tasks=tuple(replace(task, **free) for task in mission.tasks))


@pytest.mark.long(keep=1)
@every_topology
@given(seed=seeds)
def test_travel_by_tables(topology, seed):
    mission = mission_with_tables(seed)
    plan = solved(mission, topology=topology)
    assert muster.verify(mission, plan).violations == ()
    assert {reason.reason for item in plan.unassigned for reason in item.reasons} <= {"capacity", "unreachable"}


@given(seed=seeds, after=st.integers(0, 8))
def test_an_interrupted_auction_with_tables(seed, after):
    mission = mission_with_tables(seed)
    plan = solved(mission, topology="line", stop=Interrupted(after))
    assert muster.verify(mission, plan).violations == ()


def test_robots_that_do_not_hear_each_other_are_an_error(monkeypatch):
    monkeypatch.setattr(Beliefs, "exchange", lambda *_: None)
    with pytest.raises(muster.MusterError, match="do not agree within 20 rounds"):
        solved(row(0, 9, tasks=(3, 5)))


class Interrupted(Stop):
    """Is interrupted after being asked a number of times."""

    def __init__(self, after):
        super().__init__()
        self._after = after

    @property
    def interrupted(self):
        self._after -= 1
        return self._after < 0


@every_topology
@given(seed=seeds, after=st.integers(0, 12))
def test_an_interrupted_auction_leaves_what_is_agreed(topology, seed, after):
    mission = random_mission(seed, tasks=12, robots=5)
    plan = solved(mission, topology=topology, stop=Interrupted(after))
    assert muster.verify(mission, plan).violations == ()
    assert plan.book.rounds <= after
    if after == 0:
        assert plan.tasks_completed == plan.book.messages == 0


def test_an_auction_cut_short_has_agreed_on_something():
    mission = muster.load("31T-6R")
    done = [solved(mission, stop=Interrupted(after)).tasks_completed for after in (0, 50, 200, 600)]
    assert done[0] == 0
    assert 0 < done[1] < done[2] < done[3] == 31


@pytest.mark.parametrize("robots", [1, 3])
def test_no_task_takes_no_round(robots):
    plan = solved(row(*range(robots), tasks=()))
    assert (plan.book.rounds, plan.book.messages, plan.book.awards, plan.book.bids) == (0, 0, (), ())


def test_one_robot_talks_to_nobody():
    plan = solved(row(0, tasks=(3, 1, 2)))
    assert plan.routes[0].tasks == ("t1", "t2", "t0")
    assert (plan.book.rounds, plan.book.messages) == (1, 0)


def test_all_at_one_place():
    plan = solved(row(1, 1, tasks=(1, 1, 1)))
    assert plan.complete
    assert [route.tasks for route in plan.routes] == [("t0", "t1", "t2"), ()]


# The book.


@given(seed=seeds, robots=st.integers(1, 5))
def test_awards_are_the_plan(seed, robots):
    mission = random_mission(seed, tasks=10, robots=robots)
    plan = solved(mission)
    won = {(award.robot, award.task) for award in plan.book.awards}
    assert won == {(route.robot, task) for route in plan.routes for task in route.tasks}
    final = [bid for bid in plan.book.bids if bid.winner == bid.robot]
    assert [(bid.round, bid.task, bid.robot, bid.bid) for bid in final] == [
        (award.round, award.task, award.robot, award.price) for award in plan.book.awards
    ]
    assert all(bid.price == bid.bid for bid in final)
    sold = {(award.round, award.task): award.robot for award in plan.book.awards}
    assert all(bid.winner == sold.get((bid.round, bid.task)) for bid in plan.book.bids)


@given(seed=seeds)
def test_the_book_tells_every_bid(seed):
    plan = solved(random_mission(seed, tasks=10, robots=4))
    last = {}
    for bid in plan.book.bids:
        assert 1 <= bid.round <= plan.book.rounds
        last.setdefault(bid.task, {})[bid.robot] = bid.bid
    assert [bid.round for bid in plan.book.bids] == sorted(bid.round for bid in plan.book.bids)
    assert max(Counter((bid.round, bid.task, bid.robot) for bid in plan.book.bids).values(), default=1) == 1
    for award in plan.book.awards:
        assert dict(award.bids) == last[award.task]
        assert award.bidders == len(award.bids)
        assert [bid for _, bid in award.bids] == sorted((bid for _, bid in award.bids), reverse=True)


@given(seed=seeds)
def test_bids_of_a_bundle_do_not_rise(seed):
    """Of each robot's tasks won in the first layer of prerequisites."""
    mission = random_mission(seed, tasks=10, robots=4)
    mission = replace(mission, tasks=tuple(replace(task, prerequisites=()) for task in mission.tasks))
    prices = {}
    for award in solved(mission).book.awards:
        prices.setdefault(award.robot, []).append(award.price)
    assert all(row == sorted(row, reverse=True) for row in prices.values())


# Parameters.


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"topology": "star"}, "topology: star; expected complete, ring or line"),
        ({"bundle_size": -1}, "bundle_size: -1; expected a whole number of at least 0"),
        ({"bundle_size": 1.5}, "bundle_size: 1.5; expected a whole number"),
        ({"discount": 1.0}, "discount: 1.0; expected a number between 0 and 1"),
        ({"discount": 0}, "discount: 0; expected a number between 0 and 1"),
        ({"discount": math.nan}, "discount: nan; expected a number between 0 and 1"),
    ],
)
def test_wrong_parameters_are_refused_in_words(values, message):
    with pytest.raises(muster.ParameterError, match=message):
        make_parameters(CONSENSUS_BUNDLE, values)
