"""What robots of both worlds say with noise and without: inertial units, encoders, odometry, motors."""

from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot, until_idle

import muster
from muster.execution import Executor
from muster.mission.errors import ParameterError
from muster.motion.frames import wrapped
from muster.motion.port import Waypoint
from muster.running.simulation import carry_out
from muster.running.worlds import world_named
from muster.simulation import KinematicWorld, Noise

WORLDS = [
    "kinematic",
    pytest.param("physics", marks=pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")),
]
WAFFLE = {"kinematics": "differential-drive", "radius_m": 0.3, "speed_mps": 0.26, "yaw_rate_radps": 1.82}
DRONE = {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.7, "speed_mps": 0.5, "yaw_rate_radps": 2.5}
CORNERS = ((1.0, 0.0), (1.0, 1.0), (0.0, 0.0))


def under_way(name, given, seed=0, noise=None, at=(0.0, 0.0)):
    world = world_named(name)(mission(robot(position=at, **given)), seed=seed, noise=noise or Noise())
    height = at[2:] or (0.0,)
    world.ports["r"].send([Waypoint((*corner, *height), heading=0.5 * k) for k, corner in enumerate(CORNERS)])
    return world


@pytest.mark.parametrize("name", WORLDS)
@pytest.mark.parametrize(("given", "at"), [(WAFFLE, (0.0, 0.0)), (DRONE, (0.0, 0.0, 2.0))])
def test_what_is_felt_leads_from_rest_to_where_the_robot_is(name, given, at):
    """Turned and pushed as its inertial unit felt it, a robot has its true heading, velocity and place."""
    world = under_way(name, given, at=at)
    port, dt = world.ports["r"], world.dt_s
    assert port.telemetry().inertial is None
    heading, velocity, place = 0.0, np.zeros(3), np.array([*at, 0.0][:3])
    for _ in range(80):
        world.step()
        felt = port.telemetry().inertial
        assert felt.seconds == dt
        middle = heading + dt * felt.turning_radps / 2
        heading += dt * felt.turning_radps
        c, s = np.cos(middle), np.sin(middle)
        velocity += dt * np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ felt.acceleration_mps2
        place += dt * velocity
        assert wrapped(heading - world.headings[0]) == pytest.approx(0, abs=1e-9)
        np.testing.assert_allclose(velocity, world.velocities[0], atol=1e-9)
    # In physics slower than 2 mm/s counts as standing.
    np.testing.assert_allclose(place, world.positions[0], atol=1e-9 if name == "kinematic" else 0.02)
    assert abs(heading) > 0.4


def test_errors_of_the_inertial_unit_are_those_that_were_asked_for():
    noise = Noise(gyro_radps=0.02, accelerometer_mps2=0.3)
    world = KinematicWorld(mission(robot(position=(0.0, 0.0, 0.0))), noise=noise)
    port, felt = world.ports["r"], []
    for _ in range(1000):
        world.step()
        assert port.telemetry() == port.telemetry()
        said = port.telemetry()
        felt.append((*said.inertial.acceleration_mps2, said.inertial.turning_radps))
        assert (said.position, said.heading) == ((0.0, 0.0, 0.0), 0.0)
    assert np.std(felt, axis=0) == pytest.approx([0.3, 0.3, 0.3, 0.02], rel=0.1)
    assert np.abs(np.mean(felt, axis=0)).max() < 0.05


def test_nothing_is_felt_upward_in_the_plane():
    world = KinematicWorld(mission(robot()), noise=Noise(accelerometer_mps2=0.3))
    world.step()
    assert world.ports["r"].telemetry().inertial.acceleration_mps2[2] == 0


def test_a_gyro_has_one_bias_each_robot_another():
    robots = [robot(f"r_{k}", position=(3.0 * k, 0.0)) for k in range(400)]
    world = KinematicWorld(mission(*robots), noise=Noise(gyro_bias_radps=0.02), avoidance="none")
    seen = []
    for _ in range(2):
        world.step()
        seen.append([port.telemetry().inertial.turning_radps for port in world.ports.values()])
    assert seen[0] == seen[1]
    assert np.std(seen[0]) == pytest.approx(0.02, rel=0.1)
    again = KinematicWorld(mission(*robots), noise=Noise(gyro_bias_radps=0.02), avoidance="none", seed=1)
    again.step()
    assert again.ports["r_0"].telemetry().inertial.turning_radps != seen[0][0]


@pytest.mark.parametrize("name", WORLDS)
@pytest.mark.parametrize("given", [DRONE, {"radius_m": 0.3, "speed_mps": 0.3}])
def test_the_velocity_that_is_said_is_what_odometry_counts(name, given):
    """Where there are no wheels; its encoders count beside it."""
    world = under_way(name, given, noise=Noise(slip=0.3, odometry=0.1))
    port, way = world.ports["r"], 0.0
    for _ in range(60):
        world.step()
        way += world.dt_s * float(np.linalg.norm(port.telemetry().velocity))
        assert port.telemetry().odometry_m == pytest.approx(way)
    assert way > 1.05 * world.distances_m["r"]


@pytest.mark.long
@pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")
@pytest.mark.parametrize("name", ["6T-2R", "11T-2R-actions"])
def test_encoders_count_the_true_way(name):
    """To 1 %, robots of Table A.2 on the thesis' own missions; wheels roll a little less than their radius says."""
    team = muster.load(name)
    world = world_named("physics")(team)
    executor = Executor(team, muster.solve(team, iterations=100), world.ports)
    executor.tick(0.0)
    while not executor.done:
        world.advance(world.time_s + 0.5)
        executor.tick(world.time_s)
    for robot_id, metres in world.distances_m.items():
        counted = world.ports[robot_id].telemetry().odometry_m
        assert counted == pytest.approx(metres, rel=0.01)
        assert counted != metres


@pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")
def test_a_wheel_that_turns_on_the_spot_counts_no_way():
    world = world_named("physics")(mission(robot(**WAFFLE)))
    world.ports["r"].send([Waypoint((0.0, 0.0, 0.0), heading=3.0)])
    assert until_idle(world, 10.0)["r"] > 1.5
    assert world.ports["r"].telemetry().odometry_m < 0.01


@pytest.mark.long
@pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")
@pytest.mark.parametrize("given", [WAFFLE, DRONE, {"radius_m": 0.3, "speed_mps": 0.3}])
def test_motors_of_uneven_strength_shake_a_robot_that_still_arrives(given):
    flown = []
    for strength in (0.0, 0.1, 0.1):
        world = under_way("physics", given, noise=Noise(motors=strength))
        at = []
        for _ in range(200):
            world.step()
            at.append(world.positions[0])
        assert world.idle("r")
        assert world.positions[0] == pytest.approx([0, 0, 0], abs=0.05)
        flown.append(np.array(at))
    assert 1e-6 < np.abs(flown[1] - flown[0]).max() < 0.2
    assert (flown[1] == flown[2]).all()


def test_noise_of_motors_is_nothing_where_there_are_none():
    at = [under_way("kinematic", WAFFLE, noise=Noise(motors=share)) for share in (0.0, 0.5)]
    for _ in range(50):
        for world in at:
            world.step()
    assert (at[0].positions == at[1].positions).all()


@pytest.mark.parametrize("name", ["motors", "attitude_rad", "gyro_radps", "gyro_bias_radps", "accelerometer_mps2"])
def test_a_negative_error_is_told(name):
    with pytest.raises(ParameterError, match=f"^{name}: -1; expected a finite number, at least 0$"):
        Noise(**{name: -1})


@pytest.mark.long
@pytest.mark.parametrize("name", WORLDS)
def test_all_tasks_are_done_with_all_errors_at_once(name):
    """No robot touches another, though motors push unevenly."""
    noise = Noise(velocity=0.05, slip=0.05, odometry=0.02, motors=0.05, position_m=0.1, heading_rad=0.05)
    team = muster.load("6T-2R")
    report = carry_out(team, muster.solve(team, iterations=100), world=name, noise=noise, seed=3)
    assert (len(report.tasks_done), report.contacts) == (6, 0)
