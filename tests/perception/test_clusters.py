"""Clusters: what each method promises, and the thesis' failure with a tag that was rarely seen."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.library import as_printed, published
from muster.mission.errors import MissingExtraError, ParameterError

pytest.importorskip("scipy")
from muster.perception.clusters import LONE, by_density, by_means, by_tag, inertia, linked
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.matching import error_table
from muster.perception.points_of_interest import points_of_interest

from .seen import seen

places = st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), min_size=1, max_size=25).map(
    lambda found: np.array(found, dtype=float)
)
TAGS = as_printed(published("tcf-points-of-interest")["tables"]["6.4"]["tags"])
TRUTH = np.array([row["truth"] for row in TAGS])
NAMES = {str(row["tag"]): row["truth"] for row in TAGS}
RARE = 6
"""Sightings of tag 1."""


@pytest.fixture(scope="module")
def raw():
    """The 30 tags of Table 6.4; tag 1 rarely seen, its neighbours 24 and 28 often and stretched (Figure 6.5)."""
    counts, along_m = np.full(30, 100), np.full(30, 0.08)
    counts[0], counts[[23, 27]], along_m[[23, 27]] = RARE, 400, 0.25
    return seen(TRUTH, counts, along_m)


def table(raw, labels):
    return error_table([point.position for point in points_of_interest(raw, labels)], NAMES)


def test_k_means_misplaces_the_tag_that_was_rarely_seen(raw):
    """As in Table 6.4: tag 1 by more than a metre, nearer to 24 than to itself; 24 by some, all others by little."""
    found = table(raw, by_means(raw.positions, 30))
    first, second, *others = found.matches
    assert (first.name, second.name) == ("1", "24")
    assert 1.0 < first.error_m < 1.3
    assert math.dist(first.found, NAMES["24"]) < 0.5
    assert 0.1 < second.error_m < 0.2
    assert max(row.error_m for row in others) < 0.03


def test_it_is_not_the_search_that_fails_but_what_is_searched_for(raw):
    """The right clusters have the greater inertia (4.46): the wrong ones are the better answer to that question."""
    assert inertia(raw.positions, by_means(raw.positions, 30)) < inertia(raw.positions, raw.tags)


@pytest.mark.parametrize("method", ["density", "tag"])
def test_by_density_and_by_tag_the_rare_one_is_as_good_as_the_others(raw, method):
    labels = by_density(raw.positions, 0.2) if method == "density" else by_tag(raw, 1.0)
    found = table(raw, labels)
    assert (found.missed, found.extra) == ((), ())
    assert found.greatest_error_m < 3 * 0.08 / math.sqrt(RARE)  # three standard deviations of its mean
    assert found.mean_error_m < 0.015


@given(places, st.integers(1, 6), st.integers(0, 5))
def test_by_means_each_is_with_its_nearest_mean(positions, count, seed):
    count = min(count, len(positions))
    labels = by_means(positions, count, seed, starts=3)
    means = np.array([positions[labels == label].mean(axis=0) for label in np.unique(labels)])
    own = np.linalg.norm(positions - means[np.searchsorted(np.unique(labels), labels)], axis=1)
    assert (own <= np.linalg.norm(positions[:, None] - means, axis=2).min(axis=1) + 1e-9).all()
    assert set(labels) <= set(range(count))
    assert (by_means(positions, count, seed, starts=3) == labels).all()


@given(places)
def test_as_many_means_as_places_leave_no_inertia(positions):
    different = len(np.unique(positions, axis=0))
    assert inertia(positions, by_means(positions, different)) == 0


@given(places, st.integers(0, 6), st.integers(0, 6))
def test_more_starts_never_give_more_inertia(positions, seed, more):
    few, many = (inertia(positions, by_means(positions, min(3, len(positions)), seed, n)) for n in (1, 1 + more))
    assert many <= few


@given(places, st.floats(0.5, 4), st.integers(1, 5))
def test_by_density_is_what_its_definition_says(positions, radius, least):
    labels = by_density(positions, radius, least)
    near = np.linalg.norm(positions[:, None] - positions, axis=2) <= radius
    core = near.sum(axis=1) >= least
    assert (labels[core] != LONE).all()
    for i in range(len(positions)):
        cores = np.flatnonzero(near[i] & core)
        if core[i]:
            assert (labels[cores] == labels[i]).all()
        else:  # at the rim of a cluster, or alone
            assert labels[i] in (set(labels[cores].tolist()) or {LONE})
    for label in range(labels.max() + 1):  # and each cluster hangs together through its cores
        members = np.flatnonzero(core & (labels == label))
        reached, todo = {members[0]}, [members[0]]
        while todo:
            new = set(np.flatnonzero(near[todo.pop()] & core)) - reached
            reached |= new
            todo.extend(new)
        assert reached == set(members)


@given(places, st.floats(0.5, 4), st.integers(0, 40))
def test_linked_is_density_without_rims_however_many_are_taken_in_before(positions, apart, known):
    labels = linked(positions, apart, linked(positions[:known], apart))
    assert np.unique(labels, return_inverse=True)[1].tolist() == by_density(positions, apart, 1).tolist()


def test_by_tag_a_tag_at_two_places_is_two_things():
    raw = RawEstimates.at([[0, 0], [5, 5], [0.1, 0], [5, 5.1], [0.2, 0.1]], [3, 3, 3, 3, 4])
    assert by_tag(raw, 1.0).tolist() == [0, 1, 0, 1, 2]


def test_by_tag_what_was_not_decoded_stays_alone():
    raw = RawEstimates.at([[0, 0], [0.1, 0], [0, 0.1]], [NO_TAG, 5, NO_TAG])
    assert by_tag(raw, 1.0).tolist() == [LONE, 0, LONE]


def test_nothing_gives_no_clusters():
    nothing = RawEstimates.joined([])
    assert by_density(nothing.positions, 1.0).tolist() == by_tag(nothing, 1.0).tolist() == []


@pytest.mark.parametrize(
    ("cluster", "message"),
    [
        (lambda p: by_means(p, 0), "count: 0; expected at least 1"),
        (lambda p: by_means(p, 3), "count: 3; expected at most 2, the number of estimates"),
        (lambda p: by_means(p, 1, starts=0), "starts: 0; expected at least 1"),
        (lambda p: by_density(p, 0.0), "radius_m: 0.0; expected metres above 0"),
        (lambda p: by_density(p, 1.0, 0), "least: 0; expected at least 1"),
        (lambda p: by_tag(RawEstimates.at(p, [1, 1]), 0.0), "apart_m: 0.0; expected metres above 0"),
    ],
)
def test_numbers_out_of_range_are_refused(cluster, message):
    with pytest.raises(ParameterError, match=message):
        cluster(np.zeros((2, 2)))


def test_without_scipy_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "scipy", None)
    with pytest.raises(MissingExtraError, match=r"clusters by density needs .*muster-robotics\[physics\]"):
        by_density(np.zeros((2, 2)), 1.0)
