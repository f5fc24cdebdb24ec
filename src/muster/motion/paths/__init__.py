"""Ways from a start to a goal: planners behind one interface, and the lengths of shortest ways between many places."""

from muster.motion.paths.planner import Planner
from muster.motion.paths.registry import PLANNERS, find, planner_named
from muster.motion.paths.way_finder import WayFinder, travel_lengths

__all__ = ["PLANNERS", "Planner", "WayFinder", "find", "planner_named", "travel_lengths"]
