"""Flights with faults, from the plan to the last line: what `muster fly --arm` does, under a virtual clock."""

from collections import Counter
from dataclasses import dataclass, field

from tests.muster_robots.mavlink.drones import Sky, mission

import muster
from muster.mission.model import Task
from muster.running.live import carry_out_live
from muster_robots.mavlink.autopilots import PX4

FAR = tuple(Task(id=f"t_{k}", position=(60.0, 6.0 * k, 10.0)) for k in range(4))
"""Tasks that are a dozen seconds of flight away from the starts."""


@dataclass
class Flight:
    """What a flight came to."""

    report: object
    fleet: object
    drones: dict
    states: dict
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
        ended = [name for event in self.events for name in ended_by(event)]
        return {name for name, times in Counter(ended).items() if times > 1}

    def reasons(self, kind):
        return [event.data["reason"] for event in self.events if event.kind == kind]

    def kinds(self, robot):
        return [event.kind for event in self.events if event.data.get("robot") == robot]

    @property
    def safe(self):
        return not any(state.moving for state in self.states.values())


def ended_by(event):
    return [event.data["task"]] if event.kind in ("ends", "done_elsewhere") else []


def fly(faults, *, count=2, tasks=FAR, kind=PX4, at_end="return", **settings):
    """Let drones fly a mission, and end as `--at-end` says; `faults` are those of r_0, or by robot."""
    there, heard = mission(count, tasks), []
    sky = Sky(there, kind, faults if isinstance(faults, dict) else {"r_0": faults})
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
    return Flight(report, fleet, sky.drones, states, heard)
