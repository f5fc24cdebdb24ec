"""`muster export`: what it writes where, what it says, and what it refuses."""

import json
import re
from pathlib import Path

import pytest
from tests.muster_files.bay import BAY, bay_plan

pytestmark = pytest.mark.usefixtures("folder")


@pytest.fixture
def bay_files(folder):
    Path("bay.yaml").write_text(BAY, encoding="utf-8")
    bay_plan().save("bay.json")
    return "bay.yaml", "bay.json"


@pytest.fixture
def export(bay_files, muster):
    return lambda *arguments: muster("export", *bay_files, *arguments)


def test_a_plan_file_for_each_robot_that_has_tasks(export, muster):
    code, out, err = export("--to", "qgc", "-o", "plans")
    assert (code, out) == (0, "")
    assert sorted(file.name for file in Path("plans").iterdir()) == ["d1.plan", "d2.plan", "d3.plan", "rover.plan"]
    said = err.splitlines()
    assert said[0] == "idle: no tasks, no file"
    assert said[1] == "d1: lands at its start"
    assert said[2].startswith("warning: d2: its way leads over or under zone 1, ")
    assert muster("check", "plans")[0] == 0


def test_robots_that_come_near_each_other_are_named(export, muster):
    _, _, err = export("--to", "qgc", "-o", "plans", "--clearance", "3")
    near = [line for line in err.splitlines() if " apart at " in line]
    assert re.fullmatch(
        r"warning: d1 and d2: \d\.\d\d m apart at [\d.]+ s of the schedule; expected at least 3\.60 m", near[0]
    )
    _, _, err = export("--to", "qgc", "-o", "others")
    assert " apart at " not in err


def test_ways_through_closed_areas_are_not_written(export):
    Path("bay.yaml").write_text(BAY.replace("ceiling_m: 4", "ceiling_m: 14"), encoding="utf-8")
    code, out, err = export("--to", "qgc", "-o", "plans")
    assert (code, out) == (2, "")
    assert "closed-area: d2, a, the leg from its start to task a enters zone 1" in err
    assert not Path("plans").exists()


def test_heights_do_not_lift_ways_into_closed_areas(export):
    Path("bay.yaml").write_text(BAY.replace("ceiling_m: 4", "floor_m: 25"), encoding="utf-8")
    assert export("--to", "qgc", "-o", "plans")[0] == 0
    code, _, err = export("--to", "qgc", "-o", "high", "--altitude", "30")
    assert code == 2
    assert "closed-area: d2, a, the leg from" in err
    assert not Path("high").exists()


def test_a_fence_across_the_meridian_of_180_degrees_is_named(export):
    Path("bay.yaml").write_text(BAY.replace("lon_deg: -124.06", "lon_deg: 179.9995"), encoding="utf-8")
    code, _, err = export("--to", "qgc", "-o", "plans")
    assert code == 0
    assert "warning: rover: its fence crosses the meridian of 180 degrees; autopilots may take" in err


@pytest.mark.parametrize(("metres", "more"), [("0", True), ("0.2", False)])
def test_way_points_around_corners_are_joined(metres, more, export):
    around = "[[3, 10], [20, 10], [20, 25], [3, 25]]"
    text = BAY.replace("{travel: euclidean}", "{travel: map}").replace(
        "[[60, 20], [90, 20], [90, 60], [60, 60]]", around
    )
    Path("bay.yaml").write_text(text, encoding="utf-8")
    assert export("--to", "qgc", "-o", "plans", "--tolerance", metres)[0] == 0
    items = json.loads(Path("plans/rover.plan").read_text(encoding="utf-8"))["mission"]["items"]
    assert (len(items) > 5) == more


def test_quiet_writes_without_a_word(export):
    assert export("--to", "qgc", "-o", "plans", "-q") == (0, "", "")


@pytest.mark.parametrize("form", ["geojson", "gpx", "kml", "csv", "sol"])
def test_one_file_goes_to_standard_output_or_where_it_is_told(form, export):
    code, out, err = export("--to", form)
    assert (code, err) == (0, "")
    assert export("--to", form, "-o", "x") == (0, "", "")
    assert Path("x").read_text(encoding="utf-8") == out
    assert export("--to", form, "-o", "x")[0] == 0  # what it wrote it may write again


@pytest.mark.long
@pytest.mark.parametrize(("form", "magic"), [("sheets", b"%PDF-"), ("overview", b"%PDF-"), ("xlsx", b"PK")])
def test_files_that_are_no_texts_are_written_as_they_are(form, magic, export):
    assert export("--to", form, "-o", "x") == (0, "", "")
    assert Path("x").read_bytes().startswith(magic)


def test_a_file_that_is_no_text_is_not_written_to_a_terminal(export, monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    code, out, err = export("--to", "xlsx")
    assert (code, out, err) == (2, "", "-o missing; expected a file: xlsx is no text for a terminal\n")


def test_calendars_of_each_robot(export):
    text = BAY.replace("name: bay\n", "name: bay\nstarts_at: 2027-03-01T08:00:00Z\n")
    Path("bay.yaml").write_text(text, encoding="utf-8")
    code, out, err = export("--to", "ics", "--per-robot", "-o", "calendars")
    assert (code, out, err) == (0, "", "idle: no stops, no file\n")
    assert sorted(file.name for file in Path("calendars").iterdir()) == ["d1.ics", "d2.ics", "d3.ics", "rover.ics"]
    assert export("--to", "ics")[1].startswith("BEGIN:VCALENDAR\r\n")


def test_drones_in_layers(export):
    _, _, err = export("--to", "kml", "--altitude", "30", "--altitudes", "d2=60,d3=90", "-o", "x")
    assert "d1: does b, c at its height of flight, not lower as the mission says" in err.splitlines()
    assert Path("x").read_text(encoding="utf-8").count(",60 ") >= 1


@pytest.mark.parametrize("form", ["qgc", "geojson", "gpx", "kml"])
def test_a_mission_without_an_origin(form, export):
    Path("bay.yaml").write_text(re.sub("origin_wgs84.*\n", "", BAY), encoding="utf-8")
    expected = "origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06} in the mission, the place of its origin on Earth"
    code, out, err = export("--to", form, "-o", "x")
    assert (code, out, err) == (2, "", f"bay.yaml: origin_wgs84: missing; expected {expected}, for --to {form}\n")
    assert not Path("x").exists()
    assert export("--to", "csv")[0] == 0


def test_a_plan_of_another_mission(export, muster, plan):
    code, out, err = muster("export", "bay.yaml", plan, "--to", "csv")
    assert (code, out) == (2, "")
    assert err.startswith("plan.json: mission: the plan is of yard; expected bay, or no name")
    assert err.rstrip().endswith("expected an admissible plan of mission bay; muster verify says what is wrong")


def test_an_unknown_format(export):
    code, out, err = export("--to", "geojsn")
    assert (code, out) == (2, "")
    assert (
        "'geojsn' is not one of qgc, geojson, gpx, kml, csv, sol, sheets, overview, xlsx, ics; did you mean 'geojson'?"
        in err
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--to", "qgc"], "-o missing; expected a folder for the .plan files"),
        (["--to", "qgc", "-o", "bay.yaml"], "-o: bay.yaml is a file; expected a folder, or a name for a new one"),
        (["--to", "csv", "--altitude", "9"], "--altitude given; expected it with --to qgc or geojson or gpx or kml or"),
        (["--to", "gpx", "--per-robot"], "--per-robot given; expected it with --to sheets or ics, not gpx"),
        (["--to", "sheets", "--per-robot"], "-o missing; expected a folder for the .pdf files"),
        (["--to", "kml", "--altitudes", "d1"], 'altitudes: "d1"; expected ROBOT=METRES, as r_0=30,r_1=40'),
        (["--to", "kml", "--altitudes", "d9=4"], "altitudes: d9; expected robots of kind air: d1, d2, d3"),
        (["--to", "ics"], "bay.yaml: starts_at: missing; expected starts_at: 2027-03-01T08:00:00+01:00 in the mission"),
        (["--to", "csv", "--firmware", "px4"], "--firmware given; expected it with --to qgc, not csv"),
        (["--to", "csv", "-o", "bay.yaml"], "bay.yaml: given twice; expected a file that is neither read nor written"),
        (["--to", "csv", "-o", "bay.json"], "bay.json: given twice; expected a file that is neither read nor written"),
        (["--to", "gpx", "-o", "no/x.gpx"], "no/x.gpx: cannot be written; expected a file in a folder that exists"),
    ],
)
def test_what_cannot_be_written(arguments, said, export):
    before = Path("bay.yaml").read_bytes(), Path("bay.json").read_bytes()
    code, out, err = export(*arguments)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert err.startswith(said)
    assert (Path("bay.yaml").read_bytes(), Path("bay.json").read_bytes()) == before


def test_a_folder_with_plans_of_other_robots(export):
    Path("plans").mkdir()
    Path("plans/old.plan").write_text("{}", encoding="utf-8")
    code, _, err = export("--to", "qgc", "-o", "plans")
    assert (code, err) == (2, "-o: plans holds old.plan; expected a folder without .plan files of other robots\n")
    assert [file.name for file in Path("plans").iterdir()] == ["old.plan"]


def test_plan_files_that_were_read_are_not_replaced(export, muster):
    export("--to", "qgc", "-o", "plans")
    before = Path("plans/d2.plan").read_bytes()
    assert muster("solve", "plans", "--iterations", 5, "-o", "again.json")[0] == 0
    code, _, err = muster("export", "plans", "again.json", "--to", "qgc", "-o", "plans")
    assert code == 2
    assert err.splitlines()[-1].endswith(": given twice; expected a folder whose files are not read")
    assert Path("plans/d2.plan").read_bytes() == before


def test_drones_in_the_plane_need_a_height(export):
    text = re.sub(r"(position: \[[^],]*, [^],]*), [^],]*\]", r"\1]", BAY)
    text = text.replace("60, 20], [90, 20", "85, 55], [90, 55")
    Path("bay.yaml").write_text(text, encoding="utf-8")
    code, out, err = export("--to", "qgc", "-o", "plans")
    assert (code, out) == (2, "")
    assert err == "--altitude missing; expected metres above the start for d1 in the plane\n"
    assert export("--to", "qgc", "-o", "plans", "--altitude", "25")[0] == 0
    flown = json.loads(Path("plans/d2.plan").read_text(encoding="utf-8"))["mission"]["items"]
    assert [item["Altitude"] for item in flown if "Altitude" in item] == pytest.approx([25, 25, 0], abs=0.01)


def test_a_drone_that_flies_no_higher_than_its_start_is_named(export):
    Path("bay.yaml").write_text(BAY.replace("[-40, 60, 9]", "[-40, 60, 0]"), encoding="utf-8")
    _, _, err = export("--to", "qgc", "-o", "plans")
    assert (
        "warning: d3: flies no higher than its start at task e; --altitude M gives a least height" in err.splitlines()
    )


def test_ids_that_are_no_file_names(export):
    text = BAY.replace("id: d2", 'id: "../D1"').replace("id: d3", 'id: "a/b"')
    Path("bay.yaml").write_text(text, encoding="utf-8")
    plan = json.loads(Path("bay.json").read_text(encoding="utf-8"))
    plan["routes"][1]["robot"], plan["routes"][2]["robot"] = "../D1", "a/b"
    Path("bay.json").write_text(json.dumps(plan), encoding="utf-8")
    assert export("--to", "qgc", "-o", "plans", "-q")[0] == 0
    assert sorted(file.name for file in Path("plans").iterdir()) == ["_D1.plan", "a_b.plan", "d1.plan", "rover.plan"]
