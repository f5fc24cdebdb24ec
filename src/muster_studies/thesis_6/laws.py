"""Table `laws`: the published plans carried out under each law of motion, in both worlds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from muster.motion.laws import LAWS
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table
from muster_studies.thesis_6.flights import Flight, FlightResult
from muster_studies.thesis_6.physics import lacking_physics
from muster_studies.thesis_6.published import excess, plans

_TRACKING = "trajectories followed: "


@dataclass(frozen=True)
class ByLaw:
    """The published plans of the ground missions by each law."""

    number: str = "laws"
    routes: tuple[str, ...] = ("6.8", "6.9", "6.6")

    def jobs(self, effort: Effort) -> Iterator[Flight]:
        for _, flight in self._flights():
            yield flight

    def table(self, effort: Effort, found: Mapping[Flight, FlightResult]) -> Table:
        rows = []
        for figure, flight in self._flights():
            result = found[flight]
            planned, flown = sum(route.usage for route in result.planned.routes), sum(result.usages)
            report = result.report
            cells: dict[str, Cell] = {
                "mission": flight.mission,
                "figure": figure,
                "world": flight.world,
                "law": flight.law,
                "planned": planned,
                "flown": flown,
                "%": excess(flown, planned),
                "tasks": f"{len(report.tasks_done)}/{len(report.tasks_done) + result.lost}",
                "contacts": report.contacts,
                "apart": report.min_distance_m,
                "s": report.mission_time_s,
                "off": _off(result),
            }
            rows.append(cells)
        notes: tuple[str, ...] = (
            "law: as `muster simulate --law` has it. planned, flown: usage of the team, metres; %: flown against "
            "planned. apart: the least distance of two centres, m. s: until all was over.",
            "off: by how many metres robots were off their trajectories at a moment, on average and at most, while "
            "they followed them; [market-paper], (7), per sample.",
        )
        missing = lacking_physics()
        return Table.of_cells(
            self.number, "Carried out by law of motion", rows, (*notes, missing) if missing else notes
        )

    def _flights(self) -> Iterator[tuple[str, Flight]]:
        worlds = ("kinematic",) if lacking_physics() else ("kinematic", "physics")
        for number in self.routes:
            for plan in plans(number):
                for world in worlds:
                    for law in LAWS:
                        yield plan.figure, replace(plan.flight(), world=world, law=law)


def _off(result: FlightResult) -> str | None:
    """The remark on trajectories in short."""
    for remark in result.report.remarks:
        if remark.startswith(_TRACKING):
            return remark.removeprefix(_TRACKING + "off by ").replace(" on average", "").replace(" at most", "")
    return None
