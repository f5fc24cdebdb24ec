"""`python -m muster_robots.conformance`: which fleet is meant, what is printed, and the exit code."""

import json

import pytest
from click.testing import CliRunner
from tests.muster_robots.conformance import adapters

from muster_robots.conformance import __main__ as kit
from muster_robots.conformance.clauses import CLAUSES

ADAPTER = """
from tests.muster_robots.conformance.adapters import {make}, YardSettings
STAND = {make}()
YARD = STAND.kind
"""
PLACES = "schema: muster/1\nrobots:\n  - {id: r_0, position: [5, 1]}\n  - {id: r_1, position: [5, 4]}\ntasks: []\n"
STATIC = ["--without=ages", "--without=raises", "--without=prompt", "--without=again", "--without=lease"]


@pytest.fixture
def run(tmp_path):
    """Runs the kit on a fleet that a function of `adapters` makes."""
    (tmp_path / "places.yaml").write_text(PLACES, encoding="utf-8")

    def run(make, *more, target=""):
        file = tmp_path / f"{make}.py"
        file.write_text(ADAPTER.format(make=make), encoding="utf-8")
        how = ["--mission", str(tmp_path / "places.yaml"), "--setting", "site=yard", *more]
        return CliRunner().invoke(kit.command, [f"{file}{target}", *how])

    return run


def test_a_fleet_that_conforms(run):
    ended = run("right", *STATIC)
    assert ended.exit_code == 0
    assert ended.stdout.splitlines()[-1] == "conforms"
    assert "cancel: holds" in ended.stderr.splitlines()


def test_a_fleet_that_lacks_something_as_json(run):
    ended = run("does_not_cancel", *STATIC, "--format", "json", target=":YARD")
    found = json.loads(ended.stdout)
    assert (ended.exit_code, found["conforms"]) == (1, False)
    assert [one["clause"] for one in found["clauses"]] == list(CLAUSES)
    (cancel,) = [one for one in found["clauses"] if one["result"] == "lacks"]
    assert cancel["clause"] == "cancel"
    assert "farther after cancel" in cancel["seen"]


def test_what_is_not_tried_is_named(run):
    ended = run("right")
    assert ended.exit_code == 1
    assert ended.stdout.splitlines()[-1] == "lacks ages, raises, prompt, again, lease"


@pytest.mark.parametrize(
    ("target", "more", "message"),
    [
        (":STAND", (), "Stand; expected a FleetType"),
        ("", ("--setting", "sight=x"), "sight: unknown; did you mean 'site'?"),
        ("", ("--without", "cansel"), "did you mean 'cancel'?"),
        ("", ("--mission", "no_such.yaml"), "no_such.yaml"),
    ],
)
def test_what_is_wrong_is_one_line(run, target, more, message):
    ended = run("right", *more, target=target)
    assert (ended.exit_code, ended.stdout) == (2, "")
    assert message in ended.stderr.splitlines()[0]


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ("no.such.module", "no.such.module: cannot be imported: ModuleNotFoundError"),
        ("json", "json: no FleetType; expected one FleetType, or MODULE:NAME"),
        ("muster_robots.opening", "muster_robots.opening: ROS1, ROS2, MAVLINK; expected one FleetType"),
    ],
)
def test_a_module_without_one_fleet_is_refused(target, message):
    ended = CliRunner().invoke(kit.command, [target])
    assert ended.exit_code == 2
    assert ended.stderr.startswith(message)


def test_a_registered_fleet_is_meant_by_its_name():
    assert kit.fleet_type_of("mavlink").name == "mavlink"
    assert kit.fleet_type_of("muster_robots.opening:ROS2").name == "ros2"


def test_without_a_mission_robots_are_of_a_kind_that_the_fleet_carries():
    assert {robot.kind for robot in kit.two_robots(kit.fleet_type_of("mavlink")).robots} == {"air"}
    assert {robot.kind for robot in kit.two_robots(adapters.right().kind).robots} == {"ground"}


def test_a_command_that_does_not_run_is_told(run):
    ended = run("right", "--silence", "no-such-program {robot}", "--wake", "true", "--format", "json")
    found = {one["clause"]: one["seen"] for one in json.loads(ended.stdout)["clauses"]}
    assert "no-such-program {robot}: " in found["ages"]
