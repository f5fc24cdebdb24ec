"""Moves of several robots: a robot stops at its goal to do its work there, also where it makes way afterwards."""

import numpy as np

from muster.mission.model import Robot
from muster.motion.free_space import GridSpace
from muster.motion.grid import Grid
from muster.traffic.journeys.roadmap_plan import RoadmapPlan
from muster.traffic.journeys.travellers import Stop, Traveller
from muster.traffic.roadmaps.roadmap import Roadmap

LANE = Roadmap.of(
    GridSpace(Grid(np.zeros((8, 80), dtype=bool), 0.1, (0.0, 0.0, 0.0))), 0.3, [(1, 0.4), (2, 0.4), (4, 0.4), (7, 0.4)]
)


def test_moves_after_a_goal_lead_on_from_it():
    """One works half way along a lane for one, and the other goes past that place."""
    plan = RoadmapPlan(LANE)
    first = Traveller(
        Robot(id="a", position=(2.0, 0.4), radius_m=0.3), (2.0, 0.4), (Stop((4.0, 0.4), 2.0),), stays=False
    )
    behind = Traveller(
        Robot(id="b", position=(1.0, 0.4), radius_m=0.3), (1.0, 0.4), (Stop((5.5, 0.4), 2.0),), stays=False
    )
    moves = plan([first, behind]).moves
    for traveller, goal in ((0, (4.0, 0.4)), (1, (5.5, 0.4))):
        own = [(move.to, move.stop) for move in moves if move.traveller == traveller]
        at = [to for to, _ in own].index(goal)
        assert [stop for _, stop in own] == [0] * (at + 1) + [1] * (len(own) - at - 1)
    assert [move.stop for move in moves if move.traveller == 0][-1] == 1
