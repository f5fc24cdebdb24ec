"""The runs: a scenario, a method, and the perturbation of preferred velocities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from muster.motion.avoidance import (
    Avo,
    Crowd,
    Hrvo,
    Method,
    Orca,
    Rvo,
    Trajectories,
    avo,
    hrvo,
    orca,
    perturbed,
    run,
    rvo,
    towards,
)
from muster_studies.rvo.scenarios import Scenario, circle, tables

METHODS = ("RVO", "HRVO", "ORCA", "AVO")
PERTURBED = ("ORCA", "AVO")
"""Those that wait for ever where robots meet head on, unless preferred velocities are shifted."""
ARRIVAL_M = 0.05
"""How near to its goal a robot is there, in the published scenarios."""
CIRCLE_ARRIVAL_M = 0.1
UNTIL_S = 300.0
CIRCLE_UNTIL_S = {8: 600.0, 32: 600.0, 100: 900.0, 250: 1500.0}
CIRCLE_HORIZON_S = 2.0
"""Of ORCA and AVO; with longer ones the circle of 8 sometimes holds itself up for ever."""
CIRCLE_NEIGHBOURS: dict[str, Any] = {"most_neighbours": 10, "neighbour_distance_m": 15.0}

SHARE, CIRCLE_SHARE, HOLD_S = 0.1, 0.8, 5.0
"""By how much of their length the preferred velocities are shifted, and for how long a shift lasts."""


@dataclass(frozen=True)
class Job:
    """One run."""

    subject: Scenario | int
    """A published scenario, or the number of robots on the circle."""
    method: str
    seed: int | None
    """Of the perturbation; None without."""

    @property
    def crowd(self) -> Crowd:
        return circle(self.subject) if isinstance(self.subject, int) else self.subject.crowd()

    def perform(self) -> Trajectories:
        if isinstance(self.subject, int):
            until_s, method = CIRCLE_UNTIL_S[self.subject], _circle_method(self.method)
            return self._go(method, CIRCLE_SHARE, until_s=until_s, arrival_m=CIRCLE_ARRIVAL_M)
        return self._go(_method(self.method), SHARE, until_s=UNTIL_S, arrival_m=ARRIVAL_M)

    def _go(self, method: Method, share: float, *, until_s: float, arrival_m: float) -> Trajectories:
        crowd, dt = self.crowd, tables()["A.18"]["timestep_s"]
        preference = towards(crowd.goals, crowd.max_speeds, dt)
        if self.seed is not None:
            preference = perturbed(preference, share, self.seed, round(HOLD_S / dt))
        return run(crowd, method, dt=dt, until_s=until_s, arrival_m=arrival_m, preference=preference)


def _method(name: str) -> Method:
    methods: dict[str, Method] = {"RVO": Rvo(), "HRVO": Hrvo(), "ORCA": Orca(), "AVO": Avo()}
    return methods[name]


def _circle_method(name: str) -> Method:
    methods: dict[str, Method] = {
        "RVO": Rvo(rvo.Parameters(**CIRCLE_NEIGHBOURS)),
        "HRVO": Hrvo(hrvo.Parameters(**CIRCLE_NEIGHBOURS)),
        "ORCA": Orca(orca.Parameters(horizon_s=CIRCLE_HORIZON_S, **CIRCLE_NEIGHBOURS)),
        "AVO": Avo(avo.Parameters(horizon_s=CIRCLE_HORIZON_S, **CIRCLE_NEIGHBOURS)),
    }
    return methods[name]
