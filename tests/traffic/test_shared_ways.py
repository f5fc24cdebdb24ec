"""Ways of several robots over a roadmap: through several stops, free of each other, better by planning few anew."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from muster.core import SafeIntervals, SharedWays, Traveller
from muster.generation import narrow
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.roadmaps.edge_conflicts import annotated

HOLD_S = 5.0


def traveller(start: int, stops: list[tuple[int, float]], *, fixed: bool = False, stays: bool = True) -> Traveller:
    return Traveller(
        start=start,
        stops=stops,
        radius=0.3,
        speed=1.0,
        heading=0.0,
        yaw_rate=2.0,
        acceleration=1.0,
        ready=0.0,
        fixed=fixed,
        stays=stays,
    )


class Aisles:
    """Robots that each visit some tasks of a store of aisles, and come home."""

    def __init__(self, robots: int, stops: int) -> None:
        self.mission = narrow.aisles("differential-drive", 1, robots)
        shared = MissionRoadmap.of(self.mission)
        self.roadmap = shared.roadmap
        self.search = SafeIntervals(annotated(self.roadmap), self.roadmap.holding.tolist(), self.roadmap.margin_m)
        one = self.mission.robots[0]
        self.starts = shared.points([robot.position for robot in self.mission.robots], one)
        places = shared.points([task.position for task in self.mission.tasks], one)
        self.stops = [[places[(k + j * robots) % len(places)] for j in range(stops)] for k in range(robots)]

    def travellers(self) -> list[Traveller]:
        return [
            traveller(start, [*((stop, HOLD_S) for stop in stops), (start, 0.0)])
            for start, stops in zip(self.starts, self.stops, strict=True)
        ]

    def ways(self, more: int) -> SharedWays:
        travellers = self.travellers()
        return SharedWays(self.search, travellers, order=list(range(len(travellers))), ways=more, seed=1)


@pytest.fixture(scope="module")
def aisles():
    return Aisles(robots=6, stops=3)


def test_each_goes_to_its_stops_one_after_the_other_and_home(aisles):
    ways = aisles.ways(24)
    moves, ends = ways.paths()
    assert sorted(ways.order) == list(range(6))
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
    assert_free(aisles, aisles.ways(24).paths()[0])


def assert_free(aisles, moves):
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


def test_more_ways_are_never_worse(aisles):
    found = [aisles.ways(more).paths()[1] for more in (0, 24, 96)]
    costs = [max(ends) + sum(ends) / len(ends) for ends in found]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < costs[0]


def test_who_is_cut_off_by_one_that_never_leaves_does_not_hinder_the_others(aisles):
    blocked = aisles.travellers()[:2]
    standing = traveller(aisles.stops[0][0], [], fixed=True)
    moves, ends = SharedWays(aisles.search, [*blocked, standing], order=[0, 1, 2], ways=6, seed=0).paths()
    assert math.isnan(ends[0])
    assert ends[1] < math.inf
    assert 2 not in {robot for _, robot, _, _ in moves}


def test_who_rests_leaves_the_stops_of_others_free(aisles):
    stop, other = aisles.stops[0][0], aisles.stops[1][0]
    first = traveller(aisles.starts[0], [(stop, 0.0)], stays=False)
    later = traveller(aisles.starts[1], [(other, 60.0), (stop, HOLD_S)], stays=False)
    _, ends = SharedWays(aisles.search, [first, later], order=[0, 1], ways=0, seed=0).paths()
    assert max(ends) < math.inf


def test_alone_each_is_as_fast_as_if_nobody_else_were_planned(aisles):
    moves, ends = aisles.ways(24).paths_alone()
    for k, who in enumerate(aisles.travellers()):
        own, (end,) = SharedWays(aisles.search, [who], order=[0], ways=0, seed=1).paths()
        assert end == ends[k]
        assert [(at, edge) for at, _, edge, _ in own] == [(at, edge) for at, robot, edge, _ in moves if robot == k]


def test_who_goes_elsewhere_passes_the_others_and_comes_back_when_that_is_undone(aisles):
    ways = aisles.ways(24)
    before = ways.paths()
    tours = [[*((stop, HOLD_S) for stop in aisles.stops[1 - k]), (aisles.starts[k], 0.0)] for k in (0, 1)]
    ways.change([(k, traveller(aisles.starts[k], tours[k])) for k in (0, 1)], ways=12)
    moves, ends = ways.paths()
    assert_free(aisles, moves)
    assert max(ends) < math.inf
    at = {k: [aisles.roadmap.edges[edge, 1] for _, robot, edge, _ in moves if robot == k] for k in (0, 1)}
    assert set(aisles.stops[1]) <= set(at[0])
    assert set(aisles.stops[0]) <= set(at[1])
    ways.undo()
    assert ways.paths() == before
    with pytest.raises(ValueError, match="changes: no number of a traveller"):
        ways.change([(6, aisles.travellers()[0])], ways=0)
