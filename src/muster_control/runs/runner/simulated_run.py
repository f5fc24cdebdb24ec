"""A plan carried out in a simulated world, by steps of fixed length; after a crash, the rest of it.

While no process simulates it the mission's clock stands still.
"""

from __future__ import annotations

import math
from typing import Any

from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.running.run_request import RunRequest
from muster.running.simulation import Simulation

QUANTUM_S = 0.1
"""Seconds of mission time between two moments at which users can have a say."""


class SimulatedRun(Simulation):
    """A run that `RunLoop` carries to its end."""

    real = False

    def __init__(self, mission: Mission, plan: Plan, request: RunRequest, **how: Any) -> None:
        super().__init__(mission, plan, request, **how)
        self._quanta = math.ceil(self.time_s / QUANTUM_S - 1e-9)
        self.starts_at = mission.starts_at

    @property
    def next_s(self) -> float:
        """The mission's clock after the next step."""
        return (self._quanta + 1) * QUANTUM_S

    def go_on(self) -> None:
        """One step."""
        self._quanta += 1
        until_s = self._quanta * QUANTUM_S
        while not self.done and self.time_s < until_s - 1e-9:
            self.advance(until_s)

    def report(self, event: Event, *, replan: bool = False) -> None:
        """See `Simulation`; `RunLoop` has the rest planned again once for all events that come together."""
        super().report(event, replan=replan)

    def pause(self) -> None:
        """Nothing moves where time stands still."""

    def resume(self) -> None:
        """Time goes on."""
