"""The laws by which simulated robots move, against the equations as [tcf-thesis] prints them."""

import math
import random

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot, send_across, until_idle

from muster.mission.errors import ParameterError
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld

DT = 0.1
STATES = range(40)


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


def after_an_arc(x, y, yaw, ahead, yaw_rate):
    """The exact integral of (4.20) for constant inputs."""
    if abs(yaw_rate) < 1e-12:
        return x + ahead * math.cos(yaw) * DT, y + ahead * math.sin(yaw) * DT, yaw
    later, radius = yaw + yaw_rate * DT, ahead / yaw_rate
    return x + radius * (math.sin(later) - math.sin(yaw)), y - radius * (math.cos(later) - math.cos(yaw)), later


def one_step(body, goal, heading=None):
    world = KinematicWorld(mission(body), law="thesis", dt_s=DT)
    world.ports["r"].send([Waypoint(goal, heading=heading)])
    world.step()
    return (*world.positions[0], float(world.headings[0]))


@pytest.mark.parametrize("seed", STATES)
def test_a_differential_drive_moves_by_4_21_to_4_25(seed):
    draw = random.Random(seed)
    speed, most, yaw = draw.uniform(0.1, 1.0), draw.uniform(0.2, 3.0), draw.uniform(-math.pi, math.pi)
    way, far = draw.uniform(-math.pi, math.pi), draw.uniform(2.0, 9.0)
    body = robot(kinematics="differential-drive", speed_mps=speed, yaw_rate_radps=most, heading_deg=math.degrees(yaw))
    x_opt, y_opt = speed * math.cos(way), speed * math.sin(way)  # the optimal velocity: straight to the goal
    phi_t = math.atan2(y_opt, x_opt)  # (4.21)
    d_phi = phi_t - yaw  # (4.22)
    v_d = math.sqrt(y_opt**2 + x_opt**2)  # (4.23)
    omega = most * math.sin(d_phi)  # (4.24)
    v = v_d * math.cos(d_phi)  # (4.25)
    x, y, _, heading = one_step(body, (far * math.cos(way), far * math.sin(way), 0.0))
    wanted = after_an_arc(0.0, 0.0, yaw, v, omega)
    assert (x, y) == pytest.approx(wanted[:2], abs=1e-9)
    assert wrapped(heading - wanted[2]) == pytest.approx(0.0, abs=1e-9)


def test_the_turn_that_was_measured_on_the_spot_is_driven():
    """A yaw error of 0.2949 rad at 1.82 rad/s and 0.26 m/s: (4.24) gives 0.53 rad/s and (4.25) 0.249 m/s."""
    body = robot(kinematics="differential-drive", speed_mps=0.26, yaw_rate_radps=1.82)
    world = KinematicWorld(mission(body), law="thesis")
    world.ports["r"].send([Waypoint((5 * math.cos(0.2949), 5 * math.sin(0.2949), 0.0))])
    world.step()
    assert world.headings[0] / DT == pytest.approx(0.53, abs=0.005)
    assert np.linalg.norm(world.velocities[0]) == pytest.approx(0.249, abs=0.0005)


@pytest.mark.parametrize("seed", STATES)
def test_a_quadcopter_moves_by_4_9_to_4_16(seed):
    draw = random.Random(seed)
    speed, most, yaw = draw.uniform(0.5, 3.0), draw.uniform(0.2, 3.0), draw.uniform(-math.pi, math.pi)
    way, far, goal_yaw = draw.uniform(-math.pi, math.pi), draw.uniform(4.0, 9.0), draw.uniform(-math.pi, math.pi)
    z_c, z_d = draw.uniform(1.0, 6.0), draw.uniform(1.0, 6.0)
    body = robot(
        position=(0.0, 0.0, z_c),
        kinematics="quadcopter",
        kind="air",
        speed_mps=speed,
        yaw_rate_radps=most,
        heading_deg=math.degrees(yaw),
    )
    x_opt, y_opt = speed * math.cos(way), speed * math.sin(way)
    d_z = z_d - z_c  # (4.9), where z_d - z_d is printed
    d_phi = math.atan2(y_opt, x_opt) - yaw  # (4.9), (4.11)
    d_phi_h = wrapped(goal_yaw - yaw)  # (4.10)
    v_v, dt_v = speed, 0.5
    v_z = v_v * d_z / abs(d_z) if abs(d_z) > v_v * dt_v else d_z / dt_v  # (4.12)
    omega = most * math.sin(d_phi_h)  # (4.13)
    v_xy = math.sqrt(y_opt**2 + x_opt**2)  # (4.14)
    v_x, v_y = v_xy * math.cos(d_phi), v_xy * math.sin(d_phi)  # (4.15), (4.16)
    x, y, z, heading = one_step(body, (far * math.cos(way), far * math.sin(way), z_d), goal_yaw)
    # Into the map by the yaw of the current state: the planner's velocity, whatever the yaw is.
    east, north = v_x * math.cos(yaw) - v_y * math.sin(yaw), v_x * math.sin(yaw) + v_y * math.cos(yaw)
    assert (x, y, z) == pytest.approx((east * DT, north * DT, z_c + v_z * DT), abs=1e-9)
    if abs(abs(d_phi_h) - math.pi) > 0.02:
        assert wrapped(heading - yaw) == pytest.approx(omega * DT, abs=1e-9)


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive", "quadcopter"])
@pytest.mark.parametrize("avoidance", ["none", "orca"])
def test_robots_get_to_their_way_points_by_the_law_of_the_thesis(kinematics, avoidance):
    team = mission(robot(kinematics=kinematics, heading_deg=180, speed_mps=0.5, acceleration_mps2=1.0))
    world = KinematicWorld(team, law="thesis", avoidance=avoidance)
    world.ports["r"].send([Waypoint((3, 0, 0)), Waypoint((3, 2, 0), heading=math.pi, hold_s=1.0), Waypoint((0, 0, 0))])
    assert until_idle(world, 120).keys() == {"r"}
    assert world.positions[0, :2] == pytest.approx((0.0, 0.0), abs=0.021)


def test_a_quadcopter_climbs_and_sinks_to_its_way_points():
    team = mission(robot(position=(0.0, 0.0, 0.0), kinematics="quadcopter", kind="air", radius_m=0.3))
    world = KinematicWorld(team, law="thesis")
    world.ports["r"].send([Waypoint((0, 0, 4.0)), Waypoint((5, 0, 6.0)), Waypoint((5, 5, 1.0)), Waypoint((0, 0, 1.0))])
    assert until_idle(world, 60).keys() == {"r"}
    assert world.positions[0] == pytest.approx((0.0, 0.0, 1.0), abs=0.021)


@pytest.mark.parametrize("kinematics", ["differential-drive", "quadcopter"])
def test_a_half_turn_on_the_spot_is_left(kinematics):
    world = KinematicWorld(mission(robot(kinematics=kinematics)), law="thesis")
    world.ports["r"].send([Waypoint((0.0, 0.0, 0.0), heading=math.pi)])
    assert until_idle(world, 30).keys() == {"r"}
    assert abs(wrapped(world.headings[0] - math.pi)) <= 0.01


@pytest.mark.parametrize("kinematics", ["differential-drive", "quadcopter"])
def test_a_crowd_by_the_law_of_the_thesis_exchanges_places_without_contact(kinematics):
    team = mission(
        *(
            robot(f"r_{k}", (4 * math.cos(k), 4 * math.sin(k)), kinematics=kinematics, radius_m=0.3, speed_mps=0.8)
            for k in range(6)
        )
    )
    world = KinematicWorld(team, law="thesis", seed=1)
    send_across(world, team)
    assert len(until_idle(world, 300)) == 6
    assert not world.contacts


def test_the_law_of_holonomic_robots_stays():
    def driven(law):
        world = KinematicWorld(mission(robot()), law=law)
        world.ports["r"].send([Waypoint((2.0, 1.0, 0.0), heading=1.0)])
        world.advance(1.0)
        return (*world.positions[0], *world.headings)

    assert driven("thesis") == driven("profile")


def test_a_law_that_there_is_not_is_named():
    with pytest.raises(ParameterError, match=r"law: these; expected .*did you mean 'thesis'"):
        KinematicWorld(mission(robot()), law="these")
