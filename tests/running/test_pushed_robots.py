"""Real robots that people push elsewhere or take away: they say themselves where they are."""

from dataclasses import replace

import pytest
from tests.running.test_live import WorldAsFleet

import muster
from muster.mission.errors import ParameterError
from muster.mission.events import MovedRobot
from muster.mission.model import Event, Map, Mission, Robot, Task, Zone
from muster.running.live import Live

WALLS = tuple(Zone(polygon=((8, low), (8.3, low), (8.3, high), (8, high))) for low, high in ((0, 4.4), (5.6, 10)))
"""Of two halls with a door 1.2 m wide between them."""
HALLS = Map(boundary=((0, 0), (16, 0), (16, 10), (0, 10)), zones=WALLS)


def halls(count=4, **task):
    """Robots in one hall, and tasks of them in the other, crosswise."""
    robots = tuple(Robot(id=f"r_{k}", position=(1.5, 1.5 + 2.0 * k), radius_m=0.3) for k in range(count))
    tasks = tuple(
        Task(id=f"t_{k}", position=(14.0, 8.5 - 2.0 * k), only_robots=(f"r_{k}",), **task) for k in range(count)
    )
    return Mission(robots=robots, tasks=tasks, map=HALLS)


def live(there, pushes=(), traffic="reserve", told=()):
    """A run to its end: `pushes` are times, robots and where bodies are put; `told` times and what operators report."""
    fleet, pushes, told = WorldAsFleet(there), list(pushes), list(told)
    run = Live(there, muster.solve(there, iterations=50), fleet, traffic=traffic)
    while not run.done and run.time_s < 300:
        run.look()
        run.hear(run.time_s + 0.2)
        while pushes and pushes[0][0] <= run.time_s:
            _, robot, place = pushes.pop(0)
            fleet.world.place(robot, place)
        while told and told[0][0] <= run.time_s:
            run.executor.come_to(run.time_s)
            run.executor.report(told.pop(0)[1])
    run.stop()
    assert run.done
    return run, fleet


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("traffic", ["reserve", "free"])
@pytest.mark.parametrize(
    "pushes",
    [
        [(4.0, "r_0", (5.0, 1.0)), (4.0, "r_3", (2.0, 3.0))],  # aside, on the way to the door
        [(7.0, "r_1", (4.0, 9.0)), (7.0, "r_2", (10.0, 1.0))],  # back, and through the wall
        [(9.0, "r_2", (12.0, 9.0)), (9.4, "r_2", (2.0, 9.0))],
    ],
)
def test_robots_that_are_pushed_without_a_word_get_on_from_where_they_say_that_they_are(pushes, traffic):
    there = halls()
    run, fleet = live(there, pushes, traffic)
    assert run.result().tasks_lost == ()
    assert fleet.world.contacts == ()
    assert not [event for event in run.events if event.kind in ("robot_stuck", "robot_moved")]


def test_one_of_whom_an_operator_says_that_it_was_moved_begins_its_work_again():
    there = halls(1, duration_s=20)
    at = (2.0, 8.0)
    told = [(30.0, Event(at_s=0, robot_moved=MovedRobot(robot="r_0", position=at)))]
    run, _ = live(there, [(30.0, "r_0", at)], "auto", told)
    assert [event.kind for event in run.events if event.kind in ("starts", "robot_moved", "ends")] == [
        "starts",
        "robot_moved",
        "starts",
        "ends",
    ]


def test_one_that_an_operator_takes_away_stops_and_others_pass_where_it_was():
    there = halls()
    there = replace(there, tasks=tuple(replace(task, only_robots=None) for task in there.tasks))
    gone, back = Event(at_s=0, robot_removed="r_1"), Event(at_s=0, robot_returns="r_1")
    run, fleet = live(there, [(5.2, "r_1", (15.0, 0.7))], told=[(5.0, gone), (14.0, back)])
    assert run.result().tasks_lost == ()
    assert fleet.world.contacts == ()
    moved = [event.time_s for event in run.events if event.data.get("robot") == "r_1" and event.kind == "sets_out"]
    assert all(time_s < 5.2 or time_s >= 14.0 for time_s in moved)


def test_a_real_robot_comes_back_where_it_says_that_it_is_also_where_another_is_where_it_was():
    there = halls(2)
    fleet = WorldAsFleet(there)
    run = Live(there, muster.solve(there, iterations=50), fleet)

    def go_on(seconds):
        until_s = run.time_s + seconds
        while run.time_s < until_s:
            run.look()
            run.hear(run.time_s + 0.2)
        run.executor.come_to(run.time_s)

    go_on(0.4)
    run.executor.report(Event(at_s=0, robot_removed="r_0"))
    was = fleet.world.ports["r_0"].telemetry().position[:2]
    fleet.world.place("r_0", (4.0, 9.0))
    run.executor.report(Event(at_s=0, robot_moved=MovedRobot(robot="r_1", position=was)))
    fleet.world.place("r_1", was)
    go_on(0.4)
    run.executor.report(Event(at_s=0, robot_returns="r_0"))
    assert not run.status.robots["r_0"].out
    with pytest.raises(
        ParameterError, match=r"^robot_moved\.position: \[8\.1, 2\.0\]; expected a place where r_0 is free$"
    ):
        run.executor.report(Event(at_s=0, robot_moved=MovedRobot(robot="r_0", position=(8.1, 2.0))))
    run.stop()
