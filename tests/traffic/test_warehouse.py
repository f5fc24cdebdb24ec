"""The shipped warehouse: its aisles are passages for one, so that robots pass by reservation unless told otherwise."""

from __future__ import annotations

import muster
from muster.motion.map_world import World
from muster.traffic.managers import manager_named
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.names import AUTO
from muster.traffic.passages import passages
from muster.traffic.reservation.reserved import ReservedTraffic

AISLES = 2 * 11


def test_each_aisle_is_a_passage_for_one_that_is_open_at_both_ends():
    mission = muster.load("warehouse")
    found = passages(MissionRoadmap.of(mission, World.of(mission)).roadmap)
    assert [passage.exits for passage in found] == [2] * AISLES


def test_robots_pass_by_reservation():
    assert isinstance(manager_named(AUTO, muster.load("warehouse")), ReservedTraffic)
