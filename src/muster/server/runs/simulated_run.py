"""A plan carried out in a simulated world, by steps of fixed length, so that the same happens each time.

What happens is a function of mission, plan, settings, and of what users did and when on the mission's clock: after a
crash it is simulated again up to where the log reaches, and goes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.execution import Recorder, Report, Status
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.running.simulation import Simulation
from muster.server.runs.run_settings import request_of

QUANTUM_S = 0.1
"""Seconds of mission time between two moments at which users can have a say."""


class SimulatedRun:
    """See `run_loop.WorldRun`."""

    real = False

    def __init__(
        self, mission: Mission, plan: Plan, world: str, settings: Mapping[str, Any], recorder: Recorder
    ) -> None:
        self._simulation = Simulation(mission, plan, request_of(world, settings, plan), recorder=recorder)
        self._quanta = 0
        self.starts_at = mission.starts_at

    @property
    def time_s(self) -> float:
        return self._simulation.time_s

    @property
    def done(self) -> bool:
        return self._simulation.done

    @property
    def status(self) -> Status:
        return self._simulation.status

    @property
    def next_s(self) -> float:
        """The mission's clock after the next step."""
        return (self._quanta + 1) * QUANTUM_S

    def go_on(self) -> None:
        """One step."""
        self._quanta += 1
        until_s = self._quanta * QUANTUM_S
        while not self.done and self.time_s < until_s - 1e-9:
            self._simulation.advance(until_s)

    def report(self, event: Event) -> None:
        self._simulation.report(event, replan=False)

    def replan(self) -> None:
        """Plan the rest again if what was reported asks for that."""
        self._simulation.replan()

    def break_off(self, reason: str) -> Report:
        return self._simulation.break_off(reason)

    def pause(self) -> None:
        """Nothing moves where time stands still."""

    def resume(self) -> None:
        """Time goes on."""

    def close(self) -> None:
        self._simulation.close()
