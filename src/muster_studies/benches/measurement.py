"""Measurements of benches."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True)
class Measurement:
    """One line of the table: the quantity, its median and range over the runs, and the aim."""

    name: str
    unit: str
    median: float
    lowest: float
    highest: float
    runs: int
    aim: str
    note: str = ""

    @classmethod
    def over_runs(cls, name: str, unit: str, values: Sequence[float], aim: str, note: str = "") -> Self:
        """The measurement of the values of several runs."""
        return cls(name, unit, statistics.median(values), min(values), max(values), len(values), aim, note)

    @classmethod
    def once(cls, name: str, unit: str, value: float, aim: str, note: str = "") -> Self:
        """The measurement of a single run."""
        return cls.over_runs(name, unit, [value], aim, note)
