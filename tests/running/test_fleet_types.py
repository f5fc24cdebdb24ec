"""What a fleet declares that it can do decides what a run may ask of it, before anything is opened or moves."""

import threading
from dataclasses import replace

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Battery, Event, Mission, Robot, Rules, Station, Task
from muster.running.fleet_registry import FLEETS, fleet_ready
from muster.running.fleet_type import ABILITIES, FleetType, NoSettings
from muster.running.live import Live
from muster.running.run_request import RunRequest
from muster.state import MissionState
from muster_control.runs.run_settings import new_request

PLAIN = mission()
FLIES = Mission(robots=(Robot(id="d", position=(0.0, 0.0), kind="air"),), tasks=(Task(id="t", position=(1.0, 1.0)),))
JOINS = replace(PLAIN, events=(Event(at_s=1.0, robot_joins=Robot(id="new", position=(0.0, 9.0))),))
RETURNS = replace(PLAIN, rules=Rules(return_to_start=True))
CHARGES = replace(
    PLAIN,
    robots=tuple(replace(robot, battery=Battery(capacity=50.0)) for robot in PLAIN.robots),
    stations=(Station(id="dock", position=(3.0, 3.0), services=("charge",), charge_per_s=1.0),),
)
NEEDS = {
    "ground": (PLAIN, 'robot "r_0": kind ground; expected air: fleet acme has no others'),
    "air": (FLIES, 'robot "d": kind air; expected ground: fleet acme has no others'),
    "joins": (JOINS, 'robot "new": joins; expected none: no robot joins fleet acme'),
    "returns": (RETURNS, 'robot "r_0": its route has an end; expected none: fleet acme lacks the ability returns'),
    "charges": (CHARGES, 'station "dock": charge; expected no such station: fleet acme lacks the ability charges'),
}


@pytest.fixture
def acme():
    """Registers the fleet `acme` with some abilities; gives the missions with which it was opened."""
    opened = []

    def open_acme(there, settings, halt, again):
        opened.append(there)
        return WorldAsFleet(there), lambda: None

    def register(*abilities):
        FLEETS.add("acme", FleetType(name="acme", open=open_acme, abilities=abilities))
        return opened

    yield register
    FLEETS.remove("acme")


def all_but(ability):
    return [name for name in ABILITIES if name != ability]


@pytest.mark.parametrize("ability", NEEDS)
def test_a_mission_that_needs_what_a_fleet_lacks_is_refused_before_the_fleet_is_opened(acme, ability):
    there, message = NEEDS[ability]
    opened = acme(*all_but(ability))
    with pytest.raises(ParameterError) as refused:
        muster.carry_out(there, muster.solve(there, "greedy"), "acme")
    assert str(refused.value) == message
    assert not opened


@pytest.mark.parametrize("ability", NEEDS)
def test_a_fleet_with_the_ability_alone_is_opened_for_such_a_mission(acme, ability):
    there, _ = NEEDS[ability]
    kinds = {robot.kind for robot in there.all_robots}
    opened = acme(*kinds | {ability})
    fleet_ready("acme", there, {}, threading.Event(), again=False)
    assert opened == [there]


def test_a_mission_under_way_is_resumed_only_by_a_fleet_that_can(acme):
    opened = acme(*all_but("resumes"))
    with pytest.raises(ParameterError, match="under way; expected one that begins: fleet acme lacks the ability resum"):
        fleet_ready("acme", PLAIN, {}, threading.Event(), again=True)
    assert not opened
    plan, fleet = muster.solve(PLAIN, "greedy"), WorldAsFleet(PLAIN)
    with pytest.raises(ParameterError, match="lacks the ability resumes"):
        Live(PLAIN, plan, fleet, RunRequest(world="acme"), state=MissionState(PLAIN, ()))


def test_robots_that_do_not_hold_pass_as_they_meet_and_are_not_paused(acme):
    acme(*all_but("holds"))
    why = "traffic: reserve; expected free: fleet acme lacks the ability holds"
    with pytest.raises(MusterError) as python:
        muster.carry_out(PLAIN, muster.solve(PLAIN, "greedy"), "acme", traffic="reserve")
    with pytest.raises(MusterError) as server:
        new_request("acme", ("acme",), {"traffic": "reserve"})
    assert str(python.value) == str(server.value) == why
    narrow = replace(PLAIN, lanes=LANES)
    for world, managed in (("acme", False), ("(an open fleet)", True)):
        live = Live(narrow, muster.solve(narrow, "greedy"), WorldAsFleet(narrow), RunRequest(world=world))
        while live.time_s < 2.5:  # traffic is planned in a thread, for two seconds of the mission at most
            live.look()
            live.hear(live.time_s + 0.3)
        assert live.executor.crew["r_0"].steered == managed
    live = Live(PLAIN, muster.solve(PLAIN, "greedy"), WorldAsFleet(PLAIN), RunRequest(world="acme"))
    with pytest.raises(ParameterError, match=r"pause: not possible; .* fleet acme lacks the ability holds"):
        live.pause()


LANES = muster.Lanes(
    nodes={"a": (0.0, 0.0), "b": (0.0, 3.0), "c": (8.0, 0.0), "d": (8.0, 6.0)},
    edges=tuple(
        muster.Lane(start=start, end=end, both_ways=True) for start, end in (("a", "b"), ("a", "c"), ("c", "d"))
    ),
)


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ({"abilities": ("ground", "flies")}, "abilities: flies; expected ground, air, joins, holds"),
        ({"abilities": ("holds",)}, r'abilities: \["holds"\]; expected ground, air or both'),
        ({"abilities": ("air",), "settings": dict}, "settings: dict; expected a class made from Settings"),
    ],
)
def test_a_declaration_that_is_wrong_is_refused_where_it_is_made(declared, message):
    with pytest.raises(ParameterError, match=message):
        FleetType(name="acme", open=WorldAsFleet, **declared)


def test_a_fleet_has_the_name_of_its_entry():
    with pytest.raises(ParameterError, match="fleet acme: it is called other; expected the name of its entry point"):
        FLEETS.add("acme", FleetType(name="other", open=WorldAsFleet, abilities=("ground",)))


def test_a_fleet_without_settings_takes_none():
    fleet = FleetType(name="acme", open=WorldAsFleet, abilities=("ground",))
    assert fleet.checked_settings({}) == NoSettings()
    with pytest.raises(ParameterError, match="url: unknown"):
        fleet.checked_settings({"url": "x"})
