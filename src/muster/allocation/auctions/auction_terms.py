"""The terms of an auction: the bid rule, the place of a task in a route, the winner rule."""

from __future__ import annotations

from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.values.ranges import require_within

BIDS = ("total", "max", "average", "average-as-printed", "total+max", "makespan")
PLACEMENTS = ("append", "insert")
WINNERS = ("lowest", "least-contested")

_MOST_WEIGHT = 1e6
_WORDS = {"bid": BIDS, "placement": PLACEMENTS, "winner": WINNERS}


@dataclass(frozen=True, kw_only=True)
class BidTerms:
    """What robots bid, and where a task goes in a route.

    `bid` None is the rule named as the objective. The weights make bids worse by a factor: 1, plus battery_weight times
    the share of its battery that a robot has used up (as it reports its charge, else by its usage and capacity), plus
    suitability_weight times what its suitability for the task lacks to 1, plus quality_weight times what the lowest
    quality among the skills that the task requires lacks to 1.
    [auction-thesis], section 6.2, leaves all three to future work.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    bid: str | None = None
    placement: str = "insert"
    battery_weight: float = 0.0
    suitability_weight: float = 0.0
    quality_weight: float = 0.0

    def __post_init__(self) -> None:
        for name, words in _WORDS.items():
            value = getattr(self, name, words[0])
            if value not in words and not (name == "bid" and value is None):
                raise ParameterError(f"{name}: {value}; expected {' or '.join(words)}")
        require_within(0, _MOST_WEIGHT, battery_weight=self.battery_weight, suitability_weight=self.suitability_weight)
        require_within(0, _MOST_WEIGHT, quality_weight=self.quality_weight)

    @property
    def winner_rule(self) -> str:
        """Of WINNERS."""
        return WINNERS[0]

    @property
    def weights(self) -> tuple[float, float, float]:
        """What counts of the energy that a robot has used up, and of the suitability and quality that it lacks."""
        return self.battery_weight, self.suitability_weight, self.quality_weight


@dataclass(frozen=True, kw_only=True)
class Terms(BidTerms):
    """Terms of an auction in rounds: the bid terms, and which bid wins a round."""

    winner: str = "lowest"

    @property
    def winner_rule(self) -> str:
        return self.winner
