"""Winner determination against all combinations."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster_studies.alternatives.bundle_clearing import BundleBid, clear, greedy


def random_bids(seed):
    random = np.random.default_rng(seed)
    robots, tasks = int(random.integers(1, 5)), int(random.integers(1, 7))
    return [
        BundleBid(
            robot,
            tuple(random.choice(tasks, size=int(random.integers(1, min(3, tasks) + 1)), replace=False).tolist()),
            float(random.uniform(-1, 10)),
        )
        for robot in range(robots)
        for _ in range(random.integers(0, 5))
    ]


def best_of_all(bids):
    own = {}
    for bid in bids:
        own.setdefault(bid.robot, [None]).append(bid)
    gains = [0.0]
    for choice in product(*own.values()):
        won = [bid for bid in choice if bid is not None]
        tasks = [task for bid in won for task in bid.tasks]
        if len(tasks) == len(set(tasks)):
            gains.append(sum(bid.gain for bid in won))
    return max(gains)


@given(seed=st.integers(0, 10**6))
def test_the_winners_gain_most(seed):
    bids = random_bids(seed)
    cleared = clear(bids, 100_000)
    tasks = [task for bid in cleared.winners for task in bid.tasks]
    assert cleared.exact
    assert len(tasks) == len(set(tasks))
    assert len({bid.robot for bid in cleared.winners}) == len(cleared.winners)
    assert sum(bid.gain for bid in cleared.winners) == pytest.approx(best_of_all(bids))


@given(seed=st.integers(0, 10**6), most=st.integers(1, 20))
def test_cut_short_it_is_as_good_as_greedy_and_says_so(seed, most):
    bids = random_bids(seed)
    cleared = clear(bids, most)
    gain = sum(bid.gain for bid in cleared.winners)
    assert gain >= sum(bid.gain for bid in greedy(bids)) - 1e-9
    if cleared.exact:
        assert gain == pytest.approx(best_of_all(bids))


def test_two_bundles_beat_the_greatest_bid():
    bids = [BundleBid(0, (0, 1), 10.0), BundleBid(1, (0,), 6.0), BundleBid(0, (1,), 6.0)]
    assert {bid.tasks for bid in clear(bids, 1000).winners} == {(0,), (1,)}


def test_more_robots_than_a_stack_is_deep():
    bids = [BundleBid(robot, (robot,), 1.0) for robot in range(3000)]
    assert len(clear(bids, 10_000).winners) == 3000
