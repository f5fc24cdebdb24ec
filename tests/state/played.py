"""Runs whose processes are killed: a site with something of every kind, and what is known of it."""

import json

from tests.execution.world import World
from tests.running.run_log import Log

from muster.execution import Executor, Reallocation, travel_of
from muster.mission.events import DelayedTask, Event, MovedTask
from muster.mission.model import Map, Mission, Robot, Station, Task, Zone
from muster.state import checkpoint_of, event_of, restored
from muster.state.recovery import recovered_from

NEWCOMER = Robot(id="r_9", position=(9.0, 9.0), load_capacity=5.0)


SEARCH_STEPS = 20


def site(events=(), battery=None):
    robots = tuple(
        Robot(
            id=f"r_{k}",
            position=(4.0 * k, 0.0),
            load_capacity=3.0,
            load_at_start=1.0 if k == 1 else None,
            battery=battery,
            return_to_start=k == 0,
        )
        for k in range(3)
    )
    tasks = (
        *(Task(id=f"t_{k}", position=(3.0 + 5 * (k % 3), 8.0 + 4 * (k // 3)), duration_s=2.0) for k in range(6)),
        Task(id="pick", position=(5.0, 2.0), load=1.0),
        Task(id="bring", position=(40.0, 2.0), delivers="pick"),
        Task(id="pair", position=(20.0, 5.0), robots_needed=2, duration_s=3.0),
        Task(id="timed", position=(30.0, 30.0), window_s=(((6.0, 20.0),))),
        Task(id="soon", position=(60.0, 60.0), deadline_s=4.0),
        Task(id="once", position=(12.0, 3.0), duration_s=6.0, across_partition="at-most-once"),
        Task(id="tied", position=(22.0, 7.0), starts_with=("pair",), duration_s=2.0),
    )
    services = ("unload",) if battery is None else ("unload", "charge")
    rate = None if battery is None else 20.0
    stations = (Station(id="dock", position=(2.0, 2.0), services=services, charge_per_s=rate),)
    return Mission(name="site", robots=robots, tasks=tasks, stations=stations, events=tuple(events), map=two_doors())


def two_doors():
    corners = ((-50.0, -50.0), (100.0, -50.0), (100.0, 100.0), (-50.0, 100.0))
    far = {"a": (80.0, 80.0), "b": (85.0, -40.0)}
    zones = tuple(
        Zone(id=name, polygon=((x, y), (x + 2, y), (x + 2, y + 2)), open=True) for name, (x, y) in far.items()
    )
    return Map(boundary=corners, zones=zones)


class Played:
    """A run of points, whose log is kept; its process may be killed, and another goes on."""

    def __init__(self, mission, plan, standing=None):
        self.world, self.log = World(mission), Log()
        self.mission, self.plan, self.standing = mission, plan, standing
        self.executor = self._executor(None)

    def _executor(self, state):
        executor = Executor(
            self.mission,
            self.plan,
            self.world.ports,
            observer=self.log,
            now=self.world.now,
            state=state,
            standing=self.standing,
            replan=Reallocation(travel=travel_of(self.mission), iterations=SEARCH_STEPS),
        )
        executor.tick(self.world.now)
        return executor

    def go_to(self, time_s):
        while self.world.now < time_s - 1e-9:
            self.world.step(0.5)
            self.executor.tick(self.world.now)

    def report(self, event):
        """Let an event happen, also to the robots' bodies."""
        ports = self.world.ports
        if event.robot_joins is not None:
            ports[event.robot_joins.id] = type(ports["r_0"])(event.robot_joins, self.world.now)
        if event.robot_moved is not None:
            ports[event.robot_moved.robot].put(event.robot_moved.position)
        for name in filter(None, (event.robot_fails, event.robot_removed, event.robot_silent, event.robot_returns)):
            ports[name].broken = bool(event.robot_fails or event.robot_removed)
            ports[name].mute = event.robot_silent is not None
        self.executor.report_if_it_fits(event)

    @property
    def recovered(self):
        """What is known by the log alone."""
        return recovered_from(self.mission, self.plan, self.log.entries)

    def recovered_by(self, entries):
        """What is known by a checkpoint after so many entries of the log, and those that follow."""
        written = json.dumps(checkpoint_of(recovered_from(self.mission, self.plan, self.log.entries[:entries])))
        state = restored(self.mission, json.loads(written))
        for entry in self.log.entries[entries:]:
            state.apply(event_of(entry["time_s"], entry["kind"], entry["data"]))
        return state

    def kill(self):
        """Go on with the executor of the process that comes after."""
        self.executor = self._executor(self.recovered)


def known(state):
    """All that is known of a mission, as a checkpoint has it, after a round trip through JSON."""
    told = json.loads(json.dumps(checkpoint_of(state), sort_keys=True))
    for name in ("failed_stations", "cut_off_stations", "misfits"):
        told[name] = sorted(told[name])
    told["ledger"]["refusals"] = {task: why for task, why in told["ledger"]["refusals"].items() if why}
    return told


SAMPLES = {
    "robot_fails": ["r_0", "r_1", "r_2"],
    "robot_silent": ["r_0"],
    "robot_returns": ["r_0", "r_1"],
    "robot_removed": ["r_1"],
    "robot_moved": [{"robot": "r_0", "position": (41.0, 3.0)}, {"robot": "r_2", "position": (2.0, 8.0)}],
    "robot_joins": [NEWCOMER],
    "new_task": [
        Task(id="new", position=(7.0, 7.0), actuation_cost=1.0),
        Task(id="more", position=(1.0, 30.0), delivers="pick"),
    ],
    "cancel_task": ["t_5", "pick", "pair", "new"],
    "move_task": [{"task": "t_4", "position": (33.0, 3.0)}, {"task": "pair", "position": (12.0, 3.0)}],
    "delay_task": [{"task": "t_3", "by_s": 4.0}, {"task": "pair", "by_s": 2.0}],
    "door_closes": ["a", "b"],
    "door_opens": ["a", "b"],
    "station_fails": ["dock"],
    "station_returns": ["dock"],
}
"""For each kind of event some that fit `site`."""


def event(kind, value):
    made = {"move_task": MovedTask, "delay_task": DelayedTask}.get(kind)
    return Event(at_s=0.0, **{kind: made(**value) if made else value})
