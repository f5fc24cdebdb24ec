"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster_studies.auction_5.auctions import Auction, AuctionResult, hold
from muster_studies.auction_5.paths import Paths, Positions
from muster_studies.auction_5.pictures import FIGURES
from muster_studies.auction_5.rounds import Bids, SubmittedBids
from muster_studies.auction_5.teams import SCENARIO_1, SCENARIO_2, SCENARIO_3, SCENARIO_3_LEAST_CONTESTED
from muster_studies.descriptions import description
from muster_studies.repetition import Repetition, Reproduction, one_by_one

_NOT_AS_DESCRIBED = (
    "average is the bid that the text and the literature describe: the growth of the sum of the path lengths at which "
    "the tasks are reached. It gives the paths of Table 5.19 again, not those of Table 5.20, with append and insert "
    "alike. average-as-printed, the number of tasks times the length of the path, is fitted to Table 5.20."
)

_TABLES: tuple[Reproduction[Auction, AuctionResult], ...] = (
    Bids("5.2"),
    *(table for k in range(3, 15, 2) for table in (Bids(f"5.{k}"), SubmittedBids(f"5.{k + 1}"))),
    Paths("5.15", bids=("total",), placements=("append",)),
    SCENARIO_1,
    Positions(),
    Paths("5.18", bids=("total",), placements=("insert",)),
    Paths("5.19", bids=("max",), placements=("append", "insert")),
    Paths(
        "5.20",
        bids=("average-as-printed", "average"),
        placements=("insert",),
        remarks=(("average", _NOT_AS_DESCRIBED),),
    ),
    SCENARIO_2,
    SCENARIO_3,
    SCENARIO_3_LEAST_CONTESTED,
)

AUCTION_5 = Repetition(
    **description("auction-5"),
    reproductions=_TABLES,
    perform=one_by_one(hold),
    seeds=lambda _: None,
    figures=FIGURES,
)
"""Sequential single-item auction of tasks among drones, bid by bid and under each rule."""
