"""What workers answer: the same as the command, for missions with their files."""

import base64
import json
from pathlib import Path

import pytest
from tests.muster_control.work.asking import FLOOR, MAPPED, TINY, given, shipped
from tests.muster_files.sites.writers import CSV, ROBOTS, area, geojson

import muster
from muster.library import mission_path
from muster.mission.reading.plan_reader import plan_from
from muster.mission.reading.yaml_reader import parse_yaml
from muster_control.work import StopRequest, WorkError


@pytest.fixture(scope="module")
def plan(asked):
    """A plan of 31T-6R50."""
    return asked("plan", mission=shipped("31T-6R50"), iterations=50)["plan"]


def test_check_a_mission_that_is_right(asked):
    answer = asked("check", mission=given(TINY))
    assert (answer["errors"], answer["impossible"]) == ([], [])
    assert answer["summary"] == {"name": "tiny", "robots": 2, "tasks": 2, "dimensions": 2}
    assert answer["mission"]["tasks"][1] == {"id": "b", "position": [9, 0], "prerequisites": ["a"]}


def test_check_names_all_that_is_wrong_with_file_and_line(asked):
    wrong = TINY.replace("[1, 0]", "here").replace("[a]", "[c]")
    answer = asked("check", mission=given(wrong, name="yard"))
    places = [(error["file"], error["line"], error["field"]) for error in answer["errors"]]
    assert places == [("yard.yaml", 8, "tasks[0].position"), ("yard.yaml", 9, "tasks[1].prerequisites[0]")]
    assert (answer["summary"], answer["mission"]) == (None, None)


def test_check_names_tasks_that_can_never_be_done(asked):
    answer = asked("check", mission=given(TINY.replace("[1, 0]}", "[1, 0], requires: [gripper]}")))
    assert [item["task"] for item in answer["impossible"]] == ["a", "b"]


def test_a_mission_with_files_is_read_with_them(asked):
    answer = asked("check", mission=given(MAPPED, {"floors/floor.png": FLOOR}))
    assert answer["errors"] == []
    assert answer["floor"] == {"file": "floors/floor.png", "resolution_m": 1, "origin": [0, 0, 0]}
    assert (
        asked("plan", mission=given(MAPPED, {"floors/floor.png": FLOOR}), iterations=1)["plan"]["tasks_completed"] == 1
    )


def test_a_map_may_stand_beside_the_folder_of_the_mission(asked):
    folder = mission_path("floor").parent.parent / "maps"
    files = {f"../maps/{path.name}": path.read_bytes() for path in folder.iterdir()}
    text = mission_path("floor").read_text(encoding="utf-8")
    answer = asked("check", mission=given(text, files))
    assert answer["errors"] == []
    assert answer["floor"]["file"] in files
    assert asked("floor_plan", mission=given(text, files)) == {"floor": answer["floor"], "earth": None}


def test_plan_as_the_command_does(plan):
    mission = muster.load("31T-6R50")
    assert muster.verify(mission, plan_from(plan, "plan")).valid
    same = muster.solve(mission, iterations=50).as_dict()
    for told in (plan, same):
        told.pop("elapsed_s")
        told.pop("history")
    assert plan == json.loads(json.dumps(same))


def test_plan_with_everything_that_can_be_asked(asked, plan):
    answer = asked(
        "plan",
        mission=shipped("6T-2R"),
        allocator="genetic",
        objective="makespan",
        iterations=3,
        time_limit=None,
        seed=7,
        ignore=["capacity"],
        bound="quick",
        parameters={"population_size": 10},
    )
    told = answer["plan"]
    assert (told["allocator"], told["objective"]["name"], told["seed"]) == ("genetic", "makespan", 7)
    assert told["ignored"] == ["capacity"]
    assert 0 < told["lower_bound"] <= told["objective"]["value"]
    assert answer["why"]
    again = asked("plan", mission=shipped("31T-6R50"), start=plan, iterations=0)["plan"]
    assert again["objective"]["value"] <= plan["objective"]["value"]


@pytest.mark.parametrize(
    ("wish", "line"),
    [
        ({"allocator": "magic"}, "allocator: magic; expected greedy"),
        ({"objective": "fun"}, "objective: .*fun"),
        ({"parameters": {"ray": "10.0.0.1:6379"}}, "ray: given; expected no cluster"),
        ({"parameters": {"threads": 100_000}}, "threads: 100000; expected at most"),
        ({"parameters": {"nonsense": 1}}, "search has no parameter nonsense"),
        ({"time_limit": -1}, "time_limit: -1; expected seconds"),
        ({"start": {"schema": "muster-plan/1", "routes": 3}}, "start: routes: 3; expected"),
    ],
)
def test_a_wish_that_cannot_be_met_is_one_line(asked, wish, line):
    with pytest.raises(WorkError, match=f"^{line}[^\n]*$"):
        asked("plan", mission=given(TINY), **wish)


def test_a_verdict_has_figures_times_and_ways(asked, plan):
    answer = asked("judge", mission=shipped("31T-6R50"), plan=plan)
    verdict = muster.verify(muster.load("31T-6R50"), plan_from(plan, "plan"))
    assert {key: answer[key] for key in verdict.as_dict()} == verdict.as_dict()
    first = answer["routes"][0]
    assert [visit["task"] for visit in first["visits"]] == plan["routes"][0]["tasks"]
    (way,) = answer["lines"]["r_0"]["travel"]
    assert (len(way), way[0]) == (len(first["tasks"]) + 1, [5.0, -8.0])


def test_a_verdict_on_a_plan_that_is_wrong(asked):
    routes = [{"robot": "r_0", "tasks": ["b"]}, {"robot": "nobody", "tasks": []}]
    answer = asked("judge", mission=given(TINY), plan={"schema": "muster-plan/1", "routes": routes})
    assert not answer["valid"]
    assert {"unknown-robot", "prerequisite"} <= {violation["kind"] for violation in answer["violations"]}


def test_the_allocators_are_those_of_the_command(asked):
    from muster.allocation.registry import ALLOCATORS

    told = asked("allocators")["allocators"]
    assert [allocator["name"] for allocator in told] == list(ALLOCATORS)
    assert [allocator["name"] for allocator in told if allocator["default"]] == ["search"]
    assert {allocator["name"] for allocator in told if not allocator["anytime"]} >= {"greedy", "auction"}


def test_progress_of_a_plan_grows_to_its_end(asked):
    heard = []
    wish = {"time_limit": 0.5, "bound": "quick"}
    plan = asked("plan", mission=shipped("31T-6R"), on_progress=heard.append, **wish)["plan"]
    assert 1 <= len(heard) <= 6
    shares = [told["share"] for told in heard]
    assert shares == sorted(shares)
    assert all(0 < share <= 1 for share in shares)
    assert {told["bound"] for told in heard if told["weight"] == plan["weight_completed"]} == {plan["lower_bound"]}
    assert heard[-1]["history"] == plan["history"][: len(heard[-1]["history"])]


def test_a_long_history_is_thinned_to_its_end():
    from muster_control.work.tasks.plan import thinned

    history = [(float(k), -float(k)) for k in range(1001)]
    points = thinned(history)
    assert len(points) <= 200
    assert (points[-1], points == sorted(points)) == (history[-1], True)
    assert thinned(history[:150]) == history[:150]
    assert thinned([]) == []


@pytest.mark.parametrize(("bound", "why"), [(None, ""), ("quick", "planning was stopped before a bound was proven")])
def test_planning_that_is_stopped_at_once_gives_the_first_plan(asked, bound, why):
    stop_request = StopRequest()
    stop_request.ask()
    done = asked("plan", mission=shipped("31T-6R50"), time_limit=600.0, bound=bound, stop_request=stop_request)
    assert done["plan"]["tasks_completed"] > 0
    assert (done["plan"].get("lower_bound"), done["why"]) == (None, why)


def test_the_files_of_a_site_are_one_mission(asked):
    texts = {"panels.csv": CSV, "robots.csv": ROBOTS, "fences.geojson": geojson(area())}
    files = {name: base64.b64encode(text.encode()).decode() for name, text in texts.items()}
    answer = asked("convert", name="panels.csv", files=files, robots="robots.csv")
    mission = parse_yaml(answer["text"], Path("panels.yaml"))
    assert (answer["name"], answer["needs"]) == ("panels", [])
    assert (len(mission.tasks), len(mission.robots), len(mission.map.zones)) == (3, 1, 1)
    assert answer["notes"][:3] == ["panels.csv: 3 tasks", "fences.geojson: 1 zone", "robots.csv: 1 robot"]
    assert any(note.startswith("origin_wgs84 chosen: ") for note in answer["notes"])
    assert answer["ledger"]["files"]["panels.csv"] == {"read": 12, "passed_over": 0, "refused": 0}


@pytest.mark.long
def test_the_files_of_a_site_are_added_to_a_mission(asked):
    team = "schema: muster/1\nname: team\norigin_wgs84: {lat_deg: 47, lon_deg: 8}\n"
    team += "robots: [{id: r, position: [0, 0]}]\ntasks: []\n"
    texts = {"team.yaml": team, "panels.csv": CSV, "robots.csv": ROBOTS, "beside.txt": "kept"}
    files = {name: base64.b64encode(text.encode()).decode() for name, text in texts.items()}
    answer = asked("convert", name="team.yaml", files=files, robots="robots.csv", site=["panels.csv", "robots.csv"])
    mission = parse_yaml(answer["text"], Path("team.yaml"))
    assert (answer["name"], answer["needs"]) == ("team", ["beside.txt"])
    assert (len(mission.tasks), len(mission.robots)) == (3, 2)
