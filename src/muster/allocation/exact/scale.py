"""Costs and weights scaled to whole numbers, so that bounds proven for these hold for the real ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from muster.model.problem import Floats, Problem

Whole = npt.NDArray[np.int64]
_RANGE = 2.0**36  # of sums over a route
_LARGEST_WEIGHT = 2**40
_ROUNDING = 1e-11


@dataclass(frozen=True)
class Scale:
    """How many units make 1: a power of 2, so that multiplying rounds nothing.

    Costs are rounded down. All objectives grow with every cost, so that a plan's value in units is never above its true
    one, and below it by at most `slack`: the roundings of all costs that an objective adds up.
    """

    units: float
    slack: float

    @classmethod
    def of(cls, problem: Problem, largest_sum: float) -> Scale:
        """Units in which the largest sum of a route is in range."""
        units = 2.0 ** math.floor(math.log2(_RANGE / largest_sum)) if largest_sum > 0 else 1.0
        return cls(units, 3 * (len(problem.tasks) + len(problem.robots) + 1) / units)

    def down(self, costs: Floats) -> Whole:
        """Costs in units, rounded down; -1 for those that are infinite."""
        finite = np.isfinite(costs)
        return np.where(finite, np.floor(np.where(finite, costs, 0.0) * self.units), -1).astype(np.int64)

    def at_most(self, value: float) -> int:
        """A limit in units that keeps every plan whose true value keeps the limit, its rounding included."""
        return math.floor(value * (1 + _ROUNDING) * self.units)

    def at_least(self, value: float) -> int:
        """A limit in units that every plan keeps whose true value is at least the limit."""
        return max(0, math.floor((value * (1 - _ROUNDING) - self.slack) * self.units))

    def below(self, value: float) -> int:
        """A value in units, which is not above it."""
        return max(0, math.floor(value * (1 - _ROUNDING) * self.units))

    def up(self, units: float) -> float:
        """What so many units are."""
        return units / self.units


def whole_weights(weights: Sequence[float]) -> list[int] | None:
    """The weights times what makes them whole, as decimals; None if they are too fine for that."""
    exact = [Fraction(str(weight)) for weight in weights]
    factor = math.lcm(*(fraction.denominator for fraction in exact))
    whole = [int(fraction * factor) for fraction in exact]
    return whole if sum(whole) <= _LARGEST_WEIGHT else None
