"""What is left of a robot's shifts at a time."""

import pytest

from muster import Robot

THREE = Robot(id="r", position=(0, 0), shifts_s=((0, 10), (20, 30), (40, None)))
LAST = Robot(id="r", position=(0, 0), shifts_s=((0, 10), (40, 50)))


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
    gone = LAST.from_time(60)
    assert (gone.shifts_s, gone.available_from_s, gone.available_until_s) == ((), 60, 60)


def test_who_is_busy_is_so_in_no_break():
    """At work from 5 to 25, and then in what is left of the second shift."""
    assert THREE.busy(5, 25).shifts_s == ((5, 30), (40, None))
    assert THREE.busy(12, 15).shifts_s == ((12, 15), (20, 30), (40, None))
    assert THREE.busy(25, 25) == THREE.from_time(25)
    plain = Robot(id="r", position=(0, 0), available_until_s=9)
    assert (plain.busy(12, 15).available_from_s, plain.busy(12, 15).available_until_s) == (12, 12)
