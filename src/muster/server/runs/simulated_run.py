"""A plan carried out in a simulated world, by steps of fixed length; after a crash, the rest of it.

While no process simulates it the mission's clock stands still.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from muster.execution import Recorder, Report, Status
from muster.mission.model import Event, Mission
from muster.mission.plan import Plan
from muster.running.begun import Begun
from muster.running.simulation import Simulation
from muster.server.runs.run_settings import standing_of
from muster.server.work.tasks.check_request import checked_options
from muster.simulation import Noise
from muster.state import MissionState

QUANTUM_S = 0.1
"""Seconds of mission time between two moments at which users can have a say."""


class SimulatedRun:
    """See `run_loop.WorldRun`."""

    real = False

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        world: str,
        settings: Mapping[str, Any],
        recorder: Recorder,
        begun: Begun | None = None,
    ) -> None:
        how = dict(settings)
        noise = Noise(**how.pop("noise", {}))
        how["standing"] = standing_of({"stay": how.pop("stay", False), "until_s": how.pop("until_s", math.inf)})
        how["ignore"] = plan.ignored
        how.pop("accept_partial", None)  # the plan was accepted
        how["planning"] = checked_options(how.get("planning", {}))
        self._simulation = Simulation(mission, plan, world=world, noise=noise, recorder=recorder, begun=begun, **how)
        self._quanta = math.ceil(self.time_s / QUANTUM_S - 1e-9)
        self.starts_at = mission.starts_at

    @property
    def state(self) -> MissionState:
        """See `run_loop.WorldRun`."""
        return self._simulation.state

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

    def bodies(self) -> Mapping[str, Any] | None:
        """Return where bodies are, from which a run after a crash goes on; None if the world does not tell."""
        return self._simulation.snapshot()

    def close(self) -> None:
        self._simulation.close()
