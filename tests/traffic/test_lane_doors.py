"""Which ways a closed lane leaves open."""

import numpy as np
import pytest

from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Mission, Robot, Task
from muster.traffic.roadmaps.doors import RoadmapDoors

A, B, AMID, FARTHER, BESIDE, AWAY = (0, 0), (8, 0), (3, 0), (5, 0.04), (3, 0.2), (3, 2)


@pytest.fixture
def doors():
    robot = Robot(id="r", position=(0.0, 0.0), radius_m=0.3)
    lanes = Lanes(nodes={"a": A, "b": B}, edges=(Lane(start="a", end="b", id="ab", both_ways=True),))
    mission = Mission(robots=(robot,), tasks=(Task(id="t", position=(8.0, 0.0)),), lanes=lanes)
    return RoadmapDoors.of(mission, "ground", None)


@pytest.mark.parametrize(
    ("begin", "end", "is_open"),
    [
        (A, B, False),
        (B, A, False),
        (A, AMID, False),
        (AWAY, AMID, False),
        (AMID, FARTHER, True),
        (FARTHER, B, True),
        (AMID, A, True),
        (BESIDE, AMID, True),
        (AMID, AWAY, True),
        (AWAY, (3, -2), True),
        (B, (8, 6), True),
        ((-3, 0), A, True),
        ((-3, 0), (12, 0), False),
    ],
)
def test_a_closed_lane_is_left_but_not_entered(doors, begin, end, is_open):
    piece = np.array([[begin, end]], dtype=np.float64)
    assert doors.open_ways(piece, {"ab"}, 0.3).tolist() == [is_open]
    assert doors.open_ways(piece, (), 0.3).tolist() == [True]
