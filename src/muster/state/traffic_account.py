"""Who held up whom in traffic, added up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from muster.motion.port import Place


@dataclass(frozen=True)
class HeldUp:
    """For how long, and how often, one robot held up another in traffic, and where that one stood the longest time."""

    waiting_s: float
    times: int
    longest_s: float
    place: Place

    @staticmethod
    def once(seconds: float, place: Place) -> HeldUp:
        return HeldUp(seconds, 1, seconds, place)

    def and_again(self, seconds: float, place: Place) -> HeldUp:
        longest = (seconds, place) if seconds > self.longest_s else (self.longest_s, self.place)
        return HeldUp(self.waiting_s + seconds, self.times + 1, *longest)


@dataclass
class TrafficAccount:
    """Who held up whom, by both: its size does not grow with time."""

    pairs: dict[str, dict[str, HeldUp]] = field(default_factory=dict)

    def add(self, robot: str, seconds: Mapping[str, float], place: Place) -> None:
        """A robot has waited in traffic: seconds by robot that it waited for."""
        for other, waited_s in seconds.items():
            if waited_s > 0:
                before = self.pairs.setdefault(robot, {}).get(other)
                more = HeldUp.once(waited_s, place) if before is None else before.and_again(waited_s, place)
                self.pairs[robot][other] = more

    @property
    def waiting_s(self) -> float:
        """Seconds that all robots waited in traffic."""
        return sum(held_up.waiting_s for others in self.pairs.values() for held_up in others.values())
