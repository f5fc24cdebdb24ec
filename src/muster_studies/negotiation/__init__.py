"""Auctions without a centre in a simulated network: random teams, weather and faults, by a seed, and what must hold."""

from muster_studies.negotiation.trial import Report, replay

__all__ = ["Report", "replay"]
