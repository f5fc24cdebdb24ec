"""Ways round robots that are out."""

import math
from itertools import pairwise

from muster.execution.deadlocks.way_round import way_round
from muster.execution.robots.monitor import distance_to_piece
from muster.execution.robots.task_motion import places_of
from muster.mission.model import Robot
from muster.motion.port import Waypoint

ROBOT = Robot(id="r_0", position=(0.0, 0.0), radius_m=0.3)
START, GOAL = (0.0, 0.0, 0.0), (10.0, 0.0, 0.0)


def straight(robot, start, goal):
    return [Waypoint(goal)]


def corridor(half_m):
    """Ways in a corridor: none to where a robot cannot stand."""
    return lambda robot, start, goal: [Waypoint(goal)] if abs(goal[1]) <= half_m - robot.radius_m else None


def nearest(way, place):
    return min(distance_to_piece(place, *piece) for piece in pairwise([START, *way]))


def test_it_keeps_clear_of_the_one_in_the_way_and_of_others():
    about, other = ((1.0, 0.0, 0.0), 0.3), ((1.5, 0.7, 0.0), 0.3)
    way = places_of(way_round(straight, ROBOT, START, GOAL, about, [other]))
    assert way[-1] == GOAL
    assert min(nearest(way, about[0]), nearest(way, other[0])) >= 0.6
    assert sum(map(math.dist, [START, *way], way)) < 11.0


def test_in_a_corridor_it_stays_within():
    about = ((1.0, 0.3, 0.0), 0.3)
    way = places_of(way_round(corridor(1.25), ROBOT, START, GOAL, about, []))
    assert all(abs(y) <= 0.95 for _, y, _ in way)
    assert nearest(way, about[0]) >= 0.6


def test_it_turns_several_times_where_walls_leave_no_room_for_wide_turns():
    start, goal, about = (0.3, 0.0, 0.0), (1.7, 0.0, 0.0), ((1.0, 0.0, 0.0), 0.3)
    way = places_of(way_round(corridor(1.1), ROBOT, start, goal, about, []))
    assert way[-1] == goal
    assert all(abs(y) <= 0.8 for _, y, _ in way)
    assert min(distance_to_piece(about[0], *piece) for piece in pairwise([start, *way])) >= 0.6


def test_there_is_none_where_it_is_too_narrow():
    assert way_round(corridor(0.5), ROBOT, START, GOAL, ((1.0, 0.0, 0.0), 0.3), []) is None
