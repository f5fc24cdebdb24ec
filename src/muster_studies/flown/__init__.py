"""Planned times beside those of the simulated world."""
