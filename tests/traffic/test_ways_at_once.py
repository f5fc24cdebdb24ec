"""Ways of robots that all go at once: clearance by geometry, ways wherever there are any, none where there are none."""

import math
from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.traffic.annotated import annotated, lattice

from muster.core import SafeIntervals, SharedWays, Traveller
from muster.traffic.move_faults import faults
from muster.traffic.roadmaps.edge_conflicts import annotated as core_roadmap

MARGIN_M = 0.02
RADIUS_M = 0.3
HOLD_S = 5.0
DEAD_ENDS = (
    "...............",
    ".###.###.###.#.",
    ".###.###.###.#.",
    ".###.###.###.#.",
    ".###.###.###.#.",
)


def traveller(start, stops, radius=RADIUS_M, *, fixed=False, stays=False, hold_s=0.0, ready_s=0.0):
    return Traveller(
        start=int(start),
        stops=[(int(stop), hold_s) for stop in stops],
        radius=radius,
        speed=1.0,
        heading=0.0,
        yaw_rate=2.0,
        acceleration=1.0,
        ready=ready_s,
        fixed=fixed,
        stays=stays,
    )


def ways_at_once(roadmap, travellers, *, ways=0, seed=0, expansions=300):
    intervals = SafeIntervals(core_roadmap(roadmap), [True] * len(roadmap.points), MARGIN_M)
    order = list(range(len(travellers)))
    return SharedWays(
        intervals, travellers, order=order, ways=ways, seed=seed, expansions=expansions, at_once=True
    ).paths()


def judged(roadmap, starts, stops, radii=None, **options):
    """When each has passed its stops, of moves that are free of each other and lead there; and where each is then."""
    radii = radii or [RADIUS_M] * len(starts)
    stays = options.pop("stays", False)
    travellers = [traveller(*ends, radius, stays=stays) for *ends, radius in zip(starts, stops, radii, strict=True)]
    moves, ends = ways_at_once(roadmap, travellers, **options)
    in_turn = [(robot, edge) for _, robot, edge, _ in moves]
    assert faults(roadmap.points, roadmap.edges, starts, in_turn, radii, MARGIN_M) == []
    places = list(starts)
    for robot, edge in in_turn:
        places[robot] = int(roadmap.edges[edge, 1])
    for robot, (start, own) in enumerate(zip(starts, stops, strict=True)):
        passed = [start, *(int(roadmap.edges[edge, 1]) for who, edge in in_turn if who == robot)]
        there = iter(passed)
        assert math.isinf(ends[robot]) or all(stop in there for stop in own)
    return ends, places


def test_two_swap_at_a_bay_and_stay():
    roadmap, numbers = lattice([".....", "##.##"], 1.0, 0.62)
    one, other = int(numbers[0, 0]), int(numbers[0, 4])
    ends, places = judged(roadmap, [one, other], [[other], [one]], stays=True)
    assert max(ends) < math.inf
    assert places == [other, one]


def test_two_cannot_swap_in_a_dead_end():
    roadmap, numbers = lattice(["....."], 1.0, 0.62)
    one, other = int(numbers[0, 0]), int(numbers[0, 4])
    assert math.inf in judged(roadmap, [one, other], [[other], [one]])[0]


def test_who_rests_makes_way_and_comes_back():
    roadmap, numbers = lattice([".....", "##.##"], 1.0, 0.62)
    start, resting, goal = (int(numbers[0, column]) for column in (0, 2, 4))
    ends, places = judged(roadmap, [start, resting], [[goal], [resting]], stays=True)
    assert max(ends) < math.inf
    assert places == [goal, resting]


def test_all_get_through_several_stops_and_hold_there():
    roadmap, numbers = lattice([".......", "##.#.##"], 1.0, 0.62)
    one, other, bay, second = (int(numbers[at]) for at in ((0, 0), (0, 6), (1, 2), (1, 4)))
    stops = [[other, bay, one], [one, second, other]]
    ends, _ = judged(roadmap, [one, other], stops)
    assert max(ends) < math.inf
    travellers = [traveller(start, own, hold_s=HOLD_S) for start, own in zip([one, other], stops, strict=True)]
    held = ways_at_once(roadmap, travellers)[1]
    assert all(late >= end + 3 * HOLD_S - 1e-9 for late, end in zip(held, ends, strict=True))


def test_who_is_fixed_stays():
    roadmap, numbers = lattice(["...", "..."], 1.0, 0.62)
    moving, standing = traveller(numbers[0, 0], [numbers[0, 2]]), traveller(numbers[0, 1], [], fixed=True)
    moves, ends = ways_at_once(roadmap, [moving, standing])
    assert ends[0] < math.inf
    assert {robot for _, robot, _, _ in moves} == {0}


def test_who_is_not_ready_is_not_moved_before():
    roadmap, numbers = lattice([".....", "##.##"], 1.0, 0.62)
    going, busy = traveller(numbers[0, 0], [numbers[0, 4]]), traveller(numbers[0, 2], [], ready_s=20.0)
    moves, ends = ways_at_once(roadmap, [going, busy])
    assert 20.0 < ends[0] < math.inf
    assert min(at for at, robot, _, _ in moves if robot == 1) >= 20.0


def test_the_innermost_of_a_queue_comes_out_of_a_dead_end():
    """The goal of the second is where the first stands; three more stand behind."""
    roadmap, numbers = lattice(["......", "##.###", "##.###", "##.###", "##.###", "##.###"], 1.0, 0.62)
    inner, *rest = (int(numbers[row, 2]) for row in (5, 4, 3, 2, 1))
    ends, _ = judged(roadmap, [inner, *rest], [[int(numbers[0, 5])], [inner], [], [], []])
    assert max(ends) < math.inf


@pytest.mark.parametrize("robots", [4, 8, 12, 20])
def test_all_come_to_their_goals_in_dead_ends(robots):
    roadmap, numbers = lattice(DEAD_ENDS, 1.0, 0.62)
    random = np.random.default_rng(robots)
    starts, goals = (random.permutation(numbers.max() + 1)[:robots].tolist() for _ in range(2))
    assert max(judged(roadmap, starts, [[goal] for goal in goals])[0]) < math.inf


def test_ways_that_are_sought_afterwards_are_sooner():
    roadmap, numbers = lattice(DEAD_ENDS, 1.0, 0.62)
    random = np.random.default_rng(12)
    starts, goals = (random.permutation(numbers.max() + 1)[:12].tolist() for _ in range(2))
    first, later = (judged(roadmap, starts, [[goal] for goal in goals], ways=ways)[0] for ways in (0, 200))
    assert max(later) + np.mean(later) < max(first) + np.mean(first) < math.inf


def test_points_nearer_than_robots_are_wide():
    roadmap, numbers = lattice(["." * 15, "#" * 7 + "." * 3 + "#" * 5, "#" * 7 + "." * 3 + "#" * 5], 0.35, 0.62)
    one, other = int(numbers[0, 0]), int(numbers[0, 14])
    assert max(judged(roadmap, [one, other], [[other], [one]])[0]) < math.inf


@pytest.mark.long
@settings(max_examples=60)
@given(seed=st.integers(0, 10**6), settle=st.booleans())
def test_ways_are_found_where_a_joint_search_finds_some(seed, settle):
    random = np.random.default_rng(seed)
    size, robots = int(random.integers(4, 10)), int(random.integers(2, 4))
    points, radii = random.uniform(0, 4, (size, 2)), random.uniform(0.05, 0.35, robots).tolist()
    order = random.permutation(size)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    pairs = {(int(order[k]), int(min(order[:k], key=lambda j: apart[order[k], j]))) for k in range(1, size)}
    pairs |= {tuple(int(v) for v in random.choice(size, 2, replace=False)) for _ in range(int(random.integers(4)))}
    roadmap = annotated(points, pairs, 2 * 0.35 + MARGIN_M)
    starts, goals = (random.permutation(size)[:robots].tolist() for _ in range(2))
    ends, _ = judged(roadmap, starts, [[goal] for goal in goals], radii, seed=seed, expansions=10**6, stays=settle)
    assert (math.inf not in ends) == joint_search(roadmap, starts, goals, radii, settle)


def joint_search(roadmap, starts, goals, radii, settle):
    """Whether all have been at their goals after some sequence of moves (`settle`: are there)."""
    out = {}
    for edge, (tail, head) in enumerate(roadmap.edges.tolist()):
        out.setdefault(tail, []).append((edge, head))
    begin = tuple(starts), tuple(s == g for s, g in zip(starts, goals, strict=True))
    queue, seen = deque([begin]), {begin}
    while queue:
        places, visited = queue.popleft()
        if places == tuple(goals) if settle else all(visited):
            return True
        for robot, place in enumerate(places):
            for edge, head in out.get(place, ()):
                if faults(roadmap.points, roadmap.edges, places, [(robot, edge)], radii, MARGIN_M):
                    continue
                to = (*places[:robot], head, *places[robot + 1 :])
                now = (*visited[:robot], visited[robot] or head == goals[robot], *visited[robot + 1 :])
                if (to, now) not in seen:
                    seen.add((to, now))
                    queue.append((to, now))
    return False


def test_the_same_for_the_same_seed():
    roadmap, numbers = lattice(DEAD_ENDS, 1.0, 0.62)
    random = np.random.default_rng(3)
    starts, goals = (random.permutation(numbers.max() + 1)[:10].tolist() for _ in range(2))
    found = [judged(roadmap, starts, [[goal] for goal in goals], ways=20, seed=5) for _ in range(2)]
    assert found[0] == found[1]


def test_the_judge_sees_contact():
    points = np.array([(0.0, 0.0), (2.0, 0.0), (1.0, 0.5), (0.0, 0.4)])
    edges = np.array([(0, 1)])
    assert faults(points, edges, [0, 2], [(0, 0)], [0.3, 0.3], 0.02) == [
        "move 0: robot 0 comes within 0.500 m of robot 1"
    ]
    assert faults(points, edges, [0, 3], [(0, 0)], [0.3, 0.3], 0.02) == []  # it only moves away
    assert faults(points, edges, [1], [(0, 0)], [0.3], 0.02) == ["move 0: robot 0 stands at 1, but edge 0 begins at 0"]
