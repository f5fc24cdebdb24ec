"""What is left of a robot's shifts at a time, and from when on it works so long."""

import math

import pytest

from muster import Robot

THREE = Robot(id="r", position=(0, 0), shifts_s=((0, 10), (20, 30), (40, None)))


@pytest.mark.parametrize(
    ("now", "seconds", "begins"),
    [(0, 10, 0), (1, 10, 20), (1, 11, 40), (1, 9, 1), (12, 5, 20), (28, 2, 28), (29, 2, 40), (99, 50, 99)],
)
def test_a_robot_sets_out_where_a_shift_lasts(now, seconds, begins):
    assert THREE.set_out(now, seconds) == begins
    assert Robot(id="r", position=(0, 0)).set_out(now, seconds) == now


def test_no_shift_is_left():
    assert THREE.until_time(45).set_out(44, 2) == math.inf


@pytest.mark.parametrize(
    ("now", "shifts"),
    [
        (0, THREE.shifts_s),
        (5, ((5, 10), (20, 30), (40, None))),
        (10, ((20, 30), (40, None))),
        (25, ((25, 30), (40, None))),
    ],
)
def test_what_is_left_from_a_time_on(now, shifts):
    left = THREE.from_time(now)
    assert (left.shifts_s, left.available_from_s, left.available_until_s) == (shifts, shifts[0][0], None)


def test_the_last_shift_is_one_like_any_other():
    last = THREE.from_time(41)
    assert (last.shifts_s, last.available_from_s, last.available_until_s) == ((), 41, None)
    gone = THREE.until_time(50).from_time(60)
    assert (gone.shifts_s, gone.available_from_s, gone.available_until_s) == ((), 60, 60)


def test_what_is_left_until_a_time():
    assert THREE.until_time(25).shifts_s == ((0, 10), (20, 25))
    assert THREE.until_time(20).available_until_s == 10
    assert Robot(id="r", position=(0, 0), available_from_s=3).until_time(9).available_until_s == 9
