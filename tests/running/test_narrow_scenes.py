"""Teams get through the narrow places of the generator without a contact; `make campaign-narrow` tries 50 of them."""

import numpy as np
import pytest
from tests.running.narrow.trial import trial

import muster
from muster.generation.narrow import KINEMATICS, PLACES, RADIUS_M
from muster.motion.map_world import World

SMALL = (5, 9, 13)
"""Seeds with few robots: on a circle, in a corridor, in two streams."""
LARGER = (7, 8, 17, 18)


@pytest.mark.parametrize("seed", [*SMALL, *(pytest.param(seed, marks=pytest.mark.long) for seed in LARGER)])
def test_all_get_through_without_a_contact(seed):
    assert trial(seed).failures == []


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("robots", [2, 3, 20, 21, 57, 200])
def test_robots_have_room_where_they_stand_and_where_they_go(place, robots):
    (mission,) = muster.generate("narrow", seed=3, place=place, robots=robots, kinematics=KINEMATICS[0])
    assert len(mission.robots) == robots
    assert len({task.id for task in mission.tasks}) == len(mission.tasks) >= robots
    starts, goals = ([one.position for one in some] for some in (mission.robots, mission.tasks))
    apart = np.linalg.norm(np.array(starts)[:, None] - np.array(starts)[None], axis=2)
    assert (apart + np.eye(robots) > 2 * RADIUS_M).all()
    if mission.map is not None:
        assert (World.of(mission).clearance(np.array([*starts, *goals]), "ground") > RADIUS_M).all()
