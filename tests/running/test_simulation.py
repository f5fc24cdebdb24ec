"""Plans carried out by moving robots: actions over maps, and what changes meanwhile."""

import math
from dataclasses import replace

import pytest

import muster
from muster import Mission, Robot, Rules, Task
from muster.mission.events import MovedRobot
from muster.mission.model import Action, Camera, DelayedTask, Event, Map, MovedTask, Zone
from muster.mission.plan import Plan, Route
from muster.running.simulation import carry_out

pytest.importorskip("shapely", reason="needs the extra `map`")

ROVER = Robot(id="rover", position=(3.0, 3.0), radius_m=0.3, speed_mps=1.0, kinematics="differential-drive")
DRONE = Robot(
    id="drone",
    position=(3.0, 5.0),
    kind="air",
    radius_m=0.3,
    speed_mps=2.0,
    kinematics="quadcopter",
    camera=Camera(fov_deg=60, tilt_deg=45),
)
WALLED = Map(
    boundary=((0, 0), (30, 0), (30, 20), (0, 20)),
    zones=(Zone(polygon=((14, 4), (15, 4), (15, 16), (14, 16))), Zone(polygon=((22, 9), (24, 9), (24, 11), (22, 11)))),
)


def over_walls(*tasks, robots=(ROVER,), events=(), **rules):
    return Mission(rules=Rules(**rules), robots=robots, tasks=tasks, events=events, map=WALLED)


def task(name, position, action=None, /, **more):
    return Task(id=name, position=position, action=None if action is None else Action(**action), **more)


def flown(mission, plan=None):
    """The verdict on a plan and the report of carrying it out."""
    plan = muster.solve(mission, iterations=300) if plan is None else plan
    verdict = muster.verify(mission, plan)
    assert verdict.valid, verdict.violations
    return verdict, carry_out(mission, plan)


def judged(mission, *names, robot="rover"):
    return flown(mission, Plan(routes=(Route(robot, names),)))


ALONE = [
    over_walls(task("round", (23, 10), {"name": "ground-patrol", "side_m": 5})),
    over_walls(task("past", (20, 10), {"name": "delivery", "pickup": (10, 10)})),
    over_walls(task("through", (14.5, 10), {"name": "raster-search", "side_m": 3, "height_m": 2, "spacing_m": 3})),
    over_walls(task("sides", (10, 10), exit=(19, 10), actuation_cost=30)),
    over_walls(task("both", (14.5, 10), {"name": "ground-patrol", "side_m": 4}), robots=(DRONE,)),
]


@pytest.mark.parametrize("mission", ALONE, ids=lambda mission: mission.tasks[0].id)
def test_way_points_beyond_walls_are_come_to_around_them(mission):
    """For the usage that the judge finds, in no less than his time; a straight line would end at the wall."""
    verdict, report = flown(mission)
    assert report.tasks_done == (mission.tasks[0].id,)
    assert (report.contacts, report.reallocations) == (0, 0)
    assert report.robots[0].usage_flown == pytest.approx(verdict.total_cost, rel=0.02)
    assert report.mission_time_s > verdict.makespan_s - 0.1


PATROL = {"name": "ground-patrol"}
RASTER = {"name": "raster-search", "height_m": 2.0}
SHIPPED = {
    "floor": [
        ("rover0", task("desks", (24, 5), PATROL | {"side_m": 5})),
        ("carrier", task("mail", (8.8, 15.5), {"name": "delivery", "pickup": (35.2, 6.5)})),
        ("rover1", task("aisles", (5, 6), {"name": "delivery", "pickup": (5, 1.3)}, exit=(5, 8.6))),
        ("uav0", task("labs", (34.5, 21.5), RASTER | {"side_m": 2, "spacing_m": 1})),
    ],
    "yard": [
        ("rover0", task("wall", (14.2, 20, 0), PATROL | {"side_m": 7})),
        ("rover1", task("sample", (17, 20, 0), {"name": "delivery", "pickup": (11, 20, 0)})),
        ("uav0", task("over", (14.2, 20, 0), RASTER | {"side_m": 8, "spacing_m": 4})),
        ("uav1", task("roofs", (32, 30, 0), RASTER | {"side_m": 10, "spacing_m": 4})),
    ],
}


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("name", "robot", "task"), [(name, *pair) for name, pairs in SHIPPED.items() for pair in pairs]
)
def test_on_shipped_maps_robots_alone_fly_what_was_planned(name, robot, task):
    mission = replace(muster.load(name), tasks=(task,))
    mission = replace(mission, robots=tuple(one for one in mission.robots if one.id == robot))
    verdict, report = flown(mission)
    assert report.tasks_done == (task.id,)
    assert report.contacts == 0
    assert report.robots[0].usage_flown == pytest.approx(verdict.total_cost, rel=0.02)


LOOK = {"name": "stationary-observation", "width_m": 2.0}
DELAYED = [
    task("round", (23, 10), {"name": "ground-patrol", "side_m": 5}),
    task("past", (20, 10), {"name": "delivery", "pickup": (10, 10)}, duration_s=60),
    task("sides", (10, 10), exit=(19, 10), actuation_cost=30),
    task("probe", (10, 10), {"name": "sensor-activation", "duration_s": 8}),
    task("look", (10, 10), LOOK, duration_s=4, only_robots=("drone",)),
]


@pytest.mark.parametrize("one", DELAYED, ids=lambda task: task.id)
@pytest.mark.parametrize("at_s", [1.0, None])
def test_a_delay_comes_on_top_of_what_the_work_takes(one, at_s):
    """Told before the work begins, or while it is under way; the usage stays."""
    robot = (one.only_robots or ("rover",))[0]
    mission = over_walls(
        one, task("then", (3, 15), prerequisites=(one.id,)), robots=tuple(r for r in (ROVER, DRONE) if r.id == robot)
    )
    plan = Plan(routes=(Route(robot, (one.id, "then")),))
    as_planned = flown(mission, plan)[1]
    at_s = as_planned.starts_s[one.id] + 1 if at_s is None else at_s
    event = Event(at_s=at_s, delay_task=DelayedTask(task=one.id, by_s=12))
    report = carry_out(replace(mission, events=(event,)), plan)
    lasts, lasted = (r.ends_s[one.id] - r.starts_s[one.id] for r in (report, as_planned))
    assert lasts == pytest.approx(lasted + 12, abs=1.5)  # turns differ
    assert report.robots[0].usage_flown == pytest.approx(as_planned.robots[0].usage_flown, rel=0.01)
    assert report.tasks_done == (one.id, "then")


def test_a_delivery_that_moves_is_brought_to_its_new_place_from_where_the_load_is():
    mission = over_walls(task("past", (20, 10), {"name": "delivery", "pickup": (10, 10)}))
    event = Event(at_s=2, move_task=MovedTask(task="past", position=(27, 3)))
    moved = over_walls(task("past", (27, 3), {"name": "delivery", "pickup": (10, 10)}))
    report = carry_out(replace(mission, events=(event,)), muster.solve(mission, iterations=100))
    assert report.robots[0].usage_flown == pytest.approx(
        muster.verify(moved, muster.solve(moved, iterations=100)).total_cost, rel=0.02
    )


def test_a_moved_raster_is_flown_elsewhere():
    mission = over_walls(task("field", (8, 8), {"name": "raster-search", "side_m": 4, "height_m": 2, "spacing_m": 2}))
    event = Event(at_s=1, move_task=MovedTask(task="field", position=(14.5, 14)))
    there = over_walls(replace(mission.tasks[0], position=(14.5, 14)))
    report = carry_out(replace(mission, events=(event,)), muster.solve(mission, iterations=100))
    planned = muster.verify(there, muster.solve(there, iterations=100)).total_cost
    assert report.tasks_done == ("field",)
    assert report.robots[0].usage_flown == pytest.approx(planned, rel=0.02)


def test_a_task_that_moves_into_a_wall_is_lost_with_that_reason():
    mission = over_walls(task("field", (8, 8), {"name": "ground-patrol", "side_m": 4}))
    event = Event(at_s=1, move_task=MovedTask(task="field", position=(25, 12)))
    report = carry_out(replace(mission, events=(event,)), muster.solve(mission, iterations=100))
    assert report.tasks_done == ()
    assert "unreachable" in dict(report.tasks_lost)["field"]


@pytest.mark.parametrize("usage", ["distance", "time"])
def test_a_robot_sets_out_when_it_is_available_and_not_before(usage):
    """Also at a time between two steps, and between two looks."""
    late = replace(ROVER, available_from_s=7.33, kinematics="holonomic")
    mission = over_walls(task("near", (3, 9), actuation_cost=2), robots=(late,), usage=usage)
    verdict, report = flown(mission)
    assert report.starts_s["near"] == pytest.approx(7.33 + 6, abs=0.25)
    assert report.mission_time_s == pytest.approx(verdict.makespan_s, abs=0.4)
    assert report.mission_time_s >= verdict.makespan_s
    assert report.robots[0].usage_flown == pytest.approx(verdict.max_usage, abs=0.4)


def test_a_robot_that_is_available_late_gets_no_work_that_others_end_before():
    late = replace(DRONE, available_from_s=60)
    tasks = [task(str(k), (5 + 2 * k, 3)) for k in range(3)]
    mission = over_walls(*tasks, robots=(ROVER, late), objective="makespan", events=[Event(at_s=2, cancel_task="0")])
    report = carry_out(mission, muster.solve(mission, iterations=100))
    assert report.robots[1].usage_flown == 0
    assert report.mission_time_s < 20


def test_a_robot_that_returns_goes_on_from_where_it_is():
    mission = over_walls(task("there", (12, 3)))
    events = (Event(at_s=3.03, robot_fails="rover"), Event(at_s=20.07, robot_returns="rover"))
    plan = muster.solve(mission, iterations=100)
    before = carry_out(mission, plan)
    report = carry_out(replace(mission, events=events), plan)
    assert report.tasks_done == ("there",)
    assert report.mission_time_s == pytest.approx(before.mission_time_s + 17, abs=1.5)
    assert report.robots[0].usage_flown == pytest.approx(before.robots[0].usage_flown, rel=0.01)


def test_one_that_returns_before_it_is_available_waits_until_then():
    late = replace(ROVER, available_from_s=15)
    events = (Event(at_s=3, robot_fails="rover"), Event(at_s=5, robot_returns="rover"))
    mission = over_walls(task("there", (5, 3)), robots=(late,), events=events)
    report = carry_out(mission, muster.solve(mission, iterations=100))
    assert report.starts_s["there"] == pytest.approx(17, abs=0.5)


@pytest.mark.long
@pytest.mark.parametrize("iterations", [300, pytest.param(2000, marks=pytest.mark.long)])
def test_depot_is_carried_out_as_planned_and_whole_whatever_happens(iterations):
    """All actions over a map in space, several robots at once; then with a robot that fails and a task that appears."""
    mission = muster.load("depot")
    plan = muster.solve(mission, iterations=iterations)
    assert plan.complete
    calm = carry_out(replace(mission, events=()), plan)
    assert (set(calm.tasks_done), calm.contacts, calm.reallocations) == ({t.id for t in mission.tasks}, 0, 0)
    for route, robot in zip(muster.verify(mission, plan).routes, calm.robots, strict=True):
        assert robot.usage_flown == pytest.approx(route.usage, rel=0.02)
    report = carry_out(mission, plan)
    assert set(report.tasks_done) == {t.id for t in mission.tasks} | {"open-gate"}
    assert (report.contacts, report.tasks_lost) == (0, ())
    for robot, flown in zip(mission.robots, report.robots, strict=True):
        assert flown.usage_flown <= robot.work_capacity


def test_a_makespan_means_the_same_planned_and_flown():
    """The way home is no part of it; the mission's time holds it."""
    robot = Robot(id="r", position=(0, 0), return_to_start=True)
    mission = Mission(rules=Rules(objective="makespan"), robots=(robot,), tasks=(Task(id="a", position=(50, 0)),))
    report = muster.simulate(mission, muster.solve(mission, iterations=10))
    assert report.objective.planned == 50
    assert report.objective.flown == pytest.approx(50, abs=0.2)
    assert report.mission_time_s == pytest.approx(100, abs=0.4)
    assert muster.verify(mission, muster.solve(mission, iterations=10)).makespan_s == 50


def test_rules_are_ignored_by_the_caller_alone():
    """A plan names a rule as ignored: the robot waits all the same, unless the caller ignores the rule."""
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 40)))
    first, then = Task(id="first", position=(30, 0)), Task(id="then", position=(1, 40), prerequisites=("first",))
    mission = Mission(robots=robots, tasks=(first, then))
    routes = (muster.Route("r", ("first",)), muster.Route("s", ("then",)))
    plan = muster.Plan(ignored=("prerequisite",), routes=routes)
    waits = muster.simulate(mission, plan)
    assert waits.starts_s["then"] == pytest.approx(30, abs=0.4)
    ignoring = muster.simulate(mission, muster.Plan(routes=routes), ignore=["prerequisite"])
    assert ignoring.starts_s["then"] == pytest.approx(1, abs=0.4)


def test_what_the_mission_file_says_of_the_beginning_happens_at_the_beginning():
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 1)), Robot(id="t", position=(0, 2)))
    events = (
        Event(at_s=0.0, robot_joins=Robot(id="new", position=(9, 0))),
        Event(at_s=0.0, robot_moved=MovedRobot(robot="r", position=(0, 5))),
        Event(at_s=0.0, robot_fails="s"),
        Event(at_s=0.0, robot_removed="t"),
    )
    locked = tuple(Task(id=f"of {name}", position=(9, k), only_robots=(name,)) for k, name in enumerate(("new", "r")))
    mission = Mission(robots=robots, tasks=locked, events=events)
    report = carry_out(mission, muster.solve(mission, "greedy"))
    assert set(report.tasks_done) == {"of new", "of r"}
    assert report.starts_s["of r"] == pytest.approx(math.dist((0, 5), (9, 1)), abs=0.2)
