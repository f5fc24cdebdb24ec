"""Who manages the traffic of a run: by the option, the map, the avoidance and the law."""

from __future__ import annotations

from dataclasses import replace

import pytest

from muster import Negotiation, ParameterError, Simulation, simulate, solve
from muster.generation import narrow
from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Event, Map, Mission, Robot, Rules, Task, Zone
from muster.running.free_traffic import free_s
from muster.running.observed_run import ObservedRun
from muster.running.traffic_choice import LOOSE_MARGIN_M, manager_for
from muster.traffic.roadmaps.roadmap import MARGIN_M


@pytest.fixture(scope="module")
def door():
    return narrow.one_way_door("holonomic", 0, 3)


@pytest.fixture(scope="module")
def hall(door):
    """Without a map."""
    return replace(door, map=None, rules=replace(door.rules, travel="euclidean"))


def test_a_door_for_one_is_reserved(door):
    assert manager_for("auto", door) is not None
    assert manager_for("reserve", door) is not None
    assert manager_for("free", door) is None


def test_open_space_is_free_unless_lanes_are_given(hall):
    assert manager_for("auto", hall) is None
    assert manager_for("reserve", hall) is not None
    lanes = Lanes(nodes={"a": (-5.0, 0.0), "b": (5.0, 0.0)}, edges=(Lane(start="a", end="b", both_ways=True),))
    assert manager_for("auto", replace(hall, lanes=lanes)) is None  # whose rules say that travel is straight
    assert manager_for("auto", replace(hall, lanes=lanes, rules=replace(hall.rules, travel=None))) is not None


def test_given_lanes_lead_a_single_robot_too(hall):
    """One way along the x axis: the robot gets to the east, and not back to the west."""
    nodes = {"a": (-5.0, 0.0), "b": (0.0, 0.0), "c": (5.0, 0.0)}
    lanes = Lanes(nodes=nodes, edges=(Lane(start="a", end="b"), Lane(start="b", end="c")))
    robot = replace(hall.robots[0], position=(0.0, 0.0))
    tasks = tuple(replace(hall.tasks[0], id=name, position=nodes[name], only_robots=None) for name in "ac")
    rules = Rules(return_to_start=False)
    mission = replace(hall, robots=(robot,), tasks=tasks, lanes=lanes, rules=rules)
    report = simulate(mission, solve(mission, "greedy"))
    assert list(report.tasks_done) == ["c"]
    assert "no lanes lead from (0, 0) to (-5, 0)" in dict(report.tasks_lost)["a"]


@pytest.mark.long
def test_a_small_robot_passes_a_door_that_is_too_narrow_for_the_wide_one():
    walls = [(x, y) for x, gap in ((-2.0, 0.75), (3.0, 0.45)) for y in ((-6.0, -gap), (gap, 6.0))]
    zones = tuple(Zone(polygon=((x - 0.2, a), (x + 0.2, a), (x + 0.2, b), (x - 0.2, b))) for x, (a, b) in walls)
    mission = Mission(
        robots=(
            Robot(id="wide", position=(-6.0, 0.0), radius_m=0.6),
            Robot(id="small", position=(-5.0, 3.0), radius_m=0.3),
        ),
        tasks=(
            Task(id="behind the first", position=(0.0, 0.0), only_robots=("wide",)),
            Task(id="behind both", position=(6.0, 2.0), only_robots=("small",)),
        ),
        map=Map(boundary=((-8.0, -6.0), (8.0, -6.0), (8.0, 6.0), (-8.0, 6.0)), zones=zones),
        rules=Rules(travel="map"),
    )
    assert manager_for("auto", mission) is not None
    report = simulate(mission, solve(mission, "greedy"))
    assert report.tasks_lost == ()
    assert report.contacts == 0


def test_what_else_is_asked_for_leaves_traffic_free(door):
    assert manager_for("auto", door, avoidance="none") is None
    assert manager_for("auto", door, law="trajectory") is None
    assert manager_for("reserve", door, avoidance="none") is not None


def test_robots_that_are_not_exact_keep_more_between_them(door):
    assert manager_for("auto", door, exact=True).margin_m == MARGIN_M
    assert manager_for("auto", door).margin_m == LOOSE_MARGIN_M


def test_reservation_is_refused_where_it_cannot_be(door):
    with pytest.raises(ParameterError, match="traffic: reserve; expected free: by law trajectory robots leave"):
        manager_for("reserve", door, law="trajectory")
    flying = replace(door, robots=tuple(replace(robot, kind="air") for robot in door.robots))
    assert manager_for("auto", flying) is None
    with pytest.raises(ParameterError, match="expected free: fewer than two robots of kind ground"):
        manager_for("reserve", flying)


def test_without_a_centre_nothing_is_reserved(hall):
    with pytest.raises(ParameterError, match="traffic: reserve; expected free: without a centre"):
        simulate(hall, Negotiation(), traffic="reserve")


@pytest.fixture(scope="module")
def crossing():
    """Four robots change places in a room that has space for all, and its plan."""
    places = ((2.0, 2.0), (8.0, 8.0), (2.0, 8.0), (8.0, 2.0))
    robots = tuple(Robot(id=f"r_{k}", position=at, radius_m=0.4) for k, at in enumerate(places))
    goals = (places[1], places[0], places[3], places[2])
    tasks = tuple(Task(id=f"t_{k}", position=at, only_robots=(f"r_{k}",)) for k, at in enumerate(goals))
    boundary = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
    rules = Rules(travel="map", return_to_start=False)
    mission = Mission(robots=robots, tasks=tasks, map=Map(boundary=boundary), rules=rules)
    return mission, solve(mission, "greedy")


@pytest.mark.parametrize(("takes_s", "is_reserved"), [(9.0, False), (1000.0, True)])
def test_where_there_is_room_the_faster_one_by_forecast_is_chosen(crossing, takes_s, is_reserved):
    mission, plan = crossing
    asked = []

    def free(plan, within_s):
        asked.append(within_s)
        return takes_s

    assert (manager_for("auto", mission, plan=plan, free_s=free) is not None) is is_reserved
    assert 9.0 < asked[0] < 1000.0
    assert manager_for("auto", mission) is None
    assert manager_for("free", mission, plan=plan, free_s=free) is None
    assert len(asked) == 1


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("radius_m", [0.2, 1.2])
def test_a_run_in_auto_takes_as_long_as_the_faster_mode(crossing, radius_m):
    mission, plan = crossing
    mission = replace(mission, robots=tuple(replace(robot, radius_m=radius_m) for robot in mission.robots))
    plan = solve(mission, "greedy")
    auto, free, reserved = (
        simulate(mission, plan, traffic=traffic).mission_time_s for traffic in ("auto", "free", "reserve")
    )
    assert auto in (free, reserved)
    assert auto <= 1.2 * min(free, reserved)


def test_free_traffic_is_forecast_without_what_happens_later(crossing):
    mission, plan = crossing
    failing = replace(mission, events=(Event(at_s=1.0, robot_fails="r_0"),))
    alone_s = free_s(Simulation, mission, ObservedRun(), plan, 100.0)
    assert free_s(Simulation, failing, ObservedRun(), plan, 100.0) == alone_s < 100.0
    assert free_s(Simulation, mission, ObservedRun(), plan, 0.5 * alone_s) == float("inf")
