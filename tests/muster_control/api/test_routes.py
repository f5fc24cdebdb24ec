"""What every route answers, with the real services."""

import io
import json
import re
import zipfile
from base64 import b64encode
from pathlib import Path

import pytest
from tests.cli.yard import MISSION
from tests.muster_control.serving import after, plan_of

ON_EARTH = MISSION.replace("name: yard", "name: on earth\norigin_wgs84: {lat_deg: 47.0, lon_deg: 8.0}")
TRAVEL = ",look,open\n"
CASES = Path(__file__).parents[2] / "data" / "cases" / "import"


def test_missions_are_listed_made_changed_and_deleted(http):
    made = http.post("/missions", json={"text": MISSION, "name": "short lived"})
    assert made.status_code == 201
    where = made.headers["location"].removeprefix("/api/v1")
    assert made.headers["etag"] == '"1"'
    assert http.get(where).json()["text"] == MISSION
    changed = http.put(where, json={"text": MISSION + "# more\n", "base_version": 1, "note": "a comment"})
    assert (changed.status_code, changed.json()["version"], changed.headers["etag"]) == (200, 2, '"2"')
    assert http.get(f"{where}/versions/1").json()["text"] == MISSION
    listed = http.get(f"{where}/versions").json()
    assert [(version["version"], version["note"]) for version in listed] == [(2, "a comment"), (1, "")]
    assert "text" not in listed[0]
    assert http.get(f"{where}/versions", params={"limit": 1}).json() == listed[:1]
    assert http.get(f"{where}/versions", params={"before": 2}).json() == listed[1:]
    assert made.json()["id"] in [entry["id"] for entry in http.get("/missions").json()]
    assert http.delete(where).status_code == 204
    assert made.json()["id"] not in [entry["id"] for entry in http.get("/missions").json()]


def test_who_saves_onto_a_changed_mission_is_told(http):
    made = http.post("/missions", json={"text": MISSION, "name": "contended"}).json()
    where = f"/missions/{made['id']}"
    first = http.put(where, json={"text": MISSION + "# a\n"}, headers={"if-match": '"1"'})
    second = http.put(where, json={"text": MISSION + "# b\n"}, headers={"if-match": '"1"'})
    assert (first.status_code, second.status_code) == (200, 409)
    assert http.put(where, json={"text": MISSION}).status_code == 428
    assert http.get(where).json()["text"] == MISSION + "# a\n"


def test_files_of_a_mission(http):
    made = http.post("/missions", json={"text": MISSION, "name": "filed", "files": {"a.csv": b64encode(b"1").decode()}})
    where = f"/missions/{made.json()['id']}"
    assert made.json()["files"] == {"a.csv": 1}
    put = http.put(f"{where}/files/b.bin", content=b"\x00\xff", headers={"if-match": '"1"'})
    assert put.json()["files"] == {"a.csv": 1, "b.bin": 2}
    got = http.get(f"{where}/files/b.bin")
    assert got.content == b"\x00\xff"
    assert got.headers["content-disposition"].startswith('attachment; filename="b.bin"')
    assert got.headers["x-content-type-options"] == "nosniff"
    assert http.get(f"{where}/files/none").status_code == 404


def test_a_mission_is_checked_with_lines(http):
    found = http.post("/missions/check", json={"text": MISSION.replace("[4, 0]", "[4, far]")}).json()
    assert [(error["line"], error["value"]) for error in found["errors"]] == [(10, '"far"')]
    found = http.post("/missions/check", json={"text": MISSION}).json()
    assert (found["errors"], [item["task"] for item in found["impossible"]]) == ([], ["lift"])
    assert found["summary"] == {"name": "yard", "robots": 2, "tasks": 4, "dimensions": 2}


def test_a_mission_is_uploaded(http):
    made = http.post("/missions/upload", files={"file": ("folder/some yard.yaml", MISSION.encode())})
    assert (made.status_code, made.json()["text"]) == (201, MISSION)


def test_what_a_site_does_not_say_is_asked_and_answered(http):
    area = {"type": "Polygon", "coordinates": [[[11, 47], [11.001, 47], [11.001, 47.001], [11, 47]]]}
    spot = {"type": "Point", "coordinates": [11.002, 47.001]}
    features = [
        {"type": "Feature", "properties": {"name": "West"}, "geometry": area},
        {"type": "Feature", "properties": {"name": "Mavic", "kind": "drone"}, "geometry": spot},
    ]
    text = json.dumps({"type": "FeatureCollection", "features": features}).encode()
    files = {"file": ("site.geojson", text)}
    asked = http.post("/missions/upload", files=files)
    assert asked.status_code == 400
    assert "--as West=zone (or boundary, survey, skip)" in asked.text
    asked = http.post("/missions/upload", files=files, data={"as": ["West=survey"]})
    assert (asked.status_code, "height_m" in asked.text) == (400, True)
    answers = {"as": ["West=survey"], "height_m": "40", "fov_deg": "60"}
    made = http.post("/missions/upload", files=files, data=answers)
    assert made.status_code == 201
    assert "height_m: 40" in made.json()["text"]
    assert "return_to_start: true" in made.json()["text"]
    wrong = http.post("/missions/upload", files=files, data={"as": ["West"]})
    assert (wrong.status_code, "expected NAME=KIND" in wrong.text) == (400, True)


def test_an_instance_file_is_uploaded(http):
    """One whose distances are its own stays with the mission as its travel table."""
    text = b"2 20 1\n0 0 0 0 0 90 0 0 0\n1 3 4 5 0 50 1 0 2\n2 6 8 -5 0 80 1 1 0\n"
    made = http.post("/missions/upload", files={"file": ("tiny.txt", text)})
    assert (made.status_code, "delivers: 1" in made.json()["text"]) == (201, True)
    nodes = b"NODE_COORD_SECTION\n1 0 0\n2 3 4\n3 6 1\nDEMAND_SECTION\n1 0\n2 4\n3 5\n"
    text = b"TYPE : CVRP\nDIMENSION : 3\nEDGE_WEIGHT_TYPE : EUC_2D\nCAPACITY : 9\n" + nodes
    made = http.post("/missions/upload", files={"file": ("three.vrp", text)})
    assert made.status_code == 201


def test_an_upload_says_what_became_of_every_element(http):
    text = (CASES / "roi.plan").read_bytes()
    made = http.post("/missions/upload", files={"file": ("roi.plan", text)})
    assert made.status_code == 201
    ledger = made.json()["ledger"]
    assert ledger["read"] + ledger["passed_over"] == sum(row["count"] for row in ledger["rows"])
    assert "DO_SET_ROI_LOCATION" in {row["kind"] for row in ledger["rows"] if row["fate"] == "passed over"}
    assert "DO_SET_ROI_LOCATION" in made.json()["note"]
    assert http.get(f"/missions/{made.json()['id']}").json()["ledger"] is None


def test_a_plan_is_made_judged_explained_and_drawn(http, yard, plan):
    entry = http.get(f"/plans/{plan}").json()
    assert entry["plan"]["schema"] == "muster-plan/1"
    assert plan in [listed["id"] for listed in http.get("/plans", params={"mission": yard}).json()]
    assert len(http.get("/plans", params={"limit": 1}).json()) == 1
    assert http.get("/plans", params={"mission": yard, "before": plan}).json() == []
    verdict = http.get(f"/plans/{plan}/verdict").json()
    assert (verdict["valid"], verdict["tasks_completed"]) == (True, 3)
    assert [item["task"] for item in http.get(f"/plans/{plan}/explain").json()["unassigned"]] == ["lift"]
    assert http.get(f"/plans/{plan}/explain", params={"task": "look"}).json()["robot"] == "r_0"
    drawn = http.get(f"/plans/{plan}/picture", params={"what": "gantt", "format": "png"})
    assert (drawn.headers["content-type"], drawn.content[:4]) == ("image/png", b"\x89PNG")
    assert http.get(f"/plans/{plan}/compare/{plan}").status_code == 200


def test_a_plan_is_written_for_other_tools(http):
    mission = http.post("/missions", json={"text": ON_EARTH}).json()["id"]
    number = plan_of(http, mission)
    one = http.get(f"/plans/{number}/export", params={"to": "gpx"})
    assert b"<gpx" in one.content
    assert one.headers["content-disposition"].startswith("attachment")
    several = http.get(f"/plans/{number}/export", params={"to": "qgc"})
    with zipfile.ZipFile(io.BytesIO(several.content)) as archive:
        assert {"r_0.plan", "r_1.plan"} <= set(archive.namelist())


def test_a_plan_from_elsewhere(http, yard):
    given = {"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["open"]}]}
    made = http.post(f"/missions/{yard}/plans/upload", json=given)
    assert (made.status_code, made.json()["origin"]) == (201, "uploaded")
    assert http.get(made.headers["location"].removeprefix("/api/v1")).json()["plan"]["routes"][0]["tasks"] == ["open"]


def test_a_job_is_stopped_with_its_plan(http, yard):
    job = http.post(f"/missions/{yard}/plans", json={"time_limit": 60.0}).json()["id"]
    after(http, f"/jobs/{job}", "queued")
    assert http.post(f"/jobs/{job}/stop").status_code == 202
    seen = after(http, f"/jobs/{job}", "running")
    assert seen["state"] == "done"
    assert http.get(f"/plans/{seen['result']['plan']}").status_code == 200
    assert http.post(f"/jobs/{job}/stop").status_code == 409


@pytest.mark.long
def test_a_job_is_followed_and_cancelled(http, yard):
    job = http.post(f"/missions/{yard}/plans", json={"time_limit": 60.0}).json()
    assert job["state"] in ("queued", "running")
    assert job["id"] in [listed["id"] for listed in http.get("/jobs").json()]
    assert [listed["id"] for listed in http.get("/jobs", params={"mission": yard, "limit": 1}).json()] == [job["id"]]
    assert http.get("/jobs", params={"mission": "31T-6R50"}).json() == []
    assert http.delete(f"/jobs/{job['id']}").json()["state"] == "cancelled"
    assert http.delete(f"/jobs/{job['id']}").status_code == 409
    assert [listed["id"] for listed in http.get("/jobs", params={"state": "running"}).json()] == []


@pytest.fixture(scope="module")
def run(http, plan):
    """The id of a run that is over."""
    begun = http.post("/runs", json={"plan": plan, "speed": None, "settings": {"seed": 1}})
    assert begun.status_code == 201, begun.text
    where = begun.headers["location"].removeprefix("/api/v1")
    assert after(http, where, "starting", "running")["state"] == "ended"
    return begun.json()["id"]


@pytest.mark.long
def test_a_run_has_a_log_and_a_report(http, run):
    entries = http.get(f"/runs/{run}/events").json()
    assert [entry["seq"] for entry in entries] == list(range(1, len(entries) + 1))
    assert http.get(f"/runs/{run}/events", params={"after": 3, "limit": 2}).json() == entries[3:5]
    report = http.get(f"/runs/{run}/report").json()
    assert sorted(report["tasks_done"]) == ["enter", "look", "open"]
    assert [lost["task"] for lost in report["tasks_lost"]] == ["lift"]
    assert run in [listed["id"] for listed in http.get("/runs").json()]


@pytest.mark.long
def test_a_run_is_acted_upon(http, plan):
    run = http.post("/runs", json={"plan": plan, "speed": 1.0}).json()["id"]
    assert http.get(f"/runs/{run}/report").status_code == 409
    for wish in ({"verb": "speed", "data": {"speed": 2.0}}, {"verb": "event", "data": {"robot_fails": "r_1"}}):
        asked = http.post(f"/runs/{run}/actions", json=wish)
        assert (asked.status_code, asked.json()["verb"]) == (202, f"run.{wish['verb']}")
    assert http.post(f"/runs/{run}/actions", json={"verb": "cancel"}).status_code == 202
    assert after(http, f"/runs/{run}", "starting", "running")["state"] == "cancelled"
    assert http.post(f"/runs/{run}/actions", json={"verb": "pause"}).status_code == 409
    verbs = [action["verb"] for action in http.get("/actions", params={"run": run}).json()]
    assert {"run.start", "run.speed", "run.event", "run.cancel"} <= set(verbs)


def test_settings_of_a_run_name_no_parameters(http, plan):
    refused = http.post("/runs", json={"plan": plan, "settings": {"who": "me"}})
    assert (refused.status_code, refused.json()["error"][:13]) == (400, "who: unknown;")


@pytest.mark.long
def test_a_record_is_looked_at_and_taken_away(http, run):
    assert run in [listed["id"] for listed in http.get("/records").json()]
    page = http.get(f"/records/{run}/page.html")
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert "sandbox" in page.headers["content-security-policy"]
    assert b"yard" in page.content
    assert http.get(f"/records/{run}/record.mcap").content.startswith(b"\x89MCAP")
    assert http.get(f"/records/{run}/flown").status_code == 200
    assert http.get(f"/records/{run}/export", params={"to": "csv"}).content


def test_what_the_server_is(http):
    about = http.get("/about").json()
    assert (about["api"], about["worlds"]) == (1, ["kinematic", "physics"])
    assert http.get("/me").json() == {"name": "local", "role": "command", "address": "127.0.0.1"}
    assert "search" in [allocator["name"] for allocator in http.get("/allocators").json()]


def test_the_description_lists_every_route_and_needs_nothing_from_elsewhere(http):
    described = http.get("/openapi.json").json()
    assert described["openapi"].startswith("3.1")
    operations = [told for methods in described["paths"].values() for told in methods.values()]
    assert all(told["summary"] and told["description"] and told["tags"] for told in operations)
    page = http.get("/docs").text
    assert all(path in page for path in described["paths"])
    assert not re.findall(r"""(?:src|href)=["']?(?:https?:)?//""", page)


@pytest.mark.long
def test_the_same_request_with_the_same_key_makes_nothing_again(http, yard, plan):
    for path, body, other in (
        ("/runs", {"plan": plan, "speed": None}, {"plan": plan, "speed": 2.0}),
        (f"/missions/{yard}/plans", {"iterations": 1}, {"iterations": 2}),
    ):
        key = {"idempotency-key": f"k{path}"}
        first, second = (http.post(path, json=body, headers=key) for _ in range(2))
        assert first.status_code == second.status_code in (201, 202)
        assert first.json()["id"] == second.json()["id"]
        assert first.headers["location"] == second.headers["location"]
        assert http.post(path, json=other, headers=key).status_code == 409
        assert http.post(path, json=body).json()["id"] > first.json()["id"]
        assert http.post(path, json=body, headers={"idempotency-key": "a b"}).status_code == 422
