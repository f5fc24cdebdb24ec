"""Drones in wind, and what is drawn from batteries in the physics world."""

import math
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot, until_idle

from muster.motion.port import Waypoint
from muster.simulation import Wind

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

from muster_physics import PhysicsWorld
from muster_physics.airframes import FIREFLY, RB5
from muster_physics.bodies import BodyKind

HEXACOPTER = {"kind": "air", "kinematics": "hexacopter", "radius_m": 0.35}
WAFFLE = {"kinematics": "differential-drive", "radius_m": 0.3, "speed_mps": 0.26, "yaw_rate_radps": 1.82}


@pytest.mark.long
def test_a_drone_holds_its_place_in_wind_by_leaning_against_it():
    """In balance the tangent of the lean is rotor drag over weight."""
    world = PhysicsWorld(
        mission(robot(position=(0.0, 0.0, 2.0), **HEXACOPTER)), wind=Wind(velocity_mps=(8.0, 0.0, 0.0))
    )
    world.advance(0.8)
    assert world.positions[0, 0] > 0.02  # it is blown off before it finds out
    world.advance(10.0)
    assert world.positions[0] == pytest.approx((0.0, 0.0, 2.0), abs=0.01)
    speeds, up = world.simulated.rotors.speeds[0], world.axes[0][:, 2]
    drag = FIREFLY.drag * speeds.sum() * 8.0 * up[2]
    assert -up[0] / up[2] == pytest.approx(drag * up[2] / (FIREFLY.mass_kg * 9.81), rel=0.03)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2))
def test_eight_that_cross_in_light_gusts_do_not_touch(seed):
    team = []
    for k in range(8):
        angle = 2 * math.pi * k / 8 + 0.1 * (k % 3)
        team.append(robot(f"r_{k}", (2.5 * math.cos(angle), 2.5 * math.sin(angle), 3.0), speed_mps=2.0, **HEXACOPTER))
    world = PhysicsWorld(mission(*team), seed=seed, wind=Wind(velocity_mps=(5.0, 0.0, 0.0), gusts_mps=7.7))
    for one in team:
        x, y, z = one.position
        world.ports[one.id].send([Waypoint((-x, -y, z))])
    assert len(until_idle(world, 60.0)) == 8
    assert world.contacts == ()


def test_robots_on_the_ground_feel_no_wind():
    def driven(**how):
        world = PhysicsWorld(mission(robot(**WAFFLE)), **how)
        world.ports["r"].send([Waypoint((1.0, 0.5, 0.0))])
        until_idle(world, 30.0)
        return world.positions

    np.testing.assert_array_equal(driven(), driven(wind=Wind(velocity_mps=(20.0, 0.0, 0.0), gusts_mps=10.0)))


@pytest.mark.long
@pytest.mark.parametrize(("kinematics", "airframe"), [("hexacopter", FIREFLY), ("quadcopter", RB5)])
def test_hovering_empties_a_battery_in_the_flight_time(kinematics, airframe):
    given = HEXACOPTER | {"kinematics": kinematics, "radius_m": 0.2}
    world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **given)), batteries={"r": 0.8})
    world.advance(6.0)
    assert world.ports["r"].telemetry().charge == pytest.approx(0.8 - 6.0 / airframe.flight_s, rel=1e-4)


def test_climbing_takes_more_than_hovering():
    def left(height):
        world = PhysicsWorld(mission(robot(position=(0.0, 0.0, 2.0), **HEXACOPTER)), batteries={"all": 1.0})
        world.ports["r"].send([Waypoint((0.0, 0.0, height))])
        world.advance(2.0)
        return world.ports["r"].telemetry().charge

    assert left(8.0) < left(2.0) - 1e-5


def test_a_wafflebot_is_on_for_two_hours_and_its_wheels_take_more():
    world = PhysicsWorld(mission(robot(**WAFFLE), robot("other", (0.0, 3.0), **WAFFLE)), batteries={"all": 1.0})
    world.ports["r"].send([Waypoint((4.0, 0.0, 0.0))])
    world.advance(10.0)
    driving, standing = (world.ports[name].telemetry().charge for name in ("r", "other"))
    assert standing == pytest.approx(1 - 10.0 / 7200, abs=2e-6)
    assert 1 - 12.0 / 7200 < driving < standing


def test_an_empty_battery_stays_empty_and_one_that_joins_has_its_own():
    world = PhysicsWorld(mission(robot("a", **WAFFLE)), batteries={"all": 0.0005})
    world.advance(5.0)
    assert world.ports["a"].telemetry().charge == 0.0
    world.join(robot("b", (0.0, 3.0), **WAFFLE))
    world.advance(6.0)
    assert world.ports["b"].telemetry().charge == pytest.approx(0.0005 - 1 / 7200, rel=0.05)


def test_without_wind_and_batteries_quadcopters_are_as_they_were():
    plain = PhysicsWorld(mission(robot(kind="air")))
    assert plain.simulated.robots[0].body.kind is BodyKind.ROTORS
    assert plain.ports["r"].telemetry().charge is None
