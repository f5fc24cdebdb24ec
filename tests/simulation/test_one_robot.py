"""One robot alone in the kinematic world: distances, arrival, headings, holds, limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.action_missions import ARENA
from tests.simulation.scenes import mission, robot, states, until_idle

from muster.motion.map_world import body_of
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld

KINDS = ("holonomic", "differential-drive", "quadcopter")
COORDINATE = st.floats(-10, 10).map(lambda x: round(x, 3))


@settings(max_examples=60, deadline=None)
@given(
    kind=st.sampled_from(KINDS),
    places=st.lists(st.tuples(COORDINATE, COORDINATE), min_size=1, max_size=5),
    acceleration=st.sampled_from([None, 0.5, 2.0]),
    speed=st.sampled_from([0.26, 1.0, 3.0]),
)
def test_flies_the_straight_pieces_and_stops_on_the_last(kind, places, acceleration, speed):
    one = robot(kinematics=kind, acceleration_mps2=acceleration, speed_mps=speed)
    world = KinematicWorld(mission(one))
    world.ports["r"].send([Waypoint((x, y, 0.0)) for x, y in places])
    assert until_idle(world, 600.0).keys() == {"r"}
    pieces = np.diff(np.array([(0.0, 0.0), *places]), axis=0)
    straight = np.hypot(*pieces.T).sum()
    # Each way point may be cut by 2 cm and is counted as reached within 2 cm.
    assert world.distances_m["r"] == pytest.approx(straight, rel=1e-3, abs=0.04 * len(places))
    world.advance(world.time_s + 10)
    assert world.positions[0, :2] == pytest.approx(places[-1], abs=0.021)
    assert (world.velocities == 0).all()


@settings(max_examples=40, deadline=None)
@given(
    kind=st.sampled_from(KINDS),
    places=st.lists(st.tuples(COORDINATE, COORDINATE), min_size=1, max_size=5),
    acceleration=st.sampled_from([0.3, 1.0]),
)
def test_never_exceeds_its_limits(kind, places, acceleration):
    one = robot(kinematics=kind, acceleration_mps2=acceleration, speed_mps=1.5, yaw_rate_radps=1.2, heading_deg=40)
    world = KinematicWorld(mission(one))
    world.ports["r"].send([Waypoint((x, y, 0.0), heading=0.5 * k) for k, (x, y) in enumerate(places)])
    _, headings, velocities = states(world, 300)
    turns = (np.diff(headings[:, 0]) + math.pi) % (2 * math.pi) - math.pi
    speeds = np.linalg.norm(velocities[:, 0], axis=1)
    assert speeds.max() <= 1.5 + 1e-9
    assert np.abs(turns).max() <= 0.12 + 1e-9
    if kind == "differential-drive":  # ahead; the chord of a step is shorter than its arc by 0.06 %
        assert np.abs(np.diff(speeds)).max() <= 0.1 * acceleration + 1e-3
    else:
        changes = np.linalg.norm(np.diff(velocities[:, 0], axis=0), axis=1)
        assert changes.max() <= 0.1 * acceleration + 1e-9


@pytest.mark.parametrize("acceleration", [None, 0.5])
def test_a_differential_drive_moves_only_where_it_looks(acceleration):
    world = KinematicWorld(mission(robot(kinematics="differential-drive", acceleration_mps2=acceleration)))
    world.ports["r"].send([Waypoint((0.0, 3.0, 0.0)), Waypoint((-2.0, 1.0, 0.0))])
    _, headings, velocities = states(world, 200)
    x, y = velocities[:, 0, 0], velocities[:, 0, 1]
    middles = headings[:-1, 0] + ((np.diff(headings[:, 0]) + math.pi) % (2 * math.pi) - math.pi) / 2
    assert x * np.sin(middles) - y * np.cos(middles) == pytest.approx(0.0, abs=1e-9)


def test_takes_the_least_time_to_a_standstill():
    world = KinematicWorld(mission(robot(acceleration_mps2=1.0, speed_mps=1.0)))
    world.ports["r"].send([Waypoint((5.0, 0.0, 0.0))])
    # 1 s to speed up, 1 s to slow down, half a metre each; steps cost one step.
    assert until_idle(world, 60.0)["r"] == pytest.approx(6.0, abs=0.11)


@pytest.mark.parametrize("kind", KINDS)
def test_turns_to_its_heading_and_holds_there(kind):
    world = KinematicWorld(mission(robot(kinematics=kind, yaw_rate_radps=1.0)))
    world.ports["r"].send([Waypoint((1.0, 0.0, 0.0), heading=2.0, hold_s=3.0, label="work")])
    held = []
    while not world.idle("r"):
        before = world.positions
        passed = world.step()
        held.append((world.positions == before).all() and abs(world.headings[0] - 2.0) < 1e-9)
    assert sum(held) == pytest.approx(30, abs=1)
    assert [(one.label, one.order, one.passed, one.idle) for one in passed] == [("work", 1, 1, True)]


def test_tells_of_labelled_way_points_and_of_the_last():
    world = KinematicWorld(mission(robot()))
    points = [Waypoint((1.0, 0.0, 0.0), label="a"), Waypoint((2.0, 0.0, 0.0)), Waypoint((3.0, 0.0, 0.0))]
    world.ports["r"].send(points)
    first, last = world.advance(60.0), world.advance(60.0)
    assert [(one.label, one.passed, one.idle) for one in (*first, *last)] == [("a", 1, False), ("", 3, True)]
    assert world.advance(60.0) == ()
    assert world.time_s == pytest.approx(60.0)


def test_passes_points_on_a_line_without_slowing_down():
    world = KinematicWorld(mission(robot(acceleration_mps2=1.0)))
    world.ports["r"].send([Waypoint((0.37 * k, 0.0, 0.0)) for k in range(1, 20)])
    _, _, velocities = states(world, 60)
    assert velocities[15:55, 0, 0] == pytest.approx(1.0)


def test_climbs_straight_in_space():
    world = KinematicWorld(mission(robot(position=(0.0, 0.0, 1.0), kind="air", kinematics="quadcopter")))
    world.ports["r"].send([Waypoint((3.0, 0.0, 5.0))])
    positions, _, _ = states(world, 60)
    on_line = positions[:, 0, 2] - 1.0 - positions[:, 0, 0] * 4 / 3
    assert on_line == pytest.approx(0.0, abs=1e-9)
    assert world.distances_m["r"] == pytest.approx(5.0)


def test_a_new_order_replaces_the_old_one():
    world = KinematicWorld(mission(robot()))
    port = world.ports["r"]
    assert port.send([Waypoint((9.0, 0.0, 0.0))]) == 1
    world.advance(2.0)
    assert port.send([Waypoint((2.0, 1.0, 0.0))]) == 2
    until_idle(world, 60.0)
    said = port.telemetry()
    assert (said.order, said.passed) == (2, 1)
    assert said.position == pytest.approx((2.0, 1.0, 0.0), abs=0.01)
    assert said.odometry_m == pytest.approx(3.0, abs=0.01)


def test_stops_when_cancelled_as_fast_as_it_can():
    world = KinematicWorld(mission(robot(acceleration_mps2=0.5)))
    world.ports["r"].send([Waypoint((9.0, 0.0, 0.0))])
    world.advance(4.0)
    at = world.positions[0, 0]
    assert world.ports["r"].cancel() == 2
    world.advance(9.0)
    assert world.positions[0, 0] - at == pytest.approx(1.0, abs=0.06)  # v^2 / 2a
    assert world.ports["r"].telemetry().order == 2


@pytest.mark.parametrize(
    ("start", "goal"),
    [((13.129042178338342, 38.084016114332805), (26.09926980282172, 36.75831168766079)),
     ((13.850916371012572, 37.9242366008549), (24.585502769776546, 33.9957942298707)),
     ((12.847376763026215, 32.15737908406385), (28.242298911419404, 32.037106335716985))],
)  # fmt: skip
def test_a_corner_that_was_cut_does_not_draw_a_robot_back_into_the_wall(start, goal):
    """Around the end of a wall at full speed; it took 500 s for the 2 m along the end."""
    pytest.importorskip("shapely")
    team = mission(robot(position=start, radius_m=0.3, speed_mps=2.0), map=ARENA)
    way = RobotPaths.of(team).path(body_of(team.robots[0]), start, goal).points[1:]
    world = KinematicWorld(team)
    world.ports["r"].send([Waypoint((*place, 0.0)) for place in way.tolist()])
    assert until_idle(world, 30.0).keys() == {"r"}
    assert world.positions[0, :2] == pytest.approx(goal, abs=1e-3)
