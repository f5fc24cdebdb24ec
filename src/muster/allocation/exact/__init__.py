"""Proven optimal plans of small missions: a constraint program for OR-Tools (extra `exact`)."""

from muster.allocation.exact.solving import ExactResult, require_ortools, solve_exactly

__all__ = ["ExactResult", "require_ortools", "solve_exactly"]
