"""Tables 6.2 and 6.3: what the drones used, calculated, in Gazebo, and in both worlds here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.running.worlds import WORLDS
from muster_studies.comparison_marks import ERRATUM, differences
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.runs import judged
from muster_studies.tables import Cell, Notes, Table, row
from muster_studies.thesis_6.published import PublishedPlan, excess, plans, tables
from muster_studies.thesis_6.routes import USAGE_RULE, contacts_of, published_cells
from muster_studies.thesis_6.totals import TOTALS_RULE, total_and_greatest, total_cells
from muster_studies.thesis_6_1.flights import Flight, FlightResult
from muster_studies.thesis_6_1.published import flown_plan, thirty


def _flights(effort: Effort, plan: PublishedPlan) -> dict[str, Flight]:
    """By world; a plan that the thesis did not carry out is not flown in physics where time is short."""
    worlds = WORLDS.shipped if plan is flown_plan() or not effort.quick else WORLDS.shipped[:1]
    return {world: thirty(plan, world=world) for world in worlds}


def _calculated(plan: PublishedPlan) -> list[float]:
    """As the thesis calculates: to the middle of a task, and a typed cost there."""
    return [route.usage for route in judged(plan.mission, plan.ignored, dict(plan.sequences)).routes]


@dataclass(frozen=True)
class DroneUsages:
    """Table 6.2: a row for each robot of each plan."""

    number: str = "6.2"
    columns: tuple[str, ...] = (
        "figure", "robot", "tasks", "thesis", "own", "mark", "Gazebo", "Gazebo %",
        "ways", "kinematic", "physics", "physics %", "in plane",
    )  # fmt: skip

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for plan in plans("6.2"):
            yield from _flights(effort, plan).values()

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        notes, rows, remarks = Notes(), [], []
        for plan in plans("6.2"):
            flown = {world: found[flight] for world, flight in _flights(effort, plan).items()}
            for k, (robot, own) in enumerate(zip(plan.routes, _calculated(plan), strict=True)):
                cells = _published(plan, robot, own, notes) | _flown_cells(flown, k)
                rows.append(row(self.columns, cells))
            remarks += [_remark(plan, world, one) for world, one in flown.items()]
        title = f"{tables()['6.2']['title']}: usage of each robot, metres"
        lines = (*notes.lines(), *remarks, *_NOTES)
        return Table(self.number, title, self.columns, tuple(rows), lines, mark_rule=USAGE_RULE)


_NOTES = (
    "own: calculated as the thesis does, to the middle of a task and a typed cost there. ways: planned in space with "
    "the ways of the tasks and the climb to them. kinematic, physics: flown, by odometry; physics %: against ways. in "
    "plane: how far the body went in physics, heights not counted, which is what the thesis measured.",
    "Gazebo %: against own. The thesis' drones stop short of goals by a threshold that is not printed.",
)


def _published(plan: PublishedPlan, robot: str, own: float, notes: Notes) -> dict[str, Cell]:
    cells, gazebo = published_cells(plan, robot, own, notes), plan.usage(robot, "gazebo")
    return cells if gazebo is None else {**cells, "Gazebo %": excess(gazebo, own)}


def _flown_cells(flown: Mapping[str, FlightResult], k: int) -> dict[str, Cell]:
    ways = flown["kinematic"].planned.routes[k].usage
    cells: dict[str, Cell] = {"ways": ways, **{world: one.usages[k] for world, one in flown.items()}}
    if "physics" in flown:
        used = flown["physics"].usages[k]
        cells |= {"physics %": excess(used, ways), "in plane": flown["physics"].in_plane_m[k]}
    return cells


def _remark(plan: PublishedPlan, world: str, flown: FlightResult) -> str:
    report = flown.report
    return (
        f"{plan.figure} ({plan.allocator}) in the {world} world: {len(report.tasks_done)} of "
        f"{flown.planned.tasks_total} tasks done, {contacts_of(report)}; "
        f"{report.mission_time_s:.0f} s, {flown.looks} pictures."
    )


@dataclass(frozen=True)
class DroneTotals:
    """Table 6.3: totals of each plan."""

    number: str = "6.3"
    columns: tuple[str, ...] = ("plan", "values", "C", "C %", "F", "F %", "mark")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        yield from DroneUsages().jobs(effort)

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        notes, rows = Notes(), []
        for plan in plans("6.2"):
            flown = {world: found[flight] for world, flight in _flights(effort, plan).items()}
            label = f"{plan.figure} {plan.allocator}"
            rows += [row(self.columns, {"plan": label, **cells}) for cells in self._rows(plan, flown, notes)]
        remark = "%: more than own. in plane, physics: as the thesis measured it, heights not counted."
        title, lines = tables()["6.3"]["title"], (*notes.lines(), remark)
        return Table(self.number, title, self.columns, tuple(rows), lines, mark_rule=TOTALS_RULE)

    def _rows(self, plan: PublishedPlan, flown: Mapping[str, FlightResult], notes: Notes) -> Iterator[dict[str, Cell]]:
        own = _calculated(plan)
        base = total_and_greatest(own)
        for record in (record for record in tables()["6.3"]["rows"] if record["allocator"] == plan.allocator):
            measured = "measured" in record
            sums = total_and_greatest(plan.usages("gazebo")) if measured else base
            right = {"C": corrected(record)["total_cost"], "F": corrected(record)["total+max"]}
            marks = [ERRATUM + " " + notes.number(f"{plan.figure}: {text}.") for text in errata(record)]
            yield {
                "values": "thesis, Gazebo" if measured else "thesis",
                **({"C %": excess(right["C"], base[0]), "F %": excess(right["F"], base[1])} if measured else {}),
                "C": printed(record)["total_cost"],
                "F": printed(record)["total+max"],
                "mark": " ".join([differences(right, dict(zip("CF", sums, strict=True)), "CF"), *marks]),
            }
        yield {"values": "own", "C": base[0], "F": base[1]}
        yield {"values": "ways", **total_cells([route.usage for route in flown["kinematic"].planned.routes], own)}
        for world, one in flown.items():
            yield {"values": world, **total_cells(one.usages, own)}
        if "physics" in flown:
            yield {"values": "in plane, physics", **total_cells(flown["physics"].in_plane_m, own)}
