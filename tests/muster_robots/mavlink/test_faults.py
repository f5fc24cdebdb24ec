"""Every fault: injected into one of two drones it ends as the table of docs/mavlink.md says, row by row."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.mission.model import Task
from muster.running.live import carry_out_live
from muster_robots.mavlink import Kind
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.faults import Costs
from muster_robots.mavlink.simulated.faults import Faults

PAGE = Path(__file__).parents[3] / "docs" / "mavlink.md"
FAR = tuple(Task(id=f"t_{k}", position=(30.0, 6.0 * k, 10.0)) for k in range(2))


@dataclass(frozen=True)
class Case:
    """What goes wrong: by the simulated autopilot, a fence of Muster's that nothing may pass, or an error."""

    faults: Faults = field(default_factory=Faults)
    fenced: bool = False
    confusing: bool = False
    how: str = ""
    settings: dict = field(default_factory=dict)
    offboard: tuple[bool, ...] = (False, True)  # in which ways of flying it can happen


CASES = {
    Kind.LINK_LOST: [Case(Faults(silent_at_s=3), settings={"silences": 0})],
    Kind.ITEM_REJECTED: [Case(Faults(reject_item=1), offboard=(False,))],
    Kind.START_REFUSED: [Case(Faults(refuse_start=True), offboard=(False,))],
    Kind.ARM_REFUSED: [Case(Faults(refuse_arm=True))],
    Kind.COMMAND_REFUSED: [Case(Faults(refuse_start=True), offboard=(True,))],
    Kind.NO_ANSWER: [Case(Faults(mute=True))],
    Kind.LOW_BATTERY: [Case(Faults(low_battery_at_s=3))],
    Kind.FENCE_BREACHED: [Case(Faults(breach_at_s=3)), Case(Faults(breach_text_at_s=3), how="by text")],
    Kind.OUTSIDE_FENCE: [Case(fenced=True)],
    Kind.PILOT: [Case(Faults(pilot_at_s=3))],
    Kind.FAILSAFE: [Case(Faults(gps_lost_at_s=3, gps_lost_for_s=4))],
    Kind.STATION: [Case(Faults(rtl_at_s=6))],
    Kind.NO_POSITION: [Case(Faults(no_position_at_s=3, no_position_for_s=8))],
    Kind.NOT_UNDERSTOOD: [Case(confusing=True)],
    Kind.LANDED: [Case(Faults(gps_lost_at_s=1.2))],
    Kind.DISARMED: [Case(Faults(disarm_at_s=3))],
}


def in_the_way_of_flying(kind, case, offboard):
    """PX4 refuses its offboard mode before it is armed, the others what comes after."""
    return pytest.param(kind, case, offboard, id=f"{kind.words} {case.how} {'offboard' if offboard else 'mission'}")


EVERY = [
    in_the_way_of_flying(kind, case, way) for kind, found in CASES.items() for case in found for way in case.offboard
]


def rows():
    """Of the table, by the words of the first cell."""
    text = PAGE.read_text().split("## Faults and reactions")[1].split("\n## ")[0]
    cells = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in text.splitlines()
        if line.startswith("|") and line.count("|") == 7
    ]
    return {row[0]: dict(zip(cells[0], row, strict=True)) for row in cells[2:]}


def test_the_table_has_a_row_for_each_fault_and_a_fault_for_each_row():
    table = rows()
    assert list(table) == [kind.words for kind in Kind]
    assert {name: row["`Kind`"] for name, row in table.items()} == {kind.words: f"`{kind.name}`" for kind in Kind}
    assert {row["told"].split(",")[0] for row in table.values()} <= {"nothing", "hold", "return"}
    for kind in Kind:
        assert table[kind.words]["told"].split(",")[0] == kind.reaction.value


def test_every_fault_is_injected():
    assert set(CASES) == set(Kind)


def state(drone, kind):
    """In the words of the table."""
    pilots = 2 if kind is ARDUPILOT else 3 << 16
    names = {kind.hold: "hovers", kind.back: "returns", kind.land: "returns", pilots: "obeys its pilot"}
    if not drone.armed:
        return "lies where it was" if drone.flight.flies else "stands, disarmed"
    return names.get(drone.mode, "flies on")


def confuse(telemetry):
    """From when it is in the air its attitude raises an error."""
    take = telemetry.hear

    def hear(message, now):
        if telemetry.was_up and message.get_type() == "ATTITUDE":
            raise KeyError(9)
        take(message, now)

    telemetry.hear = hear


EVENTS = {Costs.ROBOT: "robot_fails", Costs.TASK: "task_refused", Costs.PAUSE: "robot_suspended"}
"""What is told of a fault, by what it costs."""


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("kind", [PX4, ARDUPILOT], ids=lambda kind: kind.name)
@pytest.mark.parametrize(("fault", "case", "offboard"), EVERY)
def test_each_fault_ends_as_the_table_says(kind, fault, case, offboard):
    there, heard = mission(2, FAR), []
    sky = Sky(there, kind, {"r_0": case.faults})
    fleet = sky.fleet(there, offboard=offboard, **case.settings)
    if case.fenced:
        fleet.sessions["r_0"].fence = lambda here, waypoints: "way to (1, 2); expected none"
    if case.confusing:
        confuse(fleet.sessions["r_0"].drone.telemetry)
    report = carry_out_live(there, muster.solve(there, iterations=50), fleet, on_event=heard.append)
    fleet.advance(fleet.time_s + 5.0)
    fleet.close()
    sky.close()

    drone, row = sky.drones["r_0"], rows()[fault.words]
    assert {found.robot for found in fleet.faults} == {"r_0"}
    assert fault in [found.kind for found in fleet.faults]
    allowed = re.split(r"[,;] or ", row["the drone"])
    assert state(drone, kind) in allowed, (state(drone, kind), hex(drone.mode), drone.flight)
    assert row["execution"] == fault.costs.value
    told = EVENTS[fault.costs]
    out = [event for event in heard if event.kind == told]
    assert {event.data["robot"] for event in out} == {"r_0"}
    assert all(event.data["reason"].startswith(f"{fault.words}: ") for event in out)
    assert set(report.tasks_done) == {"t_0", "t_1"}
    if fault.costs is not Costs.PAUSE:
        assert {task.robot for task in report.tasks} == {"r_1"}
    assert sky.drones["r_1"].armed
    causes = [cause for event in heard if event.kind == "replanned" for cause in event.data["causes"]]
    assert told in [cause["kind"] for cause in causes]


@pytest.mark.long
def test_a_fault_is_told_only_what_the_table_says():
    """`nothing` is nothing: after its fault a drone hears heartbeats alone."""
    for fault, faults in ((Kind.PILOT, Faults(pilot_at_s=3)), (Kind.DISARMED, Faults(disarm_at_s=3))):
        there = mission(1, (Task(id="t", position=(80.0, 0.0, 10.0)),))
        sky = Sky(there, PX4, {"r_0": faults})
        fleet = sky.fleet(there)
        carry_out_live(there, muster.solve(there, iterations=50), fleet)
        assert [found.kind for found in fleet.faults] == [fault]
        fleet.advance(fleet.time_s + 1.0)
        before = len(sky.drones["r_0"].heard)
        fleet.stop()
        fleet.end("return")
        fleet.close()
        sky.close()
        assert {message.get_type() for message in sky.drones["r_0"].heard[before:]} == {"HEARTBEAT"}
