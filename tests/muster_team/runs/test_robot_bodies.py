"""What take_event bodies and processes, and what robots say of it, in whatever order it comes."""

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

from muster import Event, Mission, Robot, Task
from muster.allocation.auctions.auction import Parameters
from muster.execution.record import NoObserver
from muster.mission.events import MovedRobot
from muster.mission.model import MovedTask
from muster.motion.port import Waypoint
from muster.running.state_estimation import with_state_estimation
from muster.simulation import NO_NOISE, KinematicWorld, Noise
from muster_team.knowledge.messages import Stage
from muster_team.processes.process_reports import SHOW
from muster_team.runs import robot_bodies as bodies_module
from muster_team.runs.pipe_messages import BodyState, OperatorEvent, WorkReport
from muster_team.runs.robot_bodies import RobotBodies
from muster_team.runs.simulation import setup_of
from muster_team.runs.team_log import TeamLog

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

MISSION = Mission(
    robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(9, 0))), tasks=(Task(id="t", position=(0, 0)),)
)

STATUS = SimpleNamespace(members=("a", "b"), not_admitted={})


class Processes:
    """Robots' processes that do nothing; what is told to them is kept, and they have last words."""

    lives = True

    def __init__(self, on_report, last_words=()):
        self.living, self.ended, self.progress, self.told = ["a", "b"], {}, {}, []
        self._on_report, self._last_words, self._killed = on_report, last_words, []

    def send(self, robot, word, *, latest=False):
        self.told.append((robot, word))

    def kill(self, robot):
        self._killed.append(robot)

    def poll(self, wait_s):
        for robot in self._killed:
            for word in self._last_words:
                self._on_report(robot, word)
            self.living.remove(robot)
            self.ended[robot] = "killed"
        self._killed.clear()

    def may_start(self, robot):
        return self.lives

    def start(self, robot):
        self.living.append(robot)
        self.ended.pop(robot, None)

    def agree(self, robots):
        self.asked_of = list(robots)
        return "a" in self.progress


def did(*events):
    return WorkReport(events=events, used=1.0, idle=True, settled=True, heard=0)


def bodies_of(events, tmp_path, last_words=(), noise=NO_NOISE, radius_m=0.0):
    robots = tuple(replace(robot, radius_m=radius_m) for robot in MISSION.robots)
    mission = Mission(robots=robots, tasks=MISSION.tasks, events=events)
    setup = setup_of(mission, tmp_path, method="auction", terms=Parameters(), transport="udp")
    log = TeamLog(setup.problem, NoObserver(), lambda event: None, setup.late)
    world = KinematicWorld(mission, noise=noise)
    robot_bodies = RobotBodies(mission, world, with_state_estimation(world, mission), setup, log)
    robot_bodies.team = Processes(robot_bodies.take_report, last_words)
    return robot_bodies, log


def test_what_a_robot_began_just_before_it_failed_another_does_not_begin_twice(tmp_path):
    words = did((0.0, "arrives", {"task": "t", "robot": "a"}), (0.0, "starts", {"task": "t", "robot": "a"}))
    robot_bodies, log = bodies_of([Event(at_s=0, robot_fails="a")], tmp_path, [words])
    robot_bodies.step(1.0)
    robot_bodies.take_report(
        "b", did((1.0, "arrives", {"task": "t", "robot": "b"}), (1.0, "starts", {"task": "t", "robot": "b"}))
    )
    assert "twice" not in {event.kind for event in log.events}
    assert log.state.ledger.starts_s == {"t": 1.0}


def test_what_a_robot_has_done_just_before_it_failed_is_done(tmp_path):
    words = did((0.0, "ends", {"task": "t", "robot": "a", "usage": [1.0, 1.0]}))
    robot_bodies, log = bodies_of([Event(at_s=0, robot_fails="a")], tmp_path, [words])
    robot_bodies.take_report(
        "a", did((0.0, "arrives", {"task": "t", "robot": "a"}), (0.0, "starts", {"task": "t", "robot": "a"}))
    )
    robot_bodies.step(1.0)
    assert log.state.ledger.done_by == {"t": "a"}
    assert log.state.ledger.starts_s == {"t": 0.0}


def test_what_a_robot_was_told_that_is_gone_another_is_told_unless_it_does_not_hold_any_more(tmp_path):
    new = Event(at_s=0, new_task=Task(id="n", position=(1, 1)))
    moves = [Event(at_s=at_s, move_task=MovedTask(task="t", position=(x, 5.0))) for at_s, x in ((0, 1.0), (0.2, 2.0))]
    events = [new, moves[0], Event(at_s=0.1, robot_silent="a"), moves[1], Event(at_s=0.3, robot_fails="a")]
    robot_bodies, _ = bodies_of(events, tmp_path)
    while robot_bodies.time_s < 0.4:
        robot_bodies.step(1.0)
    said = [(robot, word.event) for robot, word in robot_bodies.team.told if isinstance(word, OperatorEvent)]
    assert said == [("a", new), ("a", moves[0]), ("b", moves[1]), ("b", new)]


def test_the_plan_of_a_robot_that_has_gone_on_since_all_agreed_is_not_taken_in(tmp_path):
    robot_bodies, log = bodies_of([], tmp_path)
    view = SimpleNamespace(stage=Stage(3, b"base"))
    robot_bodies.team.progress = {
        name: SimpleNamespace(stage=Stage(2, b"base", 1, ended=True), view=view, status=STATUS) for name in "ab"
    }
    robot_bodies.step(1.0)
    assert log.account.objective_planned is None


def test_a_robot_that_does_not_tell_its_view_holds_up_nobody_and_another_is_asked(tmp_path, monkeypatch):
    robot_bodies, _ = bodies_of([], tmp_path)
    stage = Stage(2, b"base", 1, ended=True)
    robot_bodies.team.progress = {name: SimpleNamespace(stage=stage, view=None, status=STATUS) for name in "ab"}
    now_s = [100.0]
    monkeypatch.setattr(bodies_module, "_STEP_S", 0.0)
    monkeypatch.setattr(bodies_module.time, "monotonic", lambda: now_s[0])
    for _ in range(4):
        robot_bodies.step(1.0)
        now_s[0] += 0.4
    assert [robot for robot, word in robot_bodies.team.told if word == SHOW] == ["a", "b"]


def test_the_radio_of_a_robot_works_that_was_cut_off_then_failed_and_returns(tmp_path):
    events = [Event(at_s=0, robot_silent="a"), Event(at_s=0.1, robot_fails="a"), Event(at_s=0.2, robot_returns="a")]
    robot_bodies, _ = bodies_of(events, tmp_path)
    while robot_bodies.time_s < 0.3:
        robot_bodies.step(1.0)
    assert sorted(robot_bodies.team.asked_of) == ["a", "b"]


def test_a_robot_that_has_no_process_left_does_not_return(tmp_path):
    robot_bodies, log = bodies_of([Event(at_s=0.2, robot_returns="a")], tmp_path)
    robot_bodies.team.ended["a"] = "killed by somebody"
    robot_bodies.team.living.remove("a")
    robot_bodies.team.lives = False
    while robot_bodies.time_s < 0.3:
        robot_bodies.step(1.0)
    assert [event.kind for event in log.events] == ["without_effect"]


def put(at_s, robot, *position):
    return Event(at_s=at_s, robot_moved=MovedRobot(robot=robot, position=position))


def test_a_robot_that_has_failed_is_taken_away_once_and_cannot_be_moved_then(tmp_path):
    kinds = (
        Event(at_s=0, robot_fails="a"),
        put(0.1, "a", 3, 3),
        *(2 * [Event(at_s=0.2, robot_removed="a")]),
        put(0.3, "a", 4, 4),
    )
    robot_bodies, log = bodies_of(kinds, tmp_path)
    while robot_bodies.time_s < 0.4:
        robot_bodies.step(1.0)
    told = [event.kind for event in log.events]
    assert told == ["robot_fails", "robot_moved", "robot_removed", "without_effect", "without_effect"]
    assert not [word for _, word in robot_bodies.team.told if isinstance(word, OperatorEvent)]
    assert math.isnan(robot_bodies._world.positions[0, 0])


def test_one_that_was_taken_away_has_a_process_that_may_start_when_it_returns(tmp_path):
    events = [Event(at_s=0, robot_fails="a"), Event(at_s=1, robot_removed="a"), Event(at_s=2, robot_returns="a")]
    events += [Event(at_s=1, robot_removed="b"), Event(at_s=2, robot_returns="b")]
    assert setup_of(
        Mission(robots=MISSION.robots, tasks=MISSION.tasks, events=tuple(events)),
        tmp_path,
        method="auction",
        terms=Parameters(),
        transport="udp",
    ).starts == {"a": 2, "b": 2}


def test_nobody_can_put_a_robot_where_another_stands(tmp_path):
    events = [
        put(0, "a", 8.9, 0),
        Event(at_s=0.1, robot_removed="b"),
        put(0.2, "a", 8.9, 0),
        Event(at_s=0.3, robot_returns="b"),
    ]
    robot_bodies, log = bodies_of(events, tmp_path, radius_m=0.3)
    while robot_bodies.time_s < 0.4:
        robot_bodies.step(1.0)
    refused = [event.reason for event in log.events if event.kind == "event_refused"]
    assert refused == [
        "robot_moved.position: [8.9, 0.0]; expected a place clear of b, which is at [9.0, 0.0]",
        "robot_returns.position: [9.0, 0.0]; expected a place clear of a, which is at [8.9, 0.0]",
    ]
    assert "b" in robot_bodies.team.ended
    assert [event.kind for event in log.events if event.kind.startswith("robot")] == ["robot_removed", "robot_moved"]


def test_a_robot_is_accounted_for_from_when_it_joins(tmp_path):
    events = [Event(at_s=at_s, robot_joins=Robot(id=robot, position=(0, 9))) for at_s, robot in ((0, "j"), (99, "k"))]
    robot_bodies, log = bodies_of(events, tmp_path)
    robot_bodies.step(1.0)
    assert set(log.account.robots) == {"a", "b", "j"}


class OneFind:
    """Cameras that find something at 0.1 s."""

    def __init__(self, event):
        self._events = [event]
        self.unheard = []

    def look(self, now, unheard):
        self.unheard.append(set(unheard))
        if now >= 0.1 and self._events:
            yield {"tag": 4}, self._events.pop()


def test_of_what_cameras_find_one_robot_is_told(tmp_path):
    robot_bodies, log = bodies_of([], tmp_path)
    new = Event(at_s=0.1, new_task=Task(id="found-4", position=(1, 1)))
    robot_bodies.camera_search = OneFind(new)
    while robot_bodies.time_s < 0.3:
        robot_bodies.step(1.0)
    assert [(robot, word.event) for robot, word in robot_bodies.team.told if isinstance(word, OperatorEvent)] == [
        ("a", new)
    ]
    assert [(h.kind, h.data) for h in log.events if h.kind == "found"] == [("found", {"tag": 4})]


def test_what_a_robot_sees_that_is_cut_off_or_gone_nobody_hears(tmp_path):
    silent, fails = Event(at_s=0.1, robot_silent="a"), Event(at_s=0.3, robot_fails="b")
    robot_bodies, _ = bodies_of([silent, fails, Event(at_s=0.5, robot_returns="a")], tmp_path)
    robot_bodies.camera_search = OneFind(None)
    while robot_bodies.time_s < 0.6:
        robot_bodies.step(1.0)
    ways = [
        unheard
        for k, unheard in enumerate(robot_bodies.camera_search.unheard)
        if robot_bodies.camera_search.unheard[k - 1] != unheard
    ]
    assert ways == [set(), {"a"}, {"a", "b"}, {"b"}]


def test_robots_that_err_about_their_poses_are_told_the_fused_ones(tmp_path):
    noise = Noise(position_m=0.1, heading_rad=0.05)
    robot_bodies, _ = bodies_of([], tmp_path, noise=noise)
    while robot_bodies.time_s < 3.0:
        robot_bodies.step(10.0)
    sensed = [
        word.telemetry.position
        for robot, word in robot_bodies.team.told
        if robot == "a" and isinstance(word, BodyState)
    ]
    assert 0 < math.dist(sensed[-1], (0.0, 0.0, 0.0)) < 0.06  # of 30 reports, each 0.14 off


@pytest.mark.parametrize("away", [False, True])
def test_what_a_robot_did_is_judged_by_where_it_was_then_however_late_it_is_heard(tmp_path, away):
    """A process that has to wait for its turn tells late; the body has gone on by then."""
    robot_bodies, log = bodies_of((), tmp_path)
    port = robot_bodies.ports["a"]
    robot_bodies.step(1.0)
    at_place_s = robot_bodies.time_s
    port.send([Waypoint((3.0, 0.0, 0.0))])
    while port.telemetry().position[0] < 2.0:
        robot_bodies.step(10.0)
    begins_s, ends_s = (robot_bodies.time_s,) * 2 if away else (at_place_s, at_place_s)
    starts = (begins_s, "starts", {"task": "t", "robot": "a"})
    robot_bodies.take_report("a", did(starts, (ends_s, "ends", {"task": "t", "robot": "a", "usage": (1.0, 1.0)})))
    assert robot_bodies.true_places.done["t"].is_done is not away
    assert ("off_place" in [event.kind for event in log.events]) is away
