"""Robots that compare their scans with the map know where they are, though their wheels err."""

import math

import pytest

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.running.localisation import require_possible, sensors_of
from muster.running.simulation import Simulation
from muster.simulation import Noise

pytest.importorskip("shapely")
GOALS = ((7.0, 1.0), (7.0, 5.0), (1.0, 5.0), (1.0, 1.0))


def rounds(count=1, chart=True):
    """A robot that goes round a room with a box in it, which looks different from each side."""
    box = Zone(polygon=((2.0, 2.5), (4.0, 2.5), (4.0, 3.5), (2.0, 3.5)), forbidden_to=("ground",))
    room = Map(boundary=((0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (4.5, 6.0), (4.5, 5.4), (0.0, 5.4)), zones=(box,))
    tasks = [Task(id=f"{k}", position=GOALS[k % 4]) for k in range(4 * count)]
    chained = [
        task if k == 0 else Task(**{**vars(task), "prerequisites": (f"{k - 1}",)}) for k, task in enumerate(tasks)
    ]
    robot = Robot(id="r", position=(1.0, 1.0), kinematics="differential-drive", radius_m=0.2, speed_mps=1.5)
    return Mission(
        name="rounds",
        robots=(robot,),
        tasks=tuple(chained),
        map=room if chart else None,
        rules=Rules(travel="map" if chart else None),
    )


def last_error_m(localise, seed):
    """How far from its last goal the robot truly is in the end."""
    mission = rounds()
    plan = muster.solve(mission, allocator="greedy")
    simulation = Simulation(mission, plan, noise=Noise(slip=0.1, odometry=0.05), localise=localise, seed=seed)
    while not simulation.done and simulation.time_s < 300:
        simulation.advance(300.0)
    return math.dist(simulation.world.positions[0, :2], mission.tasks[-1].position)


@pytest.mark.long
def test_scans_bring_a_robot_to_its_goals():
    assert last_error_m("odometry,scans", 0) < 0.15


def test_without_scans_it_is_led_astray():
    assert max(last_error_m("odometry", seed) for seed in range(3)) > 0.2


def test_scans_need_a_map():
    with pytest.raises(ParameterError, match="scans in mission rounds; expected a mission that travels by its map"):
        require_possible(sensors_of("odometry,scans"), rounds(chart=False))
