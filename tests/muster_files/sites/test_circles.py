"""Closed areas that are circles, in missions and sites: polygons around them, at most 1 % larger."""

import math

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.sites import writers
from tests.muster_files.sites.writers import feature, geojson, points

from muster import MissionError, load, read_site
from muster.mission.reading.circles import enclosing
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text

MISSION = """\
schema: muster/1
origin_wgs84: {{lat_deg: 47, lon_deg: 11}}
map: {{boundary: [[-500, -500], [500, -500], [500, 500], [-500, 500]], zones: [{zone}]}}
robots: [{{id: r, position: [-400, 0]}}]
tasks: [{{id: a, position: [400, 0]}}]
"""


@pytest.fixture
def team(tmp_path):
    file = tmp_path / "team.csv"
    file.write_text("id,lat,lon,kind\nd1,47.3768,8.5416,air\n", encoding="utf-8")
    return file


def mission(folder, zone):
    file = folder / "m.yaml"
    file.write_text(MISSION.format(zone=zone), encoding="utf-8")
    return load(file)


@examples(200)
@given(st.floats(-1e5, 1e5), st.floats(-1e5, 1e5), st.floats(0.05, 1e4))
def test_the_polygon_encloses_the_circle_and_is_at_most_a_hundredth_larger(x, y, radius):
    area = shapely.Polygon(enclosing((x, y), radius))
    assert shapely.distance(shapely.Point(x, y), area.exterior) >= radius
    assert area.area <= 1.01 * math.pi * radius**2
    assert shapely.hausdorff_distance(shapely.Point(x, y), area.exterior) <= 1.01 * radius


def test_a_circle_of_a_mission_is_written_back_as_its_polygon(tmp_path):
    found = mission(tmp_path, "{circle: {center: [0, 0], radius_m: 300}, forbidden_to: [air]}")
    (zone,) = found.map.zones
    assert (len(zone.polygon), zone.forbidden_to) == (32, ("air",))
    assert parse_yaml(yaml_text(found), tmp_path / "again.yaml") == found
    degrees = mission(tmp_path, "{circle: {center: {lat_lon: [47, 11]}, radius_m: 300}, forbidden_to: [air]}")
    assert degrees.map == found.map


@pytest.mark.parametrize(
    ("zone", "message"),
    [
        ("{circle: {center: [0, 0]}}", r"zones\[0\].circle.radius_m: missing"),
        ("{circle: {center: [0, 0], radius_m: 0}}", r"circle.radius_m: 0; expected a finite number, above 0"),
        ("{circle: {center: [0, 0, 1], radius_m: 5}}", r"circle.center: \[0, 0, 1\]; expected \[x, y\]"),
        ("{circle: {centre: [0, 0], radius_m: 5}}", "did you mean 'center'"),
        ("{circle: 5}", r"circle: 5; expected a circle with the keys center, radius_m"),
        ("{circle: {center: {lat_lon: [470, 11]}, radius_m: 5}}", r"circle.center.lat_lon\[0\]: 470"),
        ("{circle: {center: [0, 0], radius_m: 5}, polygon: [[0, 0], [1, 0], [1, 1]]}", "polygon or circle, not both"),
    ],
)
def test_circles_that_are_none(tmp_path, zone, message):
    with pytest.raises(MissionError, match=message):
        mission(tmp_path, zone)


@pytest.mark.parametrize(
    ("properties", "metres"),
    [
        ({"radius": 300}, 300),
        ({"radius_m": "300"}, 300),
        ({"radius (m)": 300}, 300),
        ({"Radius [km]": "0,3"}, 300),
        ({"radius": "1000 ft"}, 304.8),
        ({"radius": "0.5 NM"}, 926),
        ({"diameter": "600 m"}, 300),
    ],
)
@pytest.mark.parametrize("form", ["geojson", "kml", "csv"])
def test_a_closed_point_with_a_radius_is_a_round_zone(tmp_path, team, properties, metres, form):
    ((key, value),) = properties.items()
    if form == "geojson":
        text = geojson(feature("Point", [8.5417, 47.3775], name="No-fly helipad", **properties), *points())
    elif form == "kml":
        data = f"<ExtendedData><Data name='{key}'><value>{value}</value></Data></ExtendedData>"
        place = f"{data}<Point><coordinates>8.5417,47.3775</coordinates></Point>"
        text = writers.kml(writers.placemark("No-fly helipad", place), *writers.kml_points())
    else:
        rows = "".join(f"{name};{lat};{lon};\n" for name, lat, lon in writers.TASKS)
        text = f"name;lat;lon;{key}\nNo-fly helipad;47.3775;8.5417;{value}\n{rows}"
    file = tmp_path / f"site.{form}"
    file.write_text(text, encoding="utf-8")
    found = read_site(file, robots=team)
    assert [task.id for task in found.mission.tasks] == ["north", "east", "south"]
    (zone,) = found.mission.map.zones
    area = shapely.Polygon(zone.polygon)
    assert math.pi * metres**2 <= area.area <= 1.01 * math.pi * metres**2
    north = found.mission.tasks[0].position[:2]
    assert shapely.distance(area.centroid, shapely.Point(north)) == pytest.approx(0, abs=1e-3)
    assert shapely.Polygon(found.mission.map.boundary).covers(area)


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({}, "a closed area at a point, without a radius"),
        ({"radius": 0.3}, "expected a radius with its unit, as 0.3 km or 0.3 m"),
        ({"radius": "wide"}, "radius: wide; expected a number"),
        ({"radius": "-5 m"}, "expected more than 0"),
        ({"radius (min)": 5}, r"radius \(min\): a unit that does not fit; expected m, km"),
    ],
)
def test_a_closed_point_without_a_radius_is_an_error(tmp_path, team, properties, message):
    file = tmp_path / "site.geojson"
    file.write_text(geojson(feature("Point", [8.5417, 47.3775], name="No-fly", **properties)), encoding="utf-8")
    with pytest.raises(MissionError, match=message):
        read_site(file, robots=team)


def test_a_radius_beside_a_point_that_no_word_closes_is_asked_about(tmp_path, team):
    file = tmp_path / "site.geojson"
    file.write_text(geojson(feature("Point", [8.5417, 47.3775], name="School", radius=80)), encoding="utf-8")
    with pytest.raises(MissionError, match=r"undecided: radius beside a point: a round closed area, or a task"):
        read_site(file, robots=team)
    assert len(read_site(file, robots=team, kinds={"School": "zone"}).mission.map.zones) == 1
    assert len(read_site(file, robots=team, kinds={"School": "task"}).mission.tasks) == 1


def test_circles_in_metres(tmp_path):
    site, team = tmp_path / "site.csv", tmp_path / "rovers.csv"
    site.write_text("name,x,y,radius_m\nKeep out,10,20,5\nmast,40,20,\n", encoding="utf-8")
    team.write_text("id,x,y\nr,0,0\n", encoding="utf-8")
    (zone,) = read_site(site, team).mission.map.zones
    assert shapely.Polygon(zone.polygon).contains(shapely.Point(10, 20).buffer(5))
