"""Trials of auctions without a centre in a simulated network: random teams, conditions and faults by a seed."""

from tests.muster_team.trials.trial import Report, replay

__all__ = ["Report", "replay"]
