"""The book of an auction: the bids for each task, its winner and the price. Immutable."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from muster.mission.errors import MusterError

COLUMNS = ("round", "task", "robot", "bid", "winner", "price")
MOST_BIDS_OF_AN_AWARD = 10
"""Bids that an award names; `Book.save` writes all."""


@dataclass(frozen=True)
class Award:
    """How a task of the plan came to its robot.

    `bids` are (robot, bid) of the robots that bid for the task in that round, the best first and at most
    MOST_BIDS_OF_AN_AWARD of them; `bidders` is the number of all.
    """

    round: int
    task: str
    robot: str
    price: float
    bids: tuple[tuple[str, float], ...]
    bidders: int

    @classmethod
    def of(cls, number: int, task: str, robot: str, price: float, bids: Sequence[tuple[str, float]]) -> Award:
        """An award, from all bids for the task, the best first."""
        return cls(number, task, robot, price, tuple(bids[:MOST_BIDS_OF_AN_AWARD]), len(bids))

    def as_dict(self) -> dict[str, Any]:
        head = {"round": self.round, "task": self.task, "robot": self.robot, "price": self.price}
        return {**head, "bids": dict(self.bids), "bidders": self.bidders}


@dataclass(frozen=True)
class Bid:
    """One bid; `winner` and `price` are those of its task if the task was won in this round, else None."""

    round: int
    task: str
    robot: str
    bid: float
    winner: str | None
    price: float | None


TakeBid = Callable[[Bid], None]


@dataclass(frozen=True, kw_only=True)
class Book:
    """What an auction leaves behind besides its plan.

    `awards` holds the tasks of the plan, in the order in which they were won for good. `messages` is None where nothing
    is sent. `done_twice` lists, for each task that several robots have begun, these robots; only robots that agree
    without a centre do that. `for_each_bid` calls a function with every bid of the auction in order; it is None in a
    book that was read from a plan file.
    """

    rounds: int
    messages: int | None = None
    awards: tuple[Award, ...]
    done_twice: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    for_each_bid: Callable[[TakeBid], None] | None = field(default=None, compare=False, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """What is pickled: as in a plan file, the awards and not every bid."""
        return {**self.__dict__, "for_each_bid": None}

    @property
    def central(self) -> bool:
        """Whether somebody asks the robots, so that each bids for all that it can do in every round."""
        return self.messages is None

    @property
    def bids(self) -> tuple[Bid, ...]:
        """Every bid. Of a large auction there are many: `save` keeps none of them in memory."""
        bids: list[Bid] = []
        self._every_bid()(bids.append)
        return tuple(bids)

    def award_of(self, task: str) -> Award | None:
        """How this task came to its robot; None if the plan leaves it out."""
        return next((award for award in self.awards if award.task == task), None)

    def save(self, path: str | Path) -> None:
        """Write every bid as CSV, a line each, with the columns COLUMNS."""
        for_each_bid = self._every_bid()
        try:
            with Path(path).open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(COLUMNS)
                for_each_bid(
                    lambda b: writer.writerow((b.round, b.task, b.robot, b.bid, b.winner or "", _text(b.price)))
                )
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(path)) from None

    def _every_bid(self) -> Callable[[TakeBid], None]:
        if self.for_each_bid is None:
            raise MusterError("book: read from a plan file; expected that of a plan just made, which holds every bid")
        return self.for_each_bid


def _text(price: float | None) -> str:
    return "" if price is None else repr(price)
