"""Flights with faults, from the plan to the last line: what `muster fly --arm` does, under a virtual clock.

`python -m tests.muster_robots.mavlink.fault_flights [SEEDS]` flies each family of faults with so many seeds and prints
a table; its exit code is 1 if a flight ends as none may.
"""

import random
import sys
from collections import Counter
from dataclasses import dataclass, field

from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.mission.model import Task
from muster.running.live import carry_out_live
from muster_robots.custody import Standing
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated.geofence import Area, Geofence

FAR = tuple(Task(id=f"t_{k}", position=(60.0, 6.0 * k, 10.0)) for k in range(4))
"""Tasks that are a dozen seconds of flight away from the starts."""


@dataclass
class Flight:
    """What a flight came to."""

    report: object
    fleet: object
    drones: dict
    states: dict
    at_end: str
    fleet_mission: object
    events: list = field(default_factory=list)

    @property
    def done(self):
        return set(self.report.tasks_done)

    @property
    def lost(self):
        return dict(self.report.tasks_lost)

    @property
    def done_twice(self):
        """Tasks that ended more than once."""
        ended = [event.data["task"] for event in self.events if event.kind in ("ends", "done_elsewhere")]
        return {name for name, times in Counter(ended).items() if times > 1}

    def kinds(self, robot):
        return [event.kind for event in self.events if event.data.get("robot") == robot]

    def refused_by(self, robot):
        refused = [event.data for event in self.events if event.kind == "task_refused"]
        return {one["task"] for one in refused if one["robot"] == robot}

    @property
    def live(self):
        """The robots that could do tasks when the mission ended: neither out nor in anybody else's hands."""
        out = {}
        for event in self.events:
            if event.kind in ("robot_fails", "robot_silent", "robot_suspended", "robot_returns"):
                out[event.data["robot"]] = event.kind != "robot_returns"
        return {name for name in self.drones if not out.get(name)}

    @property
    def wrongs(self):
        """What may be true of no flight, in words."""
        found = [f"{task} done twice" for task in self.done_twice]
        for task in self.lost:
            able = [name for name in self.live if task not in self.refused_by(name)]
            found += [f"{task} lost, and {name} could do it" for name in able]
        for name, drone in self.drones.items():
            state, session = self.states[name], self.fleet.sessions[name]
            if drone.armed and not state.moving:
                found.append(f"{name} is armed, and said to be: {state.state}")
            ours = drone.mode in drone.kind.own_modes and session.custody.standing is not Standing.SILENT
            if self.at_end != "hold" and drone.armed and ours:
                found.append(f"{name} is armed in a mode of Muster's, and --at-end is {self.at_end}")
            flies_on = drone.mode in (drone.kind.mission, drone.kind.guided) and session.drone.asked_to_arm
            if self.at_end == "hold" and drone.armed and ours and flies_on:
                found.append(f"{name} flies on")
        return found


def fly(faults, *, count=2, tasks=FAR, kind=PX4, at_end="return", fences=None, **settings):
    """Let drones fly a mission, and end as `--at-end` says; `faults` are those of r_0, or by robot, as are `fences`."""
    there, heard = mission(count, tasks), []
    sky = Sky(there, kind, faults if isinstance(faults, dict) else {"r_0": faults}, fences)
    fleet = sky.fleet(there, **settings)
    try:
        report = carry_out_live(there, muster.solve(there, iterations=50), fleet, on_event=heard.append)
        if at_end != "hold":
            fleet.end(at_end)
            fleet.await_landing(lambda: False)
        states = {state.robot: state for state in fleet.final_states()}
    finally:
        fleet.close()
        sky.close()
    return Flight(report, fleet, sky.drones, states, at_end, there, heard)


def _at(draw):
    return round(draw.uniform(1.0, 20.0), 1)


def drawn_fence(draw):
    """A fence of r_0, whose home is the origin of the map: one to three areas, not all of which are at home."""
    inside = Area(True, ((-30.0, -40.0), (draw.uniform(30, 90), -40.0), (draw.uniform(30, 90), 60.0), (-30.0, 60.0)))
    circle = Area(False, ((draw.uniform(20, 70), draw.uniform(-10, 30)),), draw.uniform(4, 12))
    corner = draw.uniform(25, 60), draw.uniform(-10, 20)
    triangle = Area(False, (corner, (corner[0] + 15.0, corner[1]), (corner[0], corner[1] + 15.0)))
    areas = draw.sample((inside, circle, triangle), draw.randint(1, 3))
    return Geofence(tuple(areas), return_point=draw.random() < 0.5, begins_s=draw.choice((0.0, 0.0, 6.0)))


FAMILIES = {
    "gap of the link, 2 to 9 s": lambda draw: {"silent_at_s": _at(draw), "silent_for_s": draw.uniform(2, 9)},
    "gap of the link, 10 to 20 s": lambda draw: {"silent_at_s": _at(draw), "silent_for_s": draw.uniform(10, 20)},
    "link lost for good": lambda draw: {"silent_at_s": _at(draw)},
    "heartbeats late, positions in time": lambda draw: {"late_heartbeats_s": _at(draw), "late_by_s": 7.0},
    "commands lost, 2 to 20 s": lambda draw: {"mute_at_s": _at(draw), "mute_for_s": draw.uniform(2, 20)},
    "autopilot frozen, 4 to 12 s": lambda draw: {"frozen_at_s": _at(draw), "frozen_for_s": draw.uniform(4, 12)},
    "position lost, 1 to 5 s": lambda draw: {"gps_lost_at_s": _at(draw), "gps_lost_for_s": draw.uniform(1, 5)},
    "position lost for good": lambda draw: {"gps_lost_at_s": _at(draw)},
    "no positions said, 2 to 20 s": lambda draw: {
        "no_position_at_s": _at(draw),
        "no_position_for_s": draw.uniform(2, 20),
    },
    "battery low": lambda draw: {"low_battery_at_s": _at(draw), "low_battery": 0.2},
    "battery sags for a second": lambda draw: {"low_battery_at_s": _at(draw), "low_battery_for_s": 1.0},
    "fence breached, 2 to 10 s": lambda draw: {"breach_at_s": _at(draw), "breach_for_s": draw.uniform(2, 10)},
    "fence refuses way points": lambda draw: {"fence_m": draw.uniform(20, 70), "mute_parameters": draw.random() < 0.5},
    "fence of polygons and circles": lambda draw: {"fence": drawn_fence(draw)},
    "first way point too far": lambda draw: {
        "first_item_m": draw.uniform(20, 70),
        "mute_parameters": draw.random() < 0.5,
    },
    "item rejected": lambda draw: {"reject_item": draw.randint(0, 2)},
    "return by another station": lambda draw: {"rtl_at_s": _at(draw)},
    "pilot with sticks, released": lambda draw: {"pilot_at_s": _at(draw), "pilot_for_s": draw.uniform(2, 10)},
    "pilot with sticks": lambda draw: {"pilot_at_s": _at(draw)},
    "stick mode without sticks": lambda draw: {"pilot_at_s": _at(draw), "no_sticks": True},
    "motors stop": lambda draw: {"disarm_at_s": _at(draw)},
    "30 % of packets lost": lambda draw: {"loss": 0.3},
}
"""By name the fields of `Faults` of the drone r_0; `fence` is that of its autopilot."""


def flight_of(family, seed):
    """A flight of one to three drones, on PX4 or ArduPilot, with any end; in one of three r_1 has a gap too."""
    draw = random.Random(f"{family} {seed}")
    drawn = FAMILIES[family](draw)
    fences = {"r_0": drawn.pop("fence", Geofence())}
    faults = {"r_0": Faults(**drawn)}
    if draw.random() < 1 / 3:
        faults["r_1"] = Faults(silent_at_s=_at(draw), silent_for_s=draw.uniform(2, 20))
    tasks = tuple(
        Task(id=f"t_{k}", position=(draw.uniform(20, 80), draw.uniform(-10, 30), draw.uniform(6, 15)))
        for k in range(draw.randint(2, 6))
    )
    how = {"count": draw.randint(1, 3), "kind": draw.choice((PX4, ARDUPILOT)), "offboard": draw.random() < 0.25}
    return fly(faults, tasks=tasks, fences=fences, at_end=draw.choice(("return", "land", "hold", "return")), **how)


def row_of(family, flights):
    """A line of the table: flights, tasks done, tasks lost, drones by how they ended, wrongs."""
    states = Counter(
        "armed" if state.moving else "crashed" if state.crashed else "down"
        for flight in flights
        for state in flight.states.values()
    )
    counts = (len(flights), sum(len(f.done) for f in flights), sum(len(f.lost) for f in flights))
    ends = tuple(states[end] for end in ("down", "armed", "crashed"))
    return (family, *counts, *ends, sum(len(f.wrongs) for f in flights))


def tell(line):
    sys.stdout.write(line + "\n")


def main(seeds):
    """Fly all families and print the table; return how many flights ended as none may."""
    tell("| fault of r_0 | flights | tasks done | lost | drones down | armed, and said so | crashed | wrong |")
    tell("|---|--:|--:|--:|--:|--:|--:|--:|")
    totals, wrongs = [0] * 7, 0
    for family in FAMILIES:
        flights = [flight_of(family, seed) for seed in range(seeds)]
        row = row_of(family, flights)
        totals = [total + more for total, more in zip(totals, row[1:], strict=True)]
        tell(f"| {' | '.join(map(str, row))} |")
        for seed, flight in enumerate(flights):
            for wrong in flight.wrongs:
                wrongs += 1
                sys.stderr.write(f"{family}, seed {seed}: {wrong}\n")
    tell(f"| all | {' | '.join(map(str, totals))} |")
    return wrongs


if __name__ == "__main__":
    sys.exit(bool(main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)))
