"""What a fence holds, and which ways are not written."""

import re

import pytest
from tests.muster_files.bay import BAY, bay, bay_plan

from muster import export, load
from muster.mission.errors import PlanError
from muster_files.fence import Fence
from muster_files.open_ways import require_open_itineraries


def fences(folder, text=BAY):
    mission, _, team = bay(folder, text)
    return {i.robot.id: Fence.of(mission, i) for i in team}


def test_a_way_over_or_under_a_zone_leaves_it_out(tmp_path):
    over = fences(tmp_path)["d2"]  # from (3, 0, 0) to (100, 40, 20), over the zone with a ceiling of 4 m
    assert (over.passed, list(over.zones)) == ((1,), [0])
    assert fences(tmp_path, BAY.replace("ceiling_m: 4", "floor_m: 25"))["d2"].passed == (1,)


def test_a_way_that_is_raised_into_a_zone_is_refused(tmp_path):
    mission, _, team = bay(tmp_path, BAY.replace("ceiling_m: 4", "floor_m: 25"))
    require_open_itineraries(mission, team)
    with pytest.raises(PlanError, match=r"closed-area: d2, a, the leg from .* enters zone 1"):
        require_open_itineraries(mission, [i.at_least(30) for i in team])


FLAT = re.sub(r"(position: \[[^],]*, [^],]*), [^],]*\]", r"\1]", BAY)


@pytest.mark.parametrize(
    ("text", "area"),
    [
        pytest.param(BAY.replace("ceiling_m: 4", "ceiling_m: 14"), "zone 1", id="through a zone"),
        pytest.param(FLAT, "zone 1", id="heights of zones do not count in the plane"),
        pytest.param(BAY.replace("[300, 300]", "[90, 30]"), "the boundary", id="beyond the boundary"),
    ],
)
def test_a_way_through_a_closed_area_is_not_written(text, area, tmp_path):
    (tmp_path / "bay.yaml").write_text(text, encoding="utf-8")
    mission = load(tmp_path / "bay.yaml")
    with pytest.raises(PlanError, match=rf"closed-area: d., ., the (leg|work) .* {area}"):
        export(mission, bay_plan(), "geojson")


def test_zones_of_others_are_none(tmp_path):
    found = fences(tmp_path)
    assert list(found["rover"].zones) == [0, 1, 2]
    assert 2 not in found["d1"].zones


def test_touching_a_zone_is_not_entering_it(tmp_path):
    zone = "[60, 20], [90, 20], [90, 60], [60, 60]], ceiling_m: 4"
    beside = BAY.replace(zone, "[10, 5], [20, 30], [5, 20]], forbidden_to: [ground]")
    at = "id: rover, position: [10, 5, 0], speed_mps: 1"
    assert fences(tmp_path, beside.replace(f"{at}, radius_m: 0.3", at))["rover"].passed == ()  # along a side of it
