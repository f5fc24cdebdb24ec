"""Robots that are absent for a while: suspended, or silent and at work all the same."""

from dataclasses import replace

import pytest
from tests.execution.test_executor import kinds, line, plan_of
from tests.execution.world import World, carry_out

from muster.execution import Executor, Limits
from muster.mission.errors import ParameterError


class Telling:
    """A port that adds to what a robot says."""

    def __init__(self, port):
        self._port, self.robot, self.more, self.silent_since = port, port.robot, {}, None

    def send(self, waypoints):
        return self._port.send(waypoints)

    def cancel(self):
        return self._port.cancel()

    def telemetry(self):
        said = self._port.telemetry()
        if self.silent_since is not None:
            return replace(said, time_s=self.silent_since)
        return said and replace(said, **self.more)


def told(each, *, robots=1, absent_for_s=30.0, places=(40.0, 60.0)):
    """Two tasks of r_0, carried out while `each` sets what it says."""
    mission = line(*places, robots=robots)
    world = World(mission)
    ports = {name: Telling(port) if name == "r_0" else port for name, port in world.ports.items()}
    limits = Limits(silent_after_s=5, absent_for_s=absent_for_s)
    executor = Executor(mission, plan_of(r_0=["0", "1"]), ports, limits=limits)
    carry_out(executor, world, each=lambda world, executor: each(world.now, ports["r_0"]))
    return executor


def suspended(begins_s, ends_s):
    def each(now, port):
        port.more = {"suspended": "pilot: mode POSCTL"} if begins_s <= now < ends_s else {}

    return each


def test_a_suspended_robot_takes_part_again_and_does_what_was_left():
    executor = told(suspended(5, 25))
    assert kinds(executor).count("robot_suspended") == 1
    out = next(event for event in executor.events if event.kind == "robot_suspended")
    back = next(event for event in executor.events if event.kind == "robot_returns")
    assert (out.data["robot"], out.data["reason"]) == ("r_0", "pilot: mode POSCTL")
    assert back.time_s == pytest.approx(25.0, abs=0.3)
    assert sorted(executor.ledger.ends_s) == ["0", "1"]


def test_others_do_the_tasks_of_a_suspended_robot():
    executor = told(suspended(5, 1000), robots=2)
    assert executor.crew["r_1"].done == ["0", "1"]
    assert "robot_returns" not in kinds(executor)


@pytest.mark.parametrize("absent_for_s", [0.0, 10.0])
def test_the_mission_waits_for_an_absent_robot_for_so_long(absent_for_s):
    executor = told(suspended(5, 1000), absent_for_s=absent_for_s)
    out = next(event.time_s for event in executor.events if event.kind == "robot_suspended")
    lost = [event for event in executor.events if event.kind == "lost"]
    assert [event.data["task"] for event in lost] == ["0", "1"]
    assert lost[0].time_s == pytest.approx(out + absent_for_s, abs=0.3)


def unheard(passed):
    """Silent from 2 s to 20 s; it says afterwards how much of its first order it has passed."""

    def each(now, port):
        port.silent_since = 2.0 if 2.0 < now < 20.0 else None
        port.more = {"carried_out": (1, passed)} if now >= 20.0 else {}

    return each


@pytest.mark.parametrize(("passed", "again"), [(1, False), (0, True)])
def test_what_a_robot_has_done_unheard_is_not_done_again(passed, again):
    executor = told(unheard(passed))
    assert sorted(executor.ledger.ends_s) == ["0", "1"]
    assert kinds(executor).count("ends") == 2
    sets_out = [event.data["task"] for event in executor.events if event.kind == "sets_out"]
    assert sets_out == ["0", "0", "1"] if again else ["0", "1"]
    assert executor.account.lost == {}


def test_what_others_have_done_meanwhile_does_not_count_twice():
    executor = told(unheard(1), robots=2, places=(10.0, 60.0))
    ends = [event.data["task"] for event in executor.events if event.kind == "ends"]
    assert sorted(ends) == ["0", "1"]


def test_limits_that_are_none():
    with pytest.raises(ParameterError, match="absent_for_s: -1"):
        Limits(absent_for_s=-1)
