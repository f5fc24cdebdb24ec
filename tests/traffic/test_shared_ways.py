"""Ways of several robots over a roadmap: through several stops, free of each other, better by planning few anew."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from muster.core import SafeIntervals, Traveller
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.single_moves import MovePlanner
from muster_studies.jams import scenes

HOLD_S = 5.0


class Aisles:
    """Robots that each visit some tasks of a store of aisles, and come home."""

    def __init__(self, robots: int, stops: int) -> None:
        self.mission = scenes.aisles("differential-drive", 1, robots)
        shared = MissionRoadmap.of(self.mission)
        self.roadmap, planner = shared.roadmap, MovePlanner(shared.roadmap)
        self.search = SafeIntervals(planner.shared, self.roadmap.holding.tolist(), self.roadmap.margin_m)
        self.starts = shared.points([robot.position for robot in self.mission.robots])
        places = shared.points([task.position for task in self.mission.tasks])
        self.stops = [[places[(k + j * robots) % len(places)] for j in range(stops)] for k in range(robots)]

    def travellers(self) -> list[Traveller]:
        return [
            Traveller(
                start=start,
                stops=[*((stop, HOLD_S) for stop in stops), (start, 0.0)],
                radius=0.3,
                speed=1.0,
                heading=0.0,
                yaw_rate=2.0,
                acceleration=1.0,
                ready=0.0,
                fixed=False,
                stays=True,
            )
            for start, stops in zip(self.starts, self.stops, strict=True)
        ]

    def ways(self, tries: int):
        travellers = self.travellers()
        return self.search.best_of(travellers, order=list(range(len(travellers))), tries=tries, seed=1)


@pytest.fixture(scope="module")
def aisles():
    return Aisles(robots=6, stops=3)


def test_each_goes_to_its_stops_one_after_the_other_and_home(aisles):
    moves, ends, order = aisles.ways(4)
    assert sorted(order) == list(range(6))
    edges = aisles.roadmap.edges
    for k, start in enumerate(aisles.starts):
        own = [move for move in moves if move[1] == k]
        at = [start, *(edges[edge, 1] for _, _, edge, _ in own)]
        assert [edges[edge, 0] for _, _, edge, _ in own] == at[:-1]
        assert [stop for *_, stop in own] == sorted(stop for *_, stop in own)
        for number, stop in enumerate([*aisles.stops[k], start]):
            assert [edges[edge, 1] for _, _, edge, to in own if to == number][-1] == stop
        assert own[-1][0] < ends[k] < math.inf
        assert ends[k] > 3 * HOLD_S


def test_moves_are_free_while_all_others_stand_where_theirs_have_left_them(aisles):
    moves, _, _ = aisles.ways(4)
    at = dict(enumerate(aisles.roadmap.points[aisles.starts]))
    for _, robot, edge, _ in moves:
        begin, end = aisles.roadmap.points[aisles.roadmap.edges[edge]]
        along = begin + np.linspace(0.0, 1.0, 21)[:, None] * (end - begin)
        for other, place in at.items():
            if other != robot:
                gaps = np.linalg.norm(along - place, axis=1)
                assert gaps.min() > 0.6 or gaps.min() >= gaps[0]
        at[robot] = end
    assert min(math.dist(at[a], at[b]) for a, b in combinations(at, 2)) > 0.6


def test_more_tries_are_never_worse(aisles):
    found = [aisles.ways(tries)[1] for tries in (1, 4, 16)]
    costs = [max(ends) + sum(ends) / len(ends) for ends in found]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < costs[0]


def test_who_is_cut_off_by_one_that_never_leaves_does_not_hinder_the_others(aisles):
    blocked = aisles.travellers()[:2]
    standing = Traveller(
        start=aisles.stops[0][0],
        stops=[],
        radius=0.3,
        speed=1.0,
        heading=0.0,
        yaw_rate=2.0,
        acceleration=1.0,
        ready=0.0,
        fixed=True,
        stays=True,
    )
    moves, ends, _ = aisles.search.best_of([*blocked, standing], order=[0, 1, 2], tries=2, seed=0)
    assert math.isnan(ends[0])
    assert ends[1] < math.inf
    assert 2 not in {robot for _, robot, _, _ in moves}
