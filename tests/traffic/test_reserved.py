"""Traffic by reservation in the kinematic world: where there is space for one, all get through and nobody touches."""

from __future__ import annotations

import pytest

from muster import ParameterError, Simulation, solve
from muster.generation import narrow

COUNTS = {"one_way_door": 8, "two_way_door": 6, "corridor": 8, "aisles": 4, "dead_ends": 4}
KINEMATICS = ("holonomic", "differential-drive", "holonomic", "differential-drive", "differential-drive")


@pytest.mark.long
@pytest.mark.parametrize(("scene", "kinematics"), list(zip(COUNTS, KINEMATICS, strict=True)))
def test_all_get_through(scene, kinematics):
    mission = getattr(narrow, scene)(kinematics, 1, COUNTS[scene])
    simulation = Simulation(mission, solve(mission, "greedy"), traffic="reserve")
    while not simulation.done:
        simulation.advance(simulation.time_s + 10.0)
        assert simulation.time_s < 600.0
    report = simulation.result()
    assert len(report.tasks_done) == len(mission.tasks)
    assert (report.contacts, report.tasks_lost) == (0, ())


@pytest.mark.long
@pytest.mark.parametrize("scene", [(1, 2), pytest.param((2, 3), marks=pytest.mark.long)], ids=str)
def test_it_is_the_same_again(scene):
    mission = narrow.aisles("holonomic", *scene)
    plan = solve(mission, "greedy")
    times = []
    for _ in range(2):
        simulation = Simulation(mission, plan, traffic="reserve")
        while not simulation.done:
            simulation.advance(simulation.time_s + 10.0)
        times.append([(event.time_s, event.kind) for event in simulation.events])
    assert times[0] == times[1]


def test_an_unknown_manager_is_refused():
    mission = narrow.pair("holonomic", 0)
    with pytest.raises(ParameterError, match="\"reserv\"; expected auto or free or reserve; did you mean 'reserve'"):
        Simulation(mission, solve(mission, "greedy"), traffic="reserv")
