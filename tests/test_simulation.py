"""`muster.Simulation`: a mission carried out as far as one lets it, and told what the mission file did not foresee."""

from dataclasses import replace

import pytest

import muster
from muster import Event, Mission, ParameterError, Robot, Task
from muster.simulation import Noise


@pytest.fixture
def mission():
    return Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(0, 5))),
        tasks=(Task(id="x", position=(10, 0)), Task(id="y", position=(12, 5))),
    )


@pytest.fixture
def simulation(mission):
    return muster.Simulation(mission, muster.solve(mission, iterations=100))


def test_it_stops_where_something_happens(simulation):
    happened = simulation.advance(until_s=100)
    assert {one.kind for one in happened} >= {"arrives", "starts", "ends"}
    assert simulation.time_s == pytest.approx(10, abs=0.11)


def test_it_goes_no_further_than_told(simulation):
    assert list(simulation.advance(until_s=3.0)) == []
    assert simulation.time_s == pytest.approx(3.0)
    assert simulation.positions["a"] == pytest.approx((3, 0, 0), abs=1e-6)
    assert not simulation.done


def test_a_time_within_a_step_is_its_end(mission):
    late = replace(mission, events=(Event(at_s=2.04, robot_fails="a"),))
    simulation = muster.Simulation(late, muster.solve(late, iterations=100))
    assert [one.kind for one in simulation.advance(until_s=9.99)] == ["robot_fails", "replanned", "sets_out"]
    assert simulation.time_s == pytest.approx(2.1)
    simulation.advance(until_s=2.25)
    assert simulation.time_s == pytest.approx(2.3)


def test_to_the_end_it_is_what_simulate_does(mission, simulation):
    while not simulation.done:
        simulation.advance(until_s=1000)
    assert simulation.result() == muster.simulate(mission, muster.solve(mission, iterations=100))
    assert simulation.advance(until_s=2000) == []


def test_events_from_outside_change_plan_and_world(simulation):
    simulation.advance(until_s=3.0)
    simulation.report(Event(at_s=0, robot_fails="a"))
    simulation.report(Event(at_s=0, new_task=Task(id="z", position=(0, 9))))
    simulation.report(Event(at_s=0, robot_joins=Robot(id="c", position=(0, 10))))
    while not simulation.done:
        simulation.advance(until_s=1000)
    report = simulation.result()
    assert sorted(report.tasks_done) == ["x", "y", "z"]
    assert simulation.positions["a"] == pytest.approx((3, 0, 0), abs=0.11)
    assert [robot.robot for robot in report.robots] == ["a", "b", "c"]
    assert {route.robot: route.tasks for route in simulation.plan.routes}["a"] == ()


def test_events_that_do_not_fit_change_nothing(simulation):
    for wrong, message in (
        (Event(at_s=0, robot_fails="ghost"), "ghost"),
        (Event(at_s=0, robot_joins=Robot(id="a", position=(0, 0))), "a"),
        (Event(at_s=0, new_task=Task(id="x", position=(0, 0))), "new_task"),
        (Event(at_s=0, new_task=Task(id="n", position=(0, 0, 1))), "new_task: n"),
        (Event(at_s=0, new_task=Task(id="n", position=(0, 0), prerequisites=("zzz",))), "zzz"),
    ):
        with pytest.raises(ParameterError, match=message):
            simulation.report(wrong)
    while not simulation.done:
        simulation.advance(until_s=1000)
    assert simulation.result().reallocations == 0


def test_a_plan_from_elsewhere_is_told_its_objective(mission):
    plan = muster.Plan(routes=(muster.Route("a", ("x",)), muster.Route("b", ("y",))))
    objective = muster.simulate(mission, plan).objective
    assert (objective.name, objective.planned) == ("total+max", pytest.approx(10 + 12 + 12))


def test_what_changes_nothing_is_told_all_the_same(simulation):
    while "x" not in simulation.result().tasks_done:
        simulation.advance(until_s=1000)
    simulation.report(Event(at_s=0, cancel_task="x"))
    assert [one.kind for one in simulation.events][-1] == "without_effect"
    assert simulation.result().tasks_done == ("x",)


def test_a_mission_that_is_over_goes_on_when_a_task_is_added(simulation):
    while not simulation.done:
        simulation.advance(until_s=1000)
    over_s = simulation.time_s
    simulation.report(Event(at_s=0, cancel_task="x"))
    assert simulation.done
    simulation.report(Event(at_s=0, new_task=Task(id="z", position=(0, 0))))
    while not simulation.done:
        simulation.advance(until_s=1000)
    assert simulation.result().tasks_done[-1] == "z"
    assert simulation.time_s > over_s


def test_the_mission_lasts_until_the_last_thing_happened():
    """A robot that fails on its way has used up time, though it has done nothing."""
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)),),
        tasks=(Task(id="x", position=(10, 0)),),
        events=(Event(at_s=6, robot_fails="a"),),
    )
    report = muster.simulate(mission, muster.solve(mission, "greedy"))
    assert report.mission_time_s == pytest.approx(6)
    assert report.tasks_lost == (("x", "no robot takes part any more; no longer taking part: a (failed at 6 s)"),)


def test_options_of_the_world(mission):
    plan = muster.solve(mission, "greedy")
    assert muster.simulate(mission, plan, noise=Noise(slip=0.5), dt_s=0.05).objective.flown > 30
