"""A plan exported as a map or a table and read as a site: places, areas and stations the same within a centimetre.

Anywhere on Earth but about the poles, across the meridian of 180 degrees and far north; in the plane and in space.
"""

import tempfile
from pathlib import Path

import numpy as np
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.sites.writers import write_geopackage

from muster.mission.geodesy import enu_to_wgs84, wgs84_to_enu
from muster.mission.model import Map, Mission, Origin, Robot, Rules, Station, Task, Zone
from muster.mission.plan import Plan, Route
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported
from muster.verification import verify
from muster_files.antimeridian import cut_ring
from muster_files.earth import Earth
from muster_files.importing import read_site

WITHIN_M = 0.01
ROBOTS = "id,lat_deg,lon_deg\nr_0,{lat!r},{lon!r}\n"

longitudes = st.one_of(st.floats(-180, 180), st.floats(-0.03, 0.03).map(lambda d: (360 + d) % 360 - 180))
latitudes = st.one_of(st.floats(-80, 80), st.floats(79, 85))
origins = st.builds(Origin, lat_deg=latitudes, lon_deg=longitudes, alt_m=st.floats(-50, 4000))
horizontal = st.tuples(*[st.floats(-3000, 3000)] * 2)
zones = st.builds(
    lambda x, y, size, kinds: Zone(polygon=((x, y), (x + size, y), (x, y + size)), forbidden_to=kinds),
    *[st.floats(-2000, 2000)] * 2,
    st.floats(5, 500),
    st.sampled_from([("ground",), ("air",), ("ground", "air")]),
)
maps = st.lists(zones, max_size=3, unique_by=lambda zone: zone.polygon).map(
    lambda found: Map(boundary=((-3500, -3500), (3500, -3500), (3500, 3500), (-3500, 3500)), zones=tuple(found))
)


@st.composite
def sites(draw, flat=False):
    spatial = not flat and draw(st.booleans())
    place = st.tuples(horizontal, st.floats(0, 500)).map(lambda p: (*p[0], p[1]) if spatial else p[0])
    robots = tuple(Robot(id=f"r_{k}", position=draw(place), kind="air" if k else "ground") for k in range(2))
    tasks = tuple(Task(id=f"t {k}", position=draw(place)) for k in range(draw(st.integers(1, 5))))
    stations = tuple(
        Station(id=f"s_{k}", position=draw(place), services=("unload",)) for k in range(draw(st.integers(0, 1)))
    )
    return Mission(
        origin_wgs84=draw(origins),
        rules=Rules(travel="euclidean"),
        map=draw(st.none() | maps),
        robots=robots,
        tasks=tasks,
        stations=stations,
    )


def there_and_back(mission, form):
    plan = Plan(routes=(Route("r_0", tuple(task.id for task in mission.tasks)), Route("r_1", ())))
    verdict = verify(mission, plan)
    assume(verdict.valid)
    (text,) = exported(mission, verdict, form, ExportOptions()).texts.values()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"site.{form}"
        file.write_text(text, encoding="utf-8")
        robots = None
        if form == "csv":  # has the stops of a plan alone
            robots = Path(folder) / "robots.csv"
            start = Earth.of(mission, "a test").spot(mission.robots[0].position)
            robots.write_text(ROBOTS.format(lat=start.lat, lon=start.lon), encoding="utf-8")
        kinds = {"r_0": "ground", "r_1": "air"} if form == "gpx" else {}  # which way points have no place for
        return read_site(file, robots=robots, kinds=kinds).mission


@examples(40)
@given(sites(), st.sampled_from(["geojson", "kml", "gpx"]))
def test_a_site_exported_and_read_is_the_same_within_a_centimetre(mission, form):
    again = there_and_back(mission, form)
    for group in ("robots", "tasks", "stations"):
        ours, theirs = getattr(mission, group), getattr(again, group)
        assert {one.id for one in theirs} == {one.id for one in ours}
        assert_same_places(mission, again, group, over_ground=form == "kml")
    assert [robot.kind for robot in again.robots] == [robot.kind for robot in mission.robots]
    if form != "gpx" and mission.map is not None:
        assert_same_map(mission, again)
    assert parse_yaml(yaml_text(again), Path("again.yaml")) == again


@examples(20)
@given(sites(flat=True))
def test_a_table_of_stops_read_again_has_the_same_tasks(mission):
    again = there_and_back(mission, "csv")
    assert {task.id for task in again.tasks} == {task.id for task in mission.tasks}
    assert_same_places(mission, again, "tasks")


@examples(30)
@given(sites(flat=True))
def test_a_geopackage_has_the_same_places_and_areas(mission):
    earth = Earth.of(mission, "a test")
    layers = {
        group: [
            (shapely.Point(*_lon_lat(earth.spot(one.position))), _properties(one)) for one in getattr(mission, group)
        ]
        for group in ("robots", "tasks")
    }
    if mission.map is not None:
        layers["boundary"] = [(_polygon(earth, mission.map.boundary), {})]
        layers["zones"] = [
            (_polygon(earth, zone.polygon), {"forbidden_to": " ".join(zone.forbidden_to)}) for zone in mission.map.zones
        ]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "site.gpkg"
        write_geopackage(file, layers)
        again = read_site(file).mission
    for group in ("robots", "tasks"):
        assert_same_places(mission, again, group)
    if mission.map is not None:
        assert_same_map(mission, again)


def _properties(one):
    return {"id": one.id} | ({"moves": one.kind} if isinstance(one, Robot) else {})


def _lon_lat(spot):
    return spot.lon, spot.lat


def _polygon(earth, corners):
    parts = [shapely.Polygon([_lon_lat(spot) for spot in ring]) for ring in cut_ring(earth.spots(corners))]
    return parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts)


def assert_same_places(mission, again, group, *, over_ground=False):
    """Heights over the ground are the same numbers; others are the same places on Earth."""
    ours = {one.id: one.position for one in getattr(mission, group)}
    theirs = {one.id: one.position for one in getattr(again, group)}
    size = mission.dimensions
    assert again.dimensions == size
    seen = on_map(mission, again, list(theirs.values()))
    if over_ground and size == 3:
        seen[:, 2] = [place[2] for place in theirs.values()]
    for name, place in zip(theirs, seen, strict=True):
        assert np.abs(np.subtract(ours[name][:size], place[:size])).max() < WITHIN_M, (name, ours[name], place)


def assert_same_map(mission, again):
    def polygons(area, points=lambda corners: corners):
        return [shapely.Polygon(points(ring)) for ring in (area.boundary, *(zone.polygon for zone in area.zones))]

    ours = polygons(mission.map)
    theirs = polygons(again.map, lambda corners: on_map(mission, again, corners)[:, :2])
    assert [z.forbidden_to for z in again.map.zones] == [z.forbidden_to for z in mission.map.zones]
    for own, other in zip(ours, theirs, strict=True):
        assert len(own.exterior.coords) == len(other.exterior.coords)
        assert shapely.hausdorff_distance(own.exterior, other.exterior) < WITHIN_M


def on_map(mission, again, points):
    """Points of the second mission in the map frame of the first, metres; on the ground of both in the plane."""

    def numbers(origin):
        return origin.lat_deg, origin.lon_deg, origin.alt_m

    spatial = mission.dimensions == 3 and all(len(point) == 3 for point in points)
    rows = np.array([(*point, 0.0)[:3] for point in points], dtype=float)
    degrees = enu_to_wgs84(rows, numbers(again.origin_wgs84))
    if not spatial:
        degrees[:, 2] = mission.origin_wgs84.alt_m
    elif again.origin_wgs84.alt_m == 0:  # heights of KML are over the ground, which is anywhere
        degrees[:, 2] += mission.origin_wgs84.alt_m
    return wgs84_to_enu(degrees, numbers(mission.origin_wgs84))
