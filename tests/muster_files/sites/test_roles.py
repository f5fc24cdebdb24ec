"""What features of sites are, by words of many languages; and that where no word decides nothing is guessed."""

import pytest
from tests.muster_files.sites import names, writers
from tests.muster_files.sites.writers import FENCE, area, feature, geojson, points

from muster import MissionError, read_site

YARD = [(8.540, 47.376), (8.544, 47.376), (8.544, 47.378), (8.540, 47.378)]
AIR = "id,lat,lon,kind\nd1,47.3768,8.5416,air\n"


@pytest.fixture
def team(tmp_path):
    file = tmp_path / "team.csv"
    file.write_text(AIR, encoding="utf-8")
    return file


def read(folder, *features, team, name="site.geojson", **options):
    file = folder / name
    file.write_text(geojson(*features), encoding="utf-8")
    return read_site(file, robots=team, **options)


def undecided(folder, *features, team, **options):
    with pytest.raises(MissionError) as caught:
        read(folder, *features, team=team, **options)
    return caught.value.findings


@pytest.mark.parametrize("name", names.listed(names.CLOSED))
def test_closed_areas_are_closed_to_all(tmp_path, team, name):
    (zone,) = read(tmp_path, area(name=name), *points(), team=team).mission.map.zones
    assert zone.closed_to == ("ground", "air")


@pytest.mark.parametrize("name", names.listed(names.BOUNDARY))
def test_operation_areas_are_boundaries(tmp_path, team, name):
    found = read(tmp_path, area(YARD, name=name), *points(), team=team).mission.map
    assert (len(found.boundary), found.zones) == (4, ())


@pytest.mark.parametrize("name", names.listed(names.SURVEY))
def test_search_areas_are_surveyed(tmp_path, team, name):
    found = read(tmp_path, area(name=name), team=team, height_m=60, fov_deg=60).mission
    (task,) = found.tasks
    assert (task.action.name, task.action.height_m, found.map) == ("coverage", 60, None)


@pytest.mark.long(keep=60)
@pytest.mark.parametrize("by", ["file", "id", "type", "layer"])
@pytest.mark.parametrize(
    ("name", "kind"),
    [*((n, "air") for n in names.listed(names.AIRCRAFT)), *((n, "ground") for n in names.listed(names.GROUND))],
)
def test_words_say_how_robots_move(tmp_path, by, name, kind):
    places = tmp_path / "site.csv"
    places.write_text(writers.CSV, encoding="utf-8")
    if by == "layer":
        file = tmp_path / "all.kml"
        robot = writers.placemark("r1", "<Point><coordinates>8.5416,47.3768</coordinates></Point>")
        file.write_text(writers.kml(f"<Folder><name>{name}</name>{robot}</Folder>"), encoding="utf-8")
        (one,) = read_site(places, file).mission.robots
    else:
        file = tmp_path / (f"{name}.csv" if by == "file" else "team.csv")
        row = {"file": "r1,", "id": f"{name},", "type": f"r1,{name}"}[by]
        file.write_text(f"id,type,lat,lon\n{row},47.3768,8.5416\n", encoding="utf-8")
        (one,) = (read_site(places, file) if by == "file" else read_site(places, robots=file)).mission.robots
    assert one.kind == kind


@pytest.mark.parametrize("heading", ["Model", "model", "Modell", "Platform", "型号"])
def test_a_model_says_how_a_robot_moves_beside_its_type(tmp_path, heading):
    places, team = tmp_path / "site.csv", tmp_path / "team.csv"
    places.write_text(writers.CSV, encoding="utf-8")
    team.write_text(f"id,type,{heading},lat,lon\nr1,scout,Mavic 3,47.3768,8.5416\n", encoding="utf-8")
    (one,) = read_site(places, robots=team).mission.robots
    assert (one.type, one.kind) == ("scout", "air")


@pytest.mark.parametrize("heading", ["Drone ID", "UAV name", "Drone", "uav_id"])
@pytest.mark.parametrize("as_robots", [True, False])
def test_a_heading_says_what_the_rows_are(tmp_path, heading, as_robots):
    places, team = tmp_path / "site.csv", tmp_path / "team.csv"
    places.write_text(writers.CSV, encoding="utf-8")
    team.write_text(f"{heading},lat,lon\nr1,47.3768,8.5416\n", encoding="utf-8")
    (one,) = (read_site(places, robots=team) if as_robots else read_site(places, team)).mission.robots
    assert (one.id, one.kind) == ("r1", "air")


def test_a_column_is_stronger_than_words_and_a_flag_than_both(tmp_path):
    places, drones = tmp_path / "site.csv", tmp_path / "drones.csv"
    places.write_text(writers.CSV, encoding="utf-8")
    drones.write_text("id,lat,lon,kind\nr1,47.3768,8.5416,ground\n", encoding="utf-8")
    assert read_site(places, drones).mission.robots[0].kind == "ground"
    assert read_site(places, drones, kinds={"drones": "air"}).mission.robots[0].kind == "air"


@pytest.mark.parametrize(
    "zone", [{"name": "Keep out", "forbidden_to": "air"}, {"name": "No-fly", "floor_m": 10}, {"name": "Search"}]
)
def test_how_a_robot_moves_is_asked_where_it_matters(tmp_path, zone):
    unsaid = tmp_path / "team.csv"
    unsaid.write_text("id,lat,lon\nr1,47.3768,8.5416\n", encoding="utf-8")
    options = {"height_m": 30, "fov_deg": 60}
    (finding,) = undecided(tmp_path, area(**zone), *points(), team=unsaid, **options)
    assert (finding.file, finding.line, finding.field) == (str(unsaid), 2, "kind")
    assert "a column kind, or --as team=air (or ground)" in finding.expected
    for kind in ("air", "ground"):
        found = read(tmp_path, area(**zone), *points(), team=unsaid, kinds={"team": kind}, **options)
        assert [robot.kind for robot in found.mission.robots] == [kind]


def test_what_is_taken_where_it_makes_no_difference_is_told(tmp_path):
    unsaid = tmp_path / "team.csv"
    unsaid.write_text("id,lat,lon\nr1,47.3768,8.5416\n", encoding="utf-8")
    found = read(tmp_path, area(name="Keep out"), *points(), team=unsaid)
    assert found.mission.robots[0].kind == "ground"
    assert "taken to move on the ground: r1; a column kind, or --as team=air, says other" in found.notes


@pytest.mark.parametrize(
    ("properties", "reason"),
    [
        ({"name": "West"}, "no word says what it is"),
        ({}, "no word says what it is"),
        ({"name": "Zone 4"}, "no word says what it is"),
        ({"name": "Landing zone"}, "no word says what it is"),
        ({"name": "Search area boundary"}, "the name says boundary and search"),
        ({"name": "Geofence"}, "the name says geofence, and not whether robots stay inside or outside"),
    ],
)
def test_areas_that_nothing_decides_are_asked_about(tmp_path, team, properties, reason):
    (finding,) = undecided(tmp_path, area(**properties), *points(), team=team)
    assert finding.value == f"undecided: {reason}"
    name = properties.get("name", "site")
    named = f'"{name}=zone"' if " " in name else f"{name}=zone"
    assert finding.expected.startswith(f"--as {named} (or boundary, survey, skip)")
    for role, count in (("zone", 1), ("skip", 0)):
        found = read(tmp_path, area(**properties), feature("Point", [8.5417, 47.3775], name="a", kind="task"),
                     team=team, kinds={name: role} if "name" in properties else {"site": role})  # fmt: skip
        assert len(found.mission.map.zones if found.mission.map else ()) == count


@pytest.mark.parametrize(
    "name",
    ["Centre de recherche", "Istituto di ricerca", "Suchthilfe", "Vermessungsamt", "Acesso ao parque", "Parc du Roi"],
)
def test_words_that_look_like_others_decide_nothing(tmp_path, team, name):
    (finding,) = undecided(tmp_path, area(name=name), *points(), team=team)
    assert finding.value == "undecided: no word says what it is"


def test_what_its_folder_closes_no_name_opens(tmp_path, team):
    """Sectors of airspace in a folder of closed areas are no sectors to search."""
    file = tmp_path / "site.kml"
    ring = " ".join(f"{lon},{lat}" for lon, lat in [*FENCE, FENCE[0]])
    shape = (
        "<Polygon><outerBoundaryIs><LinearRing><coordinates>"
        f"{ring}</coordinates></LinearRing></outerBoundaryIs></Polygon>"
    )
    marks = ["<Folder><name>No-fly zones</name>", writers.placemark("Sector A", shape), "</Folder>"]
    file.write_text(writers.kml(*marks, *writers.kml_points()), encoding="utf-8")
    with pytest.raises(MissionError) as caught:
        read_site(file, robots=team)
    (finding,) = caught.value.findings
    assert "closed by the word no fly in the layer No-fly zones" in finding.value
    assert len(read_site(file, robots=team, kinds={"No-fly zones": "zone"}).mission.map.zones) == 1


def test_the_name_of_a_file_makes_no_survey_beside_closed_areas(tmp_path, team):
    features = [area(name="Hospital"), area(YARD, name="Perimeter")]
    (finding,) = undecided(tmp_path, *features, team=team, name="search.geojson")
    assert "by the word search in the file search, whose other areas are none to survey" in finding.value
    alone = read(tmp_path, features[0], team=team, name="search.geojson", height_m=30, fov_deg=60)
    assert alone.mission.tasks[0].action.name == "coverage"


@pytest.mark.parametrize("file", ["drones", "drone survey", "robot tasks"])
def test_the_name_of_a_file_makes_no_robots_of_places_beside_areas(tmp_path, team, file):
    features = [*points()[:1], area(name="Search")]
    (finding,) = undecided(tmp_path, *features, team=team, name=f"{file}.geojson")
    assert finding.value.startswith(f"undecided: the file {file} says ")


RING = " ".join(f"{lon},{lat}" for lon, lat in [*FENCE, FENCE[0]])
POLYGON = (
    f"<Polygon><outerBoundaryIs><LinearRing><coordinates>{RING}</coordinates></LinearRing></outerBoundaryIs></Polygon>"
)
SPOT = "<Point><coordinates>8.5417,47.3775</coordinates></Point>"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("<name>No-fly zones</name>", ""),
        ("<Folder><name>Closed areas: danger</name><Folder><name>Group 1</name>", "</Folder></Folder>"),
        ("<Folder><name>Flugverbot</name><Folder>", "</Folder></Folder>"),
    ],
)
def test_what_is_in_a_closed_folder_is_closed(tmp_path, team, before, after):
    file = tmp_path / "site.kml"
    file.write_text(writers.kml(before, writers.placemark("Hospital", POLYGON), after), encoding="utf-8")
    assert len(read_site(file, robots=team).mission.map.zones) == 1
    file.write_text(writers.kml(before, writers.placemark("Helipad 3", SPOT), after), encoding="utf-8")
    with pytest.raises(MissionError, match="a closed area at a point, without a radius: by the word"):
        read_site(file, robots=team)


def test_a_document_for_drones_has_places_to_visit(tmp_path, team):
    file = tmp_path / "site.kml"
    file.write_text(writers.kml("<name>Drone inspection</name>", writers.placemark("Dam", SPOT)), encoding="utf-8")
    assert [task.id for task in read_site(file, robots=team).mission.tasks] == ["Dam"]


@pytest.mark.parametrize("key", ["layer", "Layer", "folder", "group"])
def test_what_was_in_a_layer_of_a_drawing_is_of_its_kind(tmp_path, team, key):
    found = read(tmp_path, area(name="x", **{key: "NOFLY_ZONES"}), *points(), team=team)
    assert len(found.mission.map.zones) == 1
    (finding,) = undecided(tmp_path, feature("Point", [8.5417, 47.3775], name="x", **{key: "NOFLY_ZONES"}), team=team)
    assert "without a radius" in finding.value


@pytest.mark.parametrize("name", names.listed(names.PLACES))
def test_points_of_other_names_are_tasks_and_that_is_told(tmp_path, team, name):
    found = read(tmp_path, feature("Point", [8.5417, 47.3775], name=name), team=team)
    assert [task.id for task in found.mission.tasks] == [name]
    told = f"{tmp_path / 'site.geojson'}: {name}: task, as points are where no word says other"
    assert told in found.notes


@pytest.mark.parametrize(
    "name", ["Home", "Rally point 2", "Landing site", "Landeplatz", "Helipad", "起飞点", "Launch pad"]
)
def test_places_where_robots_start_or_land_are_no_tasks(tmp_path, team, name):
    found = read(tmp_path, feature("Point", [8.5417, 47.3775], name=name), *points(), team=team)
    assert len(found.mission.tasks) == 3
    assert any("passed over, a place where robots start or land" in note and name in note for note in found.notes)
    asked = read(tmp_path, feature("Point", [8.5417, 47.3775], name=name), *points(), team=team, kinds={name: "task"})
    assert name in [task.id for task in asked.mission.tasks]


@pytest.mark.parametrize(
    ("name", "file"), [("Drone 1", "site"), ("UAV", "site"), ("corner", "geofence"), ("corner", "perimeter")]
)
def test_points_that_can_be_no_tasks_are_asked_about(tmp_path, team, name, file):
    spot = feature("Point", [8.5417, 47.3775], name=name)
    (finding,) = undecided(tmp_path, spot, team=team, name=f"{file}.geojson")
    assert finding.value.startswith("undecided: ")
    assert "=task" in finding.expected or "(or task)" in finding.expected


@pytest.mark.parametrize("name", names.listed(names.CLOSED)[::4])
@pytest.mark.parametrize("around", ["name", "id", "file"])
def test_a_name_makes_no_task_of_what_is_closed(tmp_path, team, name, around):
    own = {"name": name} if around == "name" else {"id": name} if around == "id" else {"name": "mast"}
    file = f"{name.replace(':', '')}.geojson" if around == "file" else "site.geojson"
    (finding,) = undecided(tmp_path, feature("Point", [8.5417, 47.3775], **own), team=team, name=file)
    assert finding.value.startswith("a closed area at a point, without a radius")


@pytest.mark.parametrize(
    "properties",
    [{"kind": "building"}, {"type": "wall"}, {"status": "closed"}, {"closed": "yes"}, {"class": "restricted access"}],
)
def test_what_is_built_or_done_may_be_visited(tmp_path, team, properties):
    spot = feature("Point", [8.5417, 47.3775], name="Valve", **properties)
    assert [task.id for task in read(tmp_path, spot, team=team).mission.tasks] == ["Valve"]


@pytest.mark.parametrize(
    "properties",
    [
        {"kind": "no-fly zone"},
        {"kind": "zone"},
        {"type": "Restricted"},
        {"restriction": "PROHIBITED"},
        {"Typ": "Sperrgebiet"},
        {"тип": "запретная зона"},
        {"类型": "禁飞区"},
        {"nofly": True},
        {"no_fly": "yes"},
        {"forbidden_to": "air"},
    ],
)
def test_a_property_makes_no_task_of_what_is_closed(tmp_path, team, properties):
    spot = feature("Point", [8.5417, 47.3775], name="Valve", **properties)
    (finding,) = undecided(tmp_path, spot, team=team)
    assert finding.value.startswith("a closed area at a point, without a radius")
    found = read(tmp_path, area(**{"name": "x", **properties}), *points(), team=team)
    assert len(found.mission.map.zones) == 1


def test_an_open_line_stays_a_line(tmp_path, team):
    line = feature("LineString", [[8.5416, 47.3768], [8.542, 47.377], [8.543, 47.3775]], name="Pipeline survey route")
    found = read(tmp_path, line, *points(), team=team)
    assert len(found.mission.lanes.edges) == 2


def test_many_undecided_features_are_told_in_few_lines(tmp_path, team):
    many = [area([(x + k / 1e3, y) for x, y in FENCE], name=f"F{k}") for k in range(50)]
    findings = undecided(tmp_path, *many, team=team)
    assert len(findings) == 21
    assert findings[-1].value.startswith("undecided, with 29 more")
