"""`muster import`, and files of sites wherever a MISSION is."""

import json
from pathlib import Path

import pytest
from tests.muster_files.sites import writers

from muster import load

CASES = Path(__file__).parents[2] / "data" / "cases" / "import"


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in (
        ("panels.csv", writers.CSV),
        ("robots.csv", writers.ROBOTS),
        ("fences.geojson", writers.geojson(writers.area())),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def test_several_files_make_a_mission(muster, files):
    code, out, err = muster("import", "panels.csv", "fences.geojson", "robots.csv", "-o", "m.yaml")
    assert (code, out) == (0, "")
    assert err == (
        "panels.csv: 3 tasks\nfences.geojson: 1 zone\nrobots.csv: 1 robot\n"
        "robots.csv: numbers without a unit are taken so: speed in m/s\n"
        "origin_wgs84 chosen: lat_deg 47.377, lon_deg 8.54205, alt_m 0.0; --origin says another\n"
        "no boundary given: a rectangle 50 m around everything is taken\n"
        "panels.csv: north, east, south: task, as points are where no word says other\n"
        "fences.geojson: features[0]: zone, by the word fences in the file fences\n"
        "next: muster check m.yaml; muster solve m.yaml\n"
    )
    assert muster("check", "m.yaml")[0] == 0
    mission = load("m.yaml")
    assert (mission.name, len(mission.tasks), len(mission.robots), len(mission.map.zones)) == ("panels", 3, 1, 1)


def test_without_a_file_to_write_it_goes_to_standard_output(muster, files):
    code, out, err = muster("import", "panels.csv", "--robots", "robots.csv", "--name", "roof", "-q")
    assert (code, err) == (0, "")
    (files / "again.yaml").write_text(out, encoding="utf-8")
    assert load("again.yaml").name == "roof"


def test_a_site_stands_where_a_mission_does(muster, files):
    code, out, err = muster("check", "panels.csv", "--robots", "robots.csv", "--column", "id=name")
    assert code == 0
    assert out.startswith("panels: 1 robot, 3 tasks; no errors\n")
    assert "origin_wgs84 chosen: " in err
    assert muster("verify", "panels.csv", "--robots", "robots.csv", "none.json", "-q")[0] == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.csv"], "none.csv: No such file or directory; expected a file to read; did you mean 'panels.csv'?\n"),
        (
            ["panels.csv"],
            "panels.csv: robots: missing; expected a sheet or file of robots whose name says so (robots.csv), or",
        ),
        (["panels.csv", "--column", "lat"], "--column: lat; expected NAME=VALUE\n"),
        (["panels.csv", "--column", "foo=name", "--robots", "robots.csv"], "--column: no key foo; did you mean "),
        (["panels.csv", "--starts-at", "noon", "--robots", "robots.csv"], '--starts-at: starts_at: "noon"; expected a'),
        (["panels.csv", "--as", "panels=tsk"], "--as panels: tsk; expected one of task, robot, station"),
        (["panels.csv", "--origin", "here"], "--origin: here; expected latitude and longitude in degrees"),
        (["panels.csv", "-o", "panels.csv"], "panels.csv: given twice; expected a file that is neither read"),
        (["site.shp"], "site.shp: a file of the kind .shp; expected a mission (.yaml, .json, .plan), a site (.csv, "),
    ],
)
def test_what_is_wrong_is_said_in_one_line(muster, files, arguments, message):
    code, out, err = muster("import", *arguments)
    assert (code, out) == (2, "")
    assert err.startswith(message)
    assert len(err.splitlines()) == 1


def test_columns_go_with_files_of_sites_alone(muster, files):
    code, _, err = muster("check", "6T-2R", "--column", "lat=x")
    assert (code, err) == (2, "6T-2R: --column given; expected no --column with this kind of mission\n")


def test_what_is_not_read_stands_in_a_table_at_the_end(muster, files):
    text = writers.CSV.replace("name,lat,lon", "name,lat,lon,colour").replace("8.5417\n", "8.5417,red\n")
    (files / "panels.csv").write_text(text, encoding="utf-8")
    code, out, err = muster("import", "panels.csv", "robots.csv", "-o", "m.yaml")
    assert (code, out) == (0, "")
    assert err.splitlines()[-4:] == [
        "not read:",
        "  panels.csv: 12 elements read, 3 passed over",
        "         2  colour  passed over: it means nothing for a task",
        "next: muster check m.yaml; muster solve m.yaml",
    ]


def test_the_ledger_is_json_beside_the_mission(muster, files):
    code, out, err = muster("import", "panels.csv", "robots.csv", "fences.geojson", "-o", "m.yaml", "--format", "json")
    assert (code, err) == (0, "next: muster check m.yaml; muster solve m.yaml\n")
    ledger = json.loads(out)["ledger"]
    assert ledger["files"]["panels.csv"] == {"read": 12, "passed_over": 0, "refused": 0}
    assert sum(row["count"] for row in ledger["rows"]) == ledger["read"] + ledger["passed_over"]
    assert muster("import", "panels.csv", "robots.csv", "--format", "json")[0] == 2


@pytest.mark.parametrize("verb", ["check", "solve", "import"])
def test_a_plan_file_says_what_of_it_is_not_read(verb, muster, files):
    (files / "roi.plan").write_bytes((CASES / "roi.plan").read_bytes())
    more = {"solve": ("--iterations", "20"), "import": ("-o", "m.yaml")}
    code, _, err = muster(verb, "roi.plan", *more.get(verb, ()))
    assert code == 0
    assert "DO_SET_ROI_LOCATION" in err
    assert "IMAGE_START_CAPTURE" in err


def test_check_has_the_ledger_in_json(muster, files):
    (files / "roi.plan").write_bytes((CASES / "roi.plan").read_bytes())
    ledger = json.loads(muster("check", "roi.plan", "--format", "json")[1])["ledger"]
    kinds = {row["kind"]: (row["fate"], row.get("because")) for row in ledger["rows"]}
    assert kinds["DO_SET_ROI_LOCATION"][0] == "passed over"
    assert "ledger" not in json.loads(muster("check", "6T-2R", "--format", "json")[1])
