"""The state of each robot when a command ends: position, whether it answers, whether it still flies or drives."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from muster.execution.fleet import Fleet
from muster.mission.errors import MusterError
from muster.mission.model import Mission, Robot
from muster.motion.port import Place, Telemetry

STILL_MPS = 0.1
"""A slower robot stands: poses are noisy."""
UP_M = 0.5
"""A robot that flies is in the air if it is this much higher than its start."""
_SILENT_S = 2.0
_POLL_S, _POLLS = 0.1, 20
"""Robots have this many times this many seconds to come to rest."""


@dataclass(frozen=True)
class FinalState:
    """One robot at the end.

    Parameters
    ----------
    robot
        its id.
    state
        in words, such as "hovers, armed", "landed, not armed", "stands", "not answering for 12 s".
    position
        the last that it reported, metres in the map frame; None if it reported none.
    moving
        whether it flies or drives, or did when it was last heard.
    crashed
        whether it fell, as far as is known: somebody has to look after it.
    """

    robot: str
    state: str
    position: Place | None
    moving: bool
    crashed: bool = False

    def __str__(self) -> str:
        if self.position is None:
            return f"{self.robot}: {self.state}; position unknown"
        return f"{self.robot}: {self.state}; at ({', '.join(f'{c:.2f}' for c in self.position)})"


class RobotsLeftError(MusterError):
    """A refusal to command robots whose states are known: some may be armed, or move.

    Attributes
    ----------
    states : tuple of FinalState
        Where robots are, and what they do.
    """

    def __init__(self, message: str, states: Sequence[FinalState]) -> None:
        super().__init__(message)
        self.states = tuple(states)


def final_states_of(fleet: Fleet, mission: Mission) -> list[FinalState]:
    """The state of each robot of a fleet, as the fleet itself tells it by `final_states()`, else by telemetry."""
    told = getattr(fleet, "final_states", None)
    if told is not None:
        return list(told())
    return final_states_by_telemetry(fleet, mission, getattr(fleet, "not_told", ()))


def final_states_by_telemetry(fleet: Fleet, mission: Mission, not_told: Collection[str] = ()) -> list[FinalState]:
    """The state of each robot of a fleet, those that joined included; robots that brake get two seconds to stand.

    Parameters
    ----------
    not_told
        robots that could not be told to stop: they may go on.
    """
    bodies = {robot.id: robot for robot in mission.robots}

    def now() -> list[FinalState]:
        ports = dict(fleet.ports)
        return [_state(name, bodies.get(name), port.telemetry(), fleet.time_s) for name, port in ports.items()]

    states = now()
    for _ in range(_POLLS):
        if not any(state.moving for state in states):
            break
        try:
            fleet.advance(fleet.time_s + _POLL_S)
        except MusterError:  # nothing more is heard: the last telemetry counts
            break
        states = now()
    return [_going_on(state) if state.robot in not_told else state for state in states]


def _going_on(state: FinalState) -> FinalState:
    return replace(state, state=f"{state.state}; not told to stop", moving=True)


def _state(name: str, body: Robot | None, said: Telemetry | None, now: float) -> FinalState:
    if said is None:
        return FinalState(name, "not answering", None, moving=False)
    flies, moves = _is_up(body, said.position), math.hypot(*said.velocity) > STILL_MPS
    does = ("flies" if flies else "drives") if moves else ("hovers" if flies else "stands")
    silent_s = now - said.time_s
    state = does if silent_s <= _SILENT_S else f"not answering for {silent_s:.0f} s; last seen: {does}"
    return FinalState(name, state, said.position, moving=flies or moves)


def _is_up(body: Robot | None, place: Place) -> bool:
    """Whether a robot is in the air; robots that joined, and missions in the plane, tell nothing of that."""
    if body is None or body.kind != "air" or len(body.position) < 3:
        return False
    return place[2] > body.position[2] + UP_M
