"""How robots end that a fleet knows by telemetry alone: whether they stand, drive, fly, or do not answer."""

from types import SimpleNamespace

import pytest

from muster.execution.final_state import FinalState, final_states_by_telemetry
from muster.mission.errors import NetworkError
from muster.mission.model import Mission, Robot
from muster.motion.port import Telemetry

ROVER, DRONE = Robot(id="rover", position=(0.0, 0.0, 0.0)), Robot(id="drone", position=(5.0, 5.0, 1.0), kind="air")


class Team:
    """A fleet in which each robot reports what is next in its list, for a tenth of a second each."""

    def __init__(self, **reports):
        self.time_s, self._reports, self.broken = 100.0, reports, False
        self.ports = {name: SimpleNamespace(telemetry=lambda name=name: self._said(name)) for name in reports}

    def _said(self, name):
        states = self._reports[name]
        return states[min(round(10 * (self.time_s - 100.0)), len(states) - 1)]

    def advance(self, until_s):
        if self.broken:
            raise NetworkError("gone")
        self.time_s = until_s
        return ()


def said(x, speed=0.0, z=0.0, at_s=101.0):
    return Telemetry(at_s, (x, 0.0, z), 0.0, (speed, 0.0, 0.0), 0.0, 1, 1)


def ended(team, *robots):
    return final_states_by_telemetry(team, Mission(robots=robots, tasks=()))


def test_a_robot_that_brakes_gets_time_to_stand():
    team = Team(rover=[said(1.0, 0.8), said(1.1, 0.4), said(1.2)])
    assert ended(team, ROVER) == [FinalState("rover", "stands", (1.2, 0.0, 0.0), moving=False)]
    assert team.time_s == pytest.approx(100.2)


def test_a_robot_that_does_not_stop_still_drives():
    team = Team(rover=[said(1.0, 0.8)])
    assert ended(team, ROVER) == [FinalState("rover", "drives", (1.0, 0.0, 0.0), moving=True)]
    assert team.time_s == pytest.approx(102.0)


def test_a_robot_in_the_air_still_flies_although_it_hovers():
    assert ended(Team(drone=[said(1.0, z=1.6)]), DRONE) == [FinalState("drone", "hovers", (1.0, 0.0, 1.6), moving=True)]
    assert not ended(Team(drone=[said(1.0, z=1.4)]), DRONE)[0].moving


def test_a_robot_that_does_not_answer():
    team = Team(rover=[said(1.0, at_s=90.0)], lost=[said(2.0, 1.0, at_s=90.0)], never=[None])
    standing, driving, never = ended(team, ROVER)
    assert (standing.state, standing.moving) == ("not answering for 12 s; last seen: stands", False)
    assert (driving.state, driving.moving) == ("not answering for 12 s; last seen: drives", True)
    assert str(never) == "never: not answering; position unknown"


def test_a_robot_that_was_not_told_to_stop_may_go_on():
    team = Team(rover=[said(1.0, at_s=100.0)])
    (state,) = final_states_by_telemetry(team, Mission(robots=(ROVER,), tasks=()), ["rover"])
    assert str(state) == "rover: stands; not told to stop; at (1.00, 0.00, 0.00)"
    assert state.moving


def test_where_nothing_is_heard_any_more_the_last_telemetry_counts():
    team = Team(rover=[said(1.0, 0.8), said(1.1)])
    team.broken = True
    assert ended(team, ROVER)[0].state == "drives"
