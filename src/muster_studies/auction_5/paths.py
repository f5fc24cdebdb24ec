"""Tables of navigation paths, 5.15 and 5.18 to 5.20, and of where the tasks are, 5.17."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.verification import RouteFigures
from muster_studies.auction_5.auctions import Auction, AuctionResult
from muster_studies.auction_5.published import content, judged_paths
from muster_studies.comparison_marks import EQUAL, ERRATUM
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.runs import mission_named
from muster_studies.tables import Cell, Notes, Table, row

OTHER_TASKS = "other tasks"


@dataclass(frozen=True)
class Paths:
    """The navigation path of each drone: a row of the thesis, then one for each own auction.

    `bids` and `placements` are those of the own auctions; `remarks`, by bid, say why another path comes out.
    """

    number: str
    bids: tuple[str, ...]
    placements: tuple[str, ...]
    remarks: tuple[tuple[str, str], ...] = ()
    columns: tuple[str, ...] = ("drone", "values", "tasks", "length", "mark")

    def jobs(self, effort: Effort) -> Iterator[Auction]:
        mission = content(self.number)["plans"][0]["run_as"]
        for bid in self.bids:
            for placement in self.placements:
                yield Auction(mission=mission, bid=bid, placement=placement)

    def table(self, effort: Effort, held: Mapping[Auction, AuctionResult]) -> Table:
        notes, rows = Notes(), []
        for k, there in enumerate(judged_paths(self.number).routes):
            rows.append(row(self.columns, _cells("thesis", there)))
            for auction in self.jobs(effort):
                own = held[auction].verdict.routes[k]
                mark = EQUAL if own.tasks == there.tasks else OTHER_TASKS + self._remark(auction, notes)
                rows.append(row(self.columns, {**_cells(self._values(auction), own), "mark": mark}))
        title = f"{content(self.number)['title']}; own: {self._shared_terms()}"
        rule = f"{EQUAL}: the own path has the published tasks in their order."
        return Table(self.number, title, self.columns, tuple(rows), notes.lines(), mark_rule=rule)

    def _values(self, auction: Auction) -> str:
        """Where an own row comes from: the terms that differ within the table."""
        differ = [*([auction.bid] * (len(self.bids) > 1)), *([auction.placement] * (len(self.placements) > 1))]
        return ", ".join(differ) or "own"

    def _shared_terms(self) -> str:
        return ", ".join(terms[0] for terms in (self.bids, self.placements) if len(terms) == 1)

    def _remark(self, auction: Auction, notes: Notes) -> str:
        text = dict(self.remarks).get(auction.bid)
        return "" if text is None else f" {notes.number(text)}"


def _cells(values: str, path: RouteFigures) -> dict[str, Cell]:
    return {"drone": path.robot, "values": values, "tasks": path.tasks, "length": path.usage}


@dataclass(frozen=True)
class Positions:
    """Table 5.17: the tasks of scenario 2; own are those of the mission that is run."""

    number: str = "5.17"
    paths: str = "5.18"
    columns: tuple[str, ...] = ("task", "position, thesis", "position, own", "mark")

    def jobs(self, effort: Effort) -> Iterator[Auction]:
        yield from ()

    def table(self, effort: Effort, held: Mapping[Auction, AuctionResult]) -> Table:
        published, notes, rows = content(self.number), Notes(), []
        positions = published["positions"]
        there, right = printed(positions), corrected(positions)
        misprints = {text.split(" ")[0]: text for text in errata(positions)}
        mission = content(self.paths)["plans"][0]["run_as"]
        for task in mission_named(mission).tasks:
            marks = [EQUAL if list(task.position) == right[task.id] else "differs"]
            if task.id in misprints:
                marks.append(f"{ERRATUM} {notes.number(f'{misprints[task.id]}.')}")
            own = tuple(f"{value:g}" for value in task.position)
            rows.append((task.id, tuple(map(str, there[task.id])), own, " ".join(marks)))
        remark = (
            f"Run as {mission}. The mission as printed is auction-2: with it none of Tables 5.18 to 5.20 comes out."
        )
        rule, lines = f"{EQUAL}: the task of the mission is where the thesis puts it.", (*notes.lines(), remark)
        return Table(self.number, published["title"], self.columns, tuple(rows), lines, mark_rule=rule)
