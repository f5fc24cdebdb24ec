"""The study: how long ways over areas are, and how well they are shared.

No way is shorter than the area divided by the width of a lane, but for one width. On a map of cells twice as wide as a
lane the spanning tree of [gabriely2001] has a closed way of just that length, and [kapoutsis2017] (DARP) gives each of
n robots one n-th of it where a division into connected parts of equal size exists. These are known without running it.
For twenty regions two planners' ways are published [apostolidis2022], with the share of each region that they see.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from muster.mission.model import Mission
from muster.planning.judging import verify
from muster.planning.solve import solve
from muster.running.simulation import carry_out
from muster_studies.areas.regions import PublishedWay, regions
from muster_studies.areas.shapes import GRIDS, SHAPES, Field, field_of_grid, random_field
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.instances.random_areas import surface
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Table

TEAMS = (1, 2, 3, 5)
_AREAS, _QUICK_AREAS = 200, 10
_ITERATIONS, _QUICK_ITERATIONS = 3000, 300
_GROUPS = ((100.0, "over 100"), (20.0, "20 to 100"), (0.0, "less than 20"))
"""Of random areas, by their side in lanes: the square root of the area over the width."""


@dataclass(frozen=True)
class Job:
    """One area, and into how many parts it is split; or the mission with so many robots."""

    field: Field | None = None
    parts: int = 1
    iterations: int = 0


@dataclass(frozen=True)
class Found:
    """What one job came to: lengths in metres, times in seconds."""

    bound_m: float = 0.0
    way_m: float = 0.0
    longest_m: float = 0.0
    mean_m: float = 0.0
    lanes: int = 0
    unseen: float = 0.0
    seconds: float = 0.0
    planned_s: float = 0.0
    flown_s: float = 0.0


def covered(field: Field, parts: int) -> Found:
    """Cover an area; how long the parts are, and which share of it is not seen."""
    import shapely

    from muster.motion.areas.coverage_path import coverage_path
    from muster.motion.areas.lanes import swaths
    from muster.motion.areas.split import parts_of, way_m

    begin = time.process_time()
    path = coverage_path(field.area, field.holes, field.width_m, None, cross_holes=False)
    shares = [way_m(path, part) for part in parts_of(path, parts)]
    seconds = time.process_time() - begin
    seen = surface(field.area, field.holes)
    left = shapely.difference(seen, shapely.union_all(swaths(path.lanes, field.width_m)))
    return Found(
        bound_m=seen.area / field.width_m,
        way_m=path.length_m,
        longest_m=max(shares),
        mean_m=sum(shares) / parts,
        lanes=len(path.lanes),
        unseen=left.area / seen.area,
        seconds=seconds,
    )


def team_mission(robots: int) -> Mission:
    """The shipped survey by so many drones, its area split among them; nothing else to do."""
    given = mission_named("field-survey")
    first, task = given.robots[0], given.tasks[0]
    assert task.action is not None
    team = tuple(replace(first, id=f"drone{k}", position=(190.0 + 10 * k, *first.position[1:])) for k in range(robots))
    whole = replace(task, id="field", action=replace(task.action, split=robots, part=None))
    return replace(given, robots=team, tasks=(whole,), rules=replace(given.rules, objective="makespan"))


def flown(robots: int, iterations: int) -> Found:
    """Plan the survey for a team, and carry it out in the kinematic world."""
    mission = team_mission(robots)
    plan = solve(mission, iterations=iterations, seed=1)
    planned = verify(mission, plan).makespan_s
    assert planned is not None, "the plan of an allocator is admissible"
    report = carry_out(mission, plan)
    return Found(planned_s=planned, flown_s=max(report.ends_s.values()))


def perform(job: Job) -> Found:
    if job.field is None:
        return flown(job.parts, job.iterations)
    return covered(job.field, job.parts)


@dataclass(frozen=True)
class Shapes:
    """A row for each awkward shape."""

    number: str = "shapes"
    columns: tuple[str, ...] = ("area", "lanes", "bound m", "way m", "way / bound", "unseen", "s")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        yield from (Job(field) for field in SHAPES.values())

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for name, field in SHAPES.items():
            one = found[Job(field)]
            ratio = one.way_m / one.bound_m
            rows.append((name, one.lanes, one.bound_m, one.way_m, ratio, f"{one.unseen:.0e}", one.seconds))
        notes = (
            "bound: area / width of a lane, below which no way sees all, but for one width. unseen: the share of the "
            "area. s: processor time; the first row has the time in which libraries are loaded.",
        )
        return Table(self.number, "Ways over awkward areas", self.columns, tuple(rows), notes, decimals=3)


@dataclass(frozen=True)
class Drawn:
    """A row for each group of random areas."""

    number: str = "random"
    columns: tuple[str, ...] = ("side in lanes", "areas", "mean way / bound", "worst", "most unseen", "most s")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        count = _QUICK_AREAS if effort.quick else effort.seeds or _AREAS
        yield from (Job(random_field(seed)) for seed in range(count))

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        left = list(self.jobs(effort))
        for least, name in _GROUPS:
            group = [found[job] for job in left if _side(job, found[job]) >= least]
            left = [job for job in left if _side(job, found[job]) < least]
            if group:
                ratios = [one.way_m / one.bound_m for one in group]
                unseen, slowest = max(one.unseen for one in group), max(one.seconds for one in group)
                mean = sum(ratios) / len(ratios)
                rows.append((name, len(group), mean, max(ratios), f"{unseen:.0e}", slowest))
        notes = ("side in lanes: the square root of the area, over the width of a lane.",)
        return Table(self.number, "Random areas with holes", self.columns, tuple(rows), notes, decimals=3)


def _side(job: Job, found: Found) -> float:
    assert job.field is not None
    return float((found.bound_m / job.field.width_m) ** 0.5)


@dataclass(frozen=True)
class Grids:
    """A row for each grid map and team."""

    number: str = "grids"
    columns: tuple[str, ...] = ("map", "robots", "DARP m", "longest m", "longest / DARP", "longest / mean")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        yield from (Job(field_of_grid(rows), parts) for rows in GRIDS.values() for parts in TEAMS)

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for name, cells in GRIDS.items():
            for parts in TEAMS:
                one = found[Job(field_of_grid(cells), parts)]
                each = one.bound_m / parts
                rows.append((name, parts, each, one.longest_m, one.longest_m / each, one.longest_m / one.mean_m))
        notes = (
            "DARP m: one n-th of the free area over the width, the length of each closed way by [kapoutsis2017] "
            "where it finds a division; computed, not run. longest m: of our parts, open ways.",
        )
        return Table(self.number, "Maps of square cells", self.columns, tuple(rows), notes, decimals=3)


@dataclass(frozen=True)
class Regions:
    """A row for each region over which others' ways are published, and one for the means."""

    number: str = "regions"
    columns: tuple[str, ...] = (
        *("region", "lanes", "bound m", "way m", "STC m", "STC sees %", "way / STC"),
        *("boustrophedon m", "boustrophedon sees %", "way / boustrophedon"),
    )

    def jobs(self, effort: Effort) -> Iterator[Job]:
        yield from (Job(region.field) for region in regions())

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        rows: list[tuple[Cell, ...]] = []
        for region in regions():
            one = found[Job(region.field)]
            beside = [_beside(one, way) for way in (region.stc, region.boustrophedon)]
            rows.append((region.name, one.lanes, one.bound_m, one.way_m, *beside[0], *beside[1]))
        means = [_mean([row[k] for row in rows]) for k in range(1, len(self.columns))]
        unseen = max(found[job].unseen for job in self.jobs(effort))
        notes = (
            "Published ways of [apostolidis2022]: STC is closed, the others are open. sees %: as printed; "
            f"ours see all, but for {unseen:.0e}. A way shorter than the bound does not. Means: of what is there.",
        )
        rows.append(("mean", *means))
        return Table(self.number, "Regions with published ways", self.columns, tuple(rows), notes, decimals=3)


def _mean(cells: Sequence[Cell]) -> float | None:
    numbers = [float(cell) for cell in cells if isinstance(cell, int | float)]
    return sum(numbers) / len(numbers) if numbers else None


def _beside(one: Found, way: PublishedWay | None) -> tuple[Cell, Cell, Cell]:
    return (None, None, None) if way is None else (way.way_m, way.seen_percent, one.way_m / way.way_m)


@dataclass(frozen=True)
class Teams:
    """A row for each team that does the shipped survey."""

    number: str = "robots"
    columns: tuple[str, ...] = ("robots", "longest / mean", "planned s", "flown s", "times as fast")

    def jobs(self, effort: Effort) -> Iterator[Job]:
        iterations = effort.iterations or (_QUICK_ITERATIONS if effort.quick else _ITERATIONS)
        for team in TEAMS:
            yield from (Job(parts=team, iterations=iterations), Job(_survey_field(), team))

    def table(self, effort: Effort, found: Mapping[Job, Found]) -> Table:
        jobs = list(self.jobs(effort))
        alone = found[jobs[0]].flown_s
        rows: list[tuple[Cell, ...]] = []
        for job, lengths in zip(jobs[::2], jobs[1::2], strict=True):
            one, shares = found[job], found[lengths]
            balance = shares.longest_m / shares.mean_m
            rows.append((job.parts, balance, one.planned_s, one.flown_s, alone / one.flown_s))
        notes = ("field-survey without hedge and gate; longest / mean: of the lengths of the parts. Kinematic world.",)
        return Table(self.number, "A survey by 1 to 5 drones", self.columns, tuple(rows), notes)


def _survey_field() -> Field:
    from muster.motion.actions import Impossible
    from muster.motion.actions.area_coverage import swath_of

    mission = mission_named("field-survey")
    action = mission.tasks[0].action
    assert action is not None
    swath = swath_of(action, mission.robots[0])
    assert action.area is not None
    assert not isinstance(swath, Impossible)
    return Field(action.area, action.holes, swath.width_m)


_TABLES: tuple[Reproduction[Job, Found], ...] = (Shapes(), Drawn(), Grids(), Regions(), Teams())

AREAS = Repetition(
    **description("areas"),
    reproductions=_TABLES,
    perform=one_by_one(perform),
    seeds=lambda effort: None,
    extras=("map",),
)
