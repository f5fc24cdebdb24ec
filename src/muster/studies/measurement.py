"""What a bench measures."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Measurement:
    """One line of the table: what was measured, the median and range over the runs, and the aim it stands against."""

    name: str
    unit: str
    median: float
    lowest: float
    highest: float
    runs: int
    aim: str
    note: str = ""
