"""Carrying a plan out: dispatch, monitoring, re-allocation. Robots are reached through ports alone."""
