"""Guidance: (2.15), (2.16) and (2.17) against the printed equations, and every law with every kind of robot."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.guidance import GUIDANCE, Line, follow, pursuit_angles, synthetic_waypoint
from muster.motion.kinematics.registry import KINEMATICS
from muster.motion.limits import Limits
from muster.motion.path import Path

LIMITS = Limits(speed_mps=0.5, yaw_rate_radps=1.5, acceleration_mps2=1.0)
BENT = Path(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [9.0, 4.0]]))
place = st.tuples(*[st.floats(-9, 9)] * 3).map(np.array)


@given(vehicle=place, target=place)
def test_azimuth_and_elevation_as_printed(vehicle, target):
    (x_v, y_v, z_v), (x_t, y_t, z_t) = vehicle, target
    assume(x_t - x_v > 1e-3)  # where the printed arctangent is that by quadrant
    azimuth, elevation = pursuit_angles(vehicle, target)
    assert math.tan(azimuth) == pytest.approx((y_t - y_v) / (x_t - x_v), rel=1e-6, abs=1e-9)
    level = math.sqrt((x_v - x_t) ** 2 + (y_v - y_t) ** 2)
    assert math.tan(elevation) == pytest.approx((z_t - z_v) / level, rel=1e-6, abs=1e-9)


@given(before=place, speed=st.floats(0, 5), course=st.floats(-4, 4), climb=st.floats(-1.5, 1.5), dt=st.floats(0, 3))
def test_the_waypoint_moves_as_printed(before, speed, course, climb, dt):
    """z downward as in the print: there it falls by sin of the climb angle."""
    x, y, z = before[0], before[1], -before[2]
    x += speed * math.cos(climb) * math.cos(course) * dt
    y += speed * math.cos(climb) * math.sin(course) * dt
    z += -speed * math.sin(climb) * dt
    assert synthetic_waypoint(before, speed, course, climb, dt) == pytest.approx([x, y, -z], abs=1e-9)


@pytest.mark.long(keep=4)
@pytest.mark.parametrize("kind", KINEMATICS)
@pytest.mark.parametrize("law", GUIDANCE)
def test_every_law_brings_every_robot_to_the_goal(law, kind):
    tracked = follow(BENT, law, KINEMATICS[kind], LIMITS, lookahead_m=0.5)
    assert tracked.arrived
    assert np.linalg.norm(tracked.states[-1, :3] - [9, 4, 0]) <= 0.05
    assert tracked.cross_track_m.max() < 0.35  # corners are cut, by less than a lookahead
    assert 12 < tracked.path.length_m < 13.2
    steps = np.linalg.norm(np.diff(tracked.states[:, :3], axis=0), axis=1)
    assert steps.max() <= 0.5 * tracked.dt + 1e-9


@pytest.mark.parametrize("law", GUIDANCE)
def test_a_shorter_lookahead_tracks_closer(law):
    near, far = (
        follow(BENT, law, KINEMATICS["holonomic"], LIMITS, lookahead_m=m).cross_track_m.max() for m in (0.3, 1.0)
    )
    assert near < far


@pytest.mark.parametrize("law", GUIDANCE)
def test_a_climb_is_flown(law):
    up = Path(np.array([[0.0, 0, 1], [6, 0, 4], [10, 3, 4]]))
    tracked = follow(up, law, KINEMATICS["quadcopter"], LIMITS)
    assert tracked.arrived
    assert tracked.states[-1, 2] == pytest.approx(4, abs=0.05)


def test_a_virtual_target_is_not_intercepted():
    tracked = follow(
        Path(np.array([[0.0, 0], [30, 0]])), "virtual-target", KINEMATICS["holonomic"], LIMITS, lookahead_m=1
    )
    middle = len(tracked.states) // 2
    ahead = 1 + 0.5 * middle * tracked.dt - tracked.states[middle, 0]
    assert ahead == pytest.approx(1, abs=0.3)


def test_the_nearest_place_of_a_line():
    line = Line(BENT)
    assert line.nearest(np.array([4.0, 1.0, 0.0]), 0, 13) == pytest.approx(4)
    assert line.nearest(np.array([5.5, 2.0, 0.0]), 5.5, 6.5) == pytest.approx(6.5)
    assert line.off(np.array([[2.0, 1, 0], [5, 2, 3]])).tolist() == [1, 3]


def test_what_is_wrong_is_named():
    with pytest.raises(ParameterError, match="guidance: pure_pursuit; expected pure-pursuit"):
        follow(BENT, "pure_pursuit", KINEMATICS["holonomic"], LIMITS)
    with pytest.raises(ParameterError, match="lookahead_m: 0"):
        follow(BENT, "pure-pursuit", KINEMATICS["holonomic"], LIMITS, lookahead_m=0)
