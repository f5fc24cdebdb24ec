"""Trajectories: the limits hold at every moment, the curve is followed, and no time is wasted where it can be told."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

from muster.mission.errors import ParameterError
from muster.motion.curves.curve import Curve
from muster.motion.limits import Limits
from muster.motion.path import Path
from muster.motion.smoothing import smoothed
from muster.motion.trajectory import Trajectory, joined
from muster.motion.velocity import timed
from muster.motion.wheels import body_speeds, fastest_translation, wheel_speeds

coordinates = st.integers(-60, 60).map(lambda k: k / 10)
angle = st.floats(-7, 7)
limits_of_robots = st.builds(
    Limits,
    speed_mps=st.floats(0.1, 5),
    acceleration_mps2=st.floats(0.1, 5) | st.just(math.inf),
    yaw_rate_radps=st.floats(0.1, 3) | st.just(math.inf),
    yaw_acceleration_radps2=st.floats(0.3, 3) | st.just(math.inf),
    track_m=st.sampled_from([0.0, 0.3]),
)


def curves_in(*dimensions):
    return st.builds(
        lambda points, smooth: smoothed(Path(points), lambda _: smooth, radii_m=(0.5,), keep=range(len(points))).curve,
        st.sampled_from(dimensions).flatmap(
            lambda d: st.lists(st.tuples(*[coordinates] * d), min_size=1, max_size=4).map(np.array)
        ),
        st.booleans(),
    )


curves = curves_in(2, 3)
every_motion = given(
    curve=curves,
    limits=limits_of_robots,
    faces=st.booleans(),
    start=st.none() | angle,
    end=st.none() | angle,
)


def moments(motion):
    """21 moments in each span of a trajectory that is not too short for float64, and the spans."""
    spans = np.diff(motion.times)
    k = np.flatnonzero(spans > 1e-4)
    shares = np.linspace(0, 1, 21)[1:-1]
    times = motion.times[k, None] + shares * spans[k, None]
    return motion.at(times.ravel()), times, shares


@examples(60)
@every_motion
def test_limits_hold_at_every_moment(curve, limits, faces, start, end):
    motion = timed(curve, limits, faces_its_way=faces, start_heading=start, end_heading=end)
    found, times, _ = moments(motion)
    slack = 1 + 1e-6
    speed = np.linalg.norm(found.velocities, axis=1)
    assert (speed <= limits.speed_mps * slack).all()
    assert (np.abs(found.yaw_rates) <= limits.yaw_rate_radps * slack).all()
    if faces:
        rims = wheel_speeds(speed, found.yaw_rates, limits.track_m)
        assert (np.abs(rims) <= limits.speed_mps * slack).all()
    shape = (*times.shape, curve.control.shape[2])
    step = np.diff(times, axis=1)[:, :, None]
    acceleration = np.linalg.norm(np.diff(found.velocities.reshape(shape), axis=1) / step, axis=2)
    assert (acceleration <= limits.acceleration_mps2 * (1 + 1e-4)).all()
    yaw_acceleration = np.abs(np.diff(found.yaw_rates.reshape(times.shape), axis=1) / step[:, :, 0])
    assert (yaw_acceleration <= limits.yaw_acceleration_radps2 * (1 + 1e-4)).all()


@examples(60)
@every_motion
def test_nothing_jumps_that_cannot(curve, limits, faces, start, end):
    motion = timed(curve, limits, faces_its_way=faces, start_heading=start, end_heading=end)
    jumps = np.flatnonzero(np.diff(motion.times) == 0)
    assert np.diff(motion.times).min() >= 0
    np.testing.assert_allclose(motion.positions[jumps], motion.positions[jumps + 1], atol=1e-9)
    if math.isfinite(limits.acceleration_mps2):
        np.testing.assert_allclose(motion.velocities[jumps], motion.velocities[jumps + 1], atol=1e-5)
    if math.isfinite(limits.yaw_acceleration_radps2):
        np.testing.assert_allclose(motion.yaw_rates[jumps], motion.yaw_rates[jumps + 1], atol=1e-6)
    if math.isfinite(limits.spot_yaw_rate):
        np.testing.assert_allclose(motion.headings[jumps], motion.headings[jumps + 1], atol=1e-5)


@examples(60)
@every_motion
def test_the_curve_is_followed_from_rest_to_rest(curve, limits, faces, start, end):
    motion = timed(curve, limits, faces_its_way=faces, start_heading=start, end_heading=end)
    found, _, _ = moments(motion)
    ends = curve.control[[0, -1], [0, 3]]
    np.testing.assert_array_equal(motion.positions[[0, -1]], ends)
    assert not motion.velocities[[0, -1]].any()
    assert not motion.yaw_rates[[0, -1]].any()
    dense = curve.sample(0.05)
    for point in found.positions[::17]:
        assert np.linalg.norm(dense - point, axis=1).min() <= 0.05
    assert motion.duration_s >= curve.length_m / limits.speed_mps * (1 - 1e-9)
    for heading, wanted in ((motion.headings[0], start), (motion.headings[-1], end)):
        assert wanted is None or math.cos(heading - wanted) == pytest.approx(1)


@examples(60)
@given(curve=curves_in(2), limits=limits_of_robots, start=angle)
def test_a_robot_that_must_looks_where_it_drives(curve, limits, start):
    found, _, _ = moments(timed(curve, limits, faces_its_way=True, start_heading=start))
    over_ground = found.velocities[:, :2]
    speed = np.linalg.norm(over_ground, axis=1)
    ahead = over_ground[:, 0] * np.cos(found.headings) + over_ground[:, 1] * np.sin(found.headings)
    moving = speed > 1e-3
    tolerance = 0.1 if math.isfinite(limits.yaw_acceleration_radps2) else 0.05
    assert (ahead[moving] >= speed[moving] * math.cos(tolerance)).all()


@pytest.mark.parametrize("yaw_acceleration", [1, 2, 4])
def test_behind_a_bend_a_heading_hardly_swings_out(yaw_acceleration):
    """However long the straight segment is, on which the yaw rate of the bend has to end."""
    points = np.array([[0.0, 0], [0, 1], [25, 3]])
    curve = smoothed(Path(points), lambda _: True, radii_m=(0.5,), keep=range(len(points))).curve
    limits = Limits(speed_mps=0.25, yaw_acceleration_radps2=yaw_acceleration)
    found, _, _ = moments(timed(curve, limits, faces_its_way=True))
    over_ground = found.velocities[:, :2]
    ahead = over_ground[:, 0] * np.cos(found.headings) + over_ground[:, 1] * np.sin(found.headings)
    assert (ahead >= np.linalg.norm(over_ground, axis=1) * math.cos(0.06)).all()


@given(
    length=st.floats(0.01, 100), speed=st.floats(0.1, 10), gain=st.floats(0.1, 10), faces=st.booleans(), d=st.just(2)
)
def test_a_straight_line_takes_the_least_time_there_is(length, speed, gain, faces, d):
    line = Curve.along(Path(np.array([[1.0, 2.0], [1.0, 2.0 + length]])))
    motion = timed(line, Limits(speed_mps=speed, acceleration_mps2=gain), faces_its_way=faces)
    ramp = speed**2 / gain
    least = length / speed + speed / gain if length > ramp else 2 * math.sqrt(length / gain)
    assert motion.duration_s == pytest.approx(least, rel=1e-9)


def test_collinear_points_are_no_corners():
    limits = Limits(speed_mps=1, acceleration_mps2=0.5)
    split = timed(Curve.along(Path(np.array([[0.0, 0], [0.3, 0.1], [3, 1]]))), limits, faces_its_way=True)
    whole = timed(Curve.along(Path(np.array([[0.0, 0], [3, 1]]))), limits, faces_its_way=True)
    assert split.duration_s == pytest.approx(whole.duration_s)


def test_at_a_corner_a_differential_drive_stops_and_turns():
    corner = Curve.along(Path(np.array([[0.0, 0], [2, 0], [2, 2]])))
    limits = Limits(speed_mps=1, acceleration_mps2=1, yaw_rate_radps=0.5)
    motion = timed(corner, limits, faces_its_way=True)
    assert motion.duration_s == pytest.approx(3 + math.pi + 3)
    middle = motion.at(3 + math.pi / 2)
    np.testing.assert_allclose(middle.positions, [[2, 0]], atol=1e-12)
    np.testing.assert_allclose((middle.headings, middle.yaw_rates), [[math.pi / 4], [0.5]])
    stopping = timed(corner, limits, faces_its_way=False)
    assert stopping.duration_s == pytest.approx(6)
    assert not stopping.headings.any()
    free = timed(corner, Limits(speed_mps=1), faces_its_way=False)
    assert free.duration_s == pytest.approx(4)


def test_an_arc_is_driven_at_the_greatest_speed_its_limits_allow():
    k = 4 / 3 * math.tan(math.pi / 8)
    arc = Curve(2 * np.array([[[1, 0], [1, k], [k, 1], [0, 1.0]]]))
    for limits, speed in (
        (Limits(speed_mps=1, yaw_rate_radps=0.25), 0.5),
        (Limits(speed_mps=1, track_m=1.0), 0.8),  # (6): 1 / (1 + 0.5 / 2)
        (Limits(speed_mps=1), 1.0),
    ):
        assert timed(arc, limits, faces_its_way=True).duration_s == pytest.approx(math.pi / speed, rel=0.01)


def test_a_smooth_curve_is_faster_than_its_corners():
    path = Path(np.array([[0.0, 0], [4, 0], [4, 4], [8, 4]]))
    limits = Limits(speed_mps=1, acceleration_mps2=1, yaw_rate_radps=1)
    smooth, cornered = smoothed(path, lambda _: True, radii_m=(1.0,)).curve, Curve.along(path)
    assert timed(smooth, limits, faces_its_way=True).duration_s < timed(cornered, limits, faces_its_way=True).duration_s


def test_between_moments_rates_are_the_derivatives():
    motion = Trajectory(
        np.array([0.0, 2.0, 2.0, 3.0]),
        np.array([[0.0, 0.0], [4.0, 1.0], [4.0, 1.0], [5.0, 1.0]]),
        np.array([0.0, 1.0, 1.0, 1.5]),
        np.array([[1.0, 0.0], [2.0, 1.0], [0.0, 0.0], [1.0, 0.0]]),
        np.array([0.2, 0.1, 0.0, 0.0]),
    )
    for t in (0.3, 1.1, 1.9, 2.4):
        near = motion.at([t - 1e-6, t, t + 1e-6])
        np.testing.assert_allclose((near.positions[2] - near.positions[0]) / 2e-6, near.velocities[1], atol=1e-5)
        np.testing.assert_allclose((near.headings[2] - near.headings[0]) / 2e-6, near.yaw_rates[1], atol=1e-5)
    np.testing.assert_array_equal(motion.at([0.0, 2.0, 3.0]).velocities, [[1, 0], [0, 0], [1, 0]])
    np.testing.assert_array_equal(motion.at([-1.0, 9.0]).positions, [[0, 0], [5, 1]])
    assert joined([motion, motion]).duration_s == 6
    assert motion.slower(2).at(2.2).positions == pytest.approx(motion.at(1.1).positions)
    assert motion.sample(0.7).times == pytest.approx([0, 0.7, 1.4, 2.1, 2.8, 3])


@given(speed=st.floats(-5, 5), rate=st.floats(-3, 3), track=st.floats(0.05, 2))
def test_wheels_and_body_are_one(speed, rate, track):
    wheels = wheel_speeds(speed, rate, track)
    np.testing.assert_allclose(body_speeds(wheels, track), [speed, rate], atol=1e-9)
    assert max(abs(wheels)) == pytest.approx(abs(speed) + abs(rate) * track / 2)  # (5)


@given(most=st.floats(0.1, 5), curvature=st.floats(-20, 20), track=st.floats(0.05, 2))
def test_on_a_turn_the_faster_rim_goes_at_its_most(most, curvature, track):
    speed = float(fastest_translation(most, curvature, track))
    assert np.abs(wheel_speeds(speed, speed * curvature, track)).max() == pytest.approx(most)


@pytest.mark.parametrize(
    "wrong", [{"speed_mps": 0}, {"speed_mps": math.inf}, {"acceleration_mps2": -1}, {"yaw_rate_radps": math.nan}]
)
def test_limits_out_of_range(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        Limits(**{"speed_mps": 1} | wrong)
    with pytest.raises(ParameterError, match="step_m"):
        timed(Curve(np.zeros((1, 4, 2))), Limits(speed_mps=1), faces_its_way=True, step_m=0)
