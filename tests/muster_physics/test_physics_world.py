"""What only a world with masses and forces shows: bodies as published, walls that stop, missions carried out."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot, until_idle

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.motion.port import Waypoint
from muster.running.simulation import carry_out
from muster.running.worlds import world_named

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster_physics import PhysicsWorld
from muster_physics.bodies import FLYING, TRACK_M, WHEEL_RADIUS_M, BodyKind, RobotBody
from muster_physics.control import Control
from muster_physics.controller import Commands
from muster_physics.model import PlacedRobot
from muster_physics.scenery import Scenery
from muster_physics.simulated_model import SimulatedModel

WAFFLE = {"kinematics": "differential-drive", "radius_m": 0.3, "speed_mps": 0.26, "yaw_rate_radps": 1.82}
DRONE = {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.7, "speed_mps": 0.5, "yaw_rate_radps": 2.5}
PLAIN = Scenery(None, (), 0.0)
WALL_AHEAD = np.array([[1.0, -2.0, 1.0, 2.0, -math.inf, math.inf]])


def standing(build, *, position=(0.0, 0.0, 0.0), walls=0):
    return PlacedRobot(RobotBody(build, 1.0), position, 0.0, walls)


def extent(model, data):
    """Of all geoms of the robot, along x, y and z."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] == 0:
            continue
        axes, half = data.geom_xmat[geom].reshape(3, 3), model.geom_aabb[geom, 3:]
        reach = np.abs(axes) @ half
        middle = data.geom_xpos[geom] + axes @ model.geom_aabb[geom, :3]
        low, high = np.minimum(low, middle - reach), np.maximum(high, middle + reach)
    return high - low


def test_the_wafflebot_is_that_of_table_a20():
    simulated = PhysicsWorld(mission(robot(**WAFFLE))).simulated
    assert simulated.model.body_subtreemass[simulated.bodies[0]] == pytest.approx(1.8)
    assert extent(simulated.model, simulated.data) == pytest.approx((0.281, 0.306, 0.141), abs=0.012)


def test_a_robot_of_half_the_radius_is_half_as_large():
    simulated = PhysicsWorld(mission(robot(**WAFFLE | {"radius_m": 0.15}))).simulated
    assert simulated.model.body_subtreemass[simulated.bodies[0]] == pytest.approx(1.8 / 8)
    assert extent(simulated.model, simulated.data) == pytest.approx((0.1405, 0.153, 0.0705), abs=0.006)


@pytest.mark.long
@pytest.mark.parametrize("build", list(BodyKind))
def test_walls_stop_bodies(build):
    at = (0.0, 0.0, 1.0 if build in FLYING else 0.0)
    for walls, far in (([WALL_AHEAD], False), ([np.empty((0, 6))], True)):
        simulated = SimulatedModel([standing(build, position=at)], walls, PLAIN, 0.005)
        control = Control(simulated, keeps_height=True)
        ahead = Commands(np.array([[0.3, 0.0, 0.0, 0.0]]), np.array([0.3]))
        for _ in range(60):
            poses = control.carry_out(ahead, 20).poses
        assert (poses[0, 0] > 1.5) == far
        if not far:
            assert poses[0, 0] == pytest.approx(1.0 - simulated.robots[0].body.size_m[0] / 2, abs=0.03)


def test_wheels_cannot_slide_sideways():
    simulated = SimulatedModel([standing(BodyKind.WHEELS)], [np.empty((0, 6))], PLAIN, 0.005)
    control = Control(simulated, keeps_height=True)
    for _ in range(20):
        poses = control.carry_out(Commands(np.array([[0.0, 0.2, 0.0, 0.0]]), np.zeros(1)), 20).poses
    assert abs(poses[0, 1]) < 0.005


@pytest.mark.parametrize("scale", [1 / 3, 1.0, 3.0])
def test_bodies_do_not_outrun_their_wheels(scale):
    """With MuJoCo's implicit integrators they do, by half."""
    simulated = SimulatedModel(
        [PlacedRobot(RobotBody(BodyKind.WHEELS, scale), (0.0, 0.0, 0.0), 0.0, 0)], [np.empty((0, 6))], PLAIN, 0.005
    )
    group, rates = simulated.group(BodyKind.WHEELS), []
    rim = WHEEL_RADIUS_M * scale
    simulated.data.ctrl[simulated.motors(group.who)[0]] = np.array([-1.0, 1.0]) * TRACK_M / 2 * scale / rim
    for _ in range(60):
        simulated.go_on()
        rates.append(group.motion().rates[0, 2])
    assert max(rates) < 1.02
    assert rates[-1] == pytest.approx(1.0, rel=0.02)


@pytest.mark.long(keep=4)
@pytest.mark.parametrize("dt_s", [0.02, 0.05, 0.2, 0.5])
@pytest.mark.parametrize("given", [WAFFLE, DRONE, WAFFLE | {"radius_m": 0.1, "speed_mps": 1.0}], ids=str)
def test_robots_arrive_whatever_the_step(given, dt_s):
    world = PhysicsWorld(mission(robot(**given)), dt_s=dt_s)
    world.ports["r"].send([Waypoint((1.0, 0.0, 0.0)), Waypoint((1.0, 1.0, 0.0), heading=0.3, hold_s=1)])
    assert until_idle(world, 40.0)
    assert world.positions[0] == pytest.approx((1.0, 1.0, 0.0), abs=0.02)
    assert world.headings[0] == pytest.approx(0.3, abs=0.02)


def test_a_drone_tilts_to_go_and_hovers_level():
    world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **DRONE)))
    world.ports["r"].send([Waypoint((4.0, 0.0, 3.0))])
    tilts = []
    while not world.idle("r"):
        world.step()
        tilts.append(math.acos(min(1.0, world.axes[0, 2, 2])))
    assert math.radians(1) < max(tilts) < math.radians(35)
    world.advance(world.time_s + 3)
    assert world.positions[0] == pytest.approx((4.0, 0.0, 3.0), abs=0.02)
    assert math.acos(min(1.0, world.axes[0, 2, 2])) < 0.005
    assert world.frames[0] == pytest.approx((4.0, 0.0, 3.0 + world.simulated.robots[0].body.standing_m), abs=0.02)


def test_robots_without_a_radius_go_through_each_other():
    world = PhysicsWorld(mission(robot("a", (-1.0, 0.0)), robot("b", (1.0, 0.0))))
    world.ports["a"].send([Waypoint((1.0, 0.0, 0.0))])
    world.ports["b"].send([Waypoint((-1.0, 0.0, 0.0))])
    assert max(until_idle(world, 20.0).values()) < 3.5
    assert world.distances_m["a"] == pytest.approx(2.0, abs=0.03)


def test_a_robot_that_joins_leaves_the_others_in_flight():
    world = PhysicsWorld(mission(robot("a", (0.0, 0.0, 2.0), **DRONE)))
    world.ports["a"].send([Waypoint((5.0, 0.0, 2.0))])
    world.advance(3.0)
    tilt = world.axes[0]
    world.join(robot("b", (0.0, 4.0, 2.0), **DRONE))
    assert world.axes[0] == pytest.approx(tilt)
    world.step()
    assert world.velocities[0] == pytest.approx((0.5, 0.0, 0.0), abs=0.01)


@pytest.mark.long
@pytest.mark.parametrize("name", ["6T-2R", "11T-2R"])
def test_ground_missions_are_done_as_in_the_kinematic_world(name):
    team = muster.load(name)
    plan = muster.solve(team, seed=1, iterations=200)
    exact, physical = (carry_out(team, plan, world=world, seed=1) for world in ("kinematic", "physics"))
    assert (physical.contacts, physical.tasks_lost) == (0, exact.tasks_lost)
    flown = [[one["usage_flown"] for one in report.as_dict()["robots"]] for report in (exact, physical)]
    assert flown[1] == pytest.approx(flown[0], rel=0.03)


@pytest.mark.long
def test_events_befall_robots_of_the_physics_world():
    team = muster.load("6T-2R")
    helper = robot("r_9", (1.0, 1.0), type="beta", **WAFFLE)
    events = (Event(at_s=5, robot_fails="r_1"), Event(at_s=8, robot_joins=helper))
    team = replace(team, events=events)
    report = carry_out(team, muster.solve(team, seed=1, iterations=200), world="physics").as_dict()
    assert report["contacts"] == 0
    done = {task["task"]: task["robot"] for task in report["tasks"] if task["robot"] is not None}
    assert set(done) == {"0", "1", "2", "3", "4", "5"}
    assert "r_9" in done.values()


def test_a_world_that_there_is_not_is_told():
    with pytest.raises(ParameterError, match="world: phisics; expected kinematic, physics; did you mean"):
        world_named("phisics")
