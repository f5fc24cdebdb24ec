"""Robots that follow trajectories: where they are at each moment, that they wait for others, and that they arrive."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.simulation.scenes import mission, robot, send_across, states, until_idle

import muster
from muster.motion.kinematics.registry import limits_of, turning_radius_of
from muster.motion.order_trajectory import STEP_S, TrajectoryMaker
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld

KINDS = ("holonomic", "differential-drive", "quadcopter")
COORDINATE = st.floats(-8, 8).map(lambda x: round(x, 3))


def maker(body, clear=lambda points: True):
    faces = body.kinematics == "differential-drive"
    return TrajectoryMaker(limits_of(body), faces, turning_radius_of(body), clear, 2)


def test_a_trajectory_passes_its_way_points_when_it_says():
    body = robot(kinematics="differential-drive", speed_mps=0.5, acceleration_mps2=0.5)
    points = [Waypoint((3, 0, 0)), Waypoint((3, 3, 0), label="a"), Waypoint((0, 3, 0), hold_s=2.0), Waypoint((0, 0, 0))]
    made = maker(body).trajectory((0.0, 0.0, 0.0, 0.0), points)
    assert (np.diff(made.times) > 0).all()
    places = made.poses[np.round(made.times / STEP_S).astype(int), :2]
    off = np.linalg.norm(places - [point.position[:2] for point in points], axis=1)
    assert off[0] < 0.2  # near
    assert (off[1:] < 0.011).all()  # through, within half a step
    speeds = np.linalg.norm(np.diff(made.poses[:, :2], axis=0), axis=1) / STEP_S
    assert speeds.max() <= 0.5 * 0.95 + 1e-9
    assert np.abs(np.diff(made.poses[:, 3])).max() / STEP_S <= math.pi / 2 * 0.95 + 1e-9
    # It stands at the way point where it holds, not at the others.
    assert speeds[round(made.times[2] / STEP_S) - 1] < 0.02
    assert speeds[round(made.times[1] / STEP_S) - 1] > 0.3


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(
    kind=st.sampled_from(KINDS),
    places=st.lists(st.tuples(COORDINATE, COORDINATE), min_size=1, max_size=5),
    acceleration=st.sampled_from([None, 0.5, 2.0]),
    speed=st.sampled_from([0.26, 1.0]),
)
def test_a_robot_alone_is_where_its_trajectory_is(kind, places, acceleration, speed):
    one = robot(kinematics=kind, acceleration_mps2=acceleration, speed_mps=speed)
    world = KinematicWorld(mission(one), law="trajectory")
    points = [Waypoint((x, y, 0.0), label="w") for x, y in places]
    world.ports["r"].send(points)
    made = maker(one).trajectory((0.0, 0.0, 0.0, 0.0), points)
    positions, _, velocities = states(world, round(made.times[-1] / 0.1) + 30)
    clock = np.arange(len(positions)) * 0.1
    index = np.minimum(np.round(clock / STEP_S).astype(int), len(made.poses) - 1)
    off = np.linalg.norm(positions[:, 0, :2] - made.poses[index, :2], axis=1)
    assert off.max() < 0.1 * speed + 0.03
    assert np.linalg.norm(velocities[:, 0], axis=1).max() <= speed + 1e-9
    assert positions[-1, 0, :2] == pytest.approx(places[-1], abs=0.021)
    assert world.idle("r")


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_goes_through_bends_instead_of_stopping(kind):
    """Around a square: a differential drive by profiles turns on the spot at each corner."""

    def seconds(law):
        world = KinematicWorld(mission(robot(kinematics=kind, acceleration_mps2=1.0)), law=law)
        world.ports["r"].send([Waypoint((x, y, 0.0)) for x, y in ((6, 0), (6, 6), (0, 6), (0, 0))])
        return until_idle(world, 100)["r"]

    assert seconds("trajectory") < seconds("profile")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("avoidance", ["orca", "rvo", "hrvo"])
def test_a_crowd_on_trajectories_exchanges_places_without_contact(kind, avoidance):
    team = mission(
        *(
            robot(f"r_{k}", (4 * math.cos(k), 4 * math.sin(k)), kinematics=kind, radius_m=0.3, acceleration_mps2=1.0)
            for k in range(6)
        )
    )
    world = KinematicWorld(team, law="trajectory", avoidance=avoidance, seed=1)
    send_across(world, team)
    assert len(until_idle(world, 400)) == 6
    assert not world.contacts


def test_a_robot_waits_and_goes_on_where_another_stands_on_its_way():
    team = mission(
        robot("r", (0.0, 0.0), kinematics="differential-drive", radius_m=0.3),
        robot("dead", (4.0, 0.0), radius_m=0.3),
    )
    world = KinematicWorld(team, law="trajectory", seed=1)
    world.fail("dead")
    world.ports["r"].send([Waypoint((8.0, 0.0, 0.0))])
    assert until_idle(world, 120).keys() == {"r"}
    assert not world.contacts


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("world", ["kinematic", "physics"])
def test_a_mission_is_carried_out_on_trajectories(world):
    if world == "physics" and find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
        pytest.skip("the extra `physics` is not installed")
    shipped = muster.load("6T-2R")
    plan = muster.solve(shipped, iterations=50)
    report = muster.simulate(shipped, plan, world=world, law="trajectory")
    assert (len(report.tasks_done), report.contacts) == (6, 0)


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "tasks"), [(0, 3), *(pytest.param(seed, None, marks=pytest.mark.long) for seed in range(2))]
)
def test_walls_stop_no_trajectory(seed, tasks):
    floor = muster.load("floor")
    shipped = replace(floor, tasks=floor.tasks[:tasks])
    plan = muster.solve(shipped, iterations=30, seed=seed)
    report = muster.simulate(shipped, plan, law="trajectory", seed=seed)
    assert (report.tasks_lost, report.contacts) == ((), 0)
