import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from muster.allocation.auctions.winners import LeastContested, Lowest, Sale

NONE = np.inf


class Table:
    """Bids that stand in a table, (m, n)."""

    def __init__(self, rows):
        self.rows = np.array(rows, dtype=float)
        self.shape = self.rows.shape

    def bids(self, robot):
        return self.rows[robot]

    def lowest_bids(self):
        tasks = self.rows.argmin(axis=1)
        return tasks, self.rows[range(len(tasks)), tasks]


def winner(rule, rows):
    table = Table(rows)
    resolution = rule(table)
    resolution.note(range(len(rows)))
    return resolution.winner()


@pytest.mark.parametrize(
    ("rows", "sale"),
    [
        ([[5, 4, 9], [3, 8, 7]], Sale(1, 0, 3)),
        ([[2, 2], [2, 2]], Sale(0, 0, 2)),  # a tie: the first robot, then the first task
        ([[5, 2], [2, 5]], Sale(0, 1, 2)),
        ([[NONE, NONE], [NONE, 7]], Sale(1, 1, 7)),
        ([[NONE, NONE]], None),
    ],
)
def test_lowest(rows, sale):
    assert winner(Lowest, rows) == sale


@pytest.mark.parametrize(
    ("rows", "sale"),
    [
        ([[5, 4, 9], [3, 8, 7]], Sale(0, 1, 4)),  # gaps 2, 4, 2
        ([[1, 6], [9, NONE]], Sale(0, 1, 6)),  # a single bidder goes first
        ([[NONE, 6], [1, NONE]], Sale(0, 1, 6)),  # of two of these, the first robot's
        ([[4, 4], [5, 5]], Sale(0, 0, 4)),
        ([[8, 4], [4, 8]], Sale(0, 1, 4)),  # equal gaps: the first robot
        ([[3, 2, NONE]], Sale(0, 0, 3)),  # one robot: all are uncontested
        ([[NONE], [NONE]], None),
    ],
)
def test_least_contested(rows, sale):
    assert winner(LeastContested, rows) == sale


bids = st.sampled_from([1.0, 2.0, 3.0, 5.0, NONE])


@given(arrays(float, (3, 5), elements=bids), st.lists(st.tuples(st.integers(0, 2), arrays(float, 5, elements=bids))))
def test_least_contested_keeps_up_with_changes(rows, changes):
    table = Table(rows)
    kept = LeastContested(table)
    kept.note(range(3))
    for robot, row in changes:
        sale = kept.winner()
        if sale is None:
            break
        table.rows[:, sale.task] = NONE
        table.rows[robot] = np.where(np.isinf(table.rows).all(axis=0), NONE, row)
        kept.note([robot], sale.task)
        assert kept.winner() == winner(LeastContested, table.rows)
