"""Tables of figures of whole teams, for each scenario: under each bid rule, placement and winner rule."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster_studies.auction_5.auctions import BIDS, PUBLISHED_NAMES, Auction, AuctionResult
from muster_studies.auction_5.published import judged_paths, paths
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row

PLACEMENTS = ("append", "insert")
_OF_THE_THESIS = ("total", "max", "average", "average-as-printed")


@dataclass(frozen=True)
class Teams:
    """Published paths, where there are any for a bid, then own ones under each choice of terms.

    `published` is the table of paths for each bid; `same_instance` says whether their lengths are known and compare.
    """

    number: str
    title: str
    mission: str
    published: Mapping[str, str]
    bids: Sequence[str] = _OF_THE_THESIS
    winner: str = "lowest"
    same_instance: bool = True
    notes: tuple[str, ...] = ()
    columns: tuple[str, ...] = ("bid", "placement", "done", "total", "max", "average", "most", "idle", "ms")

    def jobs(self, effort: Effort) -> Iterator[Auction]:
        for bid in self.bids:
            yield from self._auctions(bid)

    def _auctions(self, bid: str) -> Iterator[Auction]:
        for placement in PLACEMENTS:
            yield Auction(mission=self.mission, bid=bid, placement=placement, winner=self.winner)

    def table(self, effort: Effort, held: Mapping[Auction, AuctionResult]) -> Table:
        rows = []
        for bid in self.bids:
            if bid in self.published:
                rows.append(row(self.columns, self._thesis_cells(bid)))
            rows += [row(self.columns, _own_cells(auction, held[auction])) for auction in self._auctions(bid)]
        return Table(self.number, self.title, self.columns, tuple(rows), self.notes)

    def _thesis_cells(self, bid: str) -> dict[str, Cell]:
        number = self.published[bid]
        cells: dict[str, Cell] = {"bid": f"{PUBLISHED_NAMES[bid]}, thesis"}
        if self.same_instance:
            verdict = judged_paths(number)
            cells |= {"total": verdict.total_cost, "max": verdict.max_usage, "average": verdict.average}
        return {**cells, **_shares(list(paths(number).values()))}


def _own_cells(auction: Auction, own: AuctionResult) -> dict[str, Cell]:
    return {
        "bid": auction.bid,
        "placement": auction.placement,
        "total": own.verdict.total_cost,
        "max": own.verdict.max_usage,
        "average": own.verdict.average,
        "ms": 1000 * own.cpu_s,
        **_shares([path.tasks for path in own.verdict.routes]),
    }


def _shares(found: Sequence[Sequence[str]]) -> dict[str, Cell]:
    return {"done": sum(map(len, found)), "most": max(map(len, found)), "idle": sum(1 for path in found if not path)}


SCENARIO_1 = Teams("scenario-1", "Figures of the paths of scenario 1", "auction-1", {"total": "5.15"})
SCENARIO_2 = Teams(
    "scenario-2",
    "Figures of the paths of scenario 2",
    "auction-2-as-run",
    {"total": "5.18", "max": "5.19", "average": "5.20"},
)
_OWN_INSTANCE = (
    "Own rows are of the shipped mission auction-3-seeded: as many drones and tasks as in scenario 3, in areas of the "
    "same size, drawn at random with a fixed seed."
)
SCENARIO_3 = Teams(
    "scenario-3",
    "Figures of the paths of an instance like scenario 3",
    "auction-3-seeded",
    {"total": "5.21", "max": "5.22", "average": "5.23"},
    bids=BIDS,
    same_instance=False,
    notes=(
        "The thesis prints no coordinates of scenario 3: its rows (Tables 5.21 to 5.23) are of another instance. No "
        "lengths of them are known; only how the tasks are shared compares, in kind.",
        _OWN_INSTANCE,
    ),
)
SCENARIO_3_LEAST_CONTESTED = Teams(
    "scenario-3-least-contested",
    "The same instance, the least contested bid wins",
    "auction-3-seeded",
    {},
    bids=BIDS,
    winner="least-contested",
    notes=(_OWN_INSTANCE, "The thesis describes this rule, and prints no results with it."),
)
