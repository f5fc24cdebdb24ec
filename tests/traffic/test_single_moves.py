"""Sequences of single moves: clearance by geometry, a plan wherever there is one, a proof where there is none."""

from collections import deque
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.traffic.annotated import annotated, lattice

from muster.mission.errors import ParameterError
from muster.traffic.move_faults import faults
from muster.traffic.single_moves import MovePlanner, Parameters

MARGIN_M = 0.02
RADIUS_M = 0.3
DEAD_ENDS = (
    "...............",
    ".###.###.###.#.",
    ".###.###.###.#.",
    ".###.###.###.#.",
    ".###.###.###.#.",
)


def planned(roadmap, starts, goals, radii=None, **options):
    """A plan, judged."""
    radii = radii or [RADIUS_M] * len(starts)
    found = MovePlanner(roadmap).planned(starts, goals, radii, margin_m=MARGIN_M, **options)
    assert faults(roadmap.points, roadmap.edges, starts, found.moves, radii, MARGIN_M) == []
    places = list(starts)
    for robot, edge in found.moves:
        places[robot] = int(roadmap.edges[edge, 1])
    assert tuple(places) == found.places
    return found


def test_alone_the_shortest_way():
    roadmap, numbers = lattice(["....", "...."], 1.0, 0.62)
    found = planned(roadmap, [numbers[0, 0]], [numbers[1, 3]])
    assert (found.outcome, len(found.moves)) == ("arrived", 4)


def test_no_more_turns_than_needed():
    roadmap, numbers = lattice(["....."] * 5, 1.0, 0.62)
    found = planned(roadmap, [numbers[0, 0]], [numbers[4, 4]])
    along = [tuple(roadmap.points[roadmap.edges[e, 1]] - roadmap.points[roadmap.edges[e, 0]]) for _, e in found.moves]
    assert len(found.moves) == 8
    assert sum(a != b for a, b in pairwise(along)) == 1


def test_two_swap_at_a_bay():
    roadmap, numbers = lattice([".....", "##.##"], 1.0, 0.62)
    ends = [int(numbers[0, 0]), int(numbers[0, 4])]
    found = planned(roadmap, ends, ends[::-1], params=Parameters(settle=True))
    assert found.outcome == "arrived"
    assert found.places == tuple(ends[::-1])


def test_two_cannot_swap_in_a_dead_end():
    roadmap, numbers = lattice(["....."], 1.0, 0.62)
    ends = [int(numbers[0, 0]), int(numbers[0, 4])]
    assert planned(roadmap, ends, ends[::-1], params=Parameters(expansions=10**6)).outcome == "impossible"


def test_a_goal_without_a_way():
    roadmap = annotated([(0, 0), (1, 0), (5, 0), (6, 0)], [(0, 1), (2, 3)], 0.62)
    assert planned(roadmap, [0], [3]).outcome == "impossible"


def test_who_rests_makes_way_and_comes_back():
    roadmap, numbers = lattice([".....", "##.##"], 1.0, 0.62)
    resting = int(numbers[0, 2])
    found = planned(
        roadmap, [int(numbers[0, 0]), resting], [int(numbers[0, 4]), resting], params=Parameters(settle=True)
    )
    assert found.outcome == "arrived"
    assert found.places[1] == resting
    assert 1 in {robot for robot, _ in found.moves}


def test_who_is_pinned_stays():
    roadmap, numbers = lattice(["...", "..."], 1.0, 0.62)
    starts = [int(numbers[0, 0]), int(numbers[0, 1])]
    found = planned(roadmap, starts, [int(numbers[0, 2]), None], pinned=[False, True])
    assert found.outcome == "arrived"
    assert {robot for robot, _ in found.moves} == {0}
    roadmap, numbers = lattice(["..."], 1.0, 0.62)
    found = planned(roadmap, [0, 1], [2, None], pinned=[False, True])
    assert (found.outcome, found.moves, found.arrived) == ("impossible", (), (False, True))


def test_the_innermost_of_a_queue_comes_out_of_a_dead_end():
    """The goal of the second is where the first stands; three more stand behind."""
    roadmap, numbers = lattice(["......", "##.###", "##.###", "##.###", "##.###", "##.###"], 1.0, 0.62)
    inner, *rest = (int(numbers[row, 2]) for row in (5, 4, 3, 2, 1))
    goals = [int(numbers[0, 5]), inner, None, None, None]
    assert planned(roadmap, [inner, *rest], goals).outcome == "arrived"


@pytest.mark.parametrize("robots", [4, 8, 12, 20])
def test_all_come_to_their_goals_in_dead_ends(robots):
    roadmap, numbers = lattice(DEAD_ENDS, 1.0, 0.62)
    random = np.random.default_rng(robots)
    starts, goals = (random.permutation(numbers.max() + 1)[:robots].tolist() for _ in range(2))
    assert planned(roadmap, starts, goals).outcome == "arrived"


def test_points_nearer_than_robots_are_wide():
    roadmap, numbers = lattice(["." * 15, "#" * 7 + "." * 3 + "#" * 5, "#" * 7 + "." * 3 + "#" * 5], 0.35, 0.62)
    ends = [int(numbers[0, 0]), int(numbers[0, 14])]
    assert planned(roadmap, ends, ends[::-1]).outcome == "arrived"


def test_a_horizon_ends_the_plan():
    roadmap, numbers = lattice(["." * 10] * 2, 1.0, 0.62)
    starts, goals = numbers[:, 0].tolist(), numbers[:, 9].tolist()
    found = planned(roadmap, starts, goals, params=Parameters(horizon=6))
    assert (found.outcome, len(found.moves), found.arrived) == ("horizon", 6, (False, False))


def test_costs_count_and_not_lengths():
    roadmap, numbers = lattice(["...", "..."], 1.0, 0.62)
    costs = np.ones(len(roadmap.edges))
    top = numbers[0, 1]
    costs[(roadmap.edges == top).any(axis=1)] = 10.0  # waiting is to be expected there
    found = MovePlanner(roadmap, costs).planned([int(numbers[0, 0])], [int(numbers[0, 2])], [RADIUS_M])
    assert top not in {int(roadmap.edges[edge, 1]) for _, edge in found.moves}


@settings(max_examples=60)
@given(seed=st.integers(0, 10**6), settle=st.booleans())
def test_planned_where_a_joint_search_plans(seed, settle):
    random = np.random.default_rng(seed)
    size, robots = int(random.integers(4, 10)), int(random.integers(2, 4))
    points, radii = random.uniform(0, 4, (size, 2)), random.uniform(0.05, 0.35, robots).tolist()
    order = random.permutation(size)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    pairs = {(int(order[k]), int(min(order[:k], key=lambda j: apart[order[k], j]))) for k in range(1, size)}
    pairs |= {tuple(int(v) for v in random.choice(size, 2, replace=False)) for _ in range(int(random.integers(4)))}
    roadmap = annotated(points, pairs, 2 * 0.35 + MARGIN_M)
    starts, goals = (random.permutation(size)[:robots].tolist() for _ in range(2))
    found = planned(roadmap, starts, goals, radii, seed=seed, params=Parameters(settle=settle, expansions=10**6))
    expected = "arrived" if joint_search(roadmap, starts, goals, radii, settle) else "impossible"
    assert found.outcome == expected


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
    planner = MovePlanner(roadmap)
    plans = [planner.planned(starts, goals, [RADIUS_M] * 10, seed=5) for _ in range(2)]
    assert plans[0] == plans[1]


@pytest.mark.parametrize(
    ("starts", "goals", "radii", "message"),
    [
        ([0, 0], [1, 2], [0.3, 0.3], "two robots start at one point"),
        ([0], [7], [0.3], "a start or goal is no point"),
        ([0, 1], [1], [0.3, 0.3], "must be as many as starts"),
        ([0], [1], [-1.0], "radii and priorities must be at least 0"),
    ],
)
def test_teams_that_do_not_fit(starts, goals, radii, message):
    roadmap, _ = lattice(["..."], 1.0, 0.62)
    with pytest.raises(ParameterError, match=message):
        MovePlanner(roadmap).planned(starts, goals, radii)


def test_the_judge_sees_contact():
    points = np.array([(0.0, 0.0), (2.0, 0.0), (1.0, 0.5), (0.0, 0.4)])
    edges = np.array([(0, 1)])
    assert faults(points, edges, [0, 2], [(0, 0)], [0.3, 0.3], 0.02) == [
        "move 0: robot 0 comes within 0.500 m of robot 1"
    ]
    assert faults(points, edges, [0, 3], [(0, 0)], [0.3, 0.3], 0.02) == []  # it only moves away
    assert faults(points, edges, [1], [(0, 0)], [0.3], 0.02) == ["move 0: robot 0 stands at 1, but edge 0 begins at 0"]
