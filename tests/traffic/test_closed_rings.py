"""Where robots at rest close others out of their ends."""

from __future__ import annotations

from dataclasses import replace

import pytest

from muster import Mission, Robot, Task
from muster.traffic.blockages.closed_rings import can_close_out


def mission(places, robots=None, radius_m=0.3, **more):
    """As many robots as places, if nothing else is said, in a line far away."""
    count = len(places) if robots is None else robots
    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(3.0 * k, -50.0), radius_m=radius_m, **more) for k in range(count)),
        tasks=tuple(Task(id=f"t_{k}", position=place) for k, place in enumerate(places)),
    )


def block(columns, rows, apart_m=1.0):
    return [(column * apart_m, row * apart_m) for column in range(columns) for row in range(rows)]


RING = [place for place in block(3, 3) if place != (1.0, 1.0)]


@pytest.mark.parametrize(
    ("places", "closes"),
    [
        (block(3, 3), True),
        (block(9, 2), False),
        (block(3, 3, 1.25), False),  # one gets through between two
        (RING, False),  # nobody has to go in
        ([place for place in block(3, 3) if place != (0.0, 1.0)], False),
        ([place for place in block(3, 3) if place != (2.0, 1.0)], False),
        ([*RING, (1.0, 7.0)], False),
        ([*block(3, 3), *((x + 9.0, y) for x, y in block(4, 2))], True),
    ],
)
def test_a_ring_around_a_place(places, closes):
    assert can_close_out(mission(places)) is closes


def test_it_takes_as_many_robots_as_stand_in_the_ring():
    assert can_close_out(mission(block(7, 7), 9))
    assert not can_close_out(mission(block(7, 7), 8))
    assert not can_close_out(mission(block(3, 3), 1))
    assert not can_close_out(mission([], 9))


def test_where_robots_drive_home_only_their_homes_count():
    assert not can_close_out(mission(block(3, 3), return_to_start=True))
    at_home = mission(block(3, 3), return_to_start=True)
    homes = tuple(replace(robot, position=place) for robot, place in zip(at_home.robots, block(3, 3), strict=True))
    assert can_close_out(replace(at_home, robots=homes))


def test_robots_without_a_radius_or_in_the_air_close_nobody_out():
    assert not can_close_out(mission(block(3, 3), radius_m=0.0))
    assert not can_close_out(mission(block(3, 3), kind="air"))


@pytest.mark.parametrize(("inner", "outer", "closes"), [(0.3, 0.3, False), (0.3, 0.55, True), (0.55, 0.3, True)])
def test_who_gets_through_between_two_depends_on_these_three(inner, outer, closes):
    """Ends 1.25 m apart, each for one robot: those of the ring, and the one in its middle."""
    places = block(3, 3, 1.25)
    robots = tuple(
        Robot(id=f"r_{k}", position=(3.0 * k, -50.0), radius_m=inner if place == (1.25, 1.25) else outer)
        for k, place in enumerate(places)
    )
    tasks = tuple(Task(id=f"t_{k}", position=place, only_robots=(f"r_{k}",)) for k, place in enumerate(places))
    assert can_close_out(Mission(robots=robots, tasks=tasks)) is closes


def test_a_wide_robot_far_away_closes_no_gap_between_small_ones():
    places = block(3, 3, 1.25)
    small = mission(places)
    wide = Robot(id="wide", position=(0.0, 50.0), radius_m=0.8)
    tasks = tuple(replace(task, only_robots=tuple(robot.id for robot in small.robots)) for task in small.tasks)
    assert not can_close_out(replace(small, robots=(*small.robots, wide), tasks=tasks))
