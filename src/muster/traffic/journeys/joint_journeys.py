"""Journeys of travellers through all their stops, among each other and each alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from muster.traffic.journeys.travellers import Traveller

if TYPE_CHECKING:
    from muster import core
    from muster.traffic.journeys.roadmap_network import Network


class TimedMove(NamedTuple):
    """When a robot sets out from one point to another, by number, and the number of the stop to which that leads."""

    start_s: float
    point: int
    to: int
    stop: int


class Journey(NamedTuple):
    """When a robot has stayed at its last stop, and its moves; inf where no path is found, NaN where none can be."""

    end_s: float
    moves: tuple[TimedMove, ...]


class JointJourneys:
    """Journeys of travellers on a roadmap, whose stops can be changed: those of the others stay as far as they can.

    Parameters
    ----------
    on
        the roadmap with the places of all.
    travellers
        whose journeys they are.
    shared
        their ways.
    """

    def __init__(self, on: Network, travellers: Sequence[Traveller], shared: core.SharedWays) -> None:
        self._on, self._travellers, self._shared = on, list(travellers), shared
        self._before = self._travellers

    @property
    def together(self) -> list[Journey]:
        """Of each among the others."""
        return self._journeys(*self._shared.paths())

    @property
    def alone(self) -> list[Journey]:
        """Of each, if nobody else were on the roadmap but those who never leave."""
        return self._journeys(*self._shared.paths_alone())

    def knows(self, travellers: Sequence[Traveller]) -> bool:
        """Whether the roadmap has the places of all."""
        return all(map(self._on.knows, travellers))

    def change(self, travellers: Sequence[Traveller], *, ways: int) -> None:
        """The same robots go elsewhere; so many ways are sought beside those of the changed ones."""
        pairs = enumerate(zip(self._travellers, travellers, strict=True))
        changes = [(k, self._on.told(after)) for k, (before, after) in pairs if before != after]
        self._before, self._travellers = self._travellers, list(travellers)
        self._shared.change(changes, ways=ways)

    def undo(self) -> None:
        """Take the last change back."""
        self._travellers = self._before
        self._shared.undo()

    def _journeys(self, moves: Sequence[tuple[float, int, int, int]], ends: Sequence[float]) -> list[Journey]:
        own: list[list[TimedMove]] = [[] for _ in ends]
        for start_s, traveller, edge, stop in moves:
            point, to = self._on.ends[edge]
            own[traveller].append(TimedMove(start_s, point, to, stop))
        return [Journey(end_s, tuple(moves)) for end_s, moves in zip(ends, own, strict=True)]
