"""Quantiles of a stream in bounded memory: counts in bins whose limits grow by a fixed ratio ([masson2019])."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

_RATIO = 1.02  # of the limits of a bin; a quantile is off by half of that
_LEAST = 1e-4  # below which all is counted as 0


@dataclass
class Quantiles:
    """Values of at least 0, such as seconds, as a histogram with relative error 0.01.

    Parameters
    ----------
    count, most
        how many values there were, and the greatest.
    bins
        how many fell into each bin, by its number.
    """

    count: int = 0
    most: float = 0.0
    bins: dict[int, int] = field(default_factory=dict)

    def add(self, value: float) -> None:
        self.count += 1
        self.most = max(self.most, value)
        number = _bin(value)
        self.bins[number] = self.bins.get(number, 0) + 1

    def at(self, share: float) -> float:
        """The value that a share of all values, 0 to 1, do not exceed; 0 without values."""
        left = share * self.count
        for number in sorted(self.bins):
            left -= self.bins[number]
            if left <= 1e-9:
                return min(self.most, _upper(number))
        return self.most


def _bin(value: float) -> int:
    return 0 if value < _LEAST else 1 + math.ceil(math.log(value / _LEAST) / math.log(_RATIO))


def _upper(number: int) -> float:
    return 0.0 if number == 0 else float(_LEAST * _RATIO ** (number - 1))
