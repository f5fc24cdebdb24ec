"""What a fence holds, and what a way does not keep to."""

import re

import pytest
from tests.exchange.bay import BAY, bay

from muster.exchange.fence import Fence


def fences(folder, text=BAY):
    mission, _, team = bay(folder, text)
    return {i.robot.id: Fence.of(mission, i) for i in team}


def test_a_way_over_a_zone_leaves_it_out_and_one_through_it_breaks_the_fence(tmp_path):
    over = fences(tmp_path)["d2"]  # from (3, 0, 0) to (100, 40, 20), over the zone with a ceiling of 4 m
    assert (over.passed, over.broken, list(over.zones)) == ((1,), (), [0])
    through = fences(tmp_path, BAY.replace("ceiling_m: 4", "ceiling_m: 14"))["d2"]
    assert (through.passed, through.broken, list(through.zones)) == ((), ("zone 1",), [0, 1])
    under = fences(tmp_path, BAY.replace("ceiling_m: 4", "floor_m: 25"))["d2"]
    assert (under.passed, under.broken) == ((1,), ())


def test_a_way_that_is_raised_into_a_zone_breaks_the_fence(tmp_path):
    mission, _, team = bay(tmp_path, BAY.replace("ceiling_m: 4", "floor_m: 25"))
    (d2,) = [i for i in team if i.robot.id == "d2"]
    assert Fence.of(mission, d2.at_least(30)).broken == ("zone 1",)


def test_in_the_plane_heights_of_zones_do_not_count(tmp_path):
    flat = re.sub(r"(position: \[[^],]*, [^],]*), [^],]*\]", r"\1]", BAY)
    assert fences(tmp_path, flat)["d2"].broken == ("zone 1",)


@pytest.mark.parametrize(("corner", "broken"), [("[300, 300]", ()), ("[90, 30]", ("the boundary",))])
def test_a_way_beyond_the_boundary_breaks_the_fence(corner, broken, tmp_path):
    assert fences(tmp_path, BAY.replace("[300, 300]", corner))["d2"].broken == broken


def test_zones_of_others_are_none(tmp_path):
    found = fences(tmp_path)
    assert list(found["rover"].zones) == [0, 1, 2]
    assert 2 not in found["d1"].zones


def test_touching_a_zone_is_not_entering_it(tmp_path):
    beside = BAY.replace("[60, 20], [90, 20], [90, 60], [60, 60]", "[10, 5], [20, 30], [5, 20]")
    assert fences(tmp_path, beside)["rover"].broken == ()  # its way begins at a corner and goes along the side
