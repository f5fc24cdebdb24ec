"""What routes cost, recomputed: small cases whose figures can be worked out by hand."""

import math

import pytest

from muster.mission.errors import ParameterError
from muster.mission.model import Action, Mission, Robot, Rules, Task, TravelTable
from muster.mission.plan import Plan, Route
from muster.verification import Verdict, verify
from muster.verification.measure import equality_index


def judge(mission: Mission, objective: str | None = None, **routes: list[str]) -> Verdict:
    plan = Plan(objective=objective, routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items()))
    verdict = verify(mission, plan)
    assert verdict.violations == ()
    return verdict


def two_robots(**rules) -> Mission:
    """Robot r goes 5 m, works 2, goes 4 m more; robot s goes 1 m and works 1."""
    return Mission(
        rules=Rules(**rules),
        robots=(Robot(id="r", position=(0, 0)), Robot(id="s", position=(10, 0))),
        tasks=(
            Task(id="a", position=(3, 4), actuation_cost=2),
            Task(id="b", position=(3, 0), priority=5),
            Task(id="c", position=(10, 1), actuation_cost=1),
        ),
    )


def test_usage_is_travel_plus_work():
    verdict = judge(two_robots(), r=["a", "b"], s=["c"])
    r, s = verdict.routes
    assert (r.robot, r.tasks, r.travel, r.work, r.usage) == ("r", ("a", "b"), 9, 2, 11)
    assert (s.robot, s.tasks, s.travel, s.work, s.usage) == ("s", ("c",), 1, 1, 2)
    assert [visit.arrival_usage for visit in r.visits] == [5, 11]
    assert verdict.usage_unit == "m"


@pytest.mark.parametrize(
    ("objective", "value"),
    [("total", 13), ("max", 11), ("total+max", 24), ("average", (5 + 11 + 1) / 3), ("makespan", 11)],
)
def test_each_objective(objective, value):
    verdict = judge(two_robots(objective=objective), r=["a", "b"], s=["c"])
    assert verdict.objective_name == objective
    assert verdict.value() == verdict.value(objective) == value
    plan = Plan(objective=objective, routes=(Route("r", ("a", "b")), Route("s", ("c",))))
    named = verify(two_robots(), plan, objective=objective)
    assert (named.valid, named.objective_name, named.value()) == (True, objective, value)


def test_an_unknown_objective_has_no_value():
    with pytest.raises(ParameterError, match="makespann"):
        judge(two_robots()).value("makespann")


def test_tasks_and_their_weights_are_counted():
    verdict = judge(two_robots(), s=["b"])
    assert (verdict.tasks_completed, verdict.tasks_total, verdict.weight_completed) == (1, 3, 5)


def test_robots_without_tasks_stay_and_cost_nothing():
    verdict = judge(two_robots(return_to_start=True))
    assert [route.tasks for route in verdict.routes] == [(), ()]
    assert [route.back_s for route in verdict.routes] == [None, None]
    figures = (verdict.total_cost, verdict.max_usage, verdict.average, verdict.makespan_s, verdict.value())
    assert figures == (0, 0, 0, 0, 0)
    assert verdict.equality_index == 1


def test_a_mission_without_tasks():
    verdict = judge(Mission(robots=(Robot(id="r", position=(0, 0)),), tasks=()), r=[])
    assert verdict.valid
    assert (verdict.tasks_completed, verdict.tasks_total, verdict.weight_completed) == (0, 0, 0)


def test_routes_come_in_mission_order():
    verdict = judge(two_robots(), s=["c"], r=["a"])
    assert [route.robot for route in verdict.routes] == ["r", "s"]


def test_positions_in_three_dimensions():
    mission = Mission(robots=(Robot(id="r", position=(0, 0, 0)),), tasks=(Task(id="a", position=(2, 3, 6)),))
    assert judge(mission, r=["a"]).total_cost == 7


def test_travel_goes_from_exit_to_entry():
    tasks = (
        Task(id="a", position=(50, 50), entry=(1, 0), exit=(1, 10), actuation_cost=0.5),
        Task(id="b", position=(4, 10), exit=(4, 0)),
        Task(id="c", position=(99, 99), entry=(6, 0)),
    )
    robot = Robot(id="r", position=(0, 0), return_to_start=True)
    route = judge(Mission(robots=(robot,), tasks=tasks), r=["a", "b", "c"]).routes[0]
    # 1 to the entry of a; 3 from its exit to b; 2 from the exit of b to the entry of c; home from c's position
    assert route.travel == pytest.approx(1 + 3 + 2 + math.hypot(99, 99))
    assert route.work == 0.5
    assert [visit.arrival_usage for visit in route.visits] == pytest.approx([1, 4.5, 6.5])


@pytest.mark.parametrize(
    ("rule", "own", "usage", "back"),
    [
        (False, {}, 5, None),
        (True, {}, 10, 10),
        (False, {"return_to_start": True}, 10, 10),
        (True, {"return_to_start": False}, 5, None),
        (False, {"end_position": (3, 5)}, 6, 6),
        (True, {"end_position": (3, 5), "return_to_start": True}, 6, 6),
    ],
)
def test_where_a_route_must_end(rule, own, usage, back):
    mission = Mission(
        rules=Rules(return_to_start=rule),
        robots=(Robot(id="r", position=(0, 0), **own),),
        tasks=(Task(id="a", position=(3, 4)),),
    )
    verdict = judge(mission, r=["a"])
    assert verdict.routes[0].usage == usage
    assert verdict.routes[0].back_s == back
    assert verdict.makespan_s == 5  # the last task ends before the way back
    assert verdict.average == 5


def test_time_by_speed_and_efficiency():
    """Travel by the speed; work by the efficiency where a duration is given, else the cost by the speed."""
    tasks = (
        Task(id="a", position=(3, 4), duration_s=10, actuation_cost=7),
        Task(id="b", position=(3, 0), actuation_cost=6),
        Task(id="c", position=(3, 0), action=Action(name="sensor-activation", duration_s=4)),
    )
    robot = Robot(id="r", position=(0, 0), speed_mps=2, efficiency=0.8, return_to_start=True)

    in_time = judge(Mission(rules=Rules(usage="time"), robots=(robot,), tasks=tasks), r=["a", "b", "c"])
    route = in_time.routes[0]
    assert in_time.usage_unit == "s"
    assert route.travel == pytest.approx((5 + 4 + 0 + 3) / 2)
    assert route.work == pytest.approx(10 / 0.8 + 6 / 2 + 4 / 0.8)
    assert [visit.arrival_usage for visit in route.visits] == pytest.approx([2.5, 17, 20])
    assert in_time.makespan_s == pytest.approx(25)
    assert route.back_s == pytest.approx(26.5)

    in_metres = judge(Mission(robots=(robot,), tasks=tasks), r=["a", "b", "c"])
    assert (in_metres.routes[0].travel, in_metres.routes[0].work) == (12, 13)
    assert in_metres.makespan_s == pytest.approx(25)


def test_waiting_is_no_usage():
    mission = Mission(
        rules=Rules(usage="time"),
        robots=(Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 0))),
        tasks=(Task(id="a", position=(1, 0), prerequisites=("b",)), Task(id="b", position=(9, 0), duration_s=11)),
    )
    verdict = judge(mission, r=["a"], s=["b"])
    assert verdict.total_cost == 1 + 20
    assert verdict.makespan_s == 20


def matrix_mission(**rules) -> Mission:
    places = ("a", "r", "b")
    slow = TravelTable(places, ((0, 7, 1), (5, 0, 3), (2, 4, 0)))
    fast = TravelTable(("s", "a", "b"), ((0, 10, 20), (30, 0, 40), (50, 60, 0)))
    return Mission(
        rules=Rules(travel="matrix", **rules),
        travel={"slow": "slow.csv", "fast": "fast.csv"},
        travel_tables={"slow": with_place(slow, "s"), "fast": with_place(fast, "r")},
        robots=(Robot(id="r", type="slow", position=(0, 0), speed_mps=2), Robot(id="s", type="fast", position=(0, 0))),
        tasks=(Task(id="a", position=(1, 1), actuation_cost=0.5), Task(id="b", position=(1, 1))),
    )


def with_place(table: TravelTable, place: str) -> TravelTable:
    """A travel table holds all robots, also those of other types."""
    rows = [(*row, math.inf) for row in table.metres]
    return TravelTable((*table.places, place), (*rows, (math.inf,) * len(rows) + (0,)))


def test_travel_by_table_has_a_direction():
    assert judge(matrix_mission(), r=["a", "b"]).routes[0].travel == 5 + 1
    assert judge(matrix_mission(), r=["b", "a"]).routes[0].travel == 3 + 2
    assert judge(matrix_mission(), s=["a", "b"]).routes[1].travel == 10 + 40


def test_travel_by_table_back_to_the_start():
    verdict = judge(matrix_mission(return_to_start=True, usage="time"), r=["a", "b"], s=[])
    assert verdict.routes[0].travel == (5 + 1 + 4) / 2
    assert verdict.routes[0].work == 0.5 / 2
    assert verdict.routes[0].back_s == 5.25


def line_of_robots(*usages: float) -> Verdict:
    """A robot for each usage, at x = 0, with a task that far away."""
    robots = [Robot(id=f"r_{k}", position=(0, k)) for k in range(len(usages))]
    tasks = [Task(id=f"{k}", position=(usage, k)) for k, usage in enumerate(usages)]
    return judge(Mission(robots=tuple(robots), tasks=tuple(tasks)), **{f"r_{k}": [f"{k}"] for k in range(len(usages))})


@pytest.mark.parametrize(
    ("usages", "index"),
    [
        ((7, 7, 7, 7), 1),
        ((0, 0), 1),
        ((5,), 1),
        ((0, 5, 0, 0), 1 / 4),
        ((1, 3), 1 - (2 * (1 * 1 + 2 * 3) / (2 * 4) - 3 / 2)),
        ((3, 1), 0.75),
    ],
)
def test_equality_index(usages, index):
    assert line_of_robots(*usages).equality_index == pytest.approx(index, abs=1e-12)


def test_equality_index_where_rank_times_usage_would_overflow():
    assert equality_index([1.2e308, 2.5e307, 2.5e307]) == pytest.approx(equality_index([120, 25, 25]), abs=1e-12)


@pytest.mark.parametrize(
    ("usages", "printed"),
    [
        ((0, 239.04, 0), 0.33),  # Table 3.21, 16T-3R, MinCost: one robot of three has all
        ((83.94, 105.3, 70.17), 0.91),  # Tables 3.5 and 3.21, 16T-3R
        ((33.452, 24.27, 35.541, 30.49, 28.41), 0.93),  # the same, 24T-5R
        ((21.93, 33.06, 41.96, 28.27, 34.19, 40.03), 0.886),  # the same, 31T-6R: printed 0.88, neither 0.886 nor 0.89
        ((34.22, 21.12, 42.1, 8.72, 31.29, 39.03), 0.79),  # Tables 3.6 and 3.22, 31T-6R
        ((89.14, 64.39, 86.46), 0.93),  # the same, 16T-3R
        ((19.71, 24.27, 35.54, 27.8, 36.07), 0.88),  # the same, 24T-5R
    ],
)
def test_equality_index_as_printed_in_the_thesis(usages, printed):
    assert line_of_robots(*usages).equality_index == pytest.approx(printed, abs=0.005)


def test_the_usable_capacity():
    robots = (Robot(id="r", position=(0, 0), work_capacity=50), Robot(id="s", position=(0, 0)))
    mission = Mission(rules=Rules(capacity_reserve=0.2), robots=robots, tasks=())
    assert [route.capacity for route in judge(mission).routes] == [40, None]
    ignoring = verify(mission, Plan(routes=()), "capacity")
    assert [route.capacity for route in ignoring.routes] == [None, None]
