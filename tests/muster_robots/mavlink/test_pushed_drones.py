"""Drones that the wind or people carry elsewhere, or take away: they say themselves where they are."""

import math

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.mission.errors import ParameterError
from muster.mission.events import MovedRobot
from muster.mission.model import Event
from muster.running.live import Live


def flown(there, *happenings):
    """A run to its end; happenings are times, and what then happens to the run and the sky."""
    sky, happenings = Sky(there), list(happenings)
    fleet = sky.fleet(there)
    try:
        run = Live(there, muster.solve(there, iterations=50), fleet)
        while not run.done and run.time_s < 300:
            run.look()
            run.hear(run.time_s + 0.2)
            while happenings and happenings[0][0] <= run.time_s:
                run.executor.come_to(run.time_s)
                happenings.pop(0)[1](run, sky)
        run.stop()
    finally:
        fleet.close()
        sky.close()
    assert run.done
    assert not happenings
    return run


def let_happen(**what):
    return lambda run, sky: run.executor.report(Event(at_s=0, **what))


def carry(robot, north_m, east_m):
    def happen(run, sky):
        flight = sky.drones[robot].flight
        flight.place = (flight.place[0] + north_m, flight.place[1] + east_m, flight.place[2])

    return happen


def test_a_drone_that_is_carried_off_flies_on_from_where_it_says_that_it_is():
    there = mission(2)
    run = flown(there, (6.0, carry("r_0", -8.0, 3.0)), (9.0, carry("r_1", 5.0, -12.0)))
    assert run.result().tasks_lost == ()
    assert not {event.kind for event in run.events} & {"robot_stuck", "robot_fails", "robot_moved"}
    assert sum(row.usage_flown - row.usage_planned for row in run.result().robots) > 10


def test_a_drone_that_an_operator_takes_out_of_the_mission_hovers_until_it_returns():
    there, places = mission(2), []

    def note(run, sky):
        places.append(run.executor.crew["r_0"].position)

    gone, back = let_happen(robot_removed="r_0"), let_happen(robot_returns="r_0")
    run = flown(there, (6.0, gone), (8.0, note), (10.0, note), (11.0, back))
    assert math.dist(*places) < 0.05
    assert run.result().tasks_lost == ()
    (replanned, *_) = [event for event in run.events if event.kind == "replanned"]
    assert replanned.data["causes"][0]["kind"] == "robot_removed"
    assert not run.executor.crew["r_0"].out


def test_an_operator_says_where_a_drone_was_put_and_it_is_refused_within_another():
    there = mission(2)

    def put(run, sky):
        x, y, z = run.executor.crew["r_1"].position
        with pytest.raises(
            ParameterError, match=r"^robot_moved\.position: .*; expected a place clear of r_1, which is at"
        ):
            run.executor.report(Event(at_s=0, robot_moved=MovedRobot(robot="r_0", position=(x + 0.3, y, z))))
        carry("r_0", -6.0, 0.0)(run, sky)
        x, y, z = run.executor.crew["r_0"].position
        run.executor.report(Event(at_s=0, robot_moved=MovedRobot(robot="r_0", position=(x, y - 6.0, z))))

    run = flown(there, (6.0, put))
    assert run.result().tasks_lost == ()
    assert [event.robot for event in run.events if event.kind == "robot_moved"] == ["r_0"]
