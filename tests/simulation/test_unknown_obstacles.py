"""A robot without a map: it gets through wherever there is a way, touches nothing, and says where there is none."""

import math

import numpy as np
import pytest

from muster import Map, Mission, Robot, Zone
from muster.mission.errors import ParameterError
from muster.motion.map_world import Body, World
from muster.motion.path import NoPath
from muster.motion.paths.robot_paths import RobotPaths
from muster.perception.laser import Scanner
from muster.simulation.unknown_obstacles import Parameters, drive

BODY = Body(0.2, "ground")


def world_of(*boxes, size=(12, 8)):
    width, height = size
    zones = tuple(
        Zone(polygon=((x, y), (x + w, y), (x + w, y + h), (x, y + h)), forbidden_to=("ground", "air"))
        for x, y, w, h in boxes
    )
    chart = Map(boundary=((0, 0), (width, 0), (width, height), (0, height)), zones=zones)
    robot = Robot(id="r", position=(0.5, height / 2), radius_m=BODY.radius_m)
    return World.of(Mission(name="boxes", map=chart, robots=(robot,), tasks=()))


def least_clearance(found, world):
    steps = zip(found.poses[:-1, :2], found.poses[1:, :2], strict=True)
    fine = np.concatenate([np.linspace(a, b, 8) for a, b in steps])
    return world.clearance(fine, "ground").min()


def test_without_obstacles_it_goes_straight():
    found = drive(world_of(), BODY, (0.5, 4, 0), (11.5, 4), Parameters())
    assert found.path.length_m == pytest.approx(11, abs=0.06)
    assert found.ways == 1


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("turning_radius_m", [None, 0.1])
def test_it_gets_round_boxes_and_touches_none(seed, turning_radius_m):
    random = np.random.default_rng(seed)
    world = world_of(*((*random.uniform((2, 1), (10, 6)), *random.uniform(0.2, 1.2, 2)) for _ in range(7)))
    params = Parameters(turning_radius_m=turning_radius_m)
    known = RobotPaths(world).path(BODY, (0.5, 4), (11.5, 4))
    found = drive(world, BODY, (0.5, 4, 0), (11.5, 4), params)
    assert math.dist(found.poses[-1, :2], (11.5, 4)) <= params.arrival_m
    assert least_clearance(found, world) > (0.999 if turning_radius_m is None else 0.8) * BODY.radius_m
    assert found.path.length_m < 1.5 * known.length_m
    turns = np.abs(np.remainder(np.diff(found.poses[:, 2]) + np.pi, 2 * np.pi) - np.pi)
    assert turning_radius_m is None or turns.max() <= params.step_m / turning_radius_m + 1e-9


def test_it_remembers_a_pocket_and_leaves_it():
    """A robot without memory goes to and fro in it: the goal is behind its bottom."""
    world = world_of((6, 1, 0.3, 6), (3, 6.7, 3.3, 0.3), (3, 1, 3.3, 0.3))
    known = RobotPaths(world).path(BODY, (4, 4), (11.5, 4))
    found = drive(world, BODY, (4, 4, 0), (11.5, 4), Parameters())
    assert found.path.length_m < 2 * known.length_m
    assert least_clearance(found, world) > 0.999 * BODY.radius_m


def test_scans_with_errors_and_strays_make_a_map_that_leads_there():
    world = world_of((4, 2, 0.5, 4), (8, 0, 0.5, 5))
    noisy = Scanner(field_rad=6.2, step_rad=math.radians(1), reach_m=8, range_m=0.005, stray_share=0.002)
    found = drive(world, BODY, (0.5, 4, 0), (11.5, 4), Parameters(scanner=noisy), seed=3)
    assert math.dist(found.poses[-1, :2], (11.5, 4)) <= 0.05
    assert least_clearance(found, world) > 0.8 * BODY.radius_m


def test_that_there_is_no_way_is_said_when_the_map_proves_it():
    world = world_of((8, 2, 3, 0.3), (8, 5, 3, 0.3), (8, 2, 0.3, 3.3), (11, 2, 0.3, 3.3))
    found = drive(world, BODY, (0.5, 4, 0), (9.5, 3.5), Parameters())
    assert isinstance(found, NoPath)
    assert found.reason == "disconnected"


@pytest.mark.parametrize("name", ["turning_radius_m", "step_m", "patience"])
def test_parameters_check_themselves(name):
    with pytest.raises(ParameterError, match=name):
        Parameters(**{name: 0})
