"""Robots pass in the order of one sequence of moves: how far each may go, whatever is late."""

from __future__ import annotations

import pytest

from muster.core import LimitedLane, PassingOrder

RADIUS_M, MARGIN_M = 0.3, 0.02


@pytest.fixture
def order():
    return PassingOrder(margin=MARGIN_M, ahead=5.0)


def test_who_comes_first_in_the_order_passes_first(order):
    """Two ways cross: the second robot stops before the way of the first until that has gone by."""
    first, second = order.add((-2.0, 0.0), RADIUS_M), order.add((0.0, -2.0), RADIUS_M)
    assert order.append(first, (2.0, 0.0))
    assert order.append(second, (0.0, 2.0))
    assert order.grant(second).points == []  # the first has not even begun
    assert order.grant(first).points == [(2.0, 0.0)]
    granted = order.grant(second)
    (_, y) = granted.points[-1]
    assert -0.7 < y <= -0.62
    assert (granted.waits_for, granted.last) == (first, False)
    order.progress(first, 0, (0.7, 0.0))
    assert order.grant(second).points == [(0.0, 2.0)]
    assert order.grant(second).last


def test_no_move_leads_to_where_another_stands(order):
    first, second = order.add((0.0, 0.0), RADIUS_M), order.add((1.0, 0.0), RADIUS_M)
    assert not order.append(first, (2.0, 0.0))
    assert order.end(first) == (0.0, 0.0)
    assert order.append(second, (1.0, 3.0))
    assert order.append(first, (2.0, 0.0))


def test_robots_that_stand_too_close_may_part(order):
    first = order.add((0.0, 0.0), RADIUS_M)
    order.add((0.5, 0.0), RADIUS_M)
    assert not order.append(first, (0.2, 0.0))
    assert order.append(first, (-1.0, 0.0))
    assert order.grant(first).points == [(-1.0, 0.0)]


def test_a_new_plan_leaves_what_has_begun(order):
    """A move that waits for one that has not begun does not begin either: both may be replaced."""
    first, second = order.add((0.0, 0.0), RADIUS_M), order.add((-1.0, 0.0), RADIUS_M)
    order.append(first, (1.0, 0.0))
    order.append(second, (0.0, 0.0))
    order.append(second, (0.0, 3.0))
    assert order.grant(second).points == []  # its first move leads to where the other has not yet left
    planned = order.hold([0.0, 0.0])
    assert (planned.end(first), planned.end(second)) == ((0.0, 0.0), (-1.0, 0.0))
    planned.append(first, (1.0, 0.0))
    planned.append(second, (0.0, 0.0))
    order.adopt(planned)
    order.grant(first)
    planned = order.hold([0.0, 0.0])
    assert (planned.end(first), planned.end(second)) == ((1.0, 0.0), (-1.0, 0.0))


def test_while_a_plan_is_made_robots_go_on_by_the_moves_that_it_leaves():
    order = PassingOrder(margin=0.0, ahead=1.0)
    robot, other = order.add((0.0, 0.0), 0.3), order.add((0.0, 3.0), 0.3)
    for x in (1.0, 2.0, 3.0, 4.0):
        order.append(robot, (x, 0.0))
    order.append(other, (3.0, 3.0))
    assert order.grant(robot).points == [(1.0, 0.0)]
    planned = order.hold([1.5, 0.0])
    assert (planned.end(robot), planned.end(other)) == ((2.0, 0.0), (0.0, 3.0))
    order.progress(robot, 1, (1.0, 0.0))
    assert order.grant(robot).points == [(2.0, 0.0)]
    order.progress(robot, 2, (2.0, 0.0))
    waits = order.grant(robot)
    assert (waits.points, waits.last) == ([], False)
    assert order.grant(other).points == []
    assert order.metres_left(robot) == 2.0  # what it is to go by the plan before
    planned.extend([(other, (0.0, 1.0), 0, 1.0), (robot, (2.0, 5.0), 0, 0.5)])
    order.adopt(planned)
    assert (order.end(robot), order.end(other)) == ((2.0, 5.0), (0.0, 1.0))
    grant = order.grant(robot)
    assert (grant.points, grant.speeds) == ([(2.0, 5.0)], [0.5])
    assert order.grant(other).points == [(0.0, 1.0)]
    assert (order.passed(robot), order.metres_left(robot)) == (2, 5.0)


def test_moves_that_wait_for_what_a_plan_may_replace_do_not_begin_meanwhile(order):
    first, second = order.add((-2.0, 0.0), RADIUS_M), order.add((0.0, -2.0), RADIUS_M)
    order.append(first, (2.0, 0.0))
    order.append(second, (0.0, 2.0))
    planned = order.hold([0.0, 10.0])
    assert (planned.end(first), planned.end(second)) == ((-2.0, 0.0), (0.0, -2.0))
    order.release()
    assert order.grant(first).points == [(2.0, 0.0)]
    planned = order.hold([0.0, 10.0])
    assert (planned.end(first), planned.end(second)) == ((2.0, 0.0), (0.0, 2.0))


def test_no_more_robots_go_on_a_lane_than_may_stand_there_if_others_stay():
    """The robot on the lane may be planned anew to stay there."""
    lane = LimitedLane((0.0, 0.0), (10.0, 0.0), most=1)
    order = PassingOrder(margin=0.0, ahead=20.0, lanes=[lane])
    inside, behind = order.add((8.0, 0.0), 0.3), order.add((-1.0, 0.0), 0.3)
    order.append(inside, (12.0, 0.0))
    order.append(behind, (2.0, 0.0))
    assert order.hold([0.0, 5.0]).end(behind) == (-1.0, 0.0)
    assert order.hold([5.0, 5.0]).end(behind) == (2.0, 0.0)


def test_moves_of_a_robot_after_one_that_is_blocked_are_left_out(order):
    robot, other = order.add((0.0, 0.0), RADIUS_M), order.add((2.0, 0.0), RADIUS_M)
    order.extend([(robot, (2.0, 0.0), 0, 1.0), (other, (5.0, 0.0), 0, 1.0), (robot, (3.0, 0.0), 0, 1.0)])
    assert (order.end(robot), order.end(other)) == ((0.0, 0.0), (5.0, 0.0))


def test_a_plan_for_other_robots_is_refused(order):
    planned = order.hold([])
    order.add((0.0, 0.0), RADIUS_M)
    with pytest.raises(ValueError, match="planned: robots were added since"):
        order.adopt(planned)


def test_moves_are_cut_where_robots_have_been_let_go_to(order):
    first, second = order.add((-2.0, 0.0), RADIUS_M), order.add((0.0, -2.0), RADIUS_M)
    order.append(first, (2.0, 0.0))
    order.append(second, (0.0, 2.0))
    order.grant(first)
    stops = order.grant(second).points[-1]
    order.cut()
    assert order.end(second) == stops
    assert order.end(first) == (2.0, 0.0)


def test_a_robot_that_is_not_there_is_refused(order):
    with pytest.raises(ValueError, match="robot: not in the order"):
        order.grant(0)


def test_robots_are_led_from_stop_to_stop_and_others_are_planned_after_all_of_them():
    order = PassingOrder(margin=0.0, ahead=2.0)
    first, second = order.add((0.0, 0.0), 0.3), order.add((-2.0, 0.0), 0.3)
    assert order.append(first, (1.0, 0.0))
    assert not order.append(second, (3.0, 0.0))
    assert order.append(first, (1.0, 2.0), stop=1)
    assert order.append(second, (3.0, 0.0))
    assert (order.stand(first), order.end(first)) == ((1.0, 0.0), (1.0, 2.0))
    grant = order.grant(first)
    assert (grant.points, grant.last) == ([(1.0, 0.0)], True)
    order.progress(first, 1, (1.0, 0.0))
    assert order.grant(first).points == []
    assert order.metres_left(first) == 0.0
    assert order.grant(second).waits_for == first
    order.lead(first, 1)
    assert (order.stand(first), order.metres_left(first)) == ((1.0, 2.0), 2.0)
    assert order.grant(first).points == [(1.0, 2.0)]
    order.progress(first, 2, (1.0, 2.0))
    assert order.grant(second).points == [(3.0, 0.0)]


def test_a_robot_that_stands_elsewhere_than_was_thought_is_there():
    order = PassingOrder(margin=0.0, ahead=2.0)
    robot = order.add((0.0, 0.0), 0.3)
    order.stands(robot, (0.1, 0.0))
    assert order.end(robot) == (0.1, 0.0)
    order.append(robot, (1.0, 0.0))
    order.stands(robot, (0.3, 0.3))
    assert order.end(robot) == (1.0, 0.0)


def test_moves_have_their_speeds():
    order = PassingOrder(margin=0.0, ahead=2.0)
    robot = order.add((0.0, 0.0), 0.3)
    order.append(robot, (1.0, 0.0), speed=0.5)
    order.append(robot, (2.0, 0.0))
    assert order.grant(robot).speeds == [0.5, float("inf")]


def with_lane(most, *, both_ways=False):
    lane = LimitedLane((0.0, 0.0), (10.0, 0.0), most=most, both_ways=both_ways)
    return PassingOrder(margin=MARGIN_M, ahead=5.0, lanes=[lane])


def test_a_lane_for_one_is_left_before_the_next_enters_it():
    order = with_lane(1)
    first, second = order.add((0.0, 0.0), RADIUS_M), order.add((-2.0, 0.0), RADIUS_M)
    for robot in (first, second):
        if robot == second:
            assert order.append(robot, (0.0, 0.0))
        assert order.append(robot, (10.0, 0.0))
        assert order.append(robot, (10.0, 4.0 - robot))
    assert order.grant(first).points == [(10.0, 0.0)]
    order.progress(first, 0, (8.0, 0.0))
    assert order.grant(first).ended == 2  # it has begun to go on, but is on the lane still
    granted = order.grant(second)
    assert (granted.points, granted.waits_for) == ([(0.0, 0.0)], first)
    order.progress(first, 1, (10.0, 0.0))
    assert order.grant(second).points[0] == (0.0, 0.0)
    assert order.grant(second).ended == 1
    assert order.grant(second).points[-1][0] > 9.0


def test_no_move_is_one_too_many_on_a_lane():
    order = with_lane(2)
    robots = [order.add((x, 0.0), RADIUS_M) for x in (7.0, 4.0, -1.0)]
    assert not order.append(robots[2], (2.0, 0.0))
    assert order.append(robots[0], (10.0, 0.0))
    assert order.append(robots[2], (2.0, 0.0))
    assert order.grant(robots[2]).waits_for == robots[0]


def test_who_comes_from_beside_or_against_a_lane_enters_it_too():
    for both_ways, (place, to), may in (
        (False, ((6.0, 2.0), (6.0, 0.0)), False),
        (True, ((11.0, 0.0), (6.0, 0.0)), False),
        (False, ((11.0, 0.0), (6.0, 0.0)), True),
        (False, ((8.0, 2.0), (8.0, -2.0)), True),
    ):
        order = with_lane(1, both_ways=both_ways)
        order.add((2.0, 0.0), RADIUS_M)
        assert order.append(order.add(place, RADIUS_M), to) == may


def test_robots_enter_a_lane_in_the_order_of_the_sequence():
    """The second is nearer, but would take the place of the first."""
    order = with_lane(1, both_ways=True)
    first, second = order.add((-4.0, 0.0), RADIUS_M), order.add((10.0, 0.0), RADIUS_M)
    assert order.append(first, (-2.0, 3.0))
    assert order.append(first, (0.0, 0.0))
    assert order.append(first, (3.0, 0.0))
    assert order.append(first, (3.0, 3.0))
    assert order.append(second, (7.0, 0.0))
    assert order.grant(second).waits_for == first
