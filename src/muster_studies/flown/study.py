"""The study: what plans say that missions take, beside what they take in the kinematic world.

Robots do not keep out of each other's way: the difference is that of the motion alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from muster.generation.moving import SETTINGS, Setting, moving_mission
from muster.library import missions
from muster.mission.model import Mission
from muster.planning.judging import verify
from muster.planning.solve import solve
from muster.running.simulation import carry_out
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table

_PER_SETTING = 10
_QUICK_PER_SETTING = 2
_NOTES = (
    "planned: the makespan by the judge; flown: when the last task has ended in the kinematic world, avoidance none. "
    "Plans by greedy.",
)


@dataclass(frozen=True)
class Job:
    """A shipped mission by its name, or a random one by its setting and seed."""

    name: str = ""
    setting: Setting | None = None
    seed: int = 0

    @property
    def mission(self) -> Mission:
        found = mission_named(self.name) if self.setting is None else moving_mission(self.setting, self.seed)
        # Tags are found, and events happen, while a mission is carried out: no plan knows of them.
        return replace(found, tags=(), found=(), events=(), rules=replace(found.rules, timing="profile"))


@dataclass(frozen=True)
class Times:
    """Makespans of one mission, seconds, and how many of its tasks were not done."""

    planned_s: float
    flown_s: float
    lost: int

    @property
    def off(self) -> float:
        """By how much the flown time is above the planned one, per cent."""
        return 100 * (self.flown_s / self.planned_s - 1)


def times_of(mission: Mission) -> Times:
    """Plan a mission and carry it out."""
    plan = solve(mission, "greedy", objective="makespan")
    planned = verify(mission, plan, objective="makespan").makespan_s
    assert planned is not None, "the plan of an allocator is admissible"
    report = carry_out(mission, plan, avoidance="none")
    lost = sum(len(route.tasks) for route in plan.routes) - len(report.ends_s)
    return Times(planned, max(report.ends_s.values(), default=0.0), lost)


@dataclass(frozen=True)
class Shipped:
    """A row for each shipped mission whose robots have bodies."""

    number: str = "shipped"
    columns: tuple[str, ...] = ("mission", "robots", "tasks", "planned s", "flown s", "%")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        found = (mission.name for mission in missions() if _has_bodies(mission.name))
        yield from (Job(name) for name in found)

    def table(self, effort: Effort, found: Mapping[Job, Times]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for job in self.jobs(effort):
            mission, times = job.mission, found[job]
            rows.append((job.name, len(mission.robots), len(mission.tasks), times.planned_s, times.flown_s, times.off))
        rows.append(("mean of |%|", "", "", None, None, _mean([abs(found[job].off) for job in self.jobs(effort)])))
        notes = (*_NOTES, "All with timing: profile, those too whose file says constant; without tags and events.")
        return Table(self.number, "Shipped missions whose robots have bodies", self.columns, tuple(rows), notes)


@dataclass(frozen=True)
class Drawn:
    """A row for each setting of random missions."""

    number: str = "random"
    columns: tuple[str, ...] = ("robots", "missions", "mean %", "mean of |%|", "worst %", "lost")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        for setting in SETTINGS:
            yield from self._of(setting, effort)

    def _of(self, setting: Setting, effort: Effort) -> list[Job]:
        count = _QUICK_PER_SETTING if effort.quick else effort.seeds or _PER_SETTING
        return [Job(setting=setting, seed=seed) for seed in range(count)]

    def table(self, effort: Effort, found: Mapping[Job, Times]) -> Table:
        rows = [_row(setting.name, [found[job] for job in self._of(setting, effort)]) for setting in SETTINGS]
        rows.append(_row("all", [found[job] for job in self.jobs(effort)]))
        return Table(self.number, "Random missions", self.columns, tuple(rows), _NOTES)


def _row(name: str, times: list[Times]) -> tuple[Cell, ...]:
    off = [one.off for one in times]
    lost = sum(one.lost for one in times)
    return name, len(times), _mean(off), _mean([abs(one) for one in off]), max(off, key=abs), lost


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def _has_bodies(name: str) -> bool:
    try:
        return all(robot.radius_m > 0 for robot in mission_named(name).robots)
    except Exception:
        return False


_TABLES: tuple[Reproduction[Job, Times], ...] = (Shipped(), Drawn())

FLOWN = Repetition(
    **description("flown"),
    reproductions=_TABLES,
    perform=one_by_one(lambda job: times_of(job.mission)),
    seeds=lambda effort: None,
    extras=("map",),
)
