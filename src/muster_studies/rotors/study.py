"""The study: hovering and motors beside published parameters, steps beside the published equations.

Figures of a step response: rise time, overshoot, settling time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.perception.optional_parts import require_physics
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.rotors import flown, published, reference
from muster_studies.tables import CHECK_MARK, Cell, Table

SETTLED = 0.02
"""The share of a step within which a response has settled."""


@dataclass(frozen=True)
class Response:
    """From 10 % to 90 % of the step, in seconds; over the step, in per cent of it; until it stays within 2 %."""

    rise_s: float
    overshoot: float
    settled_s: float

    @classmethod
    def of(cls, times: Floats, shares: Floats) -> Response:
        """Of a response as shares of its step: 0 at the begin, 1 at the end."""
        outside = np.flatnonzero(np.abs(shares - 1.0) > SETTLED)
        settled = float(np.interp(0.0, [0.0, 1.0], times[outside[-1] : outside[-1] + 2]))
        rise = _reached(times, shares, 0.9) - _reached(times, shares, 0.1)
        return cls(rise, max(0.0, 100.0 * (float(shares.max()) - 1.0)), settled)


def _reached(times: Floats, shares: Floats, level: float) -> float:
    """When a response first reached a level."""
    after = int(np.argmax(shares >= level))
    return float(np.interp(level, shares[after - 1 : after + 1], times[after - 1 : after + 1]))


WITHIN = 10.0
"""Per cent by which an own figure may differ from its reference."""
_RULE = f"{CHECK_MARK}: own is within {WITHIN:g} % of the reference"
_SECONDS = 6.0
_LEAST = 1e-6
"""By which a difference is divided where the reference is 0."""
_COLUMNS = ("step", "figure", "reference", "own", "%", "mark")


@dataclass(frozen=True)
class Step:
    """A step of the wanted place, metres, or of the wanted heading, radians, from hovering."""

    axis: str
    size: float

    @property
    def name(self) -> str:
        return f"{self.axis} {self.size:g} {'rad' if self.axis == 'yaw' else 'm'}"


@dataclass(frozen=True)
class Hover:
    """Hovering for some seconds."""

    seconds: float = 5.0


Job = Step | Hover
Found = Mapping[str, tuple[float, float]]
"""By the name of a figure: the reference, and our own."""


def _perform(job: Job) -> Found:
    return _hovered(job) if isinstance(job, Hover) else _stepped(job)


def _hovered(job: Hover) -> Found:
    from muster_physics.airframes import FIREFLY

    speeds, (up_s, down_s) = flown.hovering(job.seconds), flown.motor_constants()
    lift = len(FIREFLY.rotors) * FIREFLY.motor_constant * FIREFLY.most_radps**2
    return {
        "speed of rotors hovering, rad/s": (published.HOVER_RADPS, float(speeds.mean())),
        "thrust at most, as a share of the weight": (published.THRUST_TO_WEIGHT, lift / (FIREFLY.mass_kg * 9.81)),
        "time constant of motors up, ms": (1000 * published.UP_S, 1000 * up_s),
        "time constant of motors down, ms": (1000 * published.DOWN_S, 1000 * down_s),
    }


def _stepped(job: Step) -> Found:
    axis = ("x", "y", "z", "yaw").index(job.axis)
    wanted = np.zeros(4)
    wanted[axis] = job.size
    own = flown.step_response(wanted[:3], float(wanted[3]), _SECONDS)
    times = np.linspace(0.0, _SECONDS, len(own))
    apart = reference.step_response(wanted[:3], float(wanted[3]), times)
    before, after = (Response.of(times, poses[:, axis] / job.size) for poses in (apart, own))
    return {
        "rise time, s": (before.rise_s, after.rise_s),
        "overshoot, %": (before.overshoot, after.overshoot),
        "settling time, s": (before.settled_s, after.settled_s),
    }


@dataclass(frozen=True)
class Beside:
    """A table of jobs: their figures beside the references."""

    number: str
    title: str
    all_jobs: tuple[Job, ...]
    notes: tuple[str, ...]

    def jobs(self, effort: Effort) -> Iterator[Job]:
        yield from self.all_jobs

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        rows = tuple(row for job in self.all_jobs for row in _rows(job, found[job]))
        return Table(self.number, self.title, _COLUMNS, rows, self.notes, decimals=3, mark_rule=_RULE)


def _rows(job: Job, found: Found) -> Iterator[tuple[Cell, ...]]:
    name = job.name if isinstance(job, Step) else "none"
    for figure, (before, own) in found.items():
        off = 0.0 if own == before else 100.0 * (own - before) / max(before, _LEAST)
        yield name, figure, before, own, off, CHECK_MARK if abs(off) <= WITHIN else "no"


def _check(effort: Effort) -> None:
    require_physics("study rotors", "mujoco", "scipy")


_TABLES: tuple[Reproduction[Job, Found], ...] = (
    Beside(
        "hover",
        "Hovering and motors of the Firefly",
        (Hover(),),
        ("reference: published parameters; of hovering what follows from them, sqrt(m g / (6 k)).",),
    ),
    Beside(
        "steps",
        "Steps of the wanted place and heading of the Firefly, from hovering",
        (Step("x", 1.0), Step("y", 1.0), Step("z", 1.0), Step("yaw", 0.5)),
        (
            "reference: the published equations and gains, solved apart by SciPy; neither RotorS nor Lee et al. print "
            "these figures. own: the physics world, in steps of 5 ms, without what it adds to the published law.",
            "rise time: from 10 % to 90 % of the step; settling time: until it stays within 2 % of the step.",
        ),
    ),
)

ROTORS = Repetition(
    **description("rotors"),
    reproductions=_TABLES,
    perform=one_by_one(_perform),
    seeds=lambda effort: None,
    extras=("physics",),
    check=_check,
)
