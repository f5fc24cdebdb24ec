"""A map that a team has built is the same after it was written as text and read again."""

import json

import numpy as np
import pytest

from muster import Simulation, load, solve
from muster.motion.map_world import body_of
from muster.motion.unreachable_places import checked_world
from muster.perception.team_map import TeamMap
from muster_studies.unknown.scenes import random_space, random_world


@pytest.mark.parametrize(
    "mission", [random_world(1), random_space(1), load("market-rescue-arena")], ids=lambda m: m.name
)
@pytest.mark.parametrize("seconds", [3.0, pytest.param(12.0, marks=pytest.mark.long)])
def test_a_map_comes_back_as_it_was(mission, seconds):
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    while not run.done and run.time_s < seconds:
        run.advance(seconds)
    was = run._ground.map
    again = TeamMap(checked_world(mission), mission)
    again.resume(json.loads(json.dumps(was.snapshot())))
    seen = [(was.ground.seen, again.ground.seen)]
    if was.air is not None:
        seen.append((was.air.seen, again.air.seen))
    for before, after in seen:
        assert before.occupied.any()
        assert (before.known == after.known).all()
        assert (before.occupied == after.occupied).all()
        assert (before.near == after.near).all()
        cells = np.argwhere(before.occupied)
        cell_m = getattr(before.frame, "resolution_m", None) or before.frame.cell_m
        assert np.abs(before.points_in(cells) - after.points_in(cells)).max() < 0.01 * cell_m
    for robot in mission.robots:
        body, start = body_of(robot), run._executor.crew[robot.id].position[: mission.dimensions]
        for task in mission.tasks:
            ways = [one.of(body).way(body, start, task.position) for one in (was, again)]
            lengths = [getattr(way, "length_m", None) for way in ways]
            assert lengths[0] == pytest.approx(lengths[1], rel=0.01, abs=0.02)
