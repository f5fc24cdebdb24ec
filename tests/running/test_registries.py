"""Worlds, fleets and formats of other packages are known where those that ship are."""

import json
import threading
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

import muster
from muster.cli.main import run
from muster.cli.options.run_outputs import not_at_server, run_output_options
from muster.cli.other_recordings import OTHER_RECORDINGS
from muster.mission.errors import MissingExtraError, ParameterError
from muster.mission.plan import Plan, Route
from muster.mission.reading.plan_reader import PLAN_READERS
from muster.mission.reading.travel_csv import TRAVEL_TABLES
from muster.mission.records import Settings, record, spec
from muster.mission.site import TravelTable
from muster.mission.value_types import Whole
from muster.planning import export_formats
from muster.planning.export_formats import FORMATS, Files
from muster.planning.mission_readers import MISSION_READERS, MissionReader, Noted, converted_suffixes
from muster.running.fleet_registry import FLEETS, fleet_ready
from muster.running.fleet_type import FleetType
from muster.running.observed_run import ObservedRun
from muster.running.run_outputs import RUN_OUTPUTS, BegunOutput
from muster.running.simulate import simulated
from muster.running.worlds import WORLDS, has_ability, takes_setting, world_named
from muster.simulation import KinematicWorld, SimulatedWorld
from muster.simulation.declaration import ABILITIES, BODIES, EXACT, SETTINGS, declares
from muster_control.runs.run_settings import new_request


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
    assert list(RUN_OUTPUTS) == ["cameras", "film"]
    assert list(FLEETS) == ["ros1", "ros2", "mavlink"]
    assert list(FORMATS) == ["qgc", "geojson", "gpx", "kml", "csv", "sol", "sheets", "overview", "xlsx", "ics"]
    assert list(OTHER_RECORDINGS) == ["ros"]
    assert world_named("kinematic") is KinematicWorld
    assert all(FLEETS[name].name == name for name in FLEETS)
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


def test_worlds_that_ship_declare_what_they_take_and_can_do():
    """The physics world says so without MuJoCo."""
    taken = {name: {setting for setting in SETTINGS if takes_setting(WORLDS[name], setting)} for name in WORLDS}
    assert taken == {"kinematic": set(SETTINGS) - {"wind", "rotor_level"}, "physics": set(SETTINGS)}
    able = {name: {ability for ability in ABILITIES if has_ability(WORLDS[name], ability)} for name in WORLDS}
    assert able == {"kinematic": {EXACT}, "physics": {BODIES}}


def test_a_world_takes_what_it_declares_or_what_its_signature_says(added, mission):
    @declares(settings=("law",))
    def declared(mission, **how):
        return KinematicWorld(mission, **how)

    def signed(mission, *, seed, dt_s, avoidance, noise, wind=None):
        return KinematicWorld(mission, seed=seed, dt_s=dt_s, avoidance=avoidance, noise=noise)

    added(WORLDS, "declared", declared)
    added(WORLDS, "signed", signed)
    plan = muster.solve(mission, "greedy")
    wind = {"velocity_mps": [1.0, 0.0, 0.0]}
    lacks = "expected none: the world declared has no wind; physics or signed has"
    with pytest.raises(ParameterError, match=lacks):
        muster.simulate(mission, plan, world="declared", wind=wind)
    assert muster.simulate(mission, plan, world="declared", law="thesis").tasks_done
    assert muster.simulate(mission, plan, world="signed", wind=wind).tasks_done
    with pytest.raises(ParameterError, match=r"law: .*the world signed has no other"):
        muster.simulate(mission, plan, world="signed", law="thesis")


def test_a_subclass_declares_for_itself():
    class Windy(KinematicWorld):
        def __init__(self, mission, *, wind=None, **how):
            super().__init__(mission, **how)

    assert takes_setting(Windy, "wind")
    assert not has_ability(Windy, EXACT)


def test_a_world_declares_nothing_that_there_is_not():
    with pytest.raises(ParameterError, match="settings: winds; expected law, wind"):
        declares(settings=("winds",))
    with pytest.raises(ParameterError, match="abilities: film; expected exact, bodies"):
        declares(settings=(), abilities=("film",))


@pytest.mark.long
def test_a_world_without_cameras_refuses_tags(added):
    class Blind:
        """Passes on all of the kinematic world but its cameras."""

        def __init__(self, mission, **how):
            self._world = KinematicWorld(mission, **how)

        def __getattr__(self, name):
            if name == "cameras":
                raise AttributeError(name)
            return getattr(self._world, name)

    added(WORLDS, "blind", Blind)
    scouts = muster.load("scout-and-deliver")
    plan = muster.solve(scouts, "greedy")
    with pytest.raises(ParameterError, match=r"tags: .* in mission scout-and-deliver; expected none: Blind has no cam"):
        muster.simulate(scouts, plan, world="blind")


def test_an_output_of_another_package_has_options_and_receives_the_run(added, mission, tmp_path):
    class Sizes:
        """Writes how many robots the world of a run has."""

        options = {"sizes": click.option("--sizes")}  # noqa: RUF012
        files = ("sizes",)
        not_at_server = "it counts nothing"

        def require_possible(self, world, given):
            if given["sizes"] and world != "kinematic":
                raise ParameterError("--sizes given; expected --world kinematic")

        def begin(self, mission, world, given):
            if given.get("sizes") is None:
                return None
            worlds: list[SimulatedWorld] = []
            path = tmp_path / given["sizes"]

            def write(say):
                path.write_text(str(len(worlds[0].ports)))
                say(f"{path.name} written")

            return BegunOutput(on_world=worlds.append, write=write)

    added(RUN_OUTPUTS, "sizes", Sizes())
    assert not_at_server()["sizes"] == "it counts nothing"
    asked = []
    command = click.command()(run_output_options(lambda *, outputs: asked.append(outputs)))
    for arguments in (["--sizes", "n.txt"], []):
        outcome = CliRunner().invoke(command, arguments)
        assert (outcome.exit_code, outcome.output) == (0, "")
    given, nothing = asked
    assert [list(map(str, filter(None, one.files))) for one in asked] == [["n.txt"], []]
    with pytest.raises(ParameterError, match="expected --world kinematic"):
        given.require_possible("physics")
    nothing.require_possible("physics")
    assert nothing.begin(mission, "kinematic") == []
    (begun,) = given.begin(mission, "kinematic")
    mine, said = [], []
    request = ObservedRun(on_world=mine.append).observed_by([begun])
    simulated(mission, muster.solve(mission, "greedy"), request)
    begun.write(said.append)
    assert (len(mine), (tmp_path / "n.txt").read_text(), said) == (1, str(len(mission.robots)), ["n.txt written"])


def test_what_is_no_output_is_refused():
    with pytest.raises(ParameterError, match="no options; expected what"):
        RUN_OUTPUTS.add("three", 3)
    with pytest.raises(ParameterError, match=r"fleet three: it is a int; expected a muster.*FleetType$"):
        FLEETS.add("three", 3)


def test_an_unknown_world_is_refused_with_the_near_match(capsys):
    assert run(["simulate", "31T-6R50", "--world", "phisics"]) == 2
    said = 'world: "phisics"; expected kinematic or physics or ros1 or ros2 or mavlink; did you mean'
    assert said in capsys.readouterr().err
    with pytest.raises(ParameterError, match="did you mean 'physics'"):
        new_request("phisics", (), {})


@record
class BargeSettings(Settings):
    """Where barges are."""

    port: int = spec(Whole(), "number of their port")


def test_a_fleet_is_opened_with_the_settings_of_the_run(added, mission):
    opened = []
    barges = FleetType(
        name="barges",
        open=lambda *given: opened.append(given) or ("fleet", "at end"),
        abilities=("ground", "resumes"),
        settings=BargeSettings,
    )
    added(FLEETS, "barges", barges)
    halt = threading.Event()
    assert fleet_ready("barges", mission, {"port": 3}, halt, again=True) == ("fleet", "at end")
    assert opened == [(mission, BargeSettings(port=3), halt, True)]
    new_request("barges", ("barges",), {"port": 3})
    with pytest.raises(ParameterError, match="world: barges; expected kinematic, physics"):
        new_request("barges", (), {})


def test_what_a_fleet_needs_is_asked_for_before_it_is_opened_or_served(added, mission, capsys):
    opened = []

    def lacks():
        raise MissingExtraError("barges", "fleet barges")

    how = {"open": lambda *given: opened.append(given), "abilities": ("ground",), "require_installed": lacks}
    added(FLEETS, "barges", FleetType(name="barges", **how))
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


def test_a_plan_of_another_program_is_read(added, tmp_path, mission):
    def read(path, text, of):
        return Plan(routes=(Route(of.robots[0].id, tuple(text.split()[1:])),)) if text.startswith("TOUR") else None

    added(PLAN_READERS, "tours", read)
    file = tmp_path / "a.tour"
    file.write_text("TOUR 3 1", encoding="utf-8")
    assert muster.read_plan(file, mission).routes == (Route(mission.robots[0].id, ("3", "1")),)
    with pytest.raises(muster.PlanError, match="a plan in JSON"):
        muster.read_plan(file)


def test_a_travel_table_of_another_program_is_read(added, tmp_path):
    def read(path, robots, others):
        places = (*robots, *others)
        return TravelTable(places, tuple((7.0,) * len(places) for _ in places)) if path.suffix == ".sevens" else None

    added(TRAVEL_TABLES, "sevens", read)
    (tmp_path / "m.yaml").write_text(
        "schema: muster/1\nrules: {travel: matrix}\ntravel: {car: x.sevens}\n"
        "robots: [{id: r, type: car, position: [0, 0]}]\ntasks: [{id: a, position: [1, 1]}]\n",
        encoding="utf-8",
    )
    assert muster.load(tmp_path / "m.yaml").travel_tables["car"].places == ("r", "a")


def test_what_cannot_be_called_is_refused():
    for registry in (WORLDS, FORMATS):
        with pytest.raises(ParameterError, match=r"it is a int; expected a (class or )?function"):
            registry.add("three", 3)
