"""What crosses the meridian of 180 degrees is cut there: the examples of RFC 7946, and a mission across it."""

import json
import re
from itertools import pairwise
from xml.etree import ElementTree as Tree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.bay import ALT, BAY, LAT, LON, bay

from muster.mission.geodesy import wgs84_to_enu
from muster_files.antimeridian import crosses, cut_line, cut_ring
from muster_files.earth import Earth, Spot
from muster_files.geographic_features import features_of
from muster_files.geojson import geojson_text
from muster_files.gpx import gpx_text
from muster_files.kml import kml_text

ACROSS = BAY.replace(f"lon_deg: {LON}", "lon_deg: 179.9995")
"""45 m west of the meridian: the bay reaches from 100 m west of its origin to 300 m east of it."""
KML = "{http://www.opengis.net/kml/2.2}"


def spots(*places):
    return [Spot(lat, lon, 0.0) for lon, lat in places]


def degrees(parts):
    return [[(spot.lon, spot.lat) for spot in part] for part in parts]


def test_the_line_of_the_standard():
    assert degrees(cut_line(spots((170, 45), (-170, 45)))) == [[(170, 45), (180, 45)], [(-180, 45), (-170, 45)]]


def test_the_rectangle_of_the_standard():
    west, east = cut_ring(spots((170, 40), (-170, 40), (-170, 50), (170, 50)))
    assert set(*degrees([west])) == {(180, 40), (180, 50), (170, 50), (170, 40)}
    assert set(*degrees([east])) == {(-170, 40), (-170, 50), (-180, 50), (-180, 40)}


@pytest.mark.parametrize("turned", [1, -1])
def test_parts_have_the_order_of_the_whole(turned):
    ring = spots((179, 0), (-179, 0), (-179, 1), (179, 1))[::turned]
    for part in cut_ring(ring):
        lon, lat = np.array([(spot.lon, spot.lat) for spot in part]).T
        assert np.sign(np.sum(lon * np.roll(lat, -1) - np.roll(lon, -1) * lat)) == turned


def test_what_does_not_cross_is_left_as_it_is():
    ring = spots((179, 0), (179.5, 0), (179.5, 1))
    assert cut_ring(ring) == [ring]
    assert cut_line(ring) == [ring]


degrees_about = st.tuples(st.floats(-0.02, 0.02).map(lambda d: (180 + d + 180) % 360 - 180), st.floats(-80, 80))


@examples(60)
@given(st.lists(degrees_about, min_size=2, max_size=6))
def test_pieces_lie_on_one_side_and_pass_all_places_in_order(places):
    line = spots(*places)
    pieces = cut_line(line)
    assert not any(crosses(piece) for piece in pieces)
    for before, after in pairwise(pieces):
        assert (before[-1].lon, before[-1].lat) == (-after[0].lon, after[0].lat)
        assert abs(after[0].lon) == 180
    passed = iter([spot for piece in pieces for spot in piece])
    assert all(spot in passed for spot in line)  # which takes from what is passed as far as it looks


@pytest.fixture
def seen(tmp_path):
    mission, verdict, team = bay(tmp_path, ACROSS)
    return features_of(mission, verdict, team, Earth.of(mission, "a test"))


def test_geojson_of_a_mission_across_the_meridian(seen):
    geometries = [feature["geometry"] for feature in json.loads(geojson_text(seen))["features"]]
    assert geometries[0]["type"] == "MultiPolygon"
    assert {"MultiLineString", "Polygon", "Point"} <= {geometry["type"] for geometry in geometries}
    for geometry in geometries:
        for lons in longitudes(geometry):
            assert max(lons) - min(lons) < 1
            assert -180 <= min(lons) <= max(lons) <= 180
    assert sum(map(area_m2, geometries[0]["coordinates"])) == pytest.approx(400 * 400, rel=1e-4)


def longitudes(geometry):
    found = geometry["coordinates"]
    if geometry["type"] == "Point":
        return [[found[0]]]
    lines = {"LineString": [found], "Polygon": found, "MultiLineString": found}.get(geometry["type"])
    lines = [ring for polygon in found for ring in polygon] if lines is None else lines
    return [[place[0] for place in line] for line in lines]


def area_m2(polygon):
    (ring,) = polygon
    x, y = wgs84_to_enu([(lat, lon, ALT) for lon, lat in ring], (LAT, 179.9995, ALT))[:, :2].T
    return np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) / 2


def test_kml_of_a_mission_across_the_meridian(seen):
    root = Tree.fromstring(kml_text(seen))
    assert len(list(root.iter(f"{KML}MultiGeometry"))) == sum(
        geometry["geometry"]["type"].startswith("Multi") for geometry in json.loads(geojson_text(seen))["features"]
    )
    for shape in root.iter(f"{KML}coordinates"):
        lons = [float(place.split(",")[0]) for place in shape.text.split()]
        assert max(lons) - min(lons) < 1


def test_gpx_has_longitudes_below_180(seen):
    lons = [float(lon) for lon in re.findall(r'lon="([^"]*)"', gpx_text(seen))]
    assert all(-180 <= lon < 180 for lon in lons)
    assert min(lons) < 0 < max(lons)
