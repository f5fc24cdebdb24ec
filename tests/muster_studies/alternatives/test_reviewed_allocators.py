"""What is particular to each of the reviewed allocators; what all keep is in tests/conformance."""

import numpy as np
import pytest

import muster
from muster import core
from muster.model.problem import Problem
from muster_studies.alternatives import ant_colony, contract_net, particle_swarm

MARKETS = ("contract-net", "combinatorial-auction", "bertsekas-auction")


def line(*positions, robots=(0,), **rules):
    return muster.Mission(
        rules=muster.Rules(objective="total", **rules),
        robots=tuple(muster.Robot(id=f"r_{k}", position=(x, 0)) for k, x in enumerate(robots)),
        tasks=tuple(muster.Task(id=str(k), position=(x, 0)) for k, x in enumerate(positions)),
    )


def tasks(plan):
    return [route.tasks for route in plan.routes]


def test_ants_choose_by_pheromone_and_distance():
    """(2.24) against drawn frequencies: three tasks at distances 1, 2 and 4 with pheromones 1, 2 and 1; beta 1."""
    problem = Problem.compile(line(1, -2, 4))
    colony = core.Colony(problem.core, 1.0, 3)
    trail = np.ones((4, 3))
    trail[3] = [1.0, 2.0, 1.0]
    colony.build(trail, 20_000)
    first = np.bincount([colony.routes(k)[0][0] for k in range(20_000)], minlength=3) / 20_000
    weights = np.array([1 / 1, 2 / 2, 1 / 4])
    assert first == pytest.approx(weights / weights.sum(), abs=0.015)


def test_pheromone_is_left_on_the_paths_of_a_plan():
    increment = np.zeros((5, 3))
    ant_colony.leave(increment, [[2, 0], [1]], 0.5)
    expected = np.zeros((5, 3))
    expected[3, 2] = expected[2, 0] = expected[4, 1] = 0.5
    assert (increment == expected).all()


def test_particles_choose_among_the_robots_that_may():
    problem = Problem.compile(muster.load("31T-6R50"))
    teams = particle_swarm.Teams(problem)
    robots = teams.robots(np.random.default_rng(0).random((50, 31)))
    assert problem.allowed[robots, np.arange(31)].all()
    routes = [
        [problem.task_index[t] for t in route.tasks]
        for route in muster.solve(problem.mission, "market", iterations=5).routes
    ]
    chosen = teams.robots(teams.position(routes)[None])[0]
    assert all(chosen[j] == i for i, route in enumerate(routes) for j in route)


def test_the_pareto_front_holds_what_nothing_is_better_than():
    figures = np.array([[3, 0, 10, 5], [3, 0, 8, 6], [3, 0, 9, 7], [2, 0, 1, 1], [3, 0, 12, 5]], dtype=float)
    front = particle_swarm.Front(np.arange(5.0)[:, None], figures)
    leaders = front.leaders(200, np.random.default_rng(0))
    assert set(leaders.ravel().tolist()) == {0.0, 1.0}


def test_a_swarm_with_a_pareto_leader_finds_the_best_plan_of_a_small_mission():
    mission = muster.load("6T-2R")
    best = muster.solve(mission, "search", iterations=2000).objective_value
    plan = muster.solve(mission, "particle-swarm", iterations=100, leader="pareto")
    assert plan.objective_value == pytest.approx(best, rel=0.1)


def test_a_contract_net_announces_prerequisites_first():
    problem = Problem.compile(muster.load("31T-6R50"))
    for order in contract_net.ORDERS:
        announced = list(contract_net.announcements(problem, order))
        assert sorted(announced) == list(range(31))
        assert all(announced.index(k) < announced.index(j) for j in range(31) for k in problem.prerequisites[j])


def test_a_contract_net_never_takes_an_award_back():
    """Task 0 goes to r_0 when it comes; the auction sells task 1 first, and then both to r_1."""
    mission = line(4.4, 8, robots=(0, 9))
    assert tasks(muster.solve(mission, "contract-net")) == [("0",), ("1",)]
    assert tasks(muster.solve(mission, "auction")) == [(), ("1", "0")]


def test_a_bundle_wins_where_single_bids_would_split_it():
    mission = line(10, 11, 12, robots=(0, 23))
    plan = muster.solve(mission, "combinatorial-auction")
    assert sorted(len(route) for route in tasks(plan)) == [0, 3]


def test_rising_prices_assign_one_task_to_each():
    plan = muster.solve(line(1, 2, robots=(0, 3)), "bertsekas-auction")
    assert tasks(plan) == [("0",), ("1",)]
    plan = muster.solve(line(5, 6, robots=(4, 0)), "bertsekas-auction", placement="append")
    assert sorted(map(len, tasks(plan))) == [1, 1]


def test_a_nearer_robot_of_an_alliance_takes_over():
    """r_0 sets out for task 1; r_1, sooner done with its own, would be there first and r_0 acquiesces."""
    mission = muster.Mission(
        robots=(
            muster.Robot(id="r_0", position=(0, 0), speed_mps=0.5),
            muster.Robot(id="r_1", position=(30, 0), speed_mps=10.0),
        ),
        tasks=(
            muster.Task(id="0", position=(35, 0), only_robots=("r_1",)),
            muster.Task(id="1", position=(10, 0)),
        ),
    )
    assert tasks(muster.solve(mission, "alliance", patience=1.0, acquiescence=0.0))[1] == ("0", "1")


@pytest.mark.parametrize("allocator", MARKETS)
def test_markets_keep_a_book_that_is_true(allocator):
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, allocator)
    assert muster.verify(mission, plan).valid
    assert {award.task for award in plan.book.awards} == {t for route in plan.routes for t in route.tasks}


@pytest.mark.parametrize("allocator", ["auction", "market", *MARKETS])
def test_the_better_sensor_wins_at_equal_distance(allocator):
    mission = muster.Mission(
        robots=(
            muster.Robot(id="a", position=(-5, 0), skills=("thermal",), skill_quality={"thermal": 0.6}),
            muster.Robot(id="b", position=(5, 0), skills=("thermal",), skill_quality={"thermal": 0.9}),
        ),
        tasks=(muster.Task(id="0", position=(0, 0), requires=("thermal",)),),
    )
    settings = {"iterations": 0} if allocator == "market" else {}
    assert tasks(muster.solve(mission, allocator, **settings)) == [("0",), ()]
    assert tasks(muster.solve(mission, allocator, quality_weight=1.0, **settings)) == [(), ("0",)]


@pytest.mark.parametrize(
    ("allocator", "wrong"),
    [
        ("particle-swarm", {"leader": "none"}),
        ("particle-swarm", {"inertia": -1.0}),
        ("ant-colony", {"evaporation": 1.5}),
        ("order-crossover", {"population_size": 1}),
        ("ipga", {"population_size": 15}),
        ("contract-net", {"order": "none"}),
        ("alliance", {"patience": 0.5}),
        ("combinatorial-auction", {"worth": 1.0}),
        ("bertsekas-auction", {"precision": 0.0}),
    ],
)
def test_parameters_out_of_range_are_refused(allocator, wrong):
    with pytest.raises(muster.ParameterError, match=next(iter(wrong))):
        muster.solve(muster.load("6T-2R"), allocator, **wrong)
