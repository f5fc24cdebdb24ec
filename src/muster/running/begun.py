"""Where a run was interrupted, and how it goes on from there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from muster.execution import CompletedWork, Executor
from muster.mission.model import Mission
from muster.simulation.world import standing


@dataclass(frozen=True, kw_only=True)
class Begun:
    """Where a run was interrupted.

    Parameters
    ----------
    past : CompletedWork
        What is known of the time before.
    again : sequence of str
        Tasks on which robots were at work: their work is begun again.
    bodies : mapping
        Of a simulated world: where its bodies are, by `Simulation.snapshot`.
    """

    past: CompletedWork
    again: Sequence[str] = ()
    bodies: Mapping[str, Any] = field(default_factory=dict)

    def standing(self, mission: Mission) -> Mission:
        """Return a mission whose robots start where the bodies of a simulated world stand."""
        return replace(mission, robots=tuple(standing(robot, self.bodies) for robot in mission.robots))

    def resume(self, executor: Executor) -> None:
        """Let an executor plan the rest again from where robots stand."""
        executor.plan_again("resumed", {"how": "from where robots stand", "again": list(self.again)})
