"""Matching: the tables of the thesis recomputed, the least sum of distances, what is missed and what is extra."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.library import as_corrected, as_printed, published
from muster.mission.errors import ParameterError

pytest.importorskip("scipy")
from muster.perception.matching import error_table, matched

TABLES = published("tcf-points-of-interest")["tables"]
some = st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=1, max_size=5).map(np.array)


def table_of(number, found="found"):
    rows = TABLES[number]["tags"]
    return error_table([row[found] for row in rows][::-1], {str(row["tag"]): row["truth"] for row in rows})


def test_table_6_4():
    table = table_of("6.4")
    rows = {row.name: row for row in table.matches}
    for row in TABLES["6.4"]["tags"]:
        assert rows[str(row["tag"])].found == tuple(row["found"])
        assert rows[str(row["tag"])].error_m == pytest.approx(row["error"], abs=0.0012)
    assert table.matches[0].name == "1"
    assert table.mean_error_m == pytest.approx(0.241, abs=0.0005)
    assert np.mean([row.error_m for row in table.matches[1:]]) == pytest.approx(0.210, abs=0.0005)
    assert table.mean_distance_m == pytest.approx(12.29, abs=0.005)
    assert table.mean_error_m / table.mean_distance_m == pytest.approx(0.0196, abs=0.0001)


@pytest.mark.parametrize(("side", "mean"), [("", "mean_error"), ("_real", "mean_error_real")])
def test_table_6_5(side, mean):
    table = table_of("6.5", f"found{side}")
    rows = {row.name: row for row in table.matches}
    for row in TABLES["6.5"]["tags"]:
        assert rows[str(row["tag"])].error_m == pytest.approx(row[f"error{side}"], abs=0.001)
    assert table.mean_error_m == pytest.approx(TABLES["6.5"][mean], abs=0.0006)


def test_the_mean_distance_of_table_6_5_counts_each_tag_with_itself():
    table = table_of("6.5")
    distance = table.mean_distance_m
    assert distance == pytest.approx(as_corrected(TABLES["6.5"])["mean_distance"], abs=0.005)
    assert distance * 5 / 6 == pytest.approx(as_printed(TABLES["6.5"])["mean_distance"], abs=0.005)
    share = as_corrected(TABLES["6.5"])["mean_error_share"]
    assert table.mean_error_m / distance == pytest.approx(share, abs=0.0001)


@given(some, some)
def test_the_sum_of_distances_is_least(truth, found):
    pairs = matched(truth, found)
    assert len(pairs) == min(len(truth), len(found))
    less, more = sorted((truth, found), key=len)
    best = min(sum(map(math.dist, less, chosen)) for chosen in itertools.permutations(more.tolist(), len(less)))
    assert sum(math.dist(truth[i], found[j]) for i, j in pairs) == pytest.approx(best, abs=1e-9)


@given(some, some, st.floats(0.1, 10))
def test_the_farthest_is_a_limit(truth, found, farthest):
    table = error_table(list(found), {str(i): place for i, place in enumerate(truth)}, farthest)
    assert all(row.error_m < farthest for row in table.matches)
    assert len(table.matches) + len(table.missed) == len(truth)
    assert len(table.matches) + len(table.extra) == len(found)
    errors = [row.error_m for row in table.matches]
    assert errors == sorted(errors, reverse=True)
    for place in table.extra:  # no two that are left would have been a match
        assert all(math.dist(place, truth[int(name)]) >= farthest for name in table.missed)


def test_one_missed_and_one_where_nothing_is():
    table = error_table([[0.1, 0], [9, 9]], {"a": [0, 0], "b": [5, 0]}, farthest_m=1.0)
    assert [(row.name, row.found) for row in table.matches] == [("a", (0.1, 0.0))]
    assert (table.missed, table.extra) == (("b",), ((9.0, 9.0),))


def test_nothing_found_is_all_missed():
    table = error_table([], {"a": [0, 0], "b": [5, 0]})
    assert (table.matches, table.missed, table.extra) == ((), ("a", "b"), ())
    assert math.isnan(table.mean_error_m)
    assert math.isnan(table.greatest_error_m)
    assert error_table([[1, 1]], {}).extra == ((1.0, 1.0),)


@pytest.mark.parametrize(
    ("found", "truth", "farthest", "message"),
    [
        ([[0, 0]], {"a": [0, 0]}, 0.0, "farthest_m: 0.0; expected metres above 0"),
        ([[0, 0, 0]], {"a": [0, 0]}, 1.0, "found: 3 coordinates; expected 2, as the truth"),
        ([[0, 0], [0, 0, 0]], {"a": [0, 0]}, 1.0, r"found: shapes .*; expected all \(2,\) or all \(3,\)"),
        ([[0]], {"a": [0, 0]}, 1.0, r"found: shapes .*; expected all \(2,\) or all \(3,\)"),
        ([[0, 0]], {"a": [0, math.inf]}, 1.0, "truth: a number that is not finite"),
    ],
)
def test_places_that_are_none_are_refused(found, truth, farthest, message):
    with pytest.raises(ParameterError, match=message):
        error_table(found, truth, farthest)
