"""Trials of auctions without a centre in a simulated network: random teams, network conditions and faults by a seed."""

from muster.running.negotiation_trials.trial import Report, replay

__all__ = ["Report", "replay"]
