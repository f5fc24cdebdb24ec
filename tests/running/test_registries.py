"""Worlds, fleets and formats of other packages are known where those that ship are."""

import json
import threading
from pathlib import Path

import pytest

import muster
from muster.cli.main import run
from muster.cli.other_recordings import OTHER_RECORDINGS
from muster.mission.errors import MissingExtraError, ParameterError
from muster.planning import export_formats
from muster.planning.export_formats import FORMATS, Files
from muster.planning.mission_readers import MISSION_READERS, MissionReader, Noted, converted_suffixes
from muster.running.fleet_registry import FLEETS, declares, fleet_ready
from muster.running.worlds import WORLDS, world_named
from muster.server.runs.run_settings import new_request
from muster.simulation import KinematicWorld


@pytest.fixture
def added():
    """Adds implementations for the time of a test."""
    registered = []

    def add(registry, name, implementation):
        registry.add(name, implementation)
        registered.append((registry, name))

    yield add
    for registry, name in registered:
        registry.remove(name)


@pytest.fixture(scope="module")
def mission():
    return muster.load("31T-6R50")


def test_what_ships_is_there_in_order():
    assert list(WORLDS) == ["kinematic", "physics"]
    assert list(FLEETS) == ["ros1", "ros2", "mavlink"]
    assert list(FORMATS) == ["qgc", "geojson", "gpx", "kml", "csv", "sol", "sheets", "overview", "xlsx", "ics"]
    assert list(OTHER_RECORDINGS) == ["ros"]
    assert world_named("kinematic") is KinematicWorld
    assert all(callable(FLEETS[name]) for name in FLEETS)
    assert all(callable(FORMATS[name]) for name in FORMATS)
    assert OTHER_RECORDINGS["ros"].is_recording(Path("nowhere.bag")) is False


def test_recordings_that_lack_a_function_are_refused(added):
    with pytest.raises(ParameterError, match="recordings radio: it has no add_options; expected a module"):
        added(OTHER_RECORDINGS, "radio", object())


def test_a_world_carries_a_plan_out(added, mission, tmp_path, capsys):
    made = []

    def slow(mission, **how):
        made.append(how["dt_s"])
        return KinematicWorld(mission, **how)

    added(WORLDS, "slow", slow)
    plan = muster.solve(mission, "greedy")
    report = muster.simulate(mission, plan, world="slow", dt_s=0.2)
    assert (made, len(report.tasks_done)) == ([0.2], plan.tasks_completed)
    plan.save(tmp_path / "p.json")
    assert run(["simulate", "31T-6R50", "--plan", str(tmp_path / "p.json"), "--world", "slow", "--format", "json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["tasks_done"]) == plan.tasks_completed
    new_request("slow", (), {"dt_s": 0.2})
    with pytest.raises(ParameterError, match="speeed: unknown; did you mean 'speed'"):
        new_request("slow", (), {"speeed": 1})


def test_an_unknown_world_is_refused_with_the_near_match(capsys):
    assert run(["simulate", "31T-6R50", "--world", "phisics"]) == 2
    said = 'world: "phisics"; expected kinematic or physics or ros1 or ros2 or mavlink; did you mean'
    assert said in capsys.readouterr().err
    with pytest.raises(ParameterError, match="did you mean 'physics'"):
        new_request("phisics", (), {})


def test_a_fleet_is_opened_with_the_settings_of_the_run(added, mission):
    opened = []
    added(FLEETS, "barges", lambda *given: opened.append(given) or ("fleet", "at end"))
    halt = threading.Event()
    assert fleet_ready("barges", mission, {"port": 3}, halt, again=True) == ("fleet", "at end")
    assert opened == [(mission, {"port": 3}, halt, True)]
    new_request("barges", ("barges",), {"port": 3})
    with pytest.raises(ParameterError, match="world: barges; expected kinematic, physics"):
        new_request("barges", (), {})


def test_what_a_fleet_needs_is_asked_for_before_it_is_opened_or_served(added, mission, capsys):
    opened = []

    def lacks():
        raise MissingExtraError("barges", "fleet barges")

    added(FLEETS, "barges", declares(require_installed=lacks)(lambda *given: opened.append(given)))
    with pytest.raises(MissingExtraError, match="fleet barges"):
        fleet_ready("barges", mission, {}, threading.Event(), again=False)
    assert run(["serve", "--bridge", "barges"]) == 2
    assert "fleet barges" in capsys.readouterr().err
    assert not opened


def test_a_format_is_exported_to(added, mission, tmp_path, capsys):
    added(FORMATS, "count", lambda mission, verdict: f"{verdict.tasks_completed}\n")
    plan = muster.solve(mission, "greedy")
    assert muster.export(mission, plan, "count").texts == {"plan.count": f"{plan.tasks_completed}\n"}
    plan.save(tmp_path / "p.json")
    assert run(["export", "31T-6R50", str(tmp_path / "p.json"), "--to", "count"]) == 0
    assert capsys.readouterr().out == f"{plan.tasks_completed}\n"


def test_a_format_gets_the_options_that_it_declares(added, mission, tmp_path, capsys):
    @export_formats.declares(options=("per_robot",))
    def cards(mission, verdict, options, plan):
        names = [route.robot for route in verdict.routes] if options.per_robot else ["all"]
        return Files({f"{name}.txt": f"{plan.allocator}\n" for name in names})

    added(FORMATS, "cards", cards)
    plan = muster.solve(mission, "greedy")
    assert muster.export(mission, plan, "cards").texts == {"all.txt": "greedy\n"}
    with pytest.raises(ParameterError, match="altitude"):
        muster.export(mission, plan, "cards", altitude=9)
    plan.save(tmp_path / "p.json")
    asked = ["export", "31T-6R50", str(tmp_path / "p.json"), "--to", "cards"]
    assert run([*asked, "--per-robot", "-o", str(tmp_path / "cards")]) == 0
    assert {path.stem for path in (tmp_path / "cards").iterdir()} == {robot.id for robot in mission.robots}
    capsys.readouterr()
    assert run([*asked, "--altitude", "9"]) == 2
    owners = "qgc or geojson or gpx or kml or sheets or overview or xlsx or ics"
    assert capsys.readouterr().err == f"--altitude given; expected it with --to {owners}, not cards\n"
    assert run(["export", "31T-6R50", str(tmp_path / "p.json"), "--to", "csv", "--per-robot"]) == 2
    assert "expected it with --to sheets or ics or cards, not csv" in capsys.readouterr().err


def test_a_format_declares_options_that_there_are():
    with pytest.raises(ParameterError, match="options: altitud; expected altitude, altitude_step"):
        export_formats.declares(options=("altitud",))


def test_a_mission_of_another_program_is_read(added, tmp_path, capsys):
    def read(path, robots):
        return Noted(
            muster.Mission(
                robots=[muster.Robot(id=robots or "r", position=(0, 0))], tasks=[muster.Task(id="a", position=(1, 1))]
            ),
            ("a note",),
        )

    own = MissionReader(takes=lambda path: path.suffix == ".route", read=read, flags=("robots",), suffixes=(".route",))
    added(MISSION_READERS, "routes", own)
    file = tmp_path / "a.route"
    file.write_text("anything", encoding="utf-8")
    assert [robot.id for robot in muster.load(file, robots="lead").robots] == ["lead"]
    assert run(["check", str(file)]) == 0
    assert "a note" in capsys.readouterr().err.splitlines()
    with pytest.raises(ParameterError, match="--depot given; expected no --depot with this kind of mission"):
        muster.load(file, depot="1")
    assert ".route" in converted_suffixes()
    with pytest.raises(ParameterError, match="a second mission"):
        muster.read_site(file, file)


def test_a_reader_of_missions_has_flags_that_there_are():
    with pytest.raises(ParameterError, match="flags: robot; expected robots, suitability"):
        MissionReader(takes=callable, read=Noted, flags=("robot",))
    with pytest.raises(ParameterError, match="it is a function; expected a MissionReader"):
        MISSION_READERS.add("routes", lambda path: None)


def test_what_cannot_be_called_is_refused():
    for registry in (WORLDS, FLEETS, FORMATS):
        with pytest.raises(ParameterError, match=r"it is a int; expected a (class or )?function"):
            registry.add("three", 3)
