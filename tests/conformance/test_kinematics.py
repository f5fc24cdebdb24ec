"""What every kind of kinematics keeps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.kinematics.kinematics import approach
from muster.motion.kinematics.registry import KINEMATICS, kinematics_named, limits_of
from muster.motion.limits import Limits

every_kind = pytest.mark.parametrize("kind", KINEMATICS.values(), ids=KINEMATICS)
metres, angle, rate = st.floats(-50, 50), st.floats(-4, 4), st.floats(-5, 5)
teams = st.lists(st.tuples(metres, metres, metres, angle), min_size=1, max_size=4).map(np.array)
limits_of_robots = st.builds(
    Limits,
    speed_mps=st.floats(0.1, 5),
    yaw_rate_radps=st.floats(0.1, 3),
    acceleration_mps2=st.floats(0.1, 5) | st.just(math.inf),
    climb_mps=st.none() | st.floats(0.1, 5),
)
seconds = st.floats(0, 3)


def inputs_for(data, kind, states):
    row = st.tuples(*[rate] * len(kind.input_names))
    return np.array(data.draw(st.lists(row, min_size=len(states), max_size=len(states))))


def wanted_for(data, states):
    return np.array(data.draw(st.lists(st.tuples(rate, rate, rate), min_size=len(states), max_size=len(states))))


@every_kind
@given(states=teams, data=st.data())
def test_no_time_changes_nothing(kind, states, data):
    np.testing.assert_array_equal(kind.step(states, inputs_for(data, kind, states), 0.0), states)


@every_kind
@given(states=teams, data=st.data(), first=seconds, second=seconds)
def test_two_steps_are_one(kind, states, data, first, second):
    inputs = inputs_for(data, kind, states)
    twice = kind.step(kind.step(states, inputs, first), inputs, second)
    np.testing.assert_allclose(twice, kind.step(states, inputs, first + second), atol=1e-9)


@every_kind
@given(states=teams, data=st.data(), dt=seconds)
def test_a_step_back_undoes_a_step(kind, states, data, dt):
    inputs = inputs_for(data, kind, states)
    np.testing.assert_allclose(kind.step(kind.step(states, inputs, dt), inputs, -dt), states, atol=1e-9)


@every_kind
@given(states=teams, data=st.data())
def test_a_step_goes_as_the_velocities_say(kind, states, data):
    inputs = inputs_for(data, kind, states)
    h = 1e-5
    slope = (kind.step(states, inputs, h) - kind.step(states, inputs, -h)) / (2 * h)
    np.testing.assert_allclose(slope, kind.velocities(states, inputs), atol=1e-5)


@every_kind
@given(states=teams, data=st.data(), dt=seconds)
def test_a_step_leaves_its_arguments_and_other_robots_alone(kind, states, data, dt):
    inputs = inputs_for(data, kind, states)
    before = states.copy(), inputs.copy()
    together = kind.step(states, inputs, dt)
    np.testing.assert_array_equal(states, before[0])
    np.testing.assert_array_equal(inputs, before[1])
    for k in range(len(states)):
        np.testing.assert_array_equal(kind.step(states[k : k + 1], inputs[k : k + 1], dt)[0], together[k])


def assert_within(kind, states, inputs, limits):
    velocities = kind.velocities(states, inputs)
    slack = 1 + 1e-9
    assert (np.linalg.norm(velocities[:, :2], axis=1) <= limits.speed_mps * slack).all()
    assert (np.abs(velocities[:, 2]) <= max(limits.climb, limits.speed_mps) * slack).all()
    if kind.name == "quadcopter":
        assert (np.abs(velocities[:, 2]) <= limits.climb * slack).all()
    assert (np.abs(velocities[:, 3]) <= limits.yaw_rate_radps * slack).all()


@every_kind
@given(states=teams, limits=limits_of_robots, data=st.data(), dt=st.floats(0.01, 1))
def test_limited_inputs_keep_the_limits(kind, states, limits, data, dt):
    inputs = inputs_for(data, kind, states)
    before = kind.limited(inputs_for(data, kind, states), limits)
    for limited in (kind.limited(inputs, limits), kind.limited(inputs, limits, before, dt)):
        assert_within(kind, states, limited, limits)
    change = np.linalg.norm((limited - before)[:, :-1], axis=1)
    assert (change <= limits.acceleration_mps2 * dt * (1 + 1e-9)).all()
    np.testing.assert_allclose(kind.limited(before, limits), before, atol=1e-12)
    np.testing.assert_allclose(kind.limited(before, limits, before, dt), before, atol=1e-12)


@every_kind
@given(states=teams, limits=limits_of_robots, data=st.data(), heading=st.none() | angle)
def test_the_control_law_keeps_the_limits_and_never_goes_the_other_way(kind, states, limits, data, heading):
    wanted = wanted_for(data, states)
    headings = None if heading is None else np.full(len(states), heading)
    inputs = kind.inputs(states, wanted, headings, limits)
    assert inputs.shape == (len(states), len(kind.input_names))
    assert_within(kind, states, inputs, limits)
    velocities = kind.velocities(states, inputs)
    assert (np.sum(velocities[:, :2] * wanted[:, :2], axis=1) >= -1e-9).all()


@pytest.mark.parametrize("kind", [kind for kind in KINEMATICS.values() if not kind.faces_its_way])
@given(states=teams, limits=limits_of_robots, data=st.data())
def test_robots_that_go_any_way_have_the_velocity_they_want(kind, states, limits, data):
    wanted = wanted_for(data, states)
    wanted *= np.minimum(1, min(limits.speed_mps, limits.climb) / np.linalg.norm(wanted, axis=1).clip(1e-9))[:, None]
    inputs = kind.inputs(states, wanted, None, limits)
    np.testing.assert_allclose(kind.velocities(states, inputs)[:, :3], wanted, atol=1e-9)


@pytest.mark.long(keep=1)
@every_kind
@examples(25)
@given(
    states=teams, goal=st.tuples(*[st.floats(-10, 10)] * 3), heading=angle, yaw_rate=st.floats(0.5, 3), data=st.data()
)
def test_a_goal_pose_is_reached(kind, states, goal, heading, yaw_rate, data):
    limits = Limits(speed_mps=2.0, yaw_rate_radps=yaw_rate)
    dimensions = 2 if kind.faces_its_way else 3
    states = states * [0.2, 0.2, 0.2, 1]
    headings = np.full(len(states), heading)
    for _ in range(900):
        wanted = np.zeros((len(states), 3))
        offsets = np.array(goal)[:dimensions] - states[:, :dimensions]
        offsets[np.linalg.norm(offsets, axis=1) < 1e-3] = 0  # it is there
        wanted[:, :dimensions] = approach(offsets, limits.speed_mps, 0.5)
        states = kind.step(states, kind.inputs(states, wanted, headings, limits), 0.1)
    assert np.linalg.norm(states[:, :dimensions] - np.array(goal)[:dimensions], axis=1).max() < 2e-3
    np.testing.assert_allclose(np.cos(states[:, 3] - heading), 1, atol=1e-3)


def test_names_are_those_of_missions():
    for name in KINEMATICS:
        robot = Robot(id="r", position=(0, 0), kinematics=name, speed_mps=2, yaw_rate_radps=0.7)
        assert kinematics_named(robot.kinematics).name == name
        assert limits_of(robot) == Limits(speed_mps=2, yaw_rate_radps=0.7)
    with pytest.raises(ParameterError, match="did you mean 'quadcopter'"):
        kinematics_named("quadrocopter")


@pytest.mark.parametrize("wrong", [{"speed_mps": 0}, {"yaw_rate_radps": -1}, {"climb_mps": -1}])
def test_limits_out_of_range(wrong):
    with pytest.raises(ParameterError, match="expected a number above 0"):
        Limits(**wrong)


def test_laws_steer_by_a_finite_yaw_rate():
    for kinematics in KINEMATICS.values():
        state = np.zeros((1, 4))
        with pytest.raises(ParameterError, match="yaw_rate_radps"):
            kinematics.inputs(state, np.ones((1, 3)), np.ones(1), Limits(speed_mps=1))
