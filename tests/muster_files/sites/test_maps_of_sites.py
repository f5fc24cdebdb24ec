"""Maps and tracks of sites: what points, areas and lines become; holes, cuts, coordinate systems, added missions."""

import itertools

import pytest
import shapely
from tests.muster_files.sites import writers
from tests.muster_files.sites.writers import FENCE, area, feature, geojson, points

from muster import MissionError, ParameterError, load, read_site
from muster.mission.action_keys import ACTION_KEYS, ActionKeys
from muster.mission.value_types import Key, Many, Number, Position
from muster_files.sites.readers import READERS

YARD = [(8.540, 47.376), (8.544, 47.376), (8.544, 47.378), (8.540, 47.378)]
ORIGIN = (47.377, 8.542)


@pytest.fixture
def robots(tmp_path):
    file = tmp_path / "robots.csv"
    file.write_text(writers.ROBOTS, encoding="utf-8")
    return file


def site(tmp_path, robots, *features, name="site.geojson", **options):
    file = tmp_path / name
    file.write_text(geojson(*features), encoding="utf-8")
    return read_site(file, robots=robots, **options)


def square(west, south, size=0.0002, **properties):
    corners = [(west, south), (west + size, south), (west + size, south + size), (west, south + size)]
    return area(corners, **properties)


@pytest.mark.parametrize(
    ("properties", "name", "kinds"),
    [
        ({"kind": "boundary"}, "site", {}),
        ({"type": "Perimeter"}, "site", {}),
        ({"name": "Site boundary"}, "site", {}),
        ({}, "boundary", {}),
        ({"name": "West"}, "site", {"west": "boundary"}),
        ({}, "site", {"site.geojson": "boundary"}),
        ({"name": "zone 3"}, "zones", {"zone 3": "boundary"}),
    ],
)
def test_what_says_that_an_area_is_the_boundary(tmp_path, robots, properties, name, kinds):
    found = site(tmp_path, robots, area(YARD, **properties), name=f"{name}.geojson", kinds=kinds, origin=ORIGIN)
    assert len(found.mission.map.boundary) == 4
    assert found.mission.map.zones == ()


def test_a_zone_has_a_boundary_around_everything(tmp_path, robots):
    found = site(tmp_path, robots, *points(), area(kind="zone", floor_m=2, ceiling="12 m", forbidden_to="air"))
    (zone,) = found.mission.map.zones
    assert (zone.floor_m, zone.ceiling_m, zone.forbidden_to) == (2, 12, ("air",))
    around = shapely.Polygon(found.mission.map.boundary)
    assert all(around.contains(shapely.Point(task.position)) for task in found.mission.tasks)
    assert "no boundary given: a rectangle 50 m around everything is taken" in found.notes


def test_holes_are_kept(tmp_path, robots):
    holes = [FENCE, [(8.5425, 47.3775), (8.5428, 47.3775), (8.5428, 47.3777)]]
    found = site(tmp_path, robots, area(YARD, holes, kind="zone"), *points())
    pieces = [shapely.Polygon(zone.polygon) for zone in found.mission.map.zones]
    assert all(a.intersection(b).area < 1e-6 for a, b in itertools.combinations(pieces, 2))
    whole = shapely.union_all([piece.buffer(1e-4) for piece in pieces])
    assert len(shapely.get_parts(whole)) == 1
    assert len(whole.interiors) == 2
    found = site(tmp_path, robots, area(YARD, holes, kind="boundary"), *points())
    assert len(found.mission.map.zones) == 2


def test_a_boundary_cut_at_the_meridian_is_whole_again(tmp_path):
    robots = tmp_path / "robots.csv"
    robots.write_text("id,lat,lon\nr,70,179.999\n", encoding="utf-8")
    parts = [
        [[[179.99, 70], [180, 70], [180, 70.01], [179.99, 70.01], [179.99, 70]]],
        [[[-180, 70], [-179.99, 70], [-179.99, 70.01], [-180, 70.01], [-180, 70]]],
    ]
    found = site(tmp_path, robots, feature("MultiPolygon", parts, kind="boundary"))
    corners = shapely.Polygon(found.mission.map.boundary)
    assert len(found.mission.map.boundary) == 4
    assert corners.bounds[2] - corners.bounds[0] == pytest.approx(764, abs=2)


def test_lines_are_lanes_that_meet_where_they_share_a_point(tmp_path, robots):
    main = feature("LineString", [[8.5416, 47.3768], [8.5417, 47.3770], [8.5417, 47.3772]], width="2,5 m")
    side = feature("LineString", [[8.5417, 47.3770], [8.5420, 47.3770]], oneway="yes", maxspeed="3,6 km/h", capacity=1)
    found = site(tmp_path, robots, main, side, main, *points())
    lanes = found.mission.lanes
    assert list(lanes.nodes) == ["n1", "n2", "n3", "n4"]
    assert [(lane.start, lane.end, lane.both_ways) for lane in lanes.edges] == [
        ("n1", "n2", True), ("n2", "n3", True), ("n2", "n4", False),
    ]  # fmt: skip
    assert [lane.width_m for lane in lanes.edges] == [2.5, 2.5, None]
    assert (lanes.edges[2].speed_mps, lanes.edges[2].capacity) == (1, 1)
    assert "pieces of lines along which lanes lead already are left out: features[2] (2)" in found.notes


@pytest.mark.parametrize(
    ("key", "value", "metres_a_second"),
    [("maxspeed", 36, 10), ("maxspeed", "30 mph", 13.4112), ("Max speed", 36, 36), ("speed", "36", 36)],
)
def test_the_speeds_of_openstreetmap_are_in_kilometres_an_hour(tmp_path, robots, key, value, metres_a_second):
    line = feature("LineString", [[8.5416, 47.3768], [8.5417, 47.3770]], **{key: value})
    (lane,) = site(tmp_path, robots, line, *points()).mission.lanes.edges
    assert lane.speed_mps == pytest.approx(metres_a_second)


def test_a_second_line_adds_the_direction_that_the_first_lacks(tmp_path, robots):
    line = [[8.5416, 47.3768], [8.5417, 47.3770]]
    there, both = feature("LineString", line, oneway="yes"), feature("LineString", line, maxspeed="2 m/s")
    lanes = site(tmp_path, robots, there, both, *points()).mission.lanes
    assert [(lane.start, lane.end, lane.both_ways, lane.speed_mps) for lane in lanes.edges] == [
        ("n1", "n2", False, None), ("n2", "n1", False, 2),
    ]  # fmt: skip


def test_names_are_ids_beside_numbers_of_features(tmp_path, robots):
    numbered = [{**point, "id": k} for k, point in enumerate(points())]
    assert [task.id for task in site(tmp_path, robots, *numbered).mission.tasks] == ["north", "east", "south"]


def test_features_without_a_geometry_are_passed_over_and_named(tmp_path, robots):
    gate = {"type": "Feature", "properties": {"name": "Gate"}, "geometry": None}
    found = site(tmp_path, robots, gate, *points(), feature("MultiPolygon", [], name="none"))
    assert len(found.mission.tasks) == 3
    told = "passed over, without a geometry: features[0] (Gate), features[4] (none)"
    assert f"{tmp_path / 'site.geojson'}: {told}" in found.notes
    file = tmp_path / "site.gpkg"
    fences = [(shapely.Polygon(FENCE), {"name": "mast"}), (None, {"name": "roof"})]
    writers.write_geopackage(file, {"fences": fences, "panels": [(shapely.Point(8.5417, 47.3775), {"name": "a"})]})
    found = read_site(file, robots=robots)
    assert len(found.mission.map.zones) == 1
    assert f"{file}, fences: passed over, without a geometry: layer fences, row 2 (roof)" in found.notes


@pytest.mark.parametrize(("apart_m", "nodes"), [(0.0, 3), (0.004, 3), (0.009, 3), (0.02, 4)])
def test_points_within_a_centimetre_are_one_node(tmp_path, robots, apart_m, nodes):
    for east in (8.54173, 8.541731, 8.5417321):
        moved = east + apart_m / 75_500
        lines = [[[8.5416, 47.3768], [east, 47.377]], [[moved, 47.377], [8.5420, 47.3772]]]
        found = site(tmp_path, robots, *(feature("LineString", line) for line in lines), *points())
        assert len(found.mission.lanes.nodes) == nodes


def test_a_zone_that_is_forbidden_to_nobody_is_told(tmp_path, robots):
    found = site(tmp_path, robots, area(FENCE, kind="zone", name="free", forbidden_to="[]"), *points())
    assert found.mission.map is None
    assert "zones that are forbidden to nobody are left out: free" in found.notes


@pytest.mark.parametrize(
    ("properties", "file", "forbidden"),
    [
        ({"name": "No-fly zone"}, "site", ("ground", "air")),
        ({"kind": "No-Fly-Zone"}, "site", ("ground", "air")),
        ({"type": "geofence no fly"}, "site", ("ground", "air")),
        ({"name": "Mast"}, "NFZ", ("ground", "air")),
        ({"name": "No-fly zone", "forbidden_to": "ground"}, "site", ("ground",)),
        ({"name": "No-fly zone", "forbidden_to": "drones"}, "site", ("air",)),
        ({"name": "Keep out, forbidden to: air"}, "site", ("air",)),
    ],
)
def test_closed_areas_are_closed_to_all_unless_they_say_to_whom(tmp_path, robots, properties, file, forbidden):
    found = site(tmp_path, robots, area(**properties), *named_tasks(), name=f"{file}.geojson")
    assert found.mission.map.zones[0].closed_to == forbidden


def named_tasks():
    """The places of the tests as tasks, whatever the name of their file is."""
    return [{**point, "properties": {**point["properties"], "kind": "task"}} for point in points()]


@pytest.fixture
def coverage():
    """The action of surveys, where the model has none."""
    ring = Many(Position(planar=True), minimum=3)
    own = {"area": Key(ring, ""), "holes": Key(Many(ring), ""), "lane_m": Key(Number(), "")}
    given = "coverage" in ACTION_KEYS
    if not given:
        ACTION_KEYS.add("coverage", ActionKeys(needed=("area",), optional=("holes", "lane_m", "height_m"), own=own))
    yield
    if not given:
        ACTION_KEYS.remove("coverage")


def test_areas_to_survey_are_tasks(tmp_path, robots, coverage):
    found = site(
        tmp_path, robots, area(YARD, [FENCE], name="Survey west", width_m=3, height_m=30, priority=2), *points()[:1]
    )
    task = next(task for task in found.mission.tasks if task.action is not None)
    assert (task.id, task.priority, task.action.name) == ("Survey west", 2, "coverage")
    assert (len(task.action.value("area")), len(task.action.value("holes"))) == (4, 1)
    assert task.action.value("height_m") == 30
    whole = shapely.Polygon(task.action.value("area"), task.action.value("holes"))
    assert whole.contains(shapely.Point(task.position))


def test_what_follows_an_area_in_several_parts_follows_them_all(tmp_path, robots, coverage):
    parts = [square(8.541 + k / 1000, 47.377)["geometry"]["coordinates"] for k in range(2)]
    after = feature("Point", [8.5417, 47.3775], name="post", after="field")
    survey = feature("MultiPolygon", parts, kind="survey", name="field", width_m=3)
    found = site(tmp_path, robots, survey, after)
    mission = found.mission
    assert found.counts[0] == f"{tmp_path / 'site.geojson'}: 2 areas to survey, 1 task"
    assert next(task for task in mission.tasks if task.id == "post").prerequisites == ("field", "field-2")


def test_what_an_area_to_survey_lacks_is_told_once_with_its_name(tmp_path, robots, coverage):
    parts = [square(8.541 + k / 1000, 47.377)["geometry"]["coordinates"] for k in range(2)]
    with pytest.raises(MissionError) as caught:
        site(tmp_path, robots, feature("MultiPolygon", parts, kind="survey", name="Field"))
    assert [finding.field for finding in caught.value.findings] == ["features[0] (Field), height_m"]


def test_where_a_boundary_crosses_itself_is_told(tmp_path, robots):
    bow = [(8.54, 47.37), (8.541, 47.371), (8.541, 47.37), (8.54, 47.371)]
    place = r"features\[0\] \(Bow\), geometry: self-intersection at latitude 47.3705, longitude 8.5405; expected"
    with pytest.raises(MissionError, match=place):
        site(tmp_path, robots, area(bow, name="Bow", kind="boundary"))


def test_areas_to_survey_need_their_action(tmp_path, robots, monkeypatch):
    monkeypatch.setattr("muster_files.sites.keys.COVERAGE", "no-such-action")
    with pytest.raises(MissionError, match=r"features\[0\]: an area to survey; expected the action coverage"):
        site(tmp_path, robots, area(YARD, kind="survey"))


def test_kml_folders_and_heights_over_the_ground(tmp_path):
    file = tmp_path / "site.kml"
    spot = "<Point><altitudeMode>relativeToGround</altitudeMode><coordinates>{},{},{}</coordinates></Point>"
    robot = writers.placemark("d1", spot.format(8.5416, 47.3768, 0))
    tasks = [writers.placemark(name, spot.format(lon, lat, 15)) for name, lat, lon in writers.TASKS]
    data = "<ExtendedData><Data name='duration'><value>2 min</value></Data></ExtendedData>"
    text = writers.kml("<Folder><name>Drones</name>", robot, "</Folder>", *tasks).replace(
        "<Point>", data + "<Point>", 2
    )
    file.write_text(text, encoding="utf-8")
    mission = read_site(file).mission
    assert [robot.id for robot in mission.robots] == ["d1"]
    assert [(task.id, task.position[2]) for task in mission.tasks] == [("north", 15), ("east", 15), ("south", 15)]
    assert mission.tasks[0].duration_s == 120
    writers.write_kmz(tmp_path / "site.kmz", text)
    assert read_site(tmp_path / "site.kmz", name="site").mission == mission


def test_what_of_kml_has_no_place_in_a_mission_is_named(tmp_path, robots):
    file = tmp_path / "site.kml"
    point = writers.placemark("p", "<Point><coordinates>8.5416,47.3768</coordinates></Point>")
    others = [writers.placemark("view", ""), "<Folder><NetworkLink><name>more</name></NetworkLink></Folder>"]
    file.write_text(writers.kml(point, *others), encoding="utf-8")
    found = read_site(file, robots=robots)
    assert [task.id for task in found.mission.tasks] == ["p"]
    assert f"{file}: passed over: NetworkLink more, Placemark view" in found.notes


def test_a_file_of_nothing_but_links_is_refused(tmp_path):
    file = tmp_path / "site.kml"
    file.write_text(writers.kml("<NetworkLink><name>more</name></NetworkLink>"), encoding="utf-8")
    with pytest.raises(MissionError, match=r"site.kml: nothing to read; expected points, areas or lines"):
        read_site(file)


def test_a_route_of_gpx_is_lanes_and_what_is_no_line_is_named(tmp_path, robots):
    file = tmp_path / "walk.gpx"
    route = '<rte><name>Route A</name><rtept lat="47.3768" lon="8.5416"/><rtept lat="47.3769" lon="8.5417"/></rte>'
    stop = '<trk><name>stop</name><trkseg><trkpt lat="47.3768" lon="8.5416"/></trkseg></trk>'
    file.write_text(writers.gpx(*writers.gpx_points(), route, stop), encoding="utf-8")
    found = read_site(file, robots=robots)
    assert len(found.mission.lanes.edges) == 1
    assert f"{file}: passed over: trk stop" in found.notes


def test_gpx_tracks_are_lanes_and_named_ones_areas(tmp_path, robots):
    file = tmp_path / "walk.gpx"
    ring = "".join(f'<trkpt lat="{lat}" lon="{lon}"/>' for lon, lat in [*YARD, YARD[0]])
    track = f"<trk><name>{{}}</name><trkseg>{ring}</trkseg></trk>"
    file.write_text(
        writers.gpx(*writers.gpx_points(), track.format("boundary"), track.format("road")), encoding="utf-8"
    )
    mission = read_site(file, robots=robots).mission
    assert (len(mission.tasks), len(mission.map.boundary), len(mission.lanes.edges)) == (3, 4, 4)


def test_a_geopackage_in_another_coordinate_system(tmp_path, robots):
    pyproj = pytest.importorskip("pyproj")
    grid = pyproj.Transformer.from_crs(4326, 25832, always_xy=True)
    file = tmp_path / "site.gpkg"
    tasks = [(shapely.Point(*grid.transform(lon, lat)), {"name": name, "prio": 2}) for name, lat, lon in writers.TASKS]
    writers.write_geopackage(file, {"panels": tasks}, srs=25832)
    mission = read_site(file, robots=robots, origin=ORIGIN).mission
    degrees = tmp_path / "site.geojson"
    degrees.write_text(geojson(*points()), encoding="utf-8")
    for ours, theirs in zip(mission.tasks, read_site(degrees, robots=robots, origin=ORIGIN).mission.tasks, strict=True):
        assert ours.position == pytest.approx(theirs.position, abs=2e-4)
        assert ours.priority == 2


def test_a_table_with_geometries_as_text(tmp_path, robots):
    file = tmp_path / "site.csv"
    polygon = shapely.Polygon(FENCE).wkt
    file.write_text(f'WKT,name\nPOINT (8.5417 47.3775),a\n"{polygon}",roof\n', encoding="utf-8")
    mission = read_site(file, robots=robots).mission
    assert ([task.id for task in mission.tasks], len(mission.map.zones)) == (["a"], 1)


TEAM = """\
schema: muster/1
name: team
origin_wgs84: {lat_deg: 47.377, lon_deg: 8.542}
rules: {objective: makespan}
map: {boundary: {lat_lon: [[47.376, 8.540], [47.376, 8.544], [47.378, 8.544], [47.378, 8.540]]}}
robots: [{id: r_0, lat_lon: [47.3768, 8.5416], skills: [camera]}]
tasks: [{id: first, position: [0, 0]}]
"""


def test_a_site_is_added_to_a_mission(tmp_path):
    team, panels, fences = (tmp_path / name for name in ("team.yaml", "panels.csv", "fences.geojson"))
    team.write_text(TEAM, encoding="utf-8")
    panels.write_text(writers.CSV, encoding="utf-8")
    fences.write_text(geojson(area()), encoding="utf-8")
    mission = read_site(team, panels, fences).mission
    there = load(team)
    assert (mission.name, mission.rules, mission.robots) == ("team", there.rules, there.robots)
    assert [task.id for task in mission.tasks] == ["first", "north", "east", "south"]
    assert (mission.map.boundary, len(mission.map.zones)) == (there.map.boundary, 1)
    alone = read_site(panels, robots=team).mission
    assert (alone.robots, len(alone.tasks), alone.origin_wgs84) == (there.robots, 3, there.origin_wgs84)
    with pytest.raises(MissionError, match="a second boundary; expected one boundary: the map of the mission"):
        read_site(team, fences, kinds={"fences": "boundary"})
    with pytest.raises(ParameterError, match="a second mission"):
        read_site(team, team, panels)


@pytest.mark.parametrize(
    ("features", "kinds", "message"),
    [
        ([area(YARD, kind="boundary"), area(YARD, kind="boundary")], {}, "a second boundary"),
        ([area(YARD, kind="task")], {}, "kind: task; expected one of zone, boundary, survey for an area"),
        ([square(8.54, 47.37, kind="zone", floor_m=5, ceiling_m=2)], {}, "ceiling_m: 2.0; expected a number above"),
    ],
)
def test_areas_that_cannot_be_meant(tmp_path, robots, features, kinds, message):
    with pytest.raises(MissionError, match=message):
        site(tmp_path, robots, *features, kinds=kinds)


def test_names_of_kinds_have_to_be_there(tmp_path, robots):
    with pytest.raises(ParameterError, match="--as: no file, layer or feature wset; did you mean 'west'"):
        site(tmp_path, robots, area(name="west"), kinds={"wset": "zone"})
    with pytest.raises(ParameterError, match="--as west: zoen; expected one of task"):
        site(tmp_path, robots, area(name="west"), kinds={"west": "zoen"})


def test_another_package_can_add_a_reader(tmp_path, robots):
    from muster_files.sites.features import Feature, Geometry, layer_of

    def read(path):
        place = Geometry("point", (((tuple(map(float, path.read_text(encoding="utf-8").split())),),),))
        return [layer_of(str(path), "", [Feature({"name": "spot"}, str(path), 1, "", place)])]

    file = tmp_path / "one.spot"
    file.write_text("8.5417 47.3775", encoding="utf-8")
    with pytest.raises(MissionError, match=r"a file of the kind .spot; expected a mission .* a site \(.csv, "):
        read_site(file, robots=robots)
    READERS.add("spot", read)
    try:
        assert [task.id for task in read_site(file, robots=robots).mission.tasks] == ["spot"]
        assert [task.id for task in load(file, robots=robots).tasks] == ["spot"]
    finally:
        READERS.remove("spot")
