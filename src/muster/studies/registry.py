"""The studies by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Protocol, runtime_checkable

from muster.mission.errors import ParameterError
from muster.mission.hints import did_you_mean
from muster.studies.allocators import Allocators
from muster.studies.auction_5 import Auction5
from muster.studies.effort import Effort
from muster.studies.market_rescue import MarketRescue
from muster.studies.peers import Peers
from muster.studies.rescue import Rescue
from muster.studies.rvo import CollisionAvoidance
from muster.studies.tables import Report
from muster.studies.thesis_3_3 import Thesis33

OnDone = Callable[[int, int], None]
"""Called with the number of runs done, and of all runs."""


class Study(Protocol):
    """A published experiment that can be repeated; `tables` are the numbers of its tables."""

    name: str
    summary: str
    tables: tuple[str, ...]

    def run(self, effort: Effort, workers: int = 1, on_done: OnDone | None = None) -> Report: ...


@runtime_checkable
class Illustrated(Protocol):
    """A study with pictures of the tables that are wanted."""

    def draw(self, effort: Effort, folder: Path) -> list[Path]: ...


_IMPLEMENTATIONS: tuple[Study, ...] = (
    Thesis33(),
    Auction5(),
    MarketRescue(),
    Allocators(),
    Peers(),
    CollisionAvoidance(),
    Rescue(),
)

STUDIES: Mapping[str, Study] = MappingProxyType({study.name: study for study in _IMPLEMENTATIONS})


def study_named(name: str) -> Study:
    """The study of that name.

    Raises
    ------
    ParameterError
        if there is none.
    """
    if name not in STUDIES:
        raise ParameterError(f"study: {name}; expected {' or '.join(STUDIES)}{did_you_mean(name, STUDIES)}")
    return STUDIES[name]
