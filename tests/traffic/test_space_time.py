"""Space-time A*: no contact, the soonest for one robot, and what no order can solve."""

from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.traffic.space_time import NotTogether, Parameters, together

every_plan = pytest.mark.parametrize("window", [None, 6], ids=["whole", "window"])


def grid(*rows):
    return np.array([[cell == "#" for cell in row] for row in rows])


def contacts(ways):
    """By pairs and steps, in the slow way."""
    found = []
    for (a, one), (b, other) in combinations(ways.items(), 2):
        found += [(a, b, k, "cell") for k, (p, q) in enumerate(zip(one, other, strict=True)) if p == q]
        moves = zip(pairwise(one), pairwise(other), strict=True)
        for k, ((p, p2), (q, q2)) in enumerate(moves):
            if p == q2 and q == p2:
                found.append((a, b, k, "exchange"))
            middles = np.add(p, p2), np.add(q, q2)
            if p != p2 and q != q2 and (middles[0] == middles[1]).all():
                found.append((a, b, k, "crossing"))
    return found


def legal(blocked, ways, ends, neighbours=8):
    assert len({len(way) for way in ways.values()}) == 1
    for robot, way in ways.items():
        assert (way[0], way[-1]) == ends[robot]
        for p, q in pairwise(way):
            down, right = abs(p[0] - q[0]), abs(p[1] - q[1])
            assert max(down, right) <= 1
            assert neighbours == 8 or down + right <= 1
            assert not blocked[p[0], q[1]]
            assert not blocked[q[0], p[1]]
    assert contacts(ways) == []


@every_plan
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), robots=st.integers(1, 6), neighbours=st.sampled_from([4, 8]))
def test_no_contacts_on_random_grids(window, seed, robots, neighbours):
    random = np.random.default_rng(seed)
    blocked = random.random((9, 9)) < 0.15
    free = [tuple(map(int, cell)) for cell in np.argwhere(~blocked)]
    places = random.permutation(len(free))
    ends = {f"r{k}": (free[places[k]], free[places[-1 - k]]) for k in range(robots)}
    found = together(blocked, ends, seed=seed, params=Parameters(neighbours=neighbours, window=window))
    if isinstance(found, NotTogether):
        assert found.robot in ends
        return
    legal(blocked, found, ends, neighbours)
    again = together(blocked, ends, seed=seed, params=Parameters(neighbours=neighbours, window=window))
    assert again == found


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_one_robot_is_as_short_as_scipy_says(seed):
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    random = np.random.default_rng(seed)
    blocked = random.random((8, 8)) < 0.25
    blocked[0, 0] = blocked[7, 7] = False
    links = [
        ((r, c), (r + d, c + e), np.hypot(d, e))
        for r, c in np.argwhere(~blocked)
        for d, e in ((0, 1), (1, 0), (1, 1), (1, -1))
        if r + d < 8
        and 0 <= c + e < 8
        and not blocked[min(r, r + d) : r + d + 1, min(c, c + e) : max(c, c + e) + 1].any()
    ]
    a, b, lengths = (
        [r * 8 + c for r, c in col] if k < 2 else list(col) for k, col in enumerate(zip(*links, strict=True))
    )
    wanted = dijkstra(csr_array((lengths, (a, b)), shape=(64, 64)), directed=False, indices=0)[63]
    found = together(blocked, {"r": ((0, 0), (7, 7))})
    if np.isinf(wanted):
        assert found == NotTogether("r", "its goal is not connected with its start")
        return
    assert sum(np.hypot(*np.subtract(q, p)) for p, q in pairwise(found["r"])) == pytest.approx(wanted)


@every_plan
def test_two_in_a_corridor_pass_by_the_bay(window):
    corridor = grid("####.##", ".......", "#######")
    ends = {"east": ((1, 0), (1, 6)), "west": ((1, 6), (1, 0))}
    found = together(corridor, ends, params=Parameters(window=window))
    legal(corridor, found, ends)
    assert (0, 4) in found["west"]


@every_plan
def test_without_a_bay_nobody_passes(window):
    corridor = grid(".......")
    ends = {"east": ((0, 0), (0, 6)), "west": ((0, 6), (0, 0))}
    found = together(corridor, ends, params=Parameters(window=window, steps=40))
    assert isinstance(found, NotTogether)


def test_one_that_stands_in_the_way_gets_out_of_it():
    corridor = grid("###.###", ".......", "#######")
    ends = {"through": ((1, 0), (1, 6)), "stander": ((1, 3), (1, 2))}
    found = together(corridor, ends)
    legal(corridor, found, ends)


def test_who_comes_to_a_goal_through_which_others_go_waits():
    plus = grid("#.#", "...", "#.#")
    ends = {"down": ((0, 1), (2, 1)), "middle": ((1, 0), (1, 1))}
    found = together(plus, ends, params=Parameters(neighbours=4))
    legal(plus, found, ends, 4)


def test_twenty_robots_change_sides():
    blocked = np.zeros((20, 30), dtype=bool)
    blocked[3:17, 14:16] = True
    ends = {f"r{k}": ((k, 0 if k % 2 else 29), (19 - k, 29 if k % 2 else 0)) for k in range(20)}
    found = together(blocked, ends)
    legal(blocked, found, ends)


def test_what_is_wrong_is_named():
    free = np.zeros((3, 3), dtype=bool)
    with pytest.raises(ParameterError, match="two robots with one goal"):
        together(free, {"a": ((0, 0), (2, 2)), "b": ((0, 1), (2, 2))})
    assert together(free, {"a": ((0, 0), (9, 9))}) == NotTogether("a", "its start or goal is blocked")
    for wrong in ({"neighbours": 6}, {"window": 1}, {"orders": 0}):
        with pytest.raises(ParameterError, match=next(iter(wrong))):
            Parameters(**wrong)
