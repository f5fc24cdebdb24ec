"""Robots that somebody takes away or puts elsewhere: what becomes of their work, of others, and of places."""

from dataclasses import replace

import pytest
from tests.carry_charge import battery, charger, robot, task
from tests.carry_charge import mission as serviced
from tests.execution.test_executor import plan_of, with_a_breakdown_at_work

import muster
from muster import Event, Map, Mission, ParameterError, Robot, Rules, Simulation, Task
from muster.mission.events import MovedRobot
from muster.mission.model import Zone


def moved(at_s, robot, *position):
    return Event(at_s=at_s, robot_moved=MovedRobot(robot=robot, position=position))


def over(mission, plan, **how):
    """The simulation at its end."""
    simulation = Simulation(mission, plan, **how)
    while not simulation.done and simulation.time_s < 1000:
        simulation.advance(1000)
    assert simulation.done
    return simulation


def told(simulation, kind):
    return [event.data for event in simulation.events if event.kind == kind]


@pytest.mark.parametrize("event", [Event(at_s=200, robot_removed="r_0"), moved(200, "r_0", 20.0, 20.0)])
def test_a_task_behind_a_broken_robot_is_done_when_somebody_takes_that_out_of_the_way(event):
    """r_1 gives task 0 up as r_0 stands there, out."""
    simulation = over(with_a_breakdown_at_work(event), plan_of(r_0=["0"], r_1=["1"]))
    assert [one["task"] for one in told(simulation, "task_refused")] == ["0"]
    assert sorted(simulation.result().tasks_done) == ["0", "1"]
    assert simulation.result().contacts == 0
    assert simulation.status.robots["r_0"].out


def test_work_is_begun_again_by_a_robot_that_is_moved_and_by_another_where_it_is_taken_away():
    two = (Robot(id="r_0", position=(0, 0)), Robot(id="r_1", position=(0, 9)))
    for event, by in ((moved(12, "r_0", 3.0, 4.0), "r_0"), (Event(at_s=12, robot_removed="r_0"), "r_1")):
        mission = Mission(robots=two, tasks=(Task(id="0", position=(5, 0), duration_s=20),), events=(event,))
        simulation = over(mission, plan_of(r_0=["0"]))
        assert [one["robot"] for one in told(simulation, "starts")] == ["r_0", by]
        assert [one["robot"] for one in told(simulation, "ends")] == [by]


WALL = Zone(polygon=((10, -5), (11, -5), (11, 5), (10, 5)))
PARTED = Map(boundary=((-5, -5), (20, -5), (20, 5), (-5, 5)), zones=(WALL,))
"""Two rooms, and no door between them."""


def in_two_rooms(*events, **rules):
    one, tasks = Robot(id="r_0", position=(0, 0), radius_m=0.3), (Task(id="0", position=(5, 0)),)
    return Mission(robots=(one,), tasks=tasks, map=PARTED, rules=Rules(**rules), events=events)


def test_a_robot_that_had_no_way_to_a_task_does_it_from_where_it_is_put():
    late = Event(at_s=20, new_task=Task(id="1", position=(15, 0)))
    simulation = over(in_two_rooms(late, moved(50, "r_0", 14.0, 0.0)), plan_of(r_0=["0"]))
    assert sorted(simulation.result().tasks_done) == ["0", "1"]


def test_a_robot_that_is_put_where_it_is_cut_off_from_its_end_goes_there_from_where_it_is_put_next():
    events = moved(2, "r_0", 14.0, 0.0), moved(20, "r_0", 9.0, 3.0)
    simulation = over(in_two_rooms(*events, return_to_start=True), plan_of(r_0=["0"]))
    assert simulation.result().tasks_done == ("0",)
    assert simulation.positions["r_0"][:2] == pytest.approx((0, 0), abs=0.01)


def test_the_slot_of_a_robot_that_is_taken_from_a_station_is_free_for_the_next():
    robots = [robot(name, x, battery=battery(60, 0.2)) for name, x in (("a", -1), ("b", -2))]
    tasks = [task("t0", 20, only_robots=("a",)), task("t1", 21, only_robots=("b",))]
    given = serviced(robots, tasks, [charger(rate=1)])
    for event in (Event(at_s=5, robot_removed="a"), moved(5, "a", 2.0, 9.0)):
        simulation = Simulation(given, plan_of(a=["dock", "t0"], b=["dock", "t1"]))
        while simulation.status.robots["a"].activity != "charging at dock":
            simulation.advance(simulation.time_s + 0.5)
        begun_s = simulation.time_s
        simulation.report(event)
        while simulation.status.robots["b"].activity != "charging at dock":
            simulation.advance(simulation.time_s + 0.5)
            assert simulation.time_s < begun_s + 10


HALL = Map(
    boundary=((0, 0), (20, 0), (20, 10), (0, 10)),
    zones=(
        Zone(polygon=((5, 4), (7, 4), (7, 6), (5, 6))),
        Zone(id="d", open=False, polygon=((9, 0), (10, 0), (10, 10), (9, 10))),
    ),
)
IN_HALL = Mission(
    robots=(Robot(id="a", position=(1, 1), radius_m=0.3), Robot(id="b", position=(1, 3), radius_m=0.3)),
    tasks=(Task(id="0", position=(4, 1), duration_s=5),),
    map=HALL,
)
FREE = "expected a place where a is free"


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ((6.0, 5.0), rf"robot_moved\.position: \[6\.0, 5\.0\]; {FREE}"),
        ((4.8, 5.0), FREE),  # its body would be in the wall
        ((9.5, 5.0), FREE),  # a door that is closed
        ((25.0, 5.0), FREE),
        ((0.1, 5.0), FREE),
        ((1.0, 3.4), r"expected a place clear of b, which is at \[1\.0, 3\.0\]"),
        ((1.0, 3.0, 2.0), r"robot_moved\.position: \[1\.0, 3\.0, 2\.0\]; expected 2 coordinates"),
    ],
)
def test_nobody_can_put_a_robot_where_it_cannot_stand(place, said):
    simulation = Simulation(IN_HALL, plan_of(a=["0"]))
    simulation.advance(0.5)
    before = simulation.positions
    with pytest.raises(ParameterError, match=said) as refused:
        simulation.report(moved(0, "a", *place))
    assert "\n" not in str(refused.value)
    assert simulation.positions == before
    assert not told(simulation, "robot_moved")


@pytest.mark.parametrize("travel", ["map", "euclidean"])
def test_an_event_of_the_mission_that_does_not_fit_is_told_and_nothing_moves(travel):
    mission = muster.Mission(
        **{
            **IN_HALL.__dict__,
            "events": (moved(1, "a", 6.0, 5.0), Event(at_s=1, robot_moved=MovedRobot(robot="b", position=(2.0, 8.0)))),
        }
    )
    simulation = over(mission, plan_of(a=["0"]))
    (refused,) = told(simulation, "event_refused")
    assert FREE in refused["reason"]
    assert [one["robot"] for one in told(simulation, "robot_moved")] == ["b"]
    assert simulation.positions["b"][:2] == (2.0, 8.0)


def test_one_that_was_taken_away_comes_back_only_where_there_is_room():
    simulation = Simulation(IN_HALL, plan_of(a=["0"]))
    simulation.report(Event(at_s=0, robot_removed="b"))
    with pytest.raises(ParameterError, match=r'robot_moved\.robot: "b"; expected one that was not taken away'):
        simulation.report(moved(0, "b", 2.0, 8.0))
    simulation.report(moved(0, "a", 1.0, 3.2))
    with pytest.raises(ParameterError, match=r"robot_returns\.position: \[1\.0, 3\.0\]; expected a place clear of a"):
        simulation.report(Event(at_s=0, robot_returns="b"))
    assert simulation.status.robots["b"].out
    simulation.report(moved(0, "a", 1.0, 1.0))
    simulation.report(Event(at_s=0, robot_returns="b"))
    assert not simulation.status.robots["b"].out
    assert simulation.positions["b"][:2] == (1.0, 3.0)


def test_one_that_stood_at_a_wall_or_in_a_door_that_has_closed_comes_back_there():
    """Robots come nearer to walls than their radius by a little, and doors close on them."""
    open_door = Zone(id="d", open=True, polygon=HALL.zones[1].polygon)
    robots = tuple(replace(one, position=at) for one, at in zip(IN_HALL.robots, ((1, 0.3), (9.5, 5)), strict=True))
    mission = replace(IN_HALL, robots=robots, map=replace(HALL, zones=(HALL.zones[0], open_door)))
    simulation = Simulation(mission, plan_of(a=["0"]))
    simulation.world.place("a", (1.0, 0.29999))
    simulation.advance(0.1)
    for name in "ab":
        simulation.report(Event(at_s=0, robot_removed=name))
    simulation.report(Event(at_s=0, door_closes="d"))
    for name in "ab":
        simulation.report(Event(at_s=0, robot_returns=name))
        assert not simulation.status.robots[name].out
