"""The short form of the campaign: Muster is killed while it commands robots, and goes on."""

import pytest
from tests.muster_robots.kills.campaign import killed
from tests.muster_robots.kills.worlds import Mavlink, PlugIn, Ros2


@pytest.mark.parametrize(
    ("world", "kills"),
    [
        (PlugIn, 8),
        (Ros2, 2),
        (Mavlink, 2),
        *(pytest.param(w, 60, marks=pytest.mark.long) for w in (PlugIn, Ros2, Mavlink)),
    ],
)
def test_after_a_kill_each_task_is_done_once_and_each_robot_is_accounted_for(world, kills):
    counted = killed(kills, first=3, world=world)
    assert counted["kills"] >= kills
    assert counted["runs"] > 0
