"""PIBT and LaCAM: no conflicts, a solution wherever there is one, a proof where there is none."""

from collections import deque
from itertools import pairwise, product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muster import core
from muster.mission.errors import ParameterError
from muster.traffic.joint_path_faults import faults
from muster.traffic.joint_paths import JointPaths, NoJointPaths, Parameters, costs, grid_graph, joint_paths


def grid(*rows):
    return np.array([[cell == "#" for cell in row] for row in rows])


def solved(blocked, ends, **limits):
    """The paths on a grid as cells, judged; or why there are none."""
    graph, numbers = grid_graph(blocked)
    cells = np.argwhere(numbers >= 0)
    found = joint_paths(graph, *([int(numbers[cell]) for cell in side] for side in zip(*ends, strict=True)), **limits)
    if isinstance(found, NoJointPaths):
        return found
    paths = [[tuple(int(k) for k in cells[v]) for v in column] for column in found.vertices.T]
    assert faults(blocked, paths, ends) == []
    return found


def test_two_swap_in_a_corridor_with_a_bay():
    found = solved(grid("#.###", "....."), [((1, 0), (1, 4)), ((1, 4), (1, 0))])
    assert isinstance(found, JointPaths)


def test_two_cannot_swap_in_a_corridor():
    found = solved(grid("....."), [((0, 0), (0, 4)), ((0, 4), (0, 0))])
    assert isinstance(found, NoJointPaths)
    assert found.proven


def test_a_full_cycle_turns():
    ends = [((0, 0), (0, 1)), ((0, 1), (1, 1)), ((1, 1), (1, 0)), ((1, 0), (0, 0))]
    assert len(solved(grid("..", ".."), ends).vertices) == 2


def test_what_cannot_be_is_proven_at_once():
    walled = solved(grid(".#."), [((0, 0), (0, 2))])
    assert (walled.proven, walled.reason) == (True, "a goal cannot be reached from its start")
    same = solved(grid("..."), [((0, 0), (0, 1)), ((0, 2), (0, 1))])
    assert (same.proven, same.reason) == (True, "two robots have one goal")


def test_without_expansions_nothing_is_said_of_the_mission():
    found = solved(grid("#.###", "....."), [((1, 0), (1, 4)), ((1, 4), (1, 0))], expansions=1)
    assert isinstance(found, NoJointPaths)
    assert not found.proven


@given(seed=st.integers(0, 10**6))
def test_solved_where_a_joint_search_solves(seed):
    graph, edges, starts, goals = random_instance(np.random.default_rng(seed))
    found = joint_paths(graph, starts, goals, seed=seed, time_limit=None)
    shortest = joint_search(edges, starts, goals)
    assert isinstance(found, JointPaths) == (shortest is not None)
    if isinstance(found, NoJointPaths):
        assert found.proven
    else:
        check_steps(edges, starts, goals, found.vertices.tolist())
        assert len(found.vertices) - 1 >= shortest


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6))
def test_anytime_ends_with_the_least_loss(seed):
    graph, edges, starts, goals = random_instance(np.random.default_rng(seed), most=5)
    found = joint_paths(graph, starts, goals, seed=seed, time_limit=None, params=Parameters(anytime=True))
    least = least_loss(edges, starts, goals)
    if least is None:
        assert found.proven
    else:
        assert found.optimal
        assert costs(found.vertices, goals)["sum of loss"] == least


@pytest.mark.parametrize("options", [{}, {"samples": 5}, {"refine": True}], ids=["first", "samples", "refine"])
def test_the_same_for_the_same_seed(options):
    graph, starts, goals = crowd()
    limits = {"time_limit": None, "expansions": 500, "params": Parameters(**options)}
    plans = [joint_paths(graph, starts, goals, seed=seed, **limits).vertices for seed in (1, 1, 2)]
    assert np.array_equal(plans[0], plans[1])
    assert not np.array_equal(plans[0], plans[2])


def test_refined_paths_are_paths_and_cost_less():
    free = np.zeros((12, 12), dtype=bool)
    _, starts, goals = crowd()
    ends = [(divmod(start, 12), divmod(goal, 12)) for start, goal in zip(starts, goals, strict=True)]
    first = solved(free, ends, seed=1, time_limit=None)
    refined = solved(
        free, ends, seed=1, time_limit=None, expansions=2000, params=Parameters(refine=True)
    )  # judged as all that `solved` returns
    before, after = (costs(paths.vertices, goals)["sum of costs"] for paths in (first, refined))
    assert sum(abs(a - b) + abs(c - d) for (a, c), (b, d) in ends) <= after < 0.8 * before


def test_refining_needs_an_end():
    graph, starts, goals = crowd()
    with pytest.raises(ParameterError, match="refine: without a limit"):
        joint_paths(graph, starts, goals, time_limit=None, params=Parameters(refine=True))


def test_time_limit_is_of_the_clock_given():
    class Late:
        def __init__(self):
            self.time = 0.0

        def now(self):
            self.time += 6.0
            return self.time

    graph, starts, goals = crowd()
    found = joint_paths(graph, starts, goals, time_limit=5.0, clock=Late())
    assert (found.proven, found.reason.split(":")[0]) == (False, "not found with 0 expansions")


def test_costs_as_the_benchmarks_count():
    vertices = np.array([[0, 5], [1, 5], [2, 6], [2, 5]])  # the second leaves its goal once
    assert costs(vertices, [2, 5]) == {"sum of costs": 5, "sum of loss": 4, "makespan": 3}


@pytest.mark.parametrize(
    ("starts", "goals", "message"),
    [
        ([0, 0], [1, 2], "starts: two robots at one vertex"),
        ([0], [1, 2], "goals: 2; expected as many as starts, 1"),
        ([0], [9], "goals: 9; expected a vertex, 0 to 2"),
    ],
)
def test_ends_that_do_not_fit(starts, goals, message):
    with pytest.raises(ParameterError, match=message):
        joint_paths(grid_graph(grid("..."))[0], starts, goals)


def test_rows_that_are_not_compressed():
    with pytest.raises(ValueError, match="compressed rows"):
        core.DirectedGraph([0, 2], [0], [1.0])
    with pytest.raises(ValueError, match="above 0"):
        core.DirectedGraph([0, 1], [0], [0.0])


def crowd():
    """60 robots on 12 x 12 cells."""
    graph, _ = grid_graph(np.zeros((12, 12), dtype=bool))
    random = np.random.default_rng(0)
    return graph, random.permutation(144)[:60].tolist(), random.permutation(144)[:60].tolist()


def random_instance(random, most=7):
    """A connected graph, some of its edges one-way, and two to four robots."""
    size = int(random.integers(4, most + 1))
    edges = {v: set() for v in range(size)}
    pairs = [(int(random.integers(v)), v) for v in range(1, size)]
    pairs += [tuple(int(k) for k in random.choice(size, 2, replace=False)) for _ in range(int(random.integers(4)))]
    for a, b in pairs:
        edges[a].add(b)
        if random.random() < 0.85:
            edges[b].add(a)
    robots = int(random.integers(2, 4 if size < 6 else 5))
    first = np.concatenate([[0], np.cumsum([len(edges[v]) for v in range(size)])]).tolist()
    heads = [there for v in range(size) for there in sorted(edges[v])]
    graph = core.DirectedGraph(first, heads, [1.0] * len(heads))
    return graph, edges, random.permutation(size)[:robots].tolist(), random.permutation(size)[:robots].tolist()


def next_configurations(edges, places):
    for to in product(*([v, *edges[v]] for v in places)):
        if len(set(to)) < len(to):
            continue
        moves = set(zip(places, to, strict=True))
        if not any(a != b and (b, a) in moves for a, b in moves):
            yield to


def joint_search(edges, starts, goals):
    """The steps of the shortest plan of all together; None if there is none."""
    queue, steps = deque([tuple(starts)]), {tuple(starts): 0}
    while queue:
        places = queue.popleft()
        if places == tuple(goals):
            return steps[places]
        for to in next_configurations(edges, places):
            if to not in steps:
                steps[to] = steps[places] + 1
                queue.append(to)
    return None


def least_loss(edges, starts, goals):
    """By relaxing every configuration until nothing changes."""
    losses, queue = {tuple(starts): 0}, deque([tuple(starts)])
    while queue:
        places = queue.popleft()
        for to in next_configurations(edges, places):
            loss = losses[places] + sum(a != g or b != g for a, b, g in zip(places, to, goals, strict=True))
            if loss < losses.get(to, loss + 1):
                losses[to] = loss
                queue.append(to)
    return losses.get(tuple(goals))


def check_steps(edges, starts, goals, vertices):
    assert vertices[0] == starts
    assert vertices[-1] == goals
    for places, to in pairwise(vertices):
        assert tuple(to) in set(next_configurations(edges, places))


def test_calls_shrink_where_they_take_much_of_the_limit():
    """A neighbourhood takes a hundredth of the limit, more than a call may: so a call has one, and none is too late."""

    class Slow:
        time = 0.0

        def now(self):
            return self.time

    clock = Slow()
    made = []

    class Counted:
        def __init__(self, *arguments, **options):
            self.search = core.JointRefinement(*arguments, **options)

        def advance(self, count):
            made.append(count)
            clock.time += 0.01 * count
            self.search.advance(count)

        @property
        def cost(self):
            return self.search.cost

        def solution(self):
            return self.search.solution()

    graph, starts, goals = crowd()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("muster.traffic.joint_paths.core", SimpleNamespace(**vars(core) | {"JointRefinement": Counted}))
        joint_paths(graph, starts, goals, time_limit=1.0, clock=clock, params=Parameters(refine=True))
    assert made[-1] == 1
    assert clock.time == pytest.approx(1.0, abs=0.011)
