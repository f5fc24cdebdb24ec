"""Table `noise`: how much more disturbed robots use. Table `capacity-reserve`: what a reserve of capacity achieves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from statistics import fmean

from muster.simulation import NO_NOISE, Noise
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table
from muster_studies.thesis_6.flights import ALLOCATOR, Flight, FlightResult
from muster_studies.thesis_6.published import PublishedPlan, excess, plans
from muster_studies.thesis_6.totals import search_flights, search_iterations, total_and_greatest

NOISES: Mapping[str, Noise] = {
    "none": NO_NOISE,
    "slip 0.05": Noise(slip=0.05),
    "slip 0.1": Noise(slip=0.1),
    "slip 0.2": Noise(slip=0.2),
    "velocity 0.1": Noise(velocity=0.1),
    "odometry 0.1": Noise(odometry=0.1),
}
_SLIP = "slip: a robot loses up to this share of its way in each step, half of it on average; odometry counts it all."


@dataclass(frozen=True)
class UsageUnderNoise:
    """The two plans that were driven in truth, with the ways of their tasks, under each kind of noise."""

    number: str = "noise"

    @property
    def plans(self) -> tuple[PublishedPlan, ...]:
        return (*plans("6.8"), *plans("6.9"))

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for plan in self.plans:
            for name in NOISES:
                yield from _seeded(plan, name, effort)

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        columns = ("mission", "noise", "runs", "planned", "mean %", "least %", "most %", "lost", "contacts")
        rows: list[tuple[Cell, ...]] = []
        for plan in self.plans:
            for name in NOISES:
                runs = [found[flight] for flight in _seeded(plan, name, effort)]
                planned = runs[0].planned.total_cost
                off = [excess(sum(flown.usages), planned) for flown in runs]
                lost, contacts = sum(flown.lost for flown in runs), sum(flown.report.contacts or 0 for flown in runs)
                figures = planned, fmean(off), min(off), max(off)
                rows.append((plan.with_actions, name, len(runs), *figures, lost, contacts))
        notes = (
            "By how much the usage of all robots, by odometry, is above what is planned: mean and range over seeds.",
            f"{_SLIP} velocity: standard deviation of the share of its velocity that a robot misses in a step; "
            "odometry: standard deviation of the share by which odometry errs in a step.",
            *(_in_truth(plan) for plan in self.plans),
            "Robots steer by their true poses here, as by motion capture without errors. The misaligned markers of "
            "Figure 6.15, to which the thesis puts that down, are in the table markers.",
        )
        return Table(self.number, "Usage of robots that are disturbed", columns, tuple(rows), notes)


def _seeded(plan: PublishedPlan, noise: str, effort: Effort) -> list[Flight]:
    return [plan.flight(plan.with_actions, noise=NOISES[noise], seed=seed) for seed in range(effort.seed_count)]


def _in_truth(plan: PublishedPlan) -> str:
    calculated, gazebo, real = (sum(plan.usages(kind)) for kind in ("", "gazebo", "real"))
    return (
        f"The thesis' real robots in {plan.scenario}: {excess(real, calculated):+.2f} % of its calculation, "
        f"{excess(real, gazebo):+.2f} % of its Gazebo runs."
    )


@dataclass(frozen=True)
class CapacityReserve:
    """Own plans of the missions with the tightest capacities, carried out, for each reserve."""

    number: str = "capacity-reserve"
    missions: tuple[str, ...] = ("31T-2R65-4R25-as-run", "31T-3R44-3R26-as-run", "31T-6R50-as-run")
    reserves: tuple[float, ...] = (0.0, 0.02, 0.05, 0.1)
    noises: tuple[str, ...] = ("none", "slip 0.05")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for _, flights in self._rows(effort):
            yield from flights

    def _rows(self, effort: Effort) -> Iterator[tuple[tuple[str, str, float], list[Flight]]]:
        """What a row is about, and its flights with all seeds."""
        for mission, noise, reserve in product(self.missions, self.noises, self.reserves):
            own = search_flights(effort, mission)
            yield (mission, noise, reserve), [replace(one, reserve=reserve, noise=NOISES[noise]) for one in own]

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        columns = ("mission", "noise", "reserve", "runs", "planned", "again", "moved", "lost in", "lost", "F", "over")
        rows = [(*head, *_reserve_cells([found[flight] for flight in flights])) for head, flights in self._rows(effort)]
        notes = (
            f"Plans of {ALLOCATOR} with {search_iterations(effort)} iterations, a seed each, within the reserve; ORCA. "
            "planned: tasks in the plans, of 31 (mean); again: runs in which the rest was planned again; moved: tasks "
            "that went from one robot to another then, in all runs; lost in: runs in which tasks that were planned are "
            "not done; lost: these tasks, in all runs; F: planned, mean.",
            "over: robots, in all runs, that used more than their capacity.",
            _SLIP,
        )
        return Table(self.number, "Reserve of capacity, and what becomes of plans", columns, tuple(rows), notes)


def _reserve_cells(runs: Sequence[FlightResult]) -> tuple[Cell, ...]:
    return (
        len(runs),
        fmean(flown.planned.tasks_completed for flown in runs),
        sum(flown.report.reallocations > 0 for flown in runs),
        sum(flown.moved for flown in runs),
        sum(flown.lost > 0 for flown in runs),
        sum(flown.lost for flown in runs),
        fmean(total_and_greatest([route.usage for route in flown.planned.routes])[1] for flown in runs),
        sum(flown.over for flown in runs),
    )
