"""Measured charges in bids: of two equal robots the one with the emptier battery loses."""

from dataclasses import replace

import numpy as np
import pytest

import muster
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.stop import Stop
from muster.mission.model import Battery, Mission, Robot
from muster.model.measured_energy import Drains, EnergyLeft
from muster.model.problem import Problem
from muster.running.simulation import Simulation


def two_equal(**given):
    return muster.Mission(
        rules=muster.Rules(objective="total"),
        robots=tuple(
            muster.Robot(id=name, position=(x, 0), work_capacity=100, **given) for name, x in (("a", 0), ("b", 20))
        ),
        tasks=(muster.Task(id="t", position=(10, 0)),),
    )


def winner(charges, weight=1.0):
    problem = replace(Problem.compile(two_equal()), energy_left=charges).ready()
    plan = AUCTION.solve(problem, Stop(), seed=0, params=Parameters(battery_weight=weight), start=None)
    (robot,) = (route.robot for route in plan.routes if route.tasks)
    return robot


@pytest.mark.parametrize(("left", "expected"), [((0.3, 0.9), "b"), ((0.9, 0.3), "a"), ((0.5, 0.5), "a")])
def test_of_two_equal_robots_the_emptier_loses(left, expected):
    assert winner(tuple(EnergyLeft(left=share, capacity=100.0) for share in left)) == expected


def test_without_a_weight_or_without_measurement_charges_do_not_count():
    assert winner((EnergyLeft(left=0.1, capacity=100.0), EnergyLeft(left=1.0, capacity=100.0)), weight=0.0) == "a"
    assert winner(()) == winner((None, None)) == "a"


def test_shares_are_what_is_gone_and_what_the_route_adds():
    charges = (EnergyLeft(left=0.6, used=10.0, capacity=50.0), None, EnergyLeft(left=0.25))
    drains = Drains.of(charges, np.array([20.0, 40.0, np.inf]))
    usages = np.array([20.0, 10.0, 99.0])
    np.testing.assert_allclose(drains.shares(usages, slice(None)), [0.4 + 10 / 50, 10 / 40, 0.75])
    assert drains.shares(np.array(60.0), 0) == pytest.approx(1.0)  # at most all of it


def test_a_part_of_a_problem_has_the_charges_of_its_robots():
    charges = (EnergyLeft(left=0.3), EnergyLeft(left=0.9))
    part = replace(Problem.compile(two_equal()), energy_left=charges).part([1], [0])
    assert part.energy_left == charges[1:]


def test_the_rest_of_a_mission_is_sold_by_measured_charges():
    """A task appears midway between two equal robots; the one whose battery began emptier does not get it."""
    mission = replace(
        two_equal(),
        tasks=(muster.Task(id="far", position=(10, 90)),),
        events=(muster.Event(at_s=1, new_task=muster.Task(id="t", position=(10, 0))),),
    )
    planning = muster.planning.options.PlanningOptions(allocator="auction", parameters={"battery_weight": 4.0})

    def doer(charges):
        plan = muster.Plan(routes=())
        simulation = Simulation(mission, plan, planning=planning, batteries=charges)
        while not simulation.done and simulation.time_s < 120:
            simulation.advance(simulation.time_s + 5)
        return {row.task: row.robot for row in simulation.result().tasks}["t"]

    assert doer({"a": 0.5, "b": 1.0}) == "b"
    assert doer({"a": 1.0, "b": 0.5}) == "a"


def test_robots_with_batteries_and_no_task():
    robots = tuple(Robot(id=f"r{k}", position=(k, 0), battery=Battery(capacity=5)) for k in range(3))
    mission = Mission(robots=robots, tasks=())
    assert Problem.compile(mission).energy_reaches.shape == (3, 0)
    assert muster.check(mission).impossible == ()
