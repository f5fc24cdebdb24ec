"""Robots pass in the order of one sequence of moves: how far each may go, whatever is late."""

from __future__ import annotations

import pytest

from muster.core import PassingOrder

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
    """A move that waits for one that has not begun does not begin either: both may be dropped."""
    first, second = order.add((0.0, 0.0), RADIUS_M), order.add((-1.0, 0.0), RADIUS_M)
    order.append(first, (1.0, 0.0))
    order.append(second, (0.0, 0.0))
    order.append(second, (0.0, 3.0))
    assert order.grant(second).points == []  # its first move leads to where the other has not yet left
    order.drop_ahead()
    assert (order.end(first), order.end(second)) == ((0.0, 0.0), (-1.0, 0.0))
    order.append(first, (1.0, 0.0))
    order.append(second, (0.0, 0.0))
    order.grant(first)
    order.drop_ahead()
    assert (order.end(first), order.end(second)) == ((1.0, 0.0), (-1.0, 0.0))


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
