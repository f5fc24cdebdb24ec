"""Tables of one round of scenario 1: what each drone bids, what it submits, and who wins (5.2 to 5.14)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.mission.auction_book import Bid
from muster_studies.auction_5.auctions import Auction, AuctionResult
from muster_studies.auction_5.published import content
from muster_studies.comparison_marks import EQUAL
from muster_studies.effort import Effort
from muster_studies.tables import Cell, Table, row

DECIMALS = 1
"""Of a published bid: all are rounded so, none is cut off."""

_AUCTION = Auction(mission="auction-1", bid="total", placement="append")


def as_printed(bid: float) -> str:
    """A bid with the digits that the thesis prints."""
    return f"{bid:.{DECIMALS}f}"


@dataclass(frozen=True)
class Bids:
    """What each drone bids for each task: a row of the thesis, then an own one."""

    number: str

    def jobs(self, effort: Effort) -> Iterator[Auction]:
        yield _AUCTION

    def table(self, effort: Effort, held: Mapping[Auction, AuctionResult]) -> Table:
        published, rows = content(self.number), []
        columns = ("drone", "values", *content("5.1")["positions"], "mark")
        own = held[_AUCTION].bids()[published["round"]]
        for drone, bids in published["bids"].items():
            there = {task: float(bid) for task, bid in bids.items()}
            here = {task: bid.bid for task, bid in own[drone].items()}
            mark = ", ".join(_differences(there, here)) or EQUAL
            rows.append(row(columns, {"drone": drone, "values": "thesis", **there}))
            rows.append(row(columns, {"drone": drone, "values": "own", **here, "mark": mark}))
        rule = f"{EQUAL}: all own bids as published, to the printed digit."
        return Table(self.number, published["title"], columns, tuple(rows), decimals=DECIMALS, mark_rule=rule)


def _differences(there: Mapping[str, float], here: Mapping[str, float]) -> Iterator[str]:
    for task in sorted(there.keys() | here.keys()):
        if (task in there) != (task in here):
            yield f"{task} {'no bid' if task in there else 'bid'}"
        elif as_printed(there[task]) != as_printed(here[task]):
            yield f"{task} {here[task] - there[task]:+.2f}"


@dataclass(frozen=True)
class SubmittedBids:
    """The lowest bid of each drone, and which of them wins."""

    number: str
    columns: tuple[str, ...] = ("drone", "values", "task", "bid", "wins", "mark")

    def jobs(self, effort: Effort) -> Iterator[Auction]:
        yield _AUCTION

    def table(self, effort: Effort, held: Mapping[Auction, AuctionResult]) -> Table:
        published, rows = content(self.number), []
        winner = published["winner"]
        own = held[_AUCTION].bids()[published["round"]]
        for drone, submitted in published["submitted"].items():
            ((task, bid),) = submitted.items()
            there = {"task": task, "bid": float(bid), "wins": _yes((drone, task) == (winner["robot"], winner["task"]))}
            here = _submitted(own[drone])
            rows.append(row(self.columns, {"drone": drone, "values": "thesis", **there}))
            mark = EQUAL if _shown(there) == _shown(here) else "differs"
            rows.append(row(self.columns, {"drone": drone, "values": "own", **here, "mark": mark}))
        rule = f"{EQUAL}: own task, bid (to the printed digit) and winner as published."
        return Table(self.number, published["title"], self.columns, tuple(rows), decimals=DECIMALS, mark_rule=rule)


def _submitted(bids: Mapping[str, Bid]) -> dict[str, Cell]:
    """The lowest of a drone's bids, which it submits."""
    lowest = min(bids.values(), key=lambda bid: bid.bid)
    return {"task": lowest.task, "bid": lowest.bid, "wins": _yes(lowest.winner == lowest.robot)}


def _yes(so: bool) -> str:
    return "yes" if so else "no"


def _shown(cells: Mapping[str, Cell]) -> tuple[Cell, ...]:
    return tuple(as_printed(cell) if isinstance(cell, float) else cell for cell in cells.values())
