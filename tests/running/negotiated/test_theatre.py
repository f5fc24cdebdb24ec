"""What befalls bodies and processes, and what robots say of it, in whatever order it comes."""

import math
from types import SimpleNamespace

import pytest

from muster import Event, Mission, Negotiation, Robot, Task
from muster.allocation.problem import Problem
from muster.execution.record import NoObserver
from muster.mission.model import MovedTask
from muster.negotiation.messages import Stage
from muster.running.negotiated.pipe_messages import Befalls, Did, Sense
from muster.running.negotiated.robot_bodies import Theatre
from muster.running.negotiated.simulation import order_of
from muster.running.negotiated.team_log import Log
from muster.simulation import NO_NOISE, KinematicWorld, Noise

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

MISSION = Mission(
    robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(9, 0))), tasks=(Task(id="t", position=(0, 0)),)
)


class Processes:
    """Robots' processes that do nothing; what is told to them is kept, and they have last words."""

    lives = True

    def __init__(self, on_word, last_words=()):
        self.living, self.gone, self.news, self.told = ["a", "b"], {}, {}, []
        self._on_word, self._last_words, self._killed = on_word, last_words, []

    def tell(self, robot, word):
        self.told.append((robot, word))

    def kill(self, robot):
        self._killed.append(robot)

    def hear(self, wait_s):
        for robot in self._killed:
            for word in self._last_words:
                self._on_word(robot, word)
            self.living.remove(robot)
            self.gone[robot] = "killed"
        self._killed.clear()

    def may_start(self, robot):
        return self.lives

    def start(self, robot):
        self.living.append(robot)
        self.gone.pop(robot, None)

    def agree(self, robots):
        self.asked_of = list(robots)
        return "a" in self.news

    def views(self, robots):
        return {"a": SimpleNamespace(stage=Stage(3, b"base"))}


def did(*events, usages=()):
    return Did(events=events, used=1.0, usages=dict(usages), idle=True, settled=True, heard=0)


def theatre_of(events, tmp_path, last_words=(), noise=NO_NOISE):
    mission = Mission(robots=MISSION.robots, tasks=MISSION.tasks, events=events)
    order = order_of(Problem.compile(mission), Negotiation(), tmp_path)
    log = Log(order.problem, NoObserver(), lambda event: None, order.late)
    theatre = Theatre(mission, KinematicWorld(mission, noise=noise), order, log)
    theatre.team = Processes(theatre.hear, last_words)
    return theatre, log


def test_what_a_robot_began_just_before_it_failed_another_does_not_begin_twice(tmp_path):
    words = did((0.0, "arrives", {"task": "t"}), (0.0, "starts", {"task": "t"}))
    theatre, log = theatre_of([Event(at_s=0, robot_fails="a")], tmp_path, [words])
    theatre.go_on(1.0)
    theatre.hear("b", did((1.0, "arrives", {"task": "t"}), (1.0, "starts", {"task": "t"})))
    assert "twice" not in {event.kind for event in log.events}
    assert log.ledger.starts_s == {"t": 1.0}


def test_what_a_robot_has_done_just_before_it_failed_is_done(tmp_path):
    words = did((0.0, "ends", {"task": "t"}), usages={"t": (1.0, 1.0)})
    theatre, log = theatre_of([Event(at_s=0, robot_fails="a")], tmp_path, [words])
    theatre.hear("a", did((0.0, "arrives", {"task": "t"}), (0.0, "starts", {"task": "t"})))
    theatre.go_on(1.0)
    assert log.ledger.done_by == {"t": "a"}
    assert log.ledger.starts_s == {"t": 0.0}


def test_what_a_robot_was_told_that_is_gone_another_is_told_unless_it_does_not_hold_any_more(tmp_path):
    new = Event(at_s=0, new_task=Task(id="n", position=(1, 1)))
    moves = [Event(at_s=at_s, move_task=MovedTask(task="t", position=(x, 5.0))) for at_s, x in ((0, 1.0), (0.2, 2.0))]
    events = [new, moves[0], Event(at_s=0.1, robot_silent="a"), moves[1], Event(at_s=0.3, robot_fails="a")]
    theatre, _ = theatre_of(events, tmp_path)
    while theatre.time_s < 0.4:
        theatre.go_on(1.0)
    said = [(robot, word.event) for robot, word in theatre.team.told if isinstance(word, Befalls)]
    assert said == [("a", new), ("a", moves[0]), ("b", moves[1]), ("b", new)]


def test_the_plan_of_a_robot_that_has_gone_on_since_all_agreed_is_not_taken_in(tmp_path):
    theatre, log = theatre_of([], tmp_path)
    theatre.team.news["a"] = SimpleNamespace(stage=Stage(2, b"base", 1, ended=True))
    theatre.go_on(1.0)
    assert log.account.objective_planned is None


def test_the_radio_of_a_robot_works_that_was_cut_off_then_failed_and_returns(tmp_path):
    events = [Event(at_s=0, robot_silent="a"), Event(at_s=0.1, robot_fails="a"), Event(at_s=0.2, robot_returns="a")]
    theatre, _ = theatre_of(events, tmp_path)
    while theatre.time_s < 0.3:
        theatre.go_on(1.0)
    assert sorted(theatre.team.asked_of) == ["a", "b"]


def test_a_robot_that_has_no_process_left_does_not_return(tmp_path):
    theatre, log = theatre_of([Event(at_s=0.2, robot_returns="a")], tmp_path)
    theatre.team.gone["a"] = "killed by somebody"
    theatre.team.living.remove("a")
    theatre.team.lives = False
    while theatre.time_s < 0.3:
        theatre.go_on(1.0)
    assert [event.kind for event in log.events] == ["without_effect"]


def test_a_robot_is_accounted_for_from_when_it_joins(tmp_path):
    events = [Event(at_s=at_s, robot_joins=Robot(id=robot, position=(0, 9))) for at_s, robot in ((0, "j"), (99, "k"))]
    theatre, log = theatre_of(events, tmp_path)
    theatre.go_on(1.0)
    assert set(log.account.used) == {"a", "b", "j"}


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
    theatre, log = theatre_of([], tmp_path)
    new = Event(at_s=0.1, new_task=Task(id="found-4", position=(1, 1)))
    theatre.lookout = OneFind(new)
    while theatre.time_s < 0.3:
        theatre.go_on(1.0)
    assert [(robot, word.event) for robot, word in theatre.team.told if isinstance(word, Befalls)] == [("a", new)]
    assert [(h.kind, h.data) for h in log.events if h.kind == "found"] == [("found", {"tag": 4})]


def test_what_a_robot_sees_that_is_cut_off_or_gone_nobody_hears(tmp_path):
    silent, fails = Event(at_s=0.1, robot_silent="a"), Event(at_s=0.3, robot_fails="b")
    theatre, _ = theatre_of([silent, fails, Event(at_s=0.5, robot_returns="a")], tmp_path)
    theatre.lookout = OneFind(None)
    while theatre.time_s < 0.6:
        theatre.go_on(1.0)
    ways = [unheard for k, unheard in enumerate(theatre.lookout.unheard) if theatre.lookout.unheard[k - 1] != unheard]
    assert ways == [set(), {"a"}, {"a", "b"}, {"b"}]


def test_robots_that_err_about_their_poses_are_told_the_fused_ones(tmp_path):
    noise = Noise(position_m=0.1, heading_rad=0.05)
    theatre, _ = theatre_of([], tmp_path, noise=noise)
    while theatre.time_s < 3.0:
        theatre.go_on(10.0)
    sensed = [word.telemetry.position for robot, word in theatre.team.told if robot == "a" and isinstance(word, Sense)]
    assert 0 < math.dist(sensed[-1], (0.0, 0.0, 0.0)) < 0.06  # of 30 reports, each 0.14 off
