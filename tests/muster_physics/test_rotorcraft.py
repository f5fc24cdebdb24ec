"""Drones simulated rotor by rotor: parameters as published, laws against independent formulas, flights."""

import math
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot, until_idle

from muster.motion.port import Waypoint

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster_physics import PhysicsWorld
from muster_physics.airframes import (
    FIREFLY,
    RB5,
    rb5_throttle,
    rb5_thrust,
    throttle_of_pulse,
)
from muster_physics.bodies import BodyKind, robot_body
from muster_physics.control import Control
from muster_physics.controller import Commands
from muster_physics.geometric_control import GeometricController, wanted_axes
from muster_physics.model import PlacedRobot
from muster_physics.rotors import Rotors
from muster_physics.scenery import Scenery
from muster_physics.simulated_model import SimulatedModel

HEXACOPTER = {"kind": "air", "kinematics": "hexacopter", "radius_m": 0.35, "yaw_rate_radps": 2.0}
every_airframe = pytest.mark.parametrize(
    "airframe", [FIREFLY, RB5, FIREFLY.scaled(0.4)], ids=["firefly", "rb5", "small"]
)


def vee(skew):
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def rotation(seed):
    """Some rotation by the exponential of a skew matrix, tilted by less than half a right angle."""
    random = np.random.default_rng(seed)
    axis = random.normal(size=3) * (0.5, 0.5, 1.0)
    angle = np.linalg.norm(axis)
    x, y, z = axis / angle
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew


def test_rotors_of_the_firefly_hover_at_the_speed_that_carries_its_weight():
    assert pytest.approx(math.sqrt(1.56779 * 9.81 / (6 * 8.54858e-06))) == FIREFLY.hover_radps
    assert 546 < FIREFLY.hover_radps < 550


def test_the_allocation_of_the_firefly_is_that_of_rotors():
    s, c, arm = math.sin(math.pi / 6), math.cos(math.pi / 6), 0.215
    published = np.array(
        [[s, 1, s, -s, -1, -s], [-c, 0, c, c, 0, -c], [-1, 1, -1, 1, -1, 1], [1, 1, 1, 1, 1, 1]]
    ) * np.array([[arm], [arm], [0.016], [1.0]])
    np.testing.assert_allclose(FIREFLY.allocation, published, atol=1e-12)


@every_airframe
def test_rotors_give_what_is_allocated(airframe):
    rotors = Rotors([airframe], 0.005)
    weight, arm = airframe.mass_kg * 9.81, airframe.rotors[0][0]
    moments = weight * arm * np.array([[0.05, -0.08, 0.002]])
    thrusts = rotors.thrusts(rotors.allocated(moments, np.array([1.1 * weight])))
    assert thrusts.sum() == pytest.approx(1.1 * weight)
    np.testing.assert_allclose(rotors.moments(thrusts), moments, atol=1e-12)


def test_yaw_gives_way_where_rotors_are_at_their_limits():
    rotors = Rotors([FIREFLY], 0.005)
    weight = FIREFLY.mass_kg * 9.81
    speeds = rotors.allocated(np.array([[0.3, 0.0, 5.0]]), np.array([weight]))
    thrusts = rotors.thrusts(speeds)
    assert thrusts.sum() == pytest.approx(weight)
    roll, pitch, yaw = rotors.moments(thrusts)[0]
    assert (roll, pitch) == pytest.approx((0.3, 0.0), abs=1e-9)
    assert 0 < yaw < 0.5
    assert speeds.min() == pytest.approx(0.0, abs=1e-3) or speeds.max() == pytest.approx(838.0)


@pytest.mark.parametrize(("begin", "end", "tau"), [(500.0, 600.0, 0.0125), (600.0, 500.0, 0.025)])
def test_speeds_follow_as_a_first_order_lag(begin, end, tau):
    rotors = Rotors([FIREFLY], 0.005)
    speeds = np.full((1, 6), begin)
    for step in range(1, 8):
        speeds = rotors.followed(speeds, np.full((1, 6), end))
        assert speeds == pytest.approx(end + (begin - end) * math.exp(-0.005 * step / tau))
    assert rotors.followed(speeds, np.full((1, 6), 9e9)).max() <= 838.0


@pytest.mark.parametrize("seed", range(5))
def test_the_controller_is_that_of_lee_2010(seed):
    random = np.random.default_rng(seed)
    law = GeometricController([FIREFLY])
    axes, rates = rotation(seed), random.normal(size=3)
    position_error, velocity_error, acceleration = random.normal(size=(3, 3)) * 0.4
    heading, yaw_rate = random.normal(), random.normal()
    force = law.wanted_force(position_error[None], velocity_error[None], acceleration[None])
    by_hand = -6 * position_error - 4.7 * velocity_error + 1.56779 * (np.array([0, 0, 9.81]) + acceleration)
    np.testing.assert_allclose(force[0], by_hand)
    assert law.thrust(force, axes[None])[0] == pytest.approx(by_hand @ axes[:, 2])
    wanted = wanted_axes(force, np.array([heading]))[0]
    np.testing.assert_allclose(wanted.T @ wanted, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(wanted[:, 2], by_hand / np.linalg.norm(by_hand))
    assert math.atan2(wanted[1, 0], wanted[0, 0]) == pytest.approx(math.remainder(heading, math.tau), abs=0.2)
    inertia = np.diag([0.0347563, 0.0458929, 0.0977])
    attitude_error = 0.5 * vee(wanted.T @ axes - axes.T @ wanted)
    rate_error = rates - axes.T @ wanted @ np.array([0, 0, yaw_rate])
    moments = -np.diag([3, 3, 0.15]) @ attitude_error - np.diag([0.52, 0.52, 0.18]) @ rate_error
    moments += np.cross(rates, inertia @ rates)
    found = law.moments(force, axes[None], rates[None], np.array([heading]), np.array([yaw_rate]))
    np.testing.assert_allclose(found[0], moments)


def test_drag_of_rotors_is_that_of_the_motor_model():
    rotors = Rotors([FIREFLY], 0.005)
    speeds, airspeed = np.full((1, 6), 500.0), np.array([[2.0, -1.0, 3.0]])
    force, moment = rotors.drags(speeds, airspeed, np.zeros((1, 3)))
    np.testing.assert_allclose(force[0], -6 * 500 * 8.06428e-05 * np.array([2.0, -1.0, 0.0]))
    lever = np.cross([0, 0, 0.037], force[0])
    np.testing.assert_allclose(moment[0], lever - 6 * 500 * 1e-06 * np.array([2.0, -1.0, 0.0]), atol=1e-12)


def test_throttle_and_thrust_of_the_rb5_are_those_of_table_a19():
    assert (rb5_thrust(0.0), rb5_thrust(0.5), rb5_thrust(1.0)) == pytest.approx((0.0, 3.068, 9.896))
    assert [rb5_throttle(rb5_thrust(share)) for share in (0.1, 0.5, 0.9)] == pytest.approx([0.1, 0.5, 0.9])
    assert [throttle_of_pulse(pulse) for pulse in (1000, 1500, 2000)] == pytest.approx([0.0, 0.5, 1.0])
    assert 4 * FIREFLY.motor_constant * RB5.most_radps**2 == pytest.approx(4 * 9.896)
    assert rb5_throttle(RB5.mass_kg * 9.81 / 4) == pytest.approx(0.5, abs=0.01)  # it hovers at half throttle


def test_bodies_have_the_published_mass_inertia_and_size():
    world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **HEXACOPTER)))
    simulated = world.simulated
    assert simulated.model.body_mass[simulated.bodies[0]] == pytest.approx(1.56779)
    assert tuple(simulated.model.body_inertia[simulated.bodies[0]]) == (0.0347563, 0.0458929, 0.0977)
    assert robot_body(robot(**HEXACOPTER | {"radius_m": 3.0})).scale == 1.0
    small = robot_body(robot(**HEXACOPTER | {"radius_m": 0.1}))
    assert math.hypot(*small.size_m[::2]) / 2 <= 0.1 + 1e-9
    assert robot_body(robot(kind="air")).kind is BodyKind.ROTORS
    assert robot_body(robot(kind="air"), rotor_level=True).airframe is RB5


def test_it_hovers_at_the_hover_speed():
    world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **HEXACOPTER)))
    world.advance(3.0)
    np.testing.assert_allclose(world.simulated.rotors.speeds[0], FIREFLY.hover_radps, rtol=1e-6)
    assert world.positions[0] == pytest.approx((0.0, 0.0, 2.0), abs=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("radius_m", [0.1, 0.35])
@pytest.mark.parametrize("kinematics", ["hexacopter", "quadcopter"])
def test_it_flies_to_way_points_and_does_not_overshoot(kinematics, radius_m):
    given = HEXACOPTER | {"radius_m": radius_m, "kinematics": kinematics}
    world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **given)), rotor_level=True)
    world.ports["r"].send([Waypoint((3.0, 0.0, 3.0), heading=1.0)])
    farthest = 0.0
    while not world.idle("r"):
        world.step()
        farthest = max(farthest, world.positions[0, 0])
        assert world.time_s < 15
    assert farthest < 3.03
    world.advance(world.time_s + 2)
    assert world.positions[0] == pytest.approx((3.0, 0.0, 3.0), abs=0.02)
    assert world.headings[0] == pytest.approx(1.0, abs=0.02)


@pytest.mark.long
@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_the_predicted_place_moves_as_commanded(heading):
    """Which is why the crowd may decide by it: position plus lag, while the drone answers late."""
    body = robot_body(robot(**HEXACOPTER))
    placed = [PlacedRobot(body, (0.0, 0.0, 2.0), heading, None)]
    control = Control(SimulatedModel(placed, [], Scenery(None, (), 0.0), 0.005), keeps_height=False)
    commanded = before = np.array([0.0, 0.0, 2.0])
    for step in range(60):  # up to 1 m/s at 2 m/s^2, on, to a stand, and on standing
        speed = min(1.0, 0.2 * step) if step < 25 else max(0.0, 1.0 - 0.2 * (step - 25))
        velocity = speed * np.array([0.8, 0.6, 0.3])
        done = control.carry_out(Commands(np.array([[*velocity, 0.0]]), np.zeros(1)), 20)
        predicted = done.poses[0, :3] + done.lags[0, :3]
        assert predicted - before == pytest.approx(0.1 * velocity, abs=0.01)
        commanded, before = commanded + 0.1 * velocity, predicted
    assert done.poses[0, :3] == pytest.approx(commanded, abs=0.05)


@pytest.mark.long
@pytest.mark.parametrize(
    ("space", "speed", "around", "seed"), [(False, 1.0, 1.6, 0), (True, 2.0, 2.5, 1), (False, 3.0, 3.0, 2)]
)
def test_eight_that_cross_do_not_touch(space, speed, around, seed):
    random = np.random.default_rng(seed)
    team = []
    for k in range(8):
        angle = 2 * math.pi * k / 8 + random.uniform(-0.1, 0.1)
        place = (around * math.cos(angle), around * math.sin(angle), *([2.0] if space else []))
        team.append(robot(f"r_{k}", place, speed_mps=speed, **HEXACOPTER))
    world = PhysicsWorld(mission(*team), seed=seed)
    for one in team:
        x, y, *z = one.position
        world.ports[one.id].send([Waypoint((-x, -y, *(z or (0.0,))))])
    assert len(until_idle(world, 60.0)) == 8
    assert world.contacts == ()
    assert world.min_distance_m >= 0.7


def test_one_that_joins_leaves_rotors_as_they_were():
    world = PhysicsWorld(mission(robot("a", (0.0, 0.0, 2.0), **HEXACOPTER)))
    world.ports["a"].send([Waypoint((5.0, 0.0, 2.0))])
    world.advance(0.5)
    speeds = world.simulated.rotors.speeds[0].copy()
    assert np.ptp(speeds) > 1
    world.join(robot("b", (0.0, 4.0, 2.0), **HEXACOPTER))
    np.testing.assert_array_equal(world.simulated.rotors.speeds[0], speeds)
    world.step()
    assert abs(world.positions[0, 2] - 2.0) < 0.01
