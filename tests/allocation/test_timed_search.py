"""The search where nothing is late, and where the same robots must do tasks or tasks begin together."""

import muster
from muster import Mission, Plan, Robot, Rules, Task, TeamPart
from muster.mission.plan import Route


def best(mission):
    plan = muster.solve(mission, "search", iterations=2000, seed=1)
    assert muster.verify(mission, plan).valid
    return plan


def test_where_nothing_is_late_the_total_counts():
    """Lateness is 0 in any order; ties are by total cost."""
    places = {"a": 10, "b": 30, "c": 20, "d": 40}
    tasks = tuple(Task(id=name, position=(x, 0), due_s=1000) for name, x in places.items())
    mission = Mission(rules=Rules(objective="lateness"), robots=(Robot(id="r", position=(0, 0)),), tasks=tasks)
    plan = best(mission)
    assert (plan.objective_value, plan.routes[0].tasks) == (0.0, ("a", "c", "b", "d"))


def test_a_task_that_begins_with_another_is_for_the_robot_of_its_relation():
    """c is for the robot of a, and b begins with c: for the other robot."""
    tasks = (
        Task(id="a", position=(1, 0)),
        Task(id="b", position=(5, 0)),
        Task(id="c", position=(5, 1), prerequisites=("a",), same_robot_as=("a",), starts_with=("b",)),
    )
    robots = (Robot(id="r_0", position=(0, 0)), Robot(id="r_1", position=(9, 0)))
    plan = best(Mission(rules=Rules(objective="max"), robots=robots, tasks=tasks))
    assert {route.robot: route.tasks for route in plan.routes} == {"r_0": ("a", "c"), "r_1": ("b",)}


def test_the_near_robot_leaves_the_first_task_for_the_one_that_only_it_can_do():
    """Only r_0 may do b, after a, and has not the range for both."""
    tasks = (
        Task(id="a", position=(3, 0), team=(TeamPart(type="rover"),)),
        Task(id="b", position=(-8, 0), only_robots=("r_0",), prerequisites=("a",)),
    )
    robots = (
        Robot(id="r_0", type="rover", position=(0, 0), work_capacity=16),
        Robot(id="r_1", type="rover", position=(9, 0)),
    )
    plan = best(Mission(rules=Rules(objective="total", return_to_start=True), robots=robots, tasks=tasks))
    assert {route.robot: route.tasks for route in plan.routes} == {"r_0": ("b",), "r_1": ("a",)}


def test_a_task_before_one_of_the_same_robot_is_not_for_two():
    """Two near robots could do a, but b is for one robot, and the same: the far one that can do a alone."""
    tasks = (
        Task(id="a", position=(1, 0), needs={"lift_kg": 4}),
        Task(id="b", position=(2, 0), prerequisites=("a",), same_robot_as=("a",)),
    )
    robots = (
        *(Robot(id=f"near_{k}", position=(k, 0), abilities={"lift_kg": 3}) for k in range(2)),
        Robot(id="far", position=(50, 0), abilities={"lift_kg": 5}),
    )
    plan = best(Mission(robots=robots, tasks=tasks))
    assert {route.robot: route.tasks for route in plan.routes if route.tasks} == {"far": ("a", "b")}


def test_the_team_of_the_lighter_task_is_that_of_the_heavier_one():
    """One robot could do a, but b takes both, and the same robots must do a."""
    tasks = (
        Task(id="a", position=(1, 0), needs={"lift_kg": 1}),
        Task(id="b", position=(2, 0), prerequisites=("a",), same_robot_as=("a",), needs={"lift_kg": 6}),
    )
    robots = tuple(Robot(id=f"r_{k}", position=(k, 0), abilities={"lift_kg": 3}) for k in range(2))
    plan = best(Mission(robots=robots, tasks=tasks))
    assert [route.tasks for route in plan.routes] == [("a", "b"), ("a", "b")]


def test_two_robots_that_go_on_in_each_others_lanes_exchange_what_is_left():
    """Windows keep the order; no few tasks can change robots alone at less cost."""

    def lane(name, y):
        opens = [10.0 * k for k in range(30)]
        return [Task(id=f"{name}{x:g}", position=(x + 10, y), window_s=((x, x + 60),)) for x in opens]

    tasks = (*lane("a", 0.0), *lane("b", 20.0))
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 20)))
    a, b = ([task.id for task in tasks if task.id[0] == name] for name in "ab")
    mission = Mission(rules=Rules(objective="total"), robots=robots, tasks=tasks)
    crossed = Plan(routes=(Route("r", (*a[:15], *b[15:])), Route("s", (*b[:15], *a[15:]))))
    for seed in range(5):
        plan = muster.solve(mission, "search", iterations=300, seed=seed, start=crossed)
        assert plan.objective_value == 600
