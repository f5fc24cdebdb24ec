"""The adapter of docs/your-own-robots.md: robots behind an HTTP server, from the example package."""

import importlib.util
import json
import re
import subprocess
import sys
import threading
from pathlib import Path

import pytest

import muster
from muster.cli.main import run as muster_run
from muster.running.fleet_registry import FLEETS
from muster_control.runs.run_settings import new_request

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "http_robots"
PAGE = (ROOT / "docs" / "your-own-robots.md").read_text(encoding="utf-8")


def module_of(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


adapter, server = module_of("muster_http_robots"), module_of("server")


@pytest.fixture
def robots():
    """The robots of a server, and its address; they drive five times as fast as those of the page."""
    robots = server.Robots({"r_0": (0.0, 0.0), "r_1": (0.0, 3.0)})
    served = server.server_of(robots)
    thread = threading.Thread(target=served.serve_forever, args=(0.02,))
    thread.start()
    FLEETS.add("http-robots", adapter.HTTP)
    yield robots, f"http://127.0.0.1:{served.server_address[1]}"
    FLEETS.remove("http-robots")
    served.shutdown()
    thread.join()
    served.server_close()


@pytest.fixture(autouse=True)
def fast(monkeypatch):
    monkeypatch.setattr(server, "SPEED_MPS", 5.0)


def test_the_page_shows_the_adapter_and_the_package():
    shown = re.findall(r"```(?:python|toml)\n(.*?)```", PAGE, flags=re.DOTALL)
    assert (EXAMPLE / "muster_http_robots.py").read_text(encoding="utf-8") in shown
    project = (EXAMPLE / "pyproject.toml").read_text(encoding="utf-8")
    assert any(block in project for block in shown if "muster.fleets" in block)


def test_the_adapter_is_of_about_forty_lines():
    lines = (EXAMPLE / "muster_http_robots.py").read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line]) <= 42


def test_python_carries_a_mission_out_and_each_goal_is_sent_once(robots):
    there, url = robots
    mission = muster.load(str(EXAMPLE / "mission.yaml"))
    report = muster.carry_out(mission, muster.solve(mission, "greedy"), "http-robots", settings={"url": url})
    assert set(report.tasks_done) == {"gate", "door", "ramp"}
    goals = [(data["x"], data["y"]) for _, verb, data in there.orders if verb == "goal"]
    assert sorted(goals) == sorted(task.position[:2] for task in mission.tasks)


def test_the_command_carries_a_mission_out(robots, capsys):
    _, url = robots
    call = [
        "run",
        str(EXAMPLE / "mission.yaml"),
        "--fleet",
        "http-robots",
        "--setting",
        f"url={url}",
        "--time-limit",
        "0.2",
    ]
    assert muster_run([*call, "-q", "--format", "json"]) == 0
    assert set(json.loads(capsys.readouterr().out)["tasks_done"]) == {"gate", "door", "ramp"}


def test_mission_control_takes_the_settings_of_the_fleet(robots):
    _, url = robots
    assert new_request("http-robots", ("http-robots",), {"url": url}).settings == adapter.HttpSettings(url=url)


def test_robots_of_a_server_that_is_not_there_are_named(robots, capsys):
    call = ["run", str(EXAMPLE / "mission.yaml"), "--fleet", "http-robots", "--setting", "wait_s=0"]
    assert muster_run([*call, "--setting", "url=http://127.0.0.1:9"]) == 2
    assert re.search("^robot r_0: .*Connection refused.* within 0 s", capsys.readouterr().err, flags=re.MULTILINE)


@pytest.mark.long
def test_the_adapter_conforms(robots):
    _, url = robots
    tell = f"{sys.executable} -c \"import urllib.request as r; r.urlopen('{url}/robots/{{robot}}/VERB', b'')\""
    kit = [
        sys.executable,
        "-m",
        "muster_robots.conformance",
        str(EXAMPLE / "muster_http_robots.py"),
        "--format",
        "json",
    ]
    how = ["--silence", tell.replace("VERB", "silence"), "--wake", tell.replace("VERB", "wake")]
    settings = ["--setting", f"url={url}", "--setting", "wait_s=0.5"]
    ended = subprocess.run([*kit, *settings, *how], capture_output=True, text=True, check=False)
    found = json.loads(ended.stdout)
    assert {one["clause"]: one["seen"] for one in found["clauses"] if one["result"] != "holds"} == {}
    assert (ended.returncode, found["conforms"]) == (0, True)
