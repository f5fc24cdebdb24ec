"""Consensus over a network: the conflict table of CBBA, and how robots come to agree."""

import itertools

import numpy as np
import pytest

from muster.allocation.auctions.consensus import NO_BID, NOBODY, Beliefs, Message, diameter, neighbours
from muster.allocation.stop import Stop

# The conflict table: sender 0, receiver 1, others 2 (m) and 3 (n).

K, I, M, N = range(4)  # noqa: E741  the paper's names
BELOW, EQUAL, ABOVE = -1, 0, 1
ALL = (BELOW, EQUAL, ABOVE)
TABLE = [  # sender's winner, receiver's, sender's bid and stamps of m and n against the receiver's, action
    (K, I, (ABOVE,), ALL, ALL, "update"),
    (K, I, (BELOW,), ALL, ALL, "leave"),
    (K, K, ALL, ALL, ALL, "update"),
    (K, N, ALL, ALL, (ABOVE,), "update"),
    (K, N, (ABOVE,), ALL, ALL, "update"),
    (K, N, (BELOW,), ALL, (BELOW, EQUAL), "leave"),
    (K, NOBODY, ALL, ALL, ALL, "update"),
    (I, I, ALL, ALL, ALL, "leave"),
    (I, K, ALL, ALL, ALL, "reset"),
    (I, N, ALL, ALL, (ABOVE,), "reset"),
    (I, N, ALL, ALL, (BELOW, EQUAL), "leave"),
    (I, NOBODY, ALL, ALL, ALL, "leave"),
    (M, I, (ABOVE,), (ABOVE,), ALL, "update"),
    (M, I, (BELOW,), (ABOVE,), ALL, "leave"),
    (M, I, ALL, (BELOW, EQUAL), ALL, "leave"),
    (M, K, ALL, (ABOVE,), ALL, "update"),
    (M, K, ALL, (BELOW, EQUAL), ALL, "reset"),
    (M, M, ALL, (ABOVE,), ALL, "update"),
    (M, M, ALL, (BELOW, EQUAL), ALL, "leave"),
    (M, N, ALL, (ABOVE,), (ABOVE,), "update"),
    (M, N, (ABOVE,), (ABOVE,), ALL, "update"),
    (M, N, (BELOW,), (ABOVE,), (BELOW, EQUAL), "leave"),
    (M, N, ALL, (BELOW,), (ABOVE,), "reset"),
    (M, N, ALL, (EQUAL,), ALL, "leave"),
    (M, N, ALL, (BELOW,), (BELOW, EQUAL), "leave"),
    (M, NOBODY, ALL, (ABOVE,), ALL, "update"),
    (M, NOBODY, ALL, (BELOW, EQUAL), ALL, "leave"),
    (NOBODY, I, ALL, ALL, ALL, "leave"),
    (NOBODY, K, ALL, ALL, ALL, "update"),
    (NOBODY, N, ALL, ALL, (ABOVE,), "update"),
    (NOBODY, N, ALL, ALL, (BELOW, EQUAL), "leave"),
    (NOBODY, NOBODY, ALL, ALL, ALL, "leave"),
]


def action(z_k, z_i, bid, stamp_m, stamp_n):
    """What the table says of one task."""
    stamps = (5 + stamp_m, 5, 5 + stamp_n, 5)
    if z_i == z_k:
        stamps = (5 + stamp_m, 5, 5 + stamp_m, 5)
    integers = [np.array([value]) for value in (I, z_k, z_i)]
    bids = [np.array([value]) for value in (0.5 + 0.1 * bid, 0.5)]
    update, reset = Message(K, *integers, *bids, *(np.array([value]) for value in stamps)).actions()
    assert not (update & reset)[0]
    return "update" if update[0] else "reset" if reset[0] else "leave"


@pytest.mark.parametrize(("z_k", "z_i", "bids", "stamps_m", "stamps_n", "expected"), TABLE)
def test_conflict_table(z_k, z_i, bids, stamps_m, stamps_n, expected):
    cases = itertools.product(bids, stamps_m, stamps_n)
    assert {action(z_k, z_i, *case) for case in cases} == {expected}


@pytest.mark.parametrize(
    ("z_k", "z_i", "expected"), [(K, I, "update"), (K, N, "update"), (M, N, "update"), (M, I, "leave")]
)
def test_of_equal_bids_the_lower_robots_is_higher(z_k, z_i, expected):
    assert action(z_k, z_i, EQUAL, ABOVE, BELOW) == expected


def test_a_message_is_read_by_every_receiver_and_task():
    """Robot 0 has a task and has lost another; 1 knows of neither, 2 has a lower bid for the first."""
    beliefs = Beliefs(3, 2)
    beliefs.z[:] = [[0, NOBODY], [NOBODY, 0], [2, 0]]
    beliefs.y[:] = [[-1.0, NO_BID], [NO_BID, -2.0], [-1.5, -2.0]]
    beliefs.exchange([[1, 2], [], []], now=1, stop=Stop())
    assert beliefs.z.tolist() == [[0, NOBODY]] * 3
    assert beliefs.y.tolist() == [[-1.0, NO_BID]] * 3
    assert beliefs.agree()
    assert beliefs.s[1:, 0].tolist() == [1, 1]


def test_news_travels_one_neighbour_a_round():
    beliefs = Beliefs(4, 1)
    beliefs.z[0], beliefs.y[0] = 0, -1.0
    for now in (1, 2, 3):
        assert beliefs.z[now, 0] == NOBODY
        assert beliefs.agreed_winners().tolist() == [NOBODY]
        beliefs.exchange(neighbours("line", 4), now, Stop())
    assert beliefs.agreed_winners().tolist() == [0]
    assert beliefs.s[3, :3].tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("topology", "m", "expected", "farthest"),
    [
        ("complete", 3, [[1, 2], [0, 2], [0, 1]], 1),
        ("ring", 5, [[1, 4], [0, 2], [1, 3], [2, 4], [0, 3]], 2),
        ("ring", 2, [[1], [0]], 1),
        ("line", 4, [[1], [0, 2], [1, 3], [2]], 3),
        ("ring", 1, [[]], 1),
        ("complete", 1, [[]], 1),
        ("line", 1, [[]], 1),
    ],
)
def test_topologies(topology, m, expected, farthest):
    assert neighbours(topology, m) == expected
    assert diameter(topology, m) == farthest
