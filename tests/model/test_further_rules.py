"""Rules that came after the plan model: each is a file, and all that plans, proves and explains obeys it."""

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.exact import solve_exactly
from muster.allocation.remedies.conflicts import Together, together
from muster.mission.model import Battery, Station
from muster.model.problem import Problem
from muster.planning.judging import admits
from muster.verification import verify

SOME = {"greedy": {}, "auction": {}, "search": {"iterations": 50}, "genetic": {"iterations": 50}}
"""How long each allocator goes on."""

RULES = Rules(objective="total", return_to_start=True)


def done(plan):
    return {task for route in plan.routes for task in route.tasks}


def alternatives(**keys):
    return Mission(
        rules=RULES,
        robots=(Robot(id="r", position=(0, 0)),),
        tasks=(
            Task(id="far", position=(9, 0), either_or=("near",)),
            Task(id="near", position=(2, 0)),
            Task(id="own", position=(0, 3), **keys),
        ),
    )


@pytest.mark.parametrize("allocator", ["greedy", "search", "genetic", "auction"])
def test_of_two_alternatives_the_nearer_one_is_done(allocator):
    mission = alternatives()
    plan = muster.solve(
        mission, allocator, seed=1, **({} if allocator in ("greedy", "auction") else {"iterations": 50})
    )
    assert done(plan) == {"near", "own"}
    assert plan.complete
    assert verify(mission, plan).valid


@pytest.mark.parametrize("allocator", SOME)
def test_alternatives_are_kept_apart_whichever_robots_would_do_them(allocator):
    """What a task costs another robot is as before when its alternative is placed."""
    robots = tuple(Robot(id=f"r_{x}", position=(x, 0)) for x in (0, 9))
    tasks = (Task(id="a", position=(0, 1), either_or=("b",)), Task(id="b", position=(9, 1), due_s=50))
    for objective in ("lateness", "total", "makespan"):
        mission = Mission(rules=Rules(objective=objective), robots=robots, tasks=tasks)
        plan = muster.solve(mission, allocator, **SOME[allocator])
        assert len(done(plan)) == 1
        assert plan.complete


def test_the_alternative_that_weighs_more_is_done():
    mission = alternatives()
    heavy = Task(id="far", position=(9, 0), either_or=("near",), priority=2)
    mission = Mission(rules=RULES, robots=mission.robots, tasks=(heavy, *mission.tasks[1:]))
    assert done(muster.solve(mission, "search", iterations=50)) == {"far", "own"}


def test_the_other_alternative_is_left_out_for_a_reason():
    mission = alternatives()
    (out,) = muster.solve(mission, "greedy").unassigned
    assert out.task == "far"
    assert [(one.reason, one.detail) for one in out.reasons] == [("either-or", "near is done in its place")]


def test_check_finds_a_plan_that_does_one_of_two_alternatives():
    """Both at once would be more work than there is time for."""
    mission = alternatives()
    robots = (Robot(id="r", position=(0, 0), available_until_s=14),)
    for shift, found in ((robots, Together()), (mission.robots, Together())):
        problem = Problem.compile(Mission(rules=RULES, robots=shift, tasks=mission.tasks))
        assert together(problem, admits) == found


def test_without_the_rule_both_are_done():
    assert len(done(muster.solve(alternatives(), "greedy", ignore=("either-or",)))) == 3


def test_the_quick_bound_does_not_count_both_alternatives():
    plan = muster.solve(alternatives(), "search", iterations=50, bound="quick")
    assert plan.complete
    assert 0 < plan.lower_bound <= plan.objective_value


def test_the_exact_program_keeps_alternatives():
    pytest.importorskip("ortools")
    problem = Problem.compile(alternatives())
    result = solve_exactly(problem, 10.0, [[]], 0, judge=admits)
    assert result.optimal
    assert problem.value(result.routes) == (2, pytest.approx(2 + 13**0.5 + 3))


def ride(longest_s):
    """A parcel, and a task between its ends that would make its way longer."""
    return Mission(
        rules=Rules(objective="total"),
        robots=(Robot(id="r", position=(0, 0)),),
        tasks=(
            Task(id="take", position=(1, 0), load=1),
            Task(id="bring", position=(11, 0), delivers="take", longest_aboard_s=longest_s),
            Task(id="between", position=(6, 0), duration_s=30),
        ),
    )


@pytest.mark.parametrize("allocator", ["greedy", "search", "auction"])
def test_a_load_is_on_board_no_longer_than_it_may(allocator):
    for longest_s in (12, 45):
        plan = muster.solve(ride(longest_s), allocator, **SOME[allocator])
        assert verify(ride(longest_s), plan).valid
        assert plan.complete
        (route,) = plan.routes
        assert (list(route.tasks) == ["take", "between", "bring"]) == (longest_s == 45)


def test_what_is_on_board_too_long_in_every_plan_is_left_out():
    plan = muster.solve(ride(9), "search", iterations=50)
    assert done(plan) == {"between"}
    assert verify(ride(9), plan).valid


def test_a_robot_calls_only_where_it_may():
    """Of two stations on the way between its tasks at the one that costs less, where it may call there."""

    def called(*robots):
        mission = Mission(
            rules=RULES,
            robots=(Robot(id="r", position=(0, 0), battery=Battery(capacity=12)), Robot(id="s", position=(99, 0))),
            tasks=tuple(Task(id=t, position=at, only_robots=("r",)) for t, at in (("a", (6, 0)), ("b", (0, 5)))),
            stations=(
                Station(id="off", position=(1, 0), services=("swap",)),
                Station(id="near", position=(1.5, 0), services=("swap",), only_robots=robots),
            ),
        )
        plan = muster.solve(mission, "search", iterations=50)
        assert plan.complete
        assert verify(mission, plan).valid
        return {stop.name for route in plan.routes for stop in route.stops if stop.is_station}

    assert called("r", "s") == {"near"}
    assert called("s") == {"off"}
