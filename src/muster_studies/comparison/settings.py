"""How all runs of a comparison are made."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.mission.errors import ParameterError
from muster.mission.model import OBJECTIVES
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown

DEFAULT_TIME_LIMIT_S = 1.0
CLOCKS = ("wall", "processor")


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How all runs of a comparison are made.

    Parameters
    ----------
    time_limit, iterations
        when an allocator stops, in seconds and in iterations; 1 s if neither is given. An allocator of a single
        pass has no iterations, but keeps the time limit.
    clock
        what seconds are of: `wall`, or `processor` time, which other programs on the machine do not use up. An
        allocator that waits for other processes needs `wall`.
    objective
        instead of the missions' own.
    give_up
        a run is ended after so many seconds, and its row says so; None: none is.

    Raises
    ------
    ParameterError
    """

    time_limit: float | None = None
    iterations: int | None = None
    clock: str = "wall"
    objective: str | None = None
    give_up: float | None = None

    def __post_init__(self) -> None:
        if self.time_limit is None and self.iterations is None:
            object.__setattr__(self, "time_limit", DEFAULT_TIME_LIMIT_S)
        for name in ("time_limit", "give_up"):
            value = getattr(self, name)
            if value is not None and not (_is_number(value) and 0 < value < math.inf):
                raise ParameterError(f"{name}: {shown(value)}; expected seconds, above 0")
        if self.iterations is not None and not (_is_whole(self.iterations) and self.iterations >= 0):
            raise ParameterError(f"iterations: {shown(self.iterations)}; expected a whole number of at least 0")
        for name, words in (("clock", CLOCKS), ("objective", OBJECTIVES)):
            value = getattr(self, name)
            if value not in words and not (name == "objective" and value is None):
                hint = did_you_mean(value, words) if isinstance(value, str) else ""
                raise ParameterError(f"{name}: {shown(value)}; expected {' or '.join(words)}{hint}")

    @property
    def text(self) -> str:
        """The limits, for people."""
        seconds = None if self.time_limit is None else f"{self.time_limit:g} s of {self.clock} time"
        count = None if self.iterations is None else f"{self.iterations} iterations"
        return " or ".join(filter(None, (seconds, count)))


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
