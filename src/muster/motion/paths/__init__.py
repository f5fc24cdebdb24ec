"""Paths from a start to a goal: planners behind one interface, and lengths of shortest paths between many places."""

from muster.motion.paths.path_finder import PathFinder, travel_lengths
from muster.motion.paths.planner import Planner
from muster.motion.paths.registry import PLANNERS, find, planner_named

__all__ = ["PLANNERS", "PathFinder", "Planner", "find", "planner_named", "travel_lengths"]
