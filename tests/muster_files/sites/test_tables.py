"""Tables of sites: headings, units, encodings, references, robots; and what is said of what is wrong."""

import sys

import pytest
from tests.muster_files.sites import writers

from muster import MissingExtraError, MissionError, ParameterError, load, read_site
from muster_files.formula_cells import cell


@pytest.fixture
def robots(tmp_path):
    file = tmp_path / "robots.csv"
    file.write_text(writers.ROBOTS, encoding="utf-8")
    return file


def read(tmp_path, robots, text, encoding="utf-8", **options):
    file = tmp_path / "panels.csv"
    file.write_bytes(text.encode(encoding))
    return read_site(file, robots=robots, **options)


def test_the_end_of_a_day(tmp_path, robots):
    text = "name,x,y,window,due\na,1,2,00:00-24:00,24:00\n"
    (task,) = read(tmp_path, robots, text, starts_at="2027-03-01T00:00", origin=(47, 8)).mission.tasks
    assert (task.window_s, task.due_s) == (((0, 86400),), 86400)
    found = read(tmp_path, robots, text.replace("00:00-", "10:00-"), origin=(47, 8))
    assert found.mission.starts_at == "2000-01-01T10:00"


SEMICOLONS = """Panel name;Latitude;Longitude;Duration (min);Opens;Prio;Required skills;After;Remark
A1;47,3769;8,5417;15;10:00;2;camera;;clean
A2;47,3772;8,5421;5;;1,5;;A1;
;;;;;;;;
A3;47,3775;8,5417;90 s;11:00;1;;A1 A2;
"""


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_a_table_of_a_spreadsheet(tmp_path, robots, encoding):
    found = read(tmp_path, robots, SEMICOLONS, encoding)
    first, second, third = found.mission.tasks
    assert [task.id for task in found.mission.tasks] == ["A1", "A2", "A3"]
    assert [task.duration_s for task in found.mission.tasks] == [900, 300, 90]
    assert (first.window_s, third.window_s) == (((0, None),), ((3600, None),))
    assert (first.requires, first.priority, second.priority) == (("camera",), 2, 1.5)
    assert third.prerequisites == ("A1", "A2")
    assert found.mission.starts_at == "2000-01-01T10:00"
    assert found.mission.name == "panels"
    assert found.counts == (f"{tmp_path}/panels.csv: 3 tasks", f"{robots}: 1 robot")
    assert f"{tmp_path}/panels.csv: not read: Remark" in found.notes
    assert any(note.startswith("origin_wgs84 chosen: lat_deg 47.37715, lon_deg 8.54185") for note in found.notes)


def test_load_reads_it_as_well(tmp_path, robots):
    found = read(tmp_path, robots, SEMICOLONS)
    assert load(tmp_path / "panels.csv", robots=robots) == found.mission


@pytest.mark.parametrize(
    ("heading", "cell", "metres_a_second"),
    [
        ("speed", "2", 2),
        ("Speed (km/h)", "7,2", 2),
        ("speed_kmh", "7.2", 2),
        ("max speed [kn]", "2", 3704 / 3600),
        ("speed", "3 mph", 1.34112),
    ],
)
def test_units_in_headings_and_beside_numbers(tmp_path, heading, cell, metres_a_second):
    robots = tmp_path / "robots.csv"
    robots.write_text(f"id;x;y;{heading}\nr;0;0;{cell}\n", encoding="utf-8")
    assert read(tmp_path, robots, "id,x,y\n1,3,4\n").mission.robots[0].speed_mps == pytest.approx(metres_a_second)


@pytest.mark.parametrize("headings", ["lat [\u00b0],lon [\u00b0]", "lat (deg),lon (deg)", "Lat (WGS84),Lon (WGS84)"])
def test_degrees_in_headings(tmp_path, robots, headings):
    found = read(tmp_path, robots, f"name,{headings}\na,47.3775,8.5417\n", origin=(47.3775, 8.5417))
    assert found.mission.tasks[0].position == (0, 0)


@pytest.mark.parametrize(("heading", "load"), [("Weight (kg)", 25), ("Mass (g)", 0.025), ("Load (boxes)", 25)])
def test_a_mass_is_a_load_and_no_priority(tmp_path, heading, load):
    robots = tmp_path / "robots.csv"
    robots.write_text("name,x,y,Capacity (kg)\nr,0,0,40\n", encoding="utf-8")
    mission = read(tmp_path, robots, f"name,x,y,{heading}\na,1,2,25\n").mission
    assert (mission.tasks[0].load, mission.tasks[0].priority) == (load, 1)
    assert (mission.robots[0].load_capacity, mission.robots[0].work_capacity) == (40, None)
    assert read(tmp_path, robots, "name,x,y,weight\na,1,2,25\n").mission.tasks[0].priority == 25


def test_columns_named_by_hand_are_stronger(tmp_path, robots):
    text = "Breite,Hoehe,lat,no\n47.3,8.5,1,7\n"
    found = read(tmp_path, robots, text, columns={"latitude": "Breite", "lon": "Hoehe"}, origin=(47.3, 8.5))
    assert (found.mission.tasks[0].id, found.mission.tasks[0].position) == ("7", (0.0, 0.0))
    with pytest.raises(ParameterError, match="--column lat: no heading Breit; did you mean 'Breite'"):
        read(tmp_path, robots, text, columns={"lat": "Breit"})
    with pytest.raises(ParameterError, match="--column: no key priorty; did you mean 'priority'"):
        read(tmp_path, robots, text, columns={"priorty": "no"})


@pytest.mark.parametrize(
    ("heading", "seconds"),
    [("Duration min", 900), ("Inspection (min)", 900), ("how long", 15), ("Inspection (km)", None)],
)
def test_columns_named_by_hand_have_the_unit_in_their_heading(tmp_path, robots, heading, seconds):
    text, named = f"name,lat,lon,{heading}\na,47.3,8.5,15\n", {"duration_s": heading}
    if seconds is None:
        with pytest.raises(MissionError, match=r"Inspection \(km\): a unit that does not fit"):
            read(tmp_path, robots, text, columns=named)
    else:
        assert read(tmp_path, robots, text, columns=named).mission.tasks[0].duration_s == seconds


def test_what_is_wrong_is_named_with_line_and_column(tmp_path, robots):
    text = "name,lat,lon,duration,prio\na,47.3,8.5,soon,high\nb,97,8.5,5,1\nc,,8.5,5,1\n"
    with pytest.raises(MissionError) as caught:
        read(tmp_path, robots, text)
    assert [(f.line, f.field, f.value) for f in caught.value.findings] == [
        (2, "duration", "soon"), (2, "prio", "high"), (3, "lat", "97"), (4, "lat", "missing"),
    ]  # fmt: skip


def test_what_the_mission_refuses_is_named_by_the_column(tmp_path, robots):
    with pytest.raises(MissionError) as caught:
        read(tmp_path, robots, "id,lat,lon,Prio,after\na,47.3,8.5,-1,\na,47.3,8.5,1,zz\n")
    assert [(f.line, f.field) for f in caught.value.findings] == [(2, "Prio"), (3, "id"), (3, "after")]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name,latitude,lat,lon\na,1,2,3\n", "lat: means lat, as latitude does; expected one column that says lat"),
        ("name,x (kg),y\na,1,2\n", r"x \(kg\): a unit that does not fit; expected m, km, cm, ft, mi or NM"),
        ("name,lat (km),lon (km)\na,1,2\n", r"^[^\n]*lat \(km\): a unit that [^\n]*\n[^\n]*lon \(km\)[^\n]*$"),
        ("name,lat,lon,priority (%)\na,1,2,3\n", r"priority \(%\): a unit that does not fit; expected no unit"),
        ("name,lat,lon,duration (km)\na,1,2,3\n", r"duration \(km\): a unit that does not fit; expected s, min or h"),
        ("name,lat,lon\na,1,2,3\n", 'column 4: "3" without a heading'),
        ("name,lat,lon,opens,window\na,47.4,8.5,5,10-20\n", "window: a window; expected it, or opens, not both"),
        ("name,lat,lon,opens,closes\na,47.4,8.5,5,10:00\n", "clock times or seconds, not both"),
        ("name,lat,lon,deadline\na,47.4,8.5,10:00\n", "starts_at: missing; expected --starts-at"),
        ("id,lat,lon\na,47.4,8.5\nb,8.5,47.4\n", "are latitude and longitude swapped"),
    ],
)  # fmt: skip
def test_tables_that_cannot_be_meant(tmp_path, robots, text, message):
    with pytest.raises(MissionError, match=message):
        read(tmp_path, robots, text)


@pytest.mark.parametrize("wrong", [0, 45])
def test_of_many_places_the_wrong_one_is_named(tmp_path, robots, wrong):
    rows = [f"t{k},47.{3700 + k},8.5" for k in range(45)]
    rows.insert(wrong, "Oops,0,0")
    with pytest.raises(MissionError) as caught:
        read(tmp_path, robots, "name,lat,lon\n" + "\n".join(rows))
    (finding,) = caught.value.findings
    assert (finding.line, finding.value) == (wrong + 2, "latitude 0, longitude 0")
    origin = "the origin, which is chosen in the middle of all places: latitude 23.6884, longitude 4.2708"
    assert f"within 100 km of {origin}; this place is 5,3" in finding.expected
    with pytest.raises(MissionError, match=r"within 100 km of the origin, not 5,3..; are latitude and"):
        read(tmp_path, robots, "name,lat,lon\n" + "\n".join(rows), origin=(47.37, 8.5))


def test_titles_above_the_headings_are_passed_over_and_named(tmp_path, robots):
    found = read(tmp_path, robots, "Roof 4;;\n;;\nspring;;\nname;lat;lon\nA;47,4;8,5\n", origin=(47.4, 8.5))
    assert [task.id for task in found.mission.tasks] == ["A"]
    assert f"{tmp_path / 'panels.csv'}: passed over: row 1 (Roof 4), row 3 (spring)" in found.notes


@pytest.mark.parametrize("title", ["Plant A, north", '"a;b;c;d"'])
@pytest.mark.parametrize("rows", ["A;47,4;8,5", "A;47,4;8,5;x\nB;47,4;8,5;x", "A;47,4;8,5;"])
def test_separators_are_not_taken_from_titles_or_decimal_commas(tmp_path, robots, title, rows):
    found = read(tmp_path, robots, f"{title}\n\nname;lat;lon;note\n{rows}\n", origin=(47.4, 8.5))
    assert found.mission.tasks[0].position == (0.0, 0.0)


@pytest.mark.parametrize("separator", [";", "\t", ","])
def test_headings_in_quotes(tmp_path, robots, separator):
    rows = [["name", "x", "y"], ["A", "1", "2"]]
    text = "".join(separator.join(f'"{cell}"' for cell in row) + "\n" for row in rows)
    (task,) = read(tmp_path, robots, text, origin=(47.4, 8.5)).mission.tasks
    assert (task.id, task.position) == ("A", (1, 2))


@pytest.mark.parametrize("count", [1, 8])
def test_a_table_of_one_column_has_no_titles(tmp_path, robots, count):
    rows = "".join(f'"47.4, 8.5{k}"\n' for k in range(count))
    assert len(read(tmp_path, robots, f"GPS\n{rows}").mission.tasks) == count


def test_ids_from_names_rows_and_numbers(tmp_path, robots):
    found = read(tmp_path, robots, "name,lat,lon\np,47,8\nq,47,8\np,47,8\n", origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == ["p", "q", "p-2"]
    assert "names that stand several times are numbered: p (2 times)" in found.notes
    found = read(tmp_path, robots, "lat,lon\n47,8\n47,8\n", origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == ["panels-1", "panels-2"]


NUMBERED = "id,name,x,y,after\n1,Gate,1,2,\n2,Hall,2,2,Gate\n3,Roof,3,2,1;Hall\n"


@pytest.mark.parametrize("heading", ["id", "no", "number"])
def test_names_are_ids_beside_mere_numbers(tmp_path, robots, heading):
    found = read(tmp_path, robots, NUMBERED.replace("id", heading), origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == ["Gate", "Hall", "Roof"]
    assert [task.prerequisites for task in found.mission.tasks] == [(), ("Gate",), ("Gate", "Hall")]
    told = f"name is the id, not the numbers under {heading}; --column id={heading} takes those"
    assert f"{tmp_path}/panels.csv: {told}" in found.notes


@pytest.mark.parametrize(
    ("text", "columns", "ids"),
    [
        (NUMBERED, {"id": "id"}, ["1", "2", "3"]),
        (NUMBERED.replace("3,", "C,", 1), {}, ["1", "2", "C"]),
        (NUMBERED.replace("Roof", ""), {}, ["1", "2", "3"]),
    ],
)
def test_names_beside_ids_are_told_and_may_be_meant(tmp_path, robots, text, columns, ids):
    found = read(tmp_path, robots, text, origin=(47, 8), columns=columns)
    assert [task.id for task in found.mission.tasks] == ids
    assert found.mission.tasks[2].prerequisites == ("1", "2")
    told = "not read beside id: name; --column id=name takes it for the id"
    assert f"{tmp_path}/panels.csv: {told}" in found.notes


def test_references_mean_what_their_own_file_calls_so(tmp_path, robots):
    base = tmp_path / "base.yaml"
    base.write_text(
        "schema: muster/1\norigin_wgs84: {lat_deg: 47, lon_deg: 8}\nrobots: [{id: r, position: [0, 0]}]\n"
        "tasks: [{id: A, position: [9, 9]}, {id: C, position: [9, 8]}]\n",
        encoding="utf-8",
    )
    file = tmp_path / "add.csv"
    file.write_text("name,x,y,after\nA,1,2,\nB,2,2,A C\n", encoding="utf-8")
    tasks = {task.id: task for task in read_site(base, file).mission.tasks}
    assert tasks["A-2"].position == (1, 2)
    assert tasks["B"].prerequisites == ("A-2", "C")


def test_a_name_that_stands_twice_cannot_be_meant(tmp_path, robots):
    text = "name,x,y,after\nA,1,2,\nA,2,2,\nB,3,2,{}\n"
    with pytest.raises(MissionError, match=r"panels.csv:4: after: A \(ambiguous\); expected .* an id: A, A-2"):
        read(tmp_path, robots, text.format("A"), origin=(47, 8))
    assert read(tmp_path, robots, text.format("A-2"), origin=(47, 8)).mission.tasks[2].prerequisites == ("A-2",)


def test_columns_that_mean_nothing_may_have_one_name(tmp_path, robots):
    found = read(tmp_path, robots, "name,x,y,color,color\na,1,2,red,blue\n", origin=(47, 8))
    assert f"{tmp_path}/panels.csv: not read: color, color (2)" in found.notes
    with pytest.raises(MissionError, match=r"panels.csv:1: x: a heading for the second time"):
        read(tmp_path, robots, "name,x,y,x\na,1,2,3\n")


def test_stops_of_a_plan_are_its_tasks_each_once(tmp_path, robots):
    text = "robot,order,task,x,y,arrives_s,starts_s,ends_s,station,load\n"
    text += "r,1,a,1,2,5,5,9,,2 parcels\nr,2,,3,4,10,10,11,dock,0\nq,1,a,1,2,5,5,9,,0\n,,b,5,6,,,,,\n"
    tasks = read(tmp_path, robots, text, origin=(47, 8)).mission.tasks
    assert [(task.id, task.load) for task in tasks] == [("a", None), ("b", None)]


@pytest.mark.parametrize("name", ["=SUM(A1)", "-x", "@a", "'tis"])
def test_ids_that_spreadsheets_would_run_come_back(tmp_path, robots, name):
    found = read(tmp_path, robots, f"task,x,y\n{cell(name)},1,2\n", origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == [name]


def test_what_a_row_is_of_is_its_name_where_no_other_column_is(tmp_path, robots):
    found = read(tmp_path, robots, "Panel,lat,lon\nA1,47,8\nA2,47,8\n", origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == ["A1", "A2"]
    found = read(tmp_path, robots, "Panel,name,lat,lon\n7,A1,47,8\n8,A2,47,8\n", origin=(47, 8))
    assert [task.id for task in found.mission.tasks] == ["A1", "A2"]


@pytest.mark.parametrize(("module", "extra"), [("python_calamine", "sites"), ("pymap3d", "map")])
def test_without_a_library_the_extra_is_named(tmp_path, robots, monkeypatch, module, extra):
    book = tmp_path / "site.xlsx"
    writers.write_workbook(book, {"Tasks": [["id", "lat", "lon"], ["a", 47, 8]]})
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=rf"muster-robotics\[{extra}\]"):
        read_site(book, robots=robots)


def test_robots_are_asked_for(tmp_path):
    file = tmp_path / "panels.csv"
    file.write_text(writers.CSV, encoding="utf-8")
    with pytest.raises(MissionError, match=r"panels.csv: robots: missing; expected .*--robots FILE"):
        load(file)


def test_metres_beside_degrees_need_an_origin(tmp_path, robots):
    with pytest.raises(MissionError, match="a place in degrees; expected --origin LAT,LON"):
        read(tmp_path, robots, "id,x,y\na,3,4\n")
    assert read(tmp_path, robots, "id,x,y\na,3,4\n", origin=(47.3768, 8.5416)).mission.tasks[0].position == (3, 4)


def test_heights(tmp_path, robots):
    found = read(tmp_path, robots, "id,lat,lon,height\na,47.3768,8.5416,12\n")
    assert (found.mission.tasks[0].position[2], found.mission.robots[0].position[2]) == (12, 0)
    assert any("taken on the ground" in note for note in found.notes)
    found = read(tmp_path, robots, "id,lat,lon,altitude\na,47.3768,8.5416,412\n")
    assert found.mission.dimensions == 2
    assert any("heights left out" in note for note in found.notes)
    assert read(tmp_path, robots, "id,lat,lon,height\na,47,8,12\n", flat=True, origin=(47, 8)).mission.dimensions == 2


@pytest.mark.parametrize("cell", ["8.30", "830", "0.375"])
@pytest.mark.parametrize("heading", ["opens", "closes", "due"])
def test_numbers_among_clock_times_are_named(tmp_path, robots, heading, cell):
    text = f"name,x,y,{heading}\na,1,2,09:00\nb,2,2,{cell}\nc,2,3,\n"
    with pytest.raises(MissionError) as caught:
        read(tmp_path, robots, text, origin=(47, 8), starts_at="2027-03-01T08:00")
    (finding,) = caught.value.findings
    assert (finding.line, finding.field, finding.value) == (3, heading, cell)
    assert finding.expected.startswith('a clock time, as "08:30", as others of the column are')


def test_a_clock_time_without_its_colon_is_named(tmp_path, robots):
    with pytest.raises(MissionError, match='opens: 0830; expected "08:30", or seconds that do not begin with 0'):
        read(tmp_path, robots, "name,x,y,opens\na,1,2,0830\n", origin=(47, 8))


def test_what_is_taken_for_the_next_day_is_told(tmp_path):
    robots = tmp_path / "robots.csv"
    robots.write_text("id,x,y,shift\nearly,0,0,06:00-14:00\nlate,0,0,09:00-17:00\n", encoding="utf-8")
    text = "name,x,y,window\na,1,2,07:00-09:00\nb,1,2,07:00-07:30\n"
    found = read(tmp_path, robots, text, starts_at="2027-03-01T08:00")
    told = "begin before starts_at (2027-03-01T08:00), and are the next day's: a (07:00), early (06:00)"
    assert told in found.notes
    assert found.mission.robots[0].available_from_s == 22 * 3600
