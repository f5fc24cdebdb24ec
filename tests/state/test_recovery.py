"""A run of real robots whose process is killed knows afterwards all that it knew before: its log is folded."""

import json
import random

import pytest
from tests.execution.world import World
from tests.running.run_log import Log

import muster
from muster.execution import Executor
from muster.mission.events import Event
from muster.mission.model import Mission, Robot, Station, Task
from muster.mission.records import specified
from muster.server.runs.crash_recovery import recovered_from
from muster.state import checkpoint_of

NEWCOMER = Robot(id="r_9", position=(9.0, 9.0), load_capacity=5.0)


def site(events=()):
    robots = tuple(
        Robot(id=f"r_{k}", position=(4.0 * k, 0.0), load_capacity=3.0, load_at_start=1.0 if k == 1 else None)
        for k in range(3)
    )
    tasks = (
        *(Task(id=f"t_{k}", position=(3.0 + 5 * (k % 3), 8.0 + 4 * (k // 3)), duration_s=2.0) for k in range(6)),
        Task(id="pick", position=(5.0, 2.0), load=1.0),
        Task(id="bring", position=(40.0, 2.0), delivers="pick"),
        Task(id="pair", position=(20.0, 5.0), robots_needed=2, duration_s=3.0),
        Task(id="timed", position=(30.0, 30.0), window_s=(((6.0, 20.0),))),
        Task(id="soon", position=(60.0, 60.0), deadline_s=4.0),
    )
    stations = (Station(id="dock", position=(2.0, 2.0), services=("unload",)),)
    return Mission(name="site", robots=robots, tasks=tasks, stations=stations, events=tuple(events), map=two_doors())


def two_doors():
    from muster.mission.model import Map, Zone

    corners = ((-50.0, -50.0), (100.0, -50.0), (100.0, 100.0), (-50.0, 100.0))
    far = {"a": (80.0, 80.0), "b": (85.0, -40.0)}
    zones = tuple(
        Zone(id=name, polygon=((x, y), (x + 2, y), (x + 2, y + 2)), open=True) for name, (x, y) in far.items()
    )
    return Map(boundary=corners, zones=zones)


class Played:
    """A run of points, whose log is kept."""

    def __init__(self, mission, plan):
        self.world, self.log = World(mission), Log()
        self.mission, self.plan = mission, plan
        self.executor = Executor(mission, plan, self.world.ports, observer=self.log)
        self.executor.tick(0.0)

    def go_to(self, time_s):
        while self.world.now < time_s - 1e-9:
            self.world.step(0.5)
            self.executor.tick(self.world.now)

    def report(self, event):
        if event.robot_joins is not None:
            self.world.ports[event.robot_joins.id] = type(self.world.ports["r_0"])(event.robot_joins, self.world.now)
        self.executor.report_if_it_fits(event)

    @property
    def recovered(self):
        """What is known by the log alone."""
        return recovered_from(self.mission, self.plan, self.log.entries)

    def killed(self):
        """The executor of the process that comes after."""
        return Executor(self.mission, self.plan, self.world.ports, now=self.world.now, state=self.recovered)


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
    from muster.mission.events import DelayedTask, MovedTask

    made = {"move_task": MovedTask, "delay_task": DelayedTask}.get(kind)
    return Event(at_s=0.0, **{kind: made(**value) if made else value})


def test_each_kind_of_event_has_a_sample():
    assert SAMPLES.keys() == {field.name for field in specified(Event)} - {"at_s"}


@pytest.fixture(scope="module")
def plan():
    return muster.solve(site(), "search", iterations=50, seed=1)


@pytest.mark.parametrize("kind", SAMPLES)
@pytest.mark.parametrize("then_s", [3.0, 12.0, 30.0])
def test_what_an_event_has_changed_is_known_after_a_crash(plan, kind, then_s):
    for value in SAMPLES[kind]:
        run = Played(site(), plan)
        run.go_to(2.0)
        for earlier in (("door_closes", "a"), ("station_fails", "dock")) if kind.endswith(("opens", "returns")) else ():
            run.report(event(*earlier))
        run.report(event(kind, value))
        run.go_to(then_s)
        assert known(run.recovered) == known(run.executor.state)


@pytest.mark.parametrize(
    "seed", [*range(20), 58, 198, *(pytest.param(k, marks=pytest.mark.long) for k in range(200, 400))]
)
def test_whatever_has_happened_is_known_after_a_crash(plan, seed):
    draw = random.Random(seed)
    run = Played(site([Event(at_s=15.0, cancel_task="t_0"), Event(at_s=500.0, cancel_task="t_1")]), plan)
    for point in run.world.ports.values():
        point.refuses = draw.choice([(), ((3.0, 8.0, 0.0),), ((2.0, 2.0, 0.0), (13.0, 8.0, 0.0))])
    for _ in range(draw.randrange(1, 7)):
        run.go_to(run.world.now + draw.choice([0.5, 2.0, 7.0, 15.0]))
        kind = draw.choice(sorted(SAMPLES))
        run.report(event(kind, draw.choice(SAMPLES[kind])))
    run.go_to(run.world.now + draw.choice([0.0, 1.0, 10.0]))
    assert known(run.recovered) == known(run.executor.state)


def test_events_of_the_mission_file_that_fell_into_the_time_without_a_process_happen(plan):
    run = Played(site([Event(at_s=5.0, station_fails="dock"), Event(at_s=50.0, cancel_task="t_1")]), plan)
    run.go_to(3.0)
    for _ in range(20):
        run.world.step(0.5)
    executor = run.killed()
    assert executor.now_s == 13.0
    assert executor.stations.failed == {"dock"}
    assert executor._script.next_s == 50.0


def test_a_robot_that_joined_and_cannot_be_reached_is_known_again_when_it_joins_again(plan):
    run = Played(site(), plan)
    run.report(event("robot_joins", NEWCOMER))
    run.go_to(5.0)
    run.report(event("robot_fails", "r_9"))
    port = run.world.ports.pop("r_9")
    executor = run.killed()
    assert "r_9" not in executor.crew
    run.world.ports["r_9"] = port
    executor.report(Event(at_s=0, robot_joins=NEWCOMER))
    assert executor.crew["r_9"].out == "robot_fails"
    assert executor.state.robots["r_9"].out_s == run.executor.state.robots["r_9"].out_s
