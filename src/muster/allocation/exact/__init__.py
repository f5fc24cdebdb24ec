"""Proven optimal plans of small missions: a constraint program for OR-Tools (extra `exact`)."""

from muster.allocation.exact.solving import ExactResult, solve_exactly

__all__ = ["ExactResult", "solve_exactly"]
