"""Table `physics`: plans of ground robots carried out in the physics world, beside the kinematic one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from muster.mission.errors import MissingExtraError
from muster.perception.optional_parts import require_physics
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row
from muster_studies.thesis_6.flights import ALLOCATOR, Flight, FlightResult
from muster_studies.thesis_6.published import excess, plans
from muster_studies.thesis_6.totals import search_iterations

NEAR = "near"
WITHIN = 3.0
"""Per cent of what is used in the kinematic world."""
ALL = "all"
_WHOLE = "31T-6R50-as-run"
_COLUMNS = (
    *("mission", "figure", "robot", "planned", "flown", "physics", "%"),
    *("tasks", "contacts", "apart", "s", "physics s", "mark"),
)


@dataclass(frozen=True)
class BesidePhysics:
    """The published plans of the ground missions, and one of all tasks where the published one leaves some out."""

    number: str = "physics"
    routes: tuple[str, ...] = ("6.8", "6.9", "6.6")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        if lacking_physics() is None:
            for _, flight in self._flights(effort):
                yield from (flight, _in_physics(flight))

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        title = "Flown in the physics world, and in the kinematic one"
        lacking = lacking_physics()
        if lacking is not None:
            return Table(self.number, title, _COLUMNS, (), (lacking,))
        rows = []
        for name, flight in self._flights(effort):
            cells = _rows(found[flight], found[_in_physics(flight)])
            rows += [row(_COLUMNS, {"mission": flight.mission, "figure": name, **one}) for one in cells]
        notes = (
            "planned, flown (in the kinematic world), physics: usage; %: physics against flown. tasks: done there, of "
            "those planned; contacts, apart: there, apart the least distance of two centres. s: until all was over.",
            f"mark: {NEAR} if physics is within {WITHIN:g} % of flown; of a team, too, if all that was planned is "
            "done, without contact.",
            f"{ALLOCATOR}: own plan with {search_iterations(effort)} iterations and seed 0, of all tasks; the "
            f"published one of {_WHOLE} leaves 8 out.",
        )
        return Table(self.number, title, _COLUMNS, tuple(rows), notes)

    def _flights(self, effort: Effort) -> Iterator[tuple[str, Flight]]:
        """Plans by their published figures, as they are carried out in the kinematic world."""
        for number in self.routes:
            for plan in plans(number):
                yield plan.figure, plan.flight()
        yield ALLOCATOR, Flight(mission=_WHOLE, iterations=search_iterations(effort))


def _in_physics(flight: Flight) -> Flight:
    return replace(flight, world="physics")


def lacking_physics() -> str | None:
    """The message about a missing extra, if any."""
    try:
        require_physics("the physics world", "mujoco")
    except MissingExtraError as error:
        return str(error)
    return None


def _rows(kinematic: FlightResult, physics: FlightResult) -> Iterator[dict[str, Cell]]:
    """One for each robot, and one for all."""
    for route, before, after in zip(physics.planned.routes, kinematic.usages, physics.usages, strict=True):
        if before > 0:
            cells = _usages(route.usage, before, after)
            yield {"robot": route.robot, **cells, "mark": _mark(cells)}
    cells = _usages(physics.planned.total_cost, sum(kinematic.usages), sum(physics.usages))
    report = physics.report
    yield {
        "robot": ALL,
        **cells,
        "tasks": f"{physics.planned.tasks_completed - physics.lost}/{physics.planned.tasks_completed}",
        "contacts": report.contacts,
        "apart": report.min_distance_m,
        "s": kinematic.report.mission_time_s,
        "physics s": report.mission_time_s,
        "mark": _mark(cells) if not physics.lost and not report.contacts else "no",
    }


def _usages(planned: float, kinematic: float, physics: float) -> dict[str, float]:
    return {
        "planned": planned,
        "flown": kinematic,
        "physics": physics,
        "%": excess(physics, kinematic),
    }


def _mark(cells: Mapping[str, float]) -> str:
    return NEAR if abs(cells["%"]) <= WITHIN else "more" if cells["%"] > 0 else "less"
