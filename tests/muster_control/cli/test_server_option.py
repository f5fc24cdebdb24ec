"""Verbs that a server does: the same results, errors in a line, Ctrl-C that reaches the server."""

import json
import os
import re
import signal
import subprocess
import time
from dataclasses import replace
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path

import pytest
from tests.cli.yard import MUSTER, comparable
from tests.muster_control.serving import served

from muster import load
from muster.allocation.stop import Stop
from muster.cli.verbs import extras_health as doctor
from muster.mission.system.installation import installed_version
from muster_control.client import Client
from muster_control.client.backend import ServerBackend, awaited, followed
from muster_control.client.uploads import packed_mission
from muster_control.contract import ConflictError, Job
from muster_control.security.tokens import line_of, new_token

VERBS = ("missions", "check", "solve", "verify", "explain", "simulate", "export")

APART = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], work_capacity: 12}]
tasks: [{id: east, position: [5, 0]}, {id: west, position: [-5, 0]}]
"""


@pytest.fixture(scope="module")
def url(tmp_path_factory):
    with served(tmp_path_factory.mktemp("server")) as url:
        yield url


def test_a_plan_is_as_here(folder, muster, url):
    here = muster("solve", "yard.yaml", "--iterations", 20, "-o", "here.json")
    there = muster("solve", "yard.yaml", "--iterations", 20, "-o", "there.json", "--server", url)
    assert there == here
    assert comparable("there.json") == comparable("here.json")


@pytest.mark.long
def test_rewire_fixed_and_bound_are_as_here(folder, muster, url):
    assert muster("solve", "31T-6R50", "--iterations", 300, "-o", "first.json")[0] == 0
    fixed = json.loads(Path("first.json").read_text(encoding="utf-8"))
    waiting = {task.id for task in load("31T-6R50").tasks if task.prerequisites}
    for route in fixed["routes"]:
        route["tasks"] = [name for name in route["tasks"][:1] if name not in waiting]
    Path("fixed.json").write_text(json.dumps({"schema": fixed["schema"], "routes": fixed["routes"]}), encoding="utf-8")
    for more in (["--rewire"], ["--fixed", "fixed.json"], ["--start", "first.json", "--bound=quick", "-v"]):
        call = ("solve", "31T-6R50", "--iterations", 300, *more)
        here, there = muster(*call, "-o", "here.json"), muster(*call, "-o", "there.json", "--server", url)
        assert (there[0], there[1]) == (here[0], here[1]) == (0, here[1])
        assert comparable("there.json") == comparable("here.json")
    assert here[2].splitlines()[-1] == there[2].splitlines()[-1]
    assert there[2].splitlines()[-1].startswith("lower bound: ")


def test_a_mission_is_kept_once_and_a_changed_one_as_its_next_version(folder, muster, url):
    def said():
        code, _, err = muster("solve", "yard.yaml", "--iterations", 1, "-v", "--server", url)
        assert code == 0
        return next(line for line in err.splitlines() if line.startswith("the server has it"))

    text = Path("yard.yaml").read_text(encoding="utf-8").replace("name: yard", "name: kept")
    Path("yard.yaml").write_text(text, encoding="utf-8")
    assert said() == said() == "the server has it as mission kept, version 1"
    Path("yard.yaml").write_text(text + "# changed\n", encoding="utf-8")
    assert said() == "the server has it as mission kept, version 2"


def test_plans_and_jobs_are_listed_from_the_newest_on(url):
    with Client(url) as control:
        first, second = (control.plan("6T-2R", iterations=1).wait().id for _ in range(2))
        assert [plan.id for plan in control.plans.list("6T-2R", limit=1)] == [second]
        assert [plan.id for plan in control.plans.list("6T-2R", limit=1, before=second)] == [first]
        assert [job.result for job in control.jobs("done", "6T-2R", limit=1)] == [{"plan": second, "why": ""}]


def test_a_shipped_mission_is_planned_as_it_is(muster, url):
    assert muster("solve", "6T-2R", "--iterations", 1, "--server", url) == muster("solve", "6T-2R", "--iterations", 1)
    with Client(url) as control:
        assert [entry.shipped for entry in control.missions.list() if entry.name == "6T-2R"] == [True]


@pytest.mark.long
def test_a_plan_is_judged_and_explained_as_here(plan, muster, url):
    for verb in ("verify", "explain"):
        here, there = (muster(verb, "yard.yaml", plan, "--format", "json", *more) for more in ((), ("--server", url)))
        assert there == here
    assert muster("verify", "yard.yaml", plan, "--server", url) == muster("verify", "yard.yaml", plan)
    for task in ((), ("--task", "lift"), ("--task", "gate")):
        here, there = (muster("explain", "yard.yaml", plan, *task, *more) for more in ((), ("--server", url)))
        assert there == here


def test_a_rejected_plan_is_rejected(plan, muster, url):
    data = json.loads(plan.read_text(encoding="utf-8"))
    data["routes"][0]["tasks"] = ["lift"]
    plan.write_text(json.dumps(data), encoding="utf-8")
    assert muster("verify", "yard.yaml", plan, "--server", url) == muster("verify", "yard.yaml", plan)
    assert muster("verify", "yard.yaml", plan, "--server", url)[0] == 1


def test_a_mission_is_checked(folder, muster, url):
    for more in ((), ("--ignore", "skills"), ("--format", "json"), ("--require-complete", "-q")):
        assert muster("check", "yard.yaml", *more, "--server", url) == muster("check", "yard.yaml", *more)
    assert muster("check", "yard.yaml", "--require-complete", "--server", url)[0] == 3
    code, _, err = muster("check", "yard.yaml", "--time-limit", 11, "--server", url)
    assert (code, err) == (2, "body: time_limit: 11.0; expected less than or equal to 10\n")


def test_tasks_that_no_plan_does_together_are_named(folder, muster, url):
    Path("apart.yaml").write_text(APART, encoding="utf-8")
    here = muster("check", "apart.yaml")
    assert "no plan can do all of these 2 tasks (proven)" in here[1]
    assert muster("check", "apart.yaml", "--server", url) == here
    here = muster("check", "apart.yaml", "--format", "json")
    assert muster("check", "apart.yaml", "--format", "json", "--server", url) == here


@pytest.mark.long
def test_a_simulation_is_as_here(plan, muster, url):
    arguments = ("simulate", "yard.yaml", "--plan", plan, "--seed", 3, "--format", "json")
    assert muster(*arguments, "--server", url)[:2] == muster(*arguments)[:2]
    assert muster("solve", "6T-2R", "-a", "greedy", "-o", "short.json", "-q")[0] == 0
    short = ("simulate", "6T-2R", "--plan", "short.json", "--seed", 3, "--format", "json")
    again = (*short, "--allocator", "greedy", "--rewire")
    assert muster(*again, "--server", url)[:2] == muster(*again)[:2]
    code, _, err = muster("simulate", "yard.yaml", "--plan", plan, "--set", "hott=1", "--server", url)
    assert code == 2
    assert "search has no parameter hott" in err


@pytest.mark.long
@pytest.mark.parametrize("more", [("--drain", "1.1"), pytest.param(("--orders", "o.jsonl"), marks=pytest.mark.long)])
def test_conditions_of_a_run_are_those_of_the_command(folder, muster, url, more):
    order = {"at_s": 1.0, "new_task": {"id": "ordered", "type": "D", "position": [2, 2]}}
    Path("o.jsonl").write_text(json.dumps(order), encoding="utf-8")
    how = ("--noise", "slip=0.05", "--battery", "all=1", "--dt", 0.2, *more)
    call = ("simulate", "31T-6R50", "--iterations", 5, *how, "--format", "json", "-q")
    here, there = (json.loads(muster(*call, *server)[1]) for server in ((), ("--server", url)))
    assert ("ordered" in here["tasks_done"]) == ("--orders" in more)
    assert there["tasks_done"] == here["tasks_done"]
    for one, other in zip(there["robots"], here["robots"], strict=True):
        assert one["charge"] == pytest.approx(other["charge"])
        assert one["usage_flown"] == pytest.approx(other["usage_flown"])


@pytest.mark.long
@pytest.mark.skipif(find_spec("mujoco") is None, reason="the extra `physics` is not installed")
def test_drones_in_wind_fly_there_as_here(folder, muster, url):
    Path("m.yaml").write_text(
        "schema: muster/1\nname: windy\n"
        "robots: [{id: a, position: [0, 0, 1], kind: air, kinematics: hexacopter, radius_m: 0.35}]\n"
        "tasks: [{id: t, position: [2, 0, 1]}]\n",
        encoding="utf-8",
    )
    call = ("simulate", "m.yaml", "--iterations", 5, "--world", "physics", "--wind", "4,1", "--gusts", 5, "--rotors")
    here, there = (muster(*call, "--format", "json", "-q", *more) for more in ((), ("--server", url)))
    assert here[0] == 0
    assert there == here


@pytest.mark.long
def test_a_record_comes_back(plan, muster, url):
    code, _, err = muster("simulate", "yard.yaml", "--plan", plan, "--record", "r.mcap", "--server", url)
    assert (code, err) == (0, "")
    assert Path("r.mcap").read_bytes().startswith(b"\x89MCAP")


def test_an_export_is_as_here(folder, muster, url):
    origin = "name: far\norigin_wgs84: {lat_deg: 47.0, lon_deg: 8.0}"
    Path("yard.yaml").write_text(Path("yard.yaml").read_text(encoding="utf-8").replace("name: yard", origin))
    muster("solve", "yard.yaml", "--iterations", 20, "-o", "plan.json")
    arguments = ("export", "yard.yaml", "plan.json", "--to")
    assert muster(*arguments, "geojson", "--server", url) == muster(*arguments, "geojson")
    here = muster(*arguments, "qgc", "-o", "here")
    assert muster(*arguments, "qgc", "-o", "there", "--server", url) == here
    files = {file.name: file.read_bytes() for file in Path("here").iterdir()}
    assert {file.name: file.read_bytes() for file in Path("there").iterdir()} == files


def test_missions_of_the_server_are_listed(muster, url):
    code, out, _ = muster("missions", "--format", "json", "--server", url)
    assert code == 0
    assert "31T-6R50" in [entry["id"] for entry in json.loads(out)]
    assert "31T-6R50" in muster("missions", "--server", url)[1]


@pytest.mark.long
def test_files_are_sent_with_a_mission(muster, url):
    text, files = packed_mission(load("floor"))
    assert sorted(files) == ["floor-plan.png", "floor-plan.yaml"]
    assert "../" not in text
    assert muster("solve", "floor", "--iterations", 5, "-q", "--server", url)[0] == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--ray", "x"), "--ray given; expected it without --server: a server uses no cluster"),
        (("--set", "nothing=1"), "nothing"),
        (("-a", "serach"), "serach"),
    ],
)
def test_what_makes_no_sense_there_is_refused(folder, muster, url, arguments, said):
    code, out, err = muster("solve", "yard.yaml", *arguments, "--server", url)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert said in err


def test_what_a_server_cannot_do_in_a_simulation_is_refused_with_the_reason(folder, muster, url):
    for options, said in (
        (
            ("--world", "physics", "--film", "a.mp4"),
            "--film given; expected it without --server: it keeps where bodies",
        ),
        (("--found", "a.png"), "--found given; expected it without --server: it keeps no pictures of cameras"),
        (
            ("--negotiate",),
            "--negotiate given; expected it without --server: the robots' processes run on this machine",
        ),
        (("--foxglove", "0"), "--foxglove given; expected it without --server: the port is one of this machine"),
    ):
        code, out, err = muster("simulate", "yard.yaml", *options, "--server", url)
        assert (code, out, len(err.splitlines())) == (2, "", 1)
        assert err.startswith(said)


@pytest.mark.parametrize(
    ("server", "said"),
    [
        ("http://127.0.0.1:9", "http://127.0.0.1:9: cannot be reached"),
        ("127.0.0.1:8117", "server: 127.0.0.1:8117; expected http://HOST:PORT"),
        ("ftp://127.0.0.1", "expected http://HOST:PORT"),
        ("http://127.0.0.1:99999", "expected http://HOST:PORT"),
    ],
)
@pytest.mark.parametrize("verb", VERBS)
def test_a_server_that_is_not_there(verb, server, said, plan, muster):
    arguments = {"missions": (), "check": ("yard.yaml",), "solve": ("yard.yaml",), "simulate": ("yard.yaml",)}
    given = arguments.get(verb, ("yard.yaml", plan)) + (("--to", "csv") if verb == "export" else ())
    code, out, err = muster(verb, *given, "--server", server)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert said in err


@pytest.mark.parametrize(("name", "value"), [("ALL_PROXY", "socks9://127.0.0.1:1"), ("SSL_CERT_FILE", "/no/such.pem")])
def test_an_environment_that_cannot_be_followed(muster, monkeypatch, name, value):
    monkeypatch.setenv(name, value)
    code, out, err = muster("missions", "--server", "https://127.0.0.1:9")
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert err.startswith("https://127.0.0.1:9: cannot be reached: ")
    assert name in err


@pytest.mark.long
def test_tokens(folder, muster, tmp_path, monkeypatch):
    tokens = {role: new_token() for role in ("watch", "command")}
    lines = [line_of(role, role, token) for role, token in tokens.items()]
    (tmp_path / "tokens").write_text("\n".join(lines), encoding="utf-8")
    with served(tmp_path, tokens=tmp_path / "tokens") as url:
        call = ("solve", "yard.yaml", "--iterations", 1, "-q", "--server", url)
        code, _, err = muster(*call)
        assert (code, len(err.splitlines()), "expected" in err) == (2, 1, True)
        monkeypatch.setenv("MUSTER_TOKEN", "wrong")
        assert (muster(*call)[0], "token" in muster(*call)[2]) == (2, True)
        monkeypatch.setenv("MUSTER_TOKEN", tokens["watch"])
        assert (muster(*call)[0], "may only watch" in muster(*call)[2]) == (2, True)
        Path("token").write_text(tokens["command"] + "\n", encoding="utf-8")
        assert muster(*call, "--token-file", "token")[0] == 0
        Path("token").write_text("", encoding="utf-8")
        assert muster(*call, "--token-file", "token")[2] == "token: no token; expected one line that holds it\n"


def test_a_token_needs_a_server(folder, muster):
    said = "--token-file given; expected it together with --server\n"
    assert muster("solve", "yard.yaml", "--token-file", "t") == (2, "", said)


@pytest.mark.long
def test_ctrl_c_keeps_the_best_plan_as_here(folder, url):
    environment = {name: value for name, value in os.environ.items() if name != "MUSTER_TOKEN"}
    with Client(url) as control:
        before = {job.id for job in control.jobs()}
        command = [MUSTER, "solve", "yard.yaml", "--time-limit", "600", "-o", "best.json", "--server", url]
        with subprocess.Popen(command, stdout=-1, stderr=-1, text=True, env=environment) as process:
            while not (new := [job for job in control.jobs() if job.id not in before and job.progress]):
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate()
        assert process.returncode == 130
        assert "objective" in out
        assert err.endswith("interrupted: this is the best plan so far\n")
        job = control.job(new[0].id).seen
        assert (job.state, control.plans.get(job.result["plan"]).entry.plan) == (
            "done",
            json.loads(Path("best.json").read_text(encoding="utf-8")),
        )


class Interrupted:
    """A job at a server; each time that it is looked at there is a Ctrl-C."""

    id = 7

    def __init__(self, begun, interrupt):
        self.interrupt = interrupt
        self.begun = begun
        asked = {"kind": "plan", "mission": "yard", "mission_version": 1, "arguments": {}, "author": "local"}
        self.seen = Job(id=self.id, state="running" if begun else "queued", asked_at=datetime.now(UTC), **asked)
        self.told = []

    def wait(self, on_progress, on_look):
        for _ in range(2):
            self.interrupt.interrupt()
            on_look()

    def stop(self):
        self.told.append("stop")
        self.seen = replace(self.seen, state="running" if self.begun else "cancelled")
        return self.seen

    def cancel(self):
        self.told.append("cancel")


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("begun", "told", "said"),
    [
        (True, ["stop", "cancel"], "job 7 is cancelled at the server, which keeps no plan of it"),
        (False, ["stop"], "job 7 is cancelled at the server: it had not begun"),
    ],
)
def test_a_second_ctrl_c_or_one_while_it_waits_cancels_the_job_there(begun, told, said):
    interrupt, lines = Stop(), []
    job = Interrupted(begun, interrupt)
    with pytest.raises(KeyboardInterrupt):
        awaited(job, None, interrupt, lines.append)
    assert (job.told, lines) == (told, [said])


class Carried:
    """A run at a server that is over when Ctrl-C comes."""

    def stream(self):
        raise KeyboardInterrupt

    def cancel(self):
        raise ConflictError("run 3 is over: ended; expected one that is under way")

    def wait(self):
        self.waited = True


def test_interrupted_before_a_run_the_command_names_the_plan_that_the_server_keeps(folder, muster, url, monkeypatch):
    plan = ServerBackend.plan

    def interrupted_at_its_end(self, request, on_progress, interrupt):
        solution = plan(self, request, on_progress, interrupt)
        interrupt.interrupt()
        return solution

    monkeypatch.setattr(ServerBackend, "plan", interrupted_at_its_end)
    code, out, err = muster("simulate", "yard.yaml", "--iterations", 1, "-q", "--server", url)
    assert (code, out) == (130, "")
    said = re.match(r"interrupted: plan (\d+) is kept at the server; nothing was started\n", err)
    with Client(url) as control:
        assert control.plans.get(int(said[1])).mission == "yard"


def test_doctor_tells_the_version_of_a_server_that_answers(muster, url, monkeypatch):
    monkeypatch.setattr(doctor, "import_faults", lambda names: {})
    code, out, _ = muster("doctor", "--server", url, "--format", "json")
    assert (code, json.loads(out)["server"]) == (0, {"url": url, "version": installed_version(), "fault": None})


@pytest.mark.parametrize("before", [True, False])
def test_ctrl_c_as_a_run_ends_is_no_error(before):
    carried = Carried()
    assert followed(carried, None, before) is True
    assert carried.waited


@pytest.mark.long
def test_the_client_imports_no_part_of_the_server_nor_its_libraries():
    heavy = ("fastapi", "nicegui", "sqlalchemy", "scipy", "shapely", "matplotlib", "muster_control.api")
    code = f"import sys, muster_control.client; print([m for m in {heavy} if m in sys.modules])"
    import sys

    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
