"""`muster simulate`: plans carried out by moving robots."""

import json
import re
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import pytest
from tests.running import test_camera_search as looking

import muster as package
from muster.library import mission_names
from muster.mission.reading.plan_reader import read_plan
from muster.mission.yaml_writer import yaml_text

EVENTFUL = """
schema: muster/1
name: eventful
robots:
  - {id: a, position: [0, 0], radius_m: 0.2}
  - {id: b, position: [0, 5], radius_m: 0.2}
tasks:
  - {id: far, position: [30, 0]}
  - {id: near, position: [5, 5], prerequisites: [far]}
  - {id: gone, position: [0, 30]}
events:
  - {at_s: 3, robot_fails: a}
  - {at_s: 4, new_task: {id: late, position: [10, 10]}}
  - {at_s: 5, cancel_task: gone}
"""


@pytest.fixture
def eventful(tmp_path):
    file = tmp_path / "eventful.yaml"
    file.write_text(EVENTFUL, encoding="utf-8")
    return str(file)


def answer(muster, *arguments):
    code, out, err = muster("simulate", *arguments, "--iterations", "300", "--format", "json")
    assert (code, err) == (0, "")
    return json.loads(out)


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in mission_names() if name not in ("eil51", "berlin52", "eil76")])
def test_shipped_missions_are_carried_out(name):
    """Every planned task is done, once, no contact, and nothing starts before what it waits for has ended.

    Where detours would take a robot beyond its capacity the rest is planned again, maybe better than greedy had it.
    """
    mission = package.load(name)
    plan = package.solve(mission, "greedy")
    report = package.simulate(mission, plan)
    planned = {stop.task for route in plan.routes for stop in route.stops if not stop.is_station}
    assert set(report.tasks_done) >= planned
    assert len(report.tasks_done) == len(set(report.tasks_done))
    assert set(report.tasks_done) == planned or report.reallocations
    for robot, flown in zip(mission.robots, report.robots, strict=True):
        assert robot.work_capacity is None or flown.usage_flown <= robot.work_capacity
    assert report.contacts == 0
    for task in mission.tasks:
        for before in task.prerequisites if task.id in report.tasks_done else ():
            assert report.starts_s[task.id] >= report.ends_s[before] - 1e-9


def test_what_is_printed_for_programs(muster):
    data = answer(muster, "31T-6R50")
    assert list(data) == [
        "mission_time_s", "tasks_done", "tasks_lost", "contacts", "min_distance_m", "waiting_s", "reallocations",
        "robots", "starts_s", "ends_s",
        "objective", "tasks", "done_twice", "found",
        "waiting_by_cause_s", "lateness_s", "missed", "deadlines_missed_s", "within_exceeded_s", "shifts_exceeded_s",
        "traffic",
        "orders", "tasks_forgotten",
        "ground", "team", "remarks",
    ]  # fmt: skip
    assert len(data["tasks_done"]) == 31
    assert data["tasks_lost"] == []
    for robot in data["robots"]:
        assert robot["usage_flown"] == pytest.approx(robot["usage_planned"], rel=0.05)  # they make way for each other
    assert answer(muster, "31T-6R50") == data


def test_events_happen_and_nothing_is_lost(muster, eventful):
    data = answer(muster, eventful)
    assert sorted(data["tasks_done"]) == ["far", "late", "near"]
    assert [lost["task"] for lost in data["tasks_lost"]] == ["gone"]
    assert data["reallocations"] >= 2
    assert data["starts_s"]["near"] >= data["ends_s"]["far"]


def test_for_people(muster):
    code, out, err = muster("simulate", "16T-3R", "--iterations", "300")
    assert (code, err) == (0, "")
    assert "tasks done        16 of 16" in out
    assert re.search(r"mission time +\d+\.\d\d s", out)


@pytest.mark.long
def test_a_plan_record_page_and_picture(muster, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert muster("solve", "16T-3R", "--iterations", "100", "-o", "plan.json", "-q")[0] == 0
    files = ("--record", "run.mcap", "--html", "run.html", "--plot", "run.svg")
    assert muster("simulate", "16T-3R", "--plan", "plan.json", *files)[0] == 0
    code, out, _ = muster("replay", "run.mcap", "--format", "json")
    assert code == 0
    replayed = json.loads(out)
    assert replayed["complete"]
    assert replayed["report"]["tasks_done"]
    kinds = {event["kind"] for event in replayed["events"]}
    assert {"sets_out", "arrives", "starts", "ends"} <= kinds
    assert "<html" in (tmp_path / "run.html").read_text(encoding="utf-8")
    assert "<svg" in (tmp_path / "run.svg").read_text(encoding="utf-8")
    assert read_plan("plan.json").tasks_completed == 16


@pytest.mark.long
@pytest.mark.skipif(find_spec("mujoco") is None, reason="the extra `physics` is not installed")
def test_a_film_and_a_still_of_the_physics_world(muster, tmp_path):
    film, still = tmp_path / "flown.gif", tmp_path / "end.png"
    how = ("--world", "physics", "--iterations", "20", "--film-speed", "100")
    code, out, err = muster("simulate", "6T-2R", *how, "--film", str(film), "--still", str(still))
    assert code == 0
    assert "6 of 6" in out
    assert err.startswith(f"drawing {film}; Ctrl-C leaves it as long as it is then\n")
    assert re.search(rf"\n{re.escape(str(film))}: \d\.\d s at 100 times real time\n$", err)
    assert film.read_bytes()[:6] == b"GIF89a"
    assert still.read_bytes()[:4] == b"\x89PNG"
    again = muster("simulate", "6T-2R", *how, "--film", str(film), "-q")
    assert (again[0], again[2]) == (0, "")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--film", "a.mp4"), "--film given; expected it together with --world physics"),
        (("--still", "a.png"), "--still given; expected it together with --world physics"),
        (("--film-speed", "2"), "--film-speed given; expected it together with --film"),
        (("--world", "physics", "--film", "a.avi"), "a.avi: suffix '.avi'; expected .mp4 or .gif"),
        (("--world", "physics", "--film", "film"), "film: no suffix; expected .mp4 or .gif"),
        (("--world", "physics", "--still", "a.gif"), "a.gif: suffix '.gif'; expected .png"),
        (("--world", "physics", "--film", "a.mp4", "--record", "a.mp4"), "a.mp4: given twice"),
        (("--world", "physics", "--film", "no/a.mp4"), "no/a.mp4: cannot be written"),
    ],
)
def test_films_that_cannot_be(muster, tmp_path, monkeypatch, arguments, message):
    """Found out before the mission is carried out, in one line."""
    if "physics" in arguments and find_spec("mujoco") is None:
        pytest.skip("the extra `physics` is not installed")
    monkeypatch.chdir(tmp_path)
    code, out, err = muster("simulate", "6T-2R", *arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert message in err
    assert list(tmp_path.iterdir()) == []


def test_an_alternative_that_is_not_done_is_no_error(muster, tmp_path):
    gates = tmp_path / "gates.yaml"
    tasks = "[{id: a, position: [1, 0]}, {id: b, position: [9, 0], either_or: a}]"
    gates.write_text(f"schema: muster/1\nrobots: [{{id: r_0, position: [0, 0]}}]\ntasks: {tasks}\n", encoding="utf-8")
    code, out, _ = muster("simulate", gates, "--iterations", "20", "--require-complete", "--format", "json")
    assert code == 0
    assert json.loads(out)["tasks_lost"] == [{"task": "b", "reason": "either-or: a is done in its place"}]


def test_lost_tasks_can_be_an_error(muster, eventful):
    assert muster("simulate", eventful, "--iterations", "100", "--require-complete")[0] == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--plan", "none.json"), "none.json"),
        (("--dt", "0"), "dt_s: 0; expected a finite number, at least 0.001 and at most 1"),
        (("--world", "gazebo"), 'world: "gazebo"; expected kinematic or physics'),
    ],
)
def test_bad_input(muster, arguments, message):
    code, out, err = muster("simulate", "16T-3R", *arguments)
    assert (code, out) == (2, "")
    assert message in err


def test_noise_wears_robots_down_by_its_seed(muster):
    how = ("--noise", "slip=0.2", "--pose", "true")
    noisy = [answer(muster, "6T-2R", *how, "--seed", seed) for seed in ("1", "1", "2")]
    assert noisy[0] == noisy[1] != noisy[2]
    for robot in noisy[0]["robots"]:
        assert robot["usage_flown"] > 1.05 * robot["usage_planned"]


@pytest.mark.parametrize(
    ("noise", "message"),
    [
        (["slip=x"], 'noise.slip: "x"; expected a finite number, at least 0 and at most 1'),
        (
            ["wind=1"],
            "noise.wind: unknown key; expected a known key; known keys: velocity, slip, odometry, motors, position_m",
        ),
        (["slip=0", "slip=0"], "--noise: slip=0; expected KIND=AMOUNT, each name at most once"),
        (["slip=2"], "noise.slip: 2; expected a finite number, at least 0 and at most 1"),
    ],
)
def test_noise_that_is_none(muster, noise, message):
    code, out, err = muster("simulate", "6T-2R", *(part for text in noise for part in ("--noise", text)))
    assert (code, out) == (2, "")
    assert message in err


def test_each_task_when_asked_for(muster):
    code, out, _ = muster("simulate", "6T-2R", "--iterations", "300", "-v")
    rows = [line.split() for line in out.splitlines()]
    assert code == 0
    assert sorted(row[0] for row in rows if len(row) == 9 and row[1].startswith("r_")) == list("012345")


def test_the_record_of_events_is_read_again(muster, eventful, tmp_path):
    """Robots that join and tasks that appear are in the record as the executor tells of them."""
    joins = EVENTFUL + "  - {at_s: 6, robot_joins: {id: c, position: [0, 9]}}\n"
    mission = tmp_path / "joins.yaml"
    mission.write_text(joins, encoding="utf-8")
    record = str(tmp_path / "r.mcap")
    report = answer(muster, str(mission), "--record", record)
    code, out, err = muster("replay", record, "--format", "json")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert data["report"] == report
    kinds = [event["kind"] for event in data["events"]]
    assert {"robot_fails", "new_task", "cancel_task", "robot_joins", "replanned", "lost"} <= set(kinds)
    assert [row["robot"] for row in data["robots"]] == ["a", "b", "c"]


def is_written(muster, record, seconds):
    """Whether so much of a mission under way is in its record."""
    code, out, _ = muster("replay", str(record), "--format", "json")
    return code == 0 and json.loads(out)["duration_s"] >= seconds


@pytest.mark.long
@pytest.mark.parametrize(("written_s", "after_s"), [(0.0, 0.5), (1.0, 0.0)])
def test_killed_at_any_moment_it_leaves_a_record_that_replays(muster, tmp_path, written_s, after_s):
    """The point of the record: what was carried out up to there can be looked at."""
    record = tmp_path / "killed.mcap"
    command = [sys.executable, "-m", "muster.cli", "simulate", "6T-2R", "--speed", "4", "--record", str(record)]
    process = subprocess.Popen([*command, "--iterations", "10"], stdout=subprocess.DEVNULL)
    until = time.monotonic() + 60
    while not is_written(muster, record, written_s):
        assert time.monotonic() < until
        time.sleep(0.02)
    time.sleep(after_s)
    process.kill()
    process.wait()
    code, out, err = muster("replay", str(record), "--format", "json")
    data = json.loads(out)
    assert (code, data["complete"], data["report"]) == (0, False, None)
    assert data["duration_s"] >= written_s
    assert "breaks off" in err
    assert [row["poses"] > 0 for row in data["robots"]] == [True, True]


def test_watched_it_tells_what_happens(muster):
    code, _, err = muster("simulate", "6T-2R", "--iterations", "10", "--speed", "10000")
    assert code == 0
    assert re.search(r"^ +0\.0 s  r_0 sets out for task ", err, flags=re.MULTILINE)
    assert err.count(" has done task ") == 6


def test_the_plan_of_another_mission_is_doubted(muster, tmp_path):
    plan = str(tmp_path / "p.json")
    muster("solve", "6T-2R", "-a", "greedy", "-o", plan, "-q")
    _, _, err = muster("simulate", "11T-2R", "--plan", plan)
    assert "the judge rejects this plan: mission the plan is of 6T-2R; expected 11T-2R, or no name" in err


@pytest.mark.long
def test_ctrl_c_stops_the_mission_and_tells_how_far_it_came(muster, tmp_path):
    record, page = tmp_path / "r.mcap", tmp_path / "r.html"
    files = ["--record", str(record), "--html", str(page), "--iterations", "10"]
    command = [sys.executable, "-m", "muster.cli", "simulate", "6T-2R", "--speed", "1", *files]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (record.exists() and record.stat().st_size > 0):
        time.sleep(0.05)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted at" in err
    assert "of 6" in out
    assert page.exists()
    code, out, _ = muster("replay", str(record))
    assert (code, out.splitlines()[0].rsplit(", ", 1)[-1]) == (0, "interrupted")


@pytest.mark.parametrize("wrong", [("--dt", "5"), ("--dt", "nan"), ("--speed", "nan"), ("--speed", "1e-320")])
def test_numbers_out_of_range(muster, wrong):
    code, out, err = muster("simulate", "6T-2R", *wrong)
    assert (code, out) == (2, "")
    assert "expected a finite number, at least 0.001 and at most" in err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk(muster):
    code, out, err = muster("simulate", "6T-2R", "--iterations", "10", "--record", "/dev/full")
    assert (code, out) == (2, "")
    assert err.startswith("/dev/full: No space left on device")


def test_a_plan_is_made_by_the_allocator_that_is_asked_for(muster, eventful):
    """What is planned is what `solve` has with the same options; searching finds another figure."""
    asked = ("--allocator", "auction", "--winner", "least-contested", "--objective", "max")
    planned = json.loads(muster("solve", eventful, *asked, "--format", "json")[1])
    code, out, err = muster("simulate", eventful, *asked, "--format", "json", "-q")
    assert (code, err) == (0, "")
    assert json.loads(out)["objective"]["name"] == "max"
    assert json.loads(out)["objective"]["planned"] == pytest.approx(planned["objective"]["value"])


class TestNegotiate:
    """`--negotiate`: no plan; robots are processes."""

    @pytest.fixture(autouse=True)
    def _with_net(self):
        pytest.importorskip("cryptography", reason="the extra `net` is not installed")

    @pytest.mark.long
    def test_it_tells_what_happens_and_what_it_took(self, muster, tmp_path):
        """In a mission that is shorter than the others', as it takes real time."""
        eventful = tmp_path / "eventful.yaml"
        eventful.write_text(EVENTFUL.replace("[30, 0]", "[10, 0]").replace("[10, 10]", "[6, 8]"), encoding="utf-8")
        gantt = tmp_path / "gantt.png"
        code, out, err = muster("simulate", eventful, "--negotiate", "--speed", "10", "--gantt", str(gantt))
        assert code == 0
        assert "tasks done        3 of 4" in out
        assert "cancelled at 5 s" in out
        assert "a is out" in err
        assert "b has done task late" in err
        assert gantt.stat().st_size > 10_000

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (["--negotiate", "--plan", "plan.json"], "--plan given; expected it without --negotiate"),
            (["--negotiate", "--iterations", "3"], "--iterations given; expected it without --negotiate"),
            (["--negotiate", "--allocator", "greedy"], "--allocator given; expected it without --negotiate"),
            (["--negotiate", "--set", "hot=1"], "auction has no parameter hot"),
            (["--method", "auction"], "--method given; expected it together with --negotiate"),
            (["--bid", "total"], "--bid: search takes none; expected --allocator auction or market"),
            (["--set", "battery_weight=1"], "search has no parameter battery_weight"),
            (["--negotiate", "--method", "danse"], "method: danse; expected auction or consensus-bundle"),
        ],
    )
    def test_options_that_do_not_go_together_are_refused(self, muster, eventful, options, said):
        code, out, err = muster("simulate", eventful, *options)
        assert (code, out) == (2, "")
        assert said in err


@pytest.mark.long
def test_the_physics_world_without_its_extra_is_one_line():
    program = "import sys; sys.modules['mujoco'] = None; from muster.cli.__main__ import main; main()"
    command = [sys.executable, "-c", program, "simulate", "6T-2R", "--world", "physics", "--iterations", "10"]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr.splitlines()[-1].endswith(
        "the physics world needs an optional part: pip install 'muster-robotics[physics]'"
    )
    assert "Traceback" not in ran.stderr


@pytest.mark.long
def test_a_mission_is_carried_out_in_the_physics_world(muster):
    pytest.importorskip("muster_physics", reason="needs the extra `physics`", exc_type=ImportError)
    exact, physical = (answer(muster, "6T-2R", "--world", world) for world in ("kinematic", "physics"))
    assert physical["contacts"] == 0
    assert [task["robot"] for task in physical["tasks"]] == [task["robot"] for task in exact["tasks"]]
    assert physical["mission_time_s"] != exact["mission_time_s"]


def test_what_cameras_found_is_told_and_drawn(muster, tmp_path):
    mission, file = tmp_path / "m.yaml", tmp_path / "found.png"
    mission.write_text(yaml_text(looking.mission(robots=(looking.DRONE, looking.ROVER))), encoding="utf-8")
    code, out, _ = muster("simulate", mission, "--iterations", "100", "--found", file)
    assert code == 0
    assert "found by cameras" in out
    assert "found-4" in out
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
@pytest.mark.skipif(not find_spec("mujoco"), reason="the extra `physics` is not installed")
def test_what_cameras_saw_is_kept(muster, tmp_path):
    mission, folder = tmp_path / "m.yaml", tmp_path / "new" / "seen"
    mission.write_text(
        "schema: muster/1\nrobots: [{id: d, position: [0, 0, 0], kind: air, kinematics: quadcopter,"
        " camera: {fov_deg: 60, tilt_deg: 45}}]\ntasks: [{id: 1, position: [1, 0, 3]}, {id: 2, position: [2, 0, 3]}]\n"
        "tags: [{id: 5, position: [4, 0, 0]}, {id: 6, position: [90, 0, 0]}]\n"
    )
    code, out, _ = muster("simulate", mission, "--world", "physics", "--iterations", "10", "--cameras", folder)
    assert code == 0
    assert [file.name for file in folder.iterdir()] == ["d-tag-5.png"]
    assert "not found         1 tag: 6" in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("6T-2R", "--found", "f.png"),
            "--found: 6T-2R has no tags; expected a mission in which there is something to",
        ),
        (("scout-and-deliver", "--cameras", "d"), "--cameras: no pictures in the kinematic world; expected --world"),
        (("scout-and-deliver", "--found", "f.bmp"), "suffix '.bmp'; expected one of"),
        (("scout-and-deliver", "--world", "physics", "--cameras", "README.md"), "README.md is a file; expected a fol"),
    ],
)
def test_options_of_cameras_that_make_no_sense(muster, arguments, message):
    code, out, err = muster("simulate", *arguments)
    assert (code, out) == (2, "")
    assert message in err


@pytest.fixture
def ordered(tmp_path):
    """A mission with a task that waits for another, and a function that writes a plan of it."""
    mission = tmp_path / "ordered.yaml"
    mission.write_text(
        "schema: muster/1\nname: ordered\nrobots:\n  - {id: a, position: [0, 0]}\ntasks:\n"
        "  - {id: first, position: [10, 0]}\n  - {id: second, position: [20, 0], prerequisites: [first]}\n",
        encoding="utf-8",
    )

    def plan(tasks, **figures):
        file = tmp_path / "plan.json"
        document = {"schema": "muster-plan/1", "routes": [{"robot": "a", "tasks": tasks}], **figures}
        file.write_text(json.dumps(document), encoding="utf-8")
        return str(mission), "--plan", str(file)

    return plan


def test_what_was_planned_is_the_judge_s_figure_not_the_plan_s(muster, ordered):
    stale = {"objective": {"name": "total+max", "value": 7.0}}
    code, out, err = muster("simulate", *ordered(["first", "second"], **stale), "--format", "json")
    assert code == 0
    assert json.loads(out)["objective"]["planned"] == pytest.approx(40.0)
    assert "the judge rejects this plan" in err
    assert "7" in err


def test_a_plan_that_breaks_a_rule_is_named(muster, ordered):
    code, _, err = muster("simulate", *ordered(["second", "first"]), "--format", "json")
    assert code == 0
    assert re.search(r"warning: .*plan\.json: the judge rejects this plan: .*(deadlock|prerequisite|cycle)", err)
    assert muster("simulate", *ordered(["second", "first"]), "--format", "json", "-q")[2] == ""


def test_an_admissible_plan_is_simulated_without_a_word(muster, ordered):
    assert muster("simulate", *ordered(["first", "second"]), "--format", "json")[::2] == (0, "")
