"""The interface of a peer: a solver from elsewhere that solves an instance within a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from muster.mission.errors import MissingExtraError
from muster_studies.peers.instance import Instance, Routes

EXTRA = "studies"


@dataclass(frozen=True)
class Answer:
    """What a peer found.

    Parameters
    ----------
    routes
        for each robot the tasks of the instance; None where the peer found no plan.
    claimed
        the objective that the peer itself counts, in metres or seconds.
    build_s
        how long it took to hand over the model; not part of the time limit.
    """

    routes: Routes | None
    claimed: float | None = None
    build_s: float = 0.0


class Peer(Protocol):
    """A solver from elsewhere.

    `distribution` is the package that has it; `random` tells whether the seed makes a difference, `by_wall_clock`
    whether it can be stopped by the wall clock alone, not by processor time.
    """

    name: str
    distribution: str
    settings: str
    random: bool
    by_wall_clock: bool

    def cannot(self, instance: Instance) -> str | None:
        """What the peer cannot express, if it cannot take the instance at all."""
        ...

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        """Answer the instance; the processor time counts from when the model is handed over.

        Raises
        ------
        MissingExtraError
            if the solver is not installed.
        """
        ...


def missing(name: str) -> MissingExtraError:
    """What to raise where a solver is not installed."""
    return MissingExtraError(EXTRA, f"the comparison with {name}")
