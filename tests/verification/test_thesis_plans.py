"""Plans printed in the task coordination thesis, judged: scenario 31T-6R (Tables A.3, A.9, 3.5, 3.8, 3.17, 3.18)."""

import pytest

from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.verification import Verdict, verify

# id, x, y, type, actuation cost, prerequisite; the types of tasks 9 to 15 as in the runs, not as in Table A.3
TASKS = """
0 -4.711 5.841 F 0 30 | 1 -6.616 6.258 E 0 30 | 2 -6.001 4.576 F 0 30 | 3 3.027 0.691 E 0 0 | 4 -2.314 2.332 F 0
5 3.109 5.388 E 0 16 | 6 -1.226 -2.447 F 0 | 7 5.03 -2.214 E 0 28 | 8 7.573 3.331 F 0 29 | 9 5.512 2.319 E 0 29
10 7.476 1.469 F 0 29 | 11 -6.839 0.844 E 0 27 | 12 -4.949 0.777 F 0 27 | 13 -5.1 -0.626 E 0 27
14 -1.127 5.146 F 0 16 | 15 0.612 7.144 E 0 | 16 1.025 3.758 D 16 | 17 3.642 -2.163 F 0 28 | 18 5.487 -3.395 E 0 28
19 4.232 7.428 F 0 | 20 -5.515 2.709 E 0 | 21 9.653 6.37 F 0 | 22 1.133 2.031 E 0 16 | 23 -2.649 7.655 F 0
24 7.307 8.483 E 0 | 25 -3.627 -7.308 F 0 | 26 2.474 -7.203 E 0 | 27 -5.5 0 D 12 | 28 4.5 -2.5 D 12
29 6.5 2.5 D 12 | 30 -5.5 5.5 D 12
"""
STARTS = [
    ("beta", 5, -8),
    ("epsilon", 6.5, -8),
    ("tau", 8, -8),
    ("beta", 5, -6.5),
    ("epsilon", 6.5, -6.5),
    ("tau", 8, -6.5),
]
SUITABILITY = {
    "beta": {"D": 0.9, "E": 0.7, "F": 0.5},
    "epsilon": {"D": 0.7, "E": 0.5, "F": 0.9},
    "tau": {"D": 0.5, "E": 0.9, "F": 0.7},
}


def mission(capacities: tuple[float | None, ...] = (None,) * 6) -> Mission:
    rows = [row.split() for row in TASKS.replace("|", "\n").strip().splitlines()]
    tasks = [
        Task(id=name, position=(float(x), float(y)), type=kind, actuation_cost=float(cost), prerequisites=tuple(before))
        for name, x, y, kind, cost, *before in rows
    ]
    robots = [
        Robot(id=f"r_{k}", type=kind, position=(x, y), work_capacity=capacity)
        for k, ((kind, x, y), capacity) in enumerate(zip(STARTS, capacities, strict=True))
    ]
    return Mission(suitability=SUITABILITY, robots=tuple(robots), tasks=tuple(tasks))


def judge(capacities: tuple[float | None, ...], routes: list[str], *ignored: str) -> Verdict:
    stated = tuple(Route(f"r_{k}", tuple(route.split())) for k, route in enumerate(routes))
    return verify(mission(capacities), Plan(routes=stated), ignored)


UNLIMITED = (None,) * 6


def test_table_3_5_unconstrained():
    routes = ["6 13 12 11 20 2 1", "9 19 29", "5 15 23 16", "26 25 27", "18 7 17 3 22 4 14 0 30", "10 8 21 24 28"]
    verdict = judge(UNLIMITED, routes, "prerequisites", "suitability", "capacity")
    assert verdict.violations == ()
    assert verdict.tasks_completed == verdict.tasks_total == 31
    assert [route.usage for route in verdict.routes] == pytest.approx(
        [21.93, 33.06, 41.96, 28.27, 34.19, 40.03], abs=0.01
    )
    assert verdict.total_cost == pytest.approx(199.43, abs=0.01)
    assert verdict.value() == pytest.approx(241.39, abs=0.01)
    assert {violation.kind for violation in judge(UNLIMITED, routes).violations} == {"suitability", "deadlock"}


def test_table_3_8_prerequisites():
    routes = ["6 20 27 1", "19 15 30", "28 18 9 3 22 14", "26 25 17 7 10 8 16", "4 23 12 13 11 2 0", "21 24 29 5"]
    verdict = judge(UNLIMITED, routes, "suitability")
    assert verdict.violations == ()
    assert verdict.total_cost == pytest.approx(229.25, abs=0.01)
    assert verdict.value() == pytest.approx(277.11, abs=0.015)
    assert verdict.makespan_s is not None
    assert verdict.makespan_s > verdict.max_usage  # robots wait


@pytest.mark.long
@pytest.mark.parametrize(
    ("capacities", "routes", "total", "value"),
    [
        (
            (50,) * 6,
            ["20 11 13 1", "25 27", "19 0 2", "26 15 30", "6 4 23 12 28", "21 24 3 17 7 18"],
            197.32,
            245.53,
        ),
        ((44,) * 3 + (26,) * 3, ["20 11 13 30", "25 27", "19 12 1", "26 15 3", "6 4 23 0 2", "21 24"], 163.98, 201.69),
        (
            (25, 65, 25, 25, 65, 25),
            ["20 11 13", "25 27 2 16", "19 0", "26 15 1", "6 4 23 12 30 14", "21 24 5"],
            194.98,
            252.35,
        ),
    ],
)
def test_table_3_17_all_constraints(capacities, routes, total, value):
    verdict = judge(capacities, routes)
    assert verdict.violations == ()
    assert verdict.total_cost == pytest.approx(total, abs=0.01)
    assert verdict.value() == pytest.approx(value, abs=0.01)


def test_table_3_18_all_constraints():
    """31T-6R50; the second 8 in the printed route of r_5 is a 9."""
    routes = ["13 11 29", "25 27 12", "15 0 2 1 23 14 22", "26 20 30", "28 17 6 4 16", "18 7 3 19 24 21 8 10 9 5"]
    verdict = judge((50,) * 6, routes)
    assert verdict.violations == ()
    assert verdict.total_cost == pytest.approx(218.36, abs=0.01)
    printed = judge((50,) * 6, [*routes[:5], "18 7 3 19 24 21 8 10 8 5"])
    assert [(v.kind, v.robot, v.task) for v in printed.violations] == [("repeated-task", "r_5", "8")]


def test_table_3_18_deadlocks():
    """31T-2R65-4R25: no route breaks (3.25), and yet r_1 and r_4 wait for each other."""
    routes = ["13 11", "25 27 12 2 16", "15 23 0", "26 20 1", "6 4 14 30 29 8 10", "5 19 24 21"]
    verdict = judge((25, 65, 25, 25, 65, 25), routes)
    assert [violation.kind for violation in verdict.violations] == ["deadlock"]
    cycle = "r_1: 2 -> 16; prerequisite: 16 -> 14; r_4: 14 -> 30; prerequisite: 30 -> 2"
    assert verdict.violations[0].detail == cycle
    assert verdict.makespan_s is None
    assert verdict.total_cost == pytest.approx(196.66, abs=0.01)
    assert verdict.value() == pytest.approx(257.32, abs=0.01)
    assert judge((25, 65, 25, 25, 65, 25), routes, "prerequisites").valid


def test_table_6_8():
    """6T-2R, unconstrained."""
    places = [(4.1, -0.64, 0), (0.97, -0.1, 2), (2.69, 1.75, 0), (2.3, -1.2, 2), (-0.38, -1.84, 0), (3.9, -1.5, 0)]
    small = Mission(
        robots=(Robot(id="r_0", position=(-1.857, 1.315)), Robot(id="r_1", position=(-1.784, -0.581))),
        tasks=tuple(Task(id=k, position=(x, y), actuation_cost=cost) for k, (x, y, cost) in enumerate(places)),
    )
    verdict = verify(small, Plan(routes=(Route("r_0", ("2", "0", "5")), Route("r_1", ("4", "1", "3")))))
    assert [route.usage for route in verdict.routes] == pytest.approx([8.23, 9.81], abs=0.01)
    assert verdict.total_cost == pytest.approx(18.04, abs=0.01)
    assert verdict.value() == pytest.approx(27.85, abs=0.01)
