"""Planned times beside those of the simulated world."""

from muster_studies.flown.study import FLOWN

__all__ = ["FLOWN"]
