"""Lengths that are kept between tables of places equal those that are searched for anew."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.motion.paths import kept_lengths
from muster.motion.paths.kept_lengths import KeptLengths

places = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 4)), min_size=1, max_size=12)
tables = st.lists(st.tuples(places, places | st.none()), min_size=1, max_size=8)


def apart(exits, entries, threads):
    """The straight distances; between the two sides of x = 3.5 there is no path."""
    metres = np.linalg.norm(exits[:, None] - entries[None], axis=2)
    metres[(exits[:, None, 0] > 3.5) != (entries[None, :, 0] > 3.5)] = np.inf
    return metres


@given(tables, st.sampled_from([4, 9, 30]))
def test_tables_equal_those_that_are_searched_for_anew(tables, most):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kept_lengths, "MOST_PLACES", most)
        kept = KeptLengths(apart)
        for exits, entries in tables:
            leave, enter = (np.array(some, dtype=np.float64) for some in (exits, exits if entries is None else entries))
            assert kept.lengths(leave, enter, 1) == pytest.approx(apart(leave, enter, 1))
            assert len(kept._number) <= most
            assert kept._table.shape == (len(kept._number),) * 2


def test_no_length_is_searched_for_twice():
    asked = []

    def search(exits, entries, threads):
        asked.extend((tuple(a), tuple(b)) for a in exits.tolist() for b in entries.tolist())
        return apart(exits, entries, threads)

    kept, random = KeptLengths(search), np.random.default_rng(3)
    tasks = random.uniform(0, 3, (30, 2))
    kept.lengths(tasks, tasks, 1)
    for _ in range(5):  # robots are elsewhere, and a task comes
        asked.clear()
        robots, new = random.uniform(0, 3, (4, 2)), random.uniform(0, 3, (1, 2))
        tasks = np.concatenate([tasks, new])
        here = np.concatenate([robots, tasks])
        assert kept.lengths(here, here, 1) == pytest.approx(apart(here, here, 1))
        moved = {tuple(place) for place in (*robots.tolist(), *new.tolist())}
        assert {a for a, _ in asked} == moved
        asked.clear()
        kept.lengths(tasks, here, 1)
        assert not asked
