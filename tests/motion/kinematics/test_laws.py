"""The thesis' control laws, number by number, its misprints corrected."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.motion.kinematics.differential_drive import DifferentialDrive
from muster.motion.kinematics.kinematics import approach, turn_towards
from muster.motion.kinematics.quadcopter import Quadcopter
from muster.motion.limits import Limits

LIMITS = Limits(speed_mps=2.0, yaw_rate_radps=1.5)
angle = st.floats(-math.pi, math.pi)
speed = st.floats(0.01, 2)


@given(height=st.floats(-9, 9), top=st.floats(0.1, 3), interval=st.floats(0.1, 3))
def test_the_climb_of_4_12(height, top, interval):
    printed = math.copysign(top, height) if abs(height) > top * interval else height / interval
    assert approach(np.array([[height]]), top, interval)[0, 0] == pytest.approx(printed)


@given(yaw=angle, heading=angle)
def test_the_turn_of_4_13_up_to_a_right_angle(yaw, heading):
    found = turn_towards(np.array([yaw]), np.array([heading]), 1.5)[0]
    off = math.remainder(heading - yaw, 2 * math.pi)
    if abs(off) < math.pi / 2:
        assert found == pytest.approx(1.5 * math.sin(off), abs=1e-12)
    else:
        assert abs(found) == 1.5


@given(yaw=angle, travel=angle, most=speed)
def test_the_quadcopter_travels_as_4_11_asks_whatever_its_yaw(yaw, travel, most):
    """(4.14)-(4.16) with (4.8) corrected; with (4.8) as printed the direction would be another."""
    state = np.array([[1.0, 2.0, 3.0, yaw]])
    wanted = np.array([[most * math.cos(travel), most * math.sin(travel), 0.0]])
    inputs = Quadcopter().inputs(state, wanted, None, LIMITS)
    np.testing.assert_allclose(
        inputs, [[most * math.cos(travel - yaw), most * math.sin(travel - yaw), 0, 0]], atol=1e-9
    )
    np.testing.assert_allclose(Quadcopter().velocities(state, inputs)[:, :3], wanted, atol=1e-9)


@given(yaw=angle, travel=angle, most=speed)
def test_the_differential_drive_of_4_24_and_4_25(yaw, travel, most):
    state = np.array([[1.0, 2.0, 0.0, yaw]])
    wanted = np.array([[most * math.cos(travel), most * math.sin(travel), 0.0]])
    expected = [[most * math.cos(travel - yaw), 1.5 * math.sin(travel - yaw)]]
    np.testing.assert_allclose(DifferentialDrive().inputs(state, wanted, None, LIMITS), expected, atol=1e-9)


def test_a_quarter_of_a_circle():
    quarter = DifferentialDrive().step(np.zeros((1, 4)), np.array([[math.pi, math.pi / 2]]), 1.0)
    np.testing.assert_allclose(quarter, [[2, 2, 0, math.pi / 2]])
    sideways = Quadcopter().step(np.zeros((1, 4)), np.array([[0.0, math.pi, 0.5, -math.pi / 2]]), 1.0)
    np.testing.assert_allclose(sideways, [[2, 2, 0.5, -math.pi / 2]])
