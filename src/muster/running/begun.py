"""Where a simulated run was interrupted, and where it goes on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.simulation.world import standing
from muster.state import MissionState


@dataclass(frozen=True, kw_only=True)
class Begun:
    """Where a simulated run was interrupted.

    Parameters
    ----------
    state : MissionState
        What is known of the mission.
    bodies : mapping
        Where bodies were, by `Simulation.snapshot`.
    time_s : float
        The mission's clock when the run goes on, seconds.
    """

    state: MissionState
    bodies: Mapping[str, Any]
    time_s: float

    @classmethod
    def of(cls, state: MissionState, bodies: Mapping[str, Any] | None, seen_s: float, world: str) -> Begun:
        """Return where a run in a world was interrupted that was seen until a time.

        Raises
        ------
        ParameterError
            if it is not known where bodies were.
        """
        if bodies is None:
            expected = "expected a world with snapshots, in a run that this version of Muster has begun"
            raise ParameterError(f"world {world}: it is not known where bodies were; {expected}")
        return cls(state=state, bodies=bodies, time_s=max(seen_s, state.now_s, bodies["time_s"]))

    @property
    def snapshot(self) -> Mapping[str, Any]:
        """The bodies as a world takes them that goes on at that time."""
        return {**self.bodies, "time_s": self.time_s}

    def standing(self, mission: Mission) -> Mission:
        """Return a mission with all robots that have joined, each of which starts where its body stands.

        What has happened is no event any more; tasks that came by it are there, as later events may name them.
        """
        robots = tuple(standing(known.robot, self.bodies) for known in self.state.robots.values())
        left = tuple(event for event in mission.events if event.at_s > self.bodies["time_s"] + 1e-9)
        came = (event.new_task for event in mission.events if event not in left and event.new_task is not None)
        return replace(mission, robots=robots, tasks=(*mission.tasks, *came), events=left)
