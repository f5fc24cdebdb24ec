"""Points of interest while they are being found: when one counts, when it is told again, what is one and what two."""

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception.estimates import RawEstimates
from muster.perception.point_search import FoundCriteria, PointSearch


def seen(tag, *places, deviation=0.05, robot="d", at_s=0.0):
    count = len(places)
    return RawEstimates(
        np.array(places, dtype=float),
        np.tile(np.eye(2) * deviation**2, (count, 1, 1)),
        np.full(count, tag),
        (robot,) * count,
        np.full(count, at_s),
    )


def test_a_point_counts_when_it_was_seen_often_enough():
    search = PointSearch(FoundCriteria(sightings=3))
    assert search.take(seen(4, (1, 1)), 0.0) == ()
    assert search.take(seen(4, (1, 1), at_s=6.0), 6.0) == ()
    (find,) = search.take(seen(4, (1, 1), at_s=12.0), 12.0)
    assert (find.tag, find.number, find.at_s, find.point.sightings) == (4, 0, 12.0, 3)
    assert search.take(seen(4, (1, 1), at_s=18.0), 18.0) == ()
    assert search.finds[0].at_s == 12.0
    assert search.finds[0].point.sightings == 4


def test_a_point_counts_when_it_is_known_well_enough():
    search = PointSearch(FoundCriteria(sightings=1, deviation_m=0.15))
    views = [seen(4, (1, 1), deviation=0.29, at_s=10.0 * k) for k in range(5)]
    found = [len(search.take(view, 10.0 * k)) for k, view in enumerate(views)]
    assert found == [0, 0, 0, 1, 0]  # 0.29 / 2 is below 0.15, 0.29 / sqrt(3) is not


def test_what_follows_fast_by_one_robot_is_no_more_certain():
    search = PointSearch(FoundCriteria(sightings=3, deviation_m=0.15))
    for k in range(50):
        assert search.take(seen(4, (1, 1), deviation=0.29, at_s=0.05 * k), 0.05 * k) == ()


def test_it_is_told_again_when_it_lies_elsewhere():
    search = PointSearch(FoundCriteria(sightings=1, moved_m=0.25, apart_m=1.0))
    assert len(search.take(seen(4, (1.0, 1.0), deviation=0.14), 0.0)) == 1
    assert search.take(seen(4, (1.1, 1.0), deviation=0.05, at_s=9.0), 9.0) == ()
    (again,) = search.take(seen(4, (1.6, 1.0), deviation=0.02, at_s=20.0), 20.0)
    assert (again.number, again.at_s) == (0, 0.0)
    assert again.point.position[0] > 1.25
    assert len(search.finds) == 1


def test_a_tag_at_two_places_is_two_points():
    search = PointSearch(FoundCriteria(sightings=1))
    first, second = search.take(seen(4, (0, 0), (9, 0)), 0.0)
    assert (first.number, second.number) == (0, 1)
    assert [find.point.position.tolist() for find in search.finds] == [[0, 0], [9, 0]]
    assert search.take(seen(4, (9, 0), (0, 0), at_s=9.0), 9.0) == ()


def test_a_stray_sighting_beside_a_find_does_not_take_its_place():
    search = PointSearch(FoundCriteria(sightings=2, apart_m=1.0))
    (find,) = search.take(seen(4, (0, 0.5), (0, -0.5)), 0.0)
    assert search.take(seen(4, (0.95, 0), at_s=9.0), 9.0) == ()  # farther than 1 m from each, not from their mean
    assert [found.point.position.tolist() for found in search.finds] == [find.point.position.tolist()]


def test_places_between_make_one_point_of_two_that_were_not_found():
    search = PointSearch(FoundCriteria(sightings=3, deviation_m=1.0, apart_m=1.0))
    assert search.take(seen(4, (0, 0), (1.6, 0)), 0.0) == ()
    (find,) = search.take(seen(4, (0.8, 0), at_s=9.0), 9.0)
    assert find.point.position == pytest.approx([0.8, 0.0])
    assert find.point.sightings == 3


def test_all_estimates_are_kept():
    search = PointSearch()
    search.take(RawEstimates.joined([seen(4, (1, 1)), seen(2, (5, 5), (6, 6), robot="e")]), 0.0)
    assert search.raw.tags.tolist() == [2, 2, 4]
    assert search.raw.robots == ("e", "e", "d")


@pytest.mark.parametrize("name", ["sightings", "deviation_m", "moved_m", "apart_m", "independent_after_s"])
def test_a_proof_needs_numbers_above_0(name):
    with pytest.raises(ParameterError, match=name):
        FoundCriteria(**{name: 0})
