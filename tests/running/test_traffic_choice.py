"""Who manages the traffic of a run: by the option, the map, the avoidance and the law."""

from __future__ import annotations

from dataclasses import replace

import pytest

from muster import Negotiation, ParameterError, simulate
from muster.mission.lanes import Lane, Lanes
from muster.running.traffic_choice import LOOSE_MARGIN_M, manager_for
from muster.traffic.roadmap import MARGIN_M
from muster_studies.jams import scenes


@pytest.fixture(scope="module")
def door():
    return scenes.one_way_door("holonomic", 0, 3)


@pytest.fixture(scope="module")
def hall(door):
    """Without a map."""
    return replace(door, map=None, rules=replace(door.rules, travel="euclidean"))


def test_a_door_for_one_is_reserved(door):
    assert manager_for("auto", door) is not None
    assert manager_for("reserve", door) is not None
    assert manager_for("free", door) is None


def test_open_space_is_free_unless_lanes_are_given(hall):
    assert manager_for("auto", hall) is None
    assert manager_for("reserve", hall) is not None
    lanes = Lanes(nodes={"a": (-5.0, 0.0), "b": (5.0, 0.0)}, edges=(Lane(start="a", end="b", both_ways=True),))
    assert manager_for("auto", replace(hall, lanes=lanes)) is not None


def test_what_else_is_asked_for_leaves_traffic_free(door):
    assert manager_for("auto", door, avoidance="none") is None
    assert manager_for("auto", door, law="trajectory") is None
    assert manager_for("reserve", door, avoidance="none") is not None


def test_robots_that_are_not_exact_keep_more_between_them(door):
    assert manager_for("auto", door, exact=True).margin_m == MARGIN_M
    assert manager_for("auto", door).margin_m == LOOSE_MARGIN_M


def test_reservation_is_refused_where_it_cannot_be(door):
    with pytest.raises(ParameterError, match="traffic: reserve; expected free: by law trajectory robots leave"):
        manager_for("reserve", door, law="trajectory")
    flying = replace(door, robots=tuple(replace(robot, kind="air") for robot in door.robots))
    assert manager_for("auto", flying) is None
    with pytest.raises(ParameterError, match="expected free: fewer than two robots of kind ground"):
        manager_for("reserve", flying)


def test_without_a_centre_nothing_is_reserved(hall):
    with pytest.raises(ParameterError, match="traffic: reserve; expected free: without a centre"):
        simulate(hall, Negotiation(), traffic="reserve")
