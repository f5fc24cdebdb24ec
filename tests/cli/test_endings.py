"""The table of endings, verb by verb: exit code and words; and what the API answers to the same."""

import json
import shutil

import pytest
from tests.muster_control.serving import after, served

from muster import load, solve
from muster.cli.exit_codes import Ending
from muster.cli.main import run
from muster.library import mission_path

MISSION = """schema: muster/1
name: m
robots: [{id: r, position: [0, 0], work_capacity: 12}]
tasks: [{id: east, position: [5, 0]}, {id: west, position: [-5, 0]}]
"""
ZONE = """rules: {travel: euclidean}
map:
  boundary: [[-9, -9], [9, -9], [9, 9], [-9, 9]]
  zones: [{polygon: [[2, -1], [3, -1], [3, 1], [2, 1]]}]"""
TEXTS = {
    "m.yaml": MISSION,
    "never.yaml": MISSION.replace("id: west,", "id: west, requires: [gripper],"),
    "zone.yaml": MISSION.replace("tasks:", f"{ZONE}\ntasks:"),
    "bad.yaml": "schema: muster/1\n",
    "far.json": '{"schema": "muster-plan/1", "routes": [{"robot": "r", "tasks": ["east", "west"]}]}',
    "east.json": '{"schema": "muster-plan/1", "routes": [{"robot": "r", "tasks": ["east"]}]}',
    "cut.json": '{"schema": "muster-plan/1", "routes": [{"robot": "r", "tasks": ["east"]}], "cut_short": true}',
}
FAST = ["--iterations", "5"]


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in TEXTS.items():
        (tmp_path / name).write_text(text)
    shutil.copy(mission_path("6T-2R"), "whole.yaml")
    solve(load("whole.yaml"), "greedy").save("whole.json")


CASES = [
    # a complete search that leaves tasks out is done
    (["solve", "whole.yaml", *FAST], Ending.DONE, 0),
    (["solve", "m.yaml", *FAST], Ending.DONE, 0),
    (["solve", "m.yaml", *FAST, "--require-complete"], Ending.LEFT_OUT, 3),
    (["solve", "bad.yaml"], Ending.REFUSED, 2),
    (["solve", "m.yaml", "--no-such-option"], Ending.REFUSED, 2),
    (["check", "whole.yaml"], Ending.DONE, 0),
    (["check", "m.yaml"], Ending.DONE, 0),
    (["check", "m.yaml", "--require-complete"], Ending.LEFT_OUT, 3),
    (["check", "never.yaml"], Ending.IMPOSSIBLE, 3),
    (["check", "zone.yaml"], Ending.IMPOSSIBLE, 3),
    (["check", "bad.yaml"], Ending.REFUSED, 2),
    (["verify", "m.yaml", "east.json"], Ending.DONE, 0),
    (["verify", "m.yaml", "far.json"], Ending.REJECTED, 1),
    (["verify", "zone.yaml", "east.json"], Ending.REJECTED, 1),
    (["verify", "m.yaml", "m.yaml"], Ending.REFUSED, 2),
    (["explain", "m.yaml", "east.json"], Ending.DONE, 0),
    (["explain", "m.yaml", "none.json"], Ending.REFUSED, 2),
    (["simulate", "whole.yaml", "--plan", "whole.json"], Ending.DONE, 0),
    (["simulate", "m.yaml", "--plan", "east.json"], Ending.DONE, 0),
    (["simulate", "m.yaml", "--plan", "east.json", "--require-complete"], Ending.LEFT_OUT, 3),
    (["simulate", "m.yaml", "--plan", "cut.json"], Ending.CUT_SHORT, 3),
    (["simulate", "m.yaml", "--plan", "cut.json", "--accept-partial"], Ending.DONE, 0),
    (["simulate", "zone.yaml", "--plan", "east.json"], Ending.REFUSED, 2),
    (["export", "m.yaml", "east.json", "--to", "csv"], Ending.DONE, 0),
    (["export", "m.yaml", "cut.json", "--to", "csv"], Ending.CUT_SHORT, 3),
    (["export", "m.yaml", "far.json", "--to", "csv"], Ending.REFUSED, 2),
    (["export", "zone.yaml", "east.json", "--to", "csv"], Ending.REFUSED, 2),
    (["import", "none.kml"], Ending.REFUSED, 2),
    (["generate", "no-such-family"], Ending.REFUSED, 2),
    (["missions"], Ending.DONE, 0),
    (["no-such-verb"], Ending.REFUSED, 2),
]


@pytest.mark.parametrize(
    ("arguments", "ending", "code"), CASES, ids=lambda value: " ".join(value) if isinstance(value, list) else None
)
def test_each_verb_ends_as_the_table_says(arguments, ending, code, capsys):
    assert ending.code == code
    assert run(arguments) == code
    captured = capsys.readouterr()
    if ending not in (Ending.REFUSED, Ending.DONE):  # of which each message is its own
        assert ending.words in captured.out + captured.err
    assert "Traceback" not in captured.err
    if ending is Ending.REFUSED:
        assert captured.err.strip()


def test_every_ending_that_is_no_robots_is_shown_here_or_by_a_test_of_its_own():
    shown = {ending for _, ending, _ in CASES}
    robots = {Ending.STILL_MOVING, Ending.TASKS_LOST}  # tests/muster_robots
    others = {Ending.INTERNAL_ERROR, Ending.INTERRUPTED, Ending.BROKEN_PIPE, Ending.NO_PLAN}  # tests/cli
    assert shown | robots | others == set(Ending)


@pytest.fixture(scope="module")
def http(tmp_path_factory):
    import httpx

    with served(tmp_path_factory.mktemp("server")) as url, httpx.Client(base_url=f"{url}/api/v1", timeout=60) as http:
        yield http


def begun(http, mission, plan, **settings):
    """The answer to the start of a run of an uploaded plan."""
    kept = http.post("/missions", json={"text": TEXTS[mission]}).json()["id"]
    uploaded = http.post(f"/missions/{kept}/plans/upload", json=json.loads(TEXTS[plan]))
    assert uploaded.status_code == 201, uploaded.text
    return http.post("/runs", json={"plan": uploaded.json()["id"], "speed": None, "settings": settings})


@pytest.mark.long
@pytest.mark.parametrize(
    ("plan", "settings", "status"),
    [("east.json", {}, 201), ("cut.json", {}, 409), ("cut.json", {"accept_partial": True}, 201)],
)
def test_the_api_begins_no_run_with_a_part(http, plan, settings, status):
    answered = begun(http, "m.yaml", plan, **settings)
    assert answered.status_code == status, answered.text


@pytest.mark.long
def test_a_run_through_a_closed_area_fails_before_it_begins(http):
    run_id = begun(http, "zone.yaml", "east.json").json()["id"]
    seen = after(http, f"/runs/{run_id}", "starting", "running")
    assert seen["state"] == "failed"
    assert "closed-area: r, east, the leg from its start to task east enters zone 0" in seen["remark"]
