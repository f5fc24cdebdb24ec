"""Zones that are drawn on the map, as they stand in the text."""

from __future__ import annotations

import pytest

from muster_control.work.editing.changes import add_zone
from muster_control.work.editing.edits import EditError, data_of

WITH_MAP = """\
map: {boundary: [[0, 0], [9, 0], [9, 9], [0, 9]]}   # the yard
robots: [{id: a, position: [-20, 3]}]
tasks: []
"""
WITHOUT = "robots: [{id: a, position: [-20, 3]}]\ntasks: []\n"
CORNERS = [[8.780000000000001, 8], [12, 8.004], [12, 12]]
NEAT = [[8.78, 8], [12, 8], [12, 12]]


def test_corners_are_kept_to_centimetres_and_what_is_not_said_is_not_written() -> None:
    text = add_zone(WITH_MAP, CORNERS)
    assert data_of(text)["map"]["zones"] == [{"polygon": NEAT}]
    assert "8.78," in text
    assert "# the yard" in text


def test_heights_and_whom_it_is_closed_to_are_kept() -> None:
    zone = data_of(add_zone(WITH_MAP, CORNERS, floor=0.5, ceiling=3, forbidden_to=["air"]))["map"]["zones"][0]
    assert zone == {"polygon": NEAT, "floor_m": 0.5, "ceiling_m": 3, "forbidden_to": ["air"]}


def test_a_boundary_is_made_only_where_there_is_no_map() -> None:
    ground = data_of(add_zone(WITHOUT, CORNERS))["map"]
    assert ground == {"boundary": [[-25, -2], [18, -2], [18, 18], [-25, 18]], "zones": [{"polygon": NEAT}]}
    twice = add_zone(add_zone(WITH_MAP, CORNERS), CORNERS)
    assert len(data_of(twice)["map"]["zones"]) == 2
    assert data_of(twice)["map"]["boundary"] == data_of(WITH_MAP)["map"]["boundary"]


def test_what_is_no_zone_is_refused() -> None:
    with pytest.raises(EditError, match="at least 3"):
        add_zone(WITH_MAP, CORNERS[:2])
    with pytest.raises(EditError, match="below ceiling_m"):
        add_zone(WITH_MAP, CORNERS, floor=3, ceiling=3)
    with pytest.raises(EditError, match="forbidden_to"):
        add_zone(WITH_MAP, CORNERS, forbidden_to=[])
