"""Whether routes keep their distance in time: against closed forms, and against fine sampling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

from muster.execution.reports.itinerary import Itinerary, Passage
from muster.execution.reports.separation import meetings
from muster.mission.model import Robot


def itinerary(name, *passages, radius_m=0.5):
    robot = Robot(id=name, position=(0, 0, 0), radius_m=radius_m)
    return Itinerary(
        robot, tuple(Passage(place, arrives, leaves) for place, arrives, leaves in passages), has_end=False
    )


EAST = itinerary("east", ((-10, 0, 5), 0, 0), ((10, 0, 5), 20, 20))


def test_crossing_at_the_same_time_is_named_with_time_and_distance():
    north = itinerary("north", ((0, -10, 5), 0, 0), ((0, 10, 5), 20, 20))
    (meeting,) = meetings([EAST, north])
    assert (meeting.robots, meeting.time_s, meeting.distance_m) == (("east", "north"), 10, 0)
    assert str(meeting) == "east and north: 0.00 m apart at 10.0 s of the schedule; expected at least 1.00 m"


@pytest.mark.parametrize(("height", "near"), [(6.01, 0), (5.99, 1)])
def test_height_keeps_apart(height, near):
    north = itinerary("north", ((0, -10, height), 0, 0), ((0, 10, height), 20, 20))
    assert len(meetings([EAST, north])) == near
    assert len(meetings([EAST, north], clearance_m=0.5)) == 1


def test_time_keeps_apart():
    later = itinerary("later", ((0, -10, 5), 0, 3), ((0, 10, 5), 23, 23))
    assert meetings([EAST, later]) == ()


def test_who_has_arrived_stays_there():
    stays = itinerary("stays", ((8, 0, 5), 0, 0))
    (meeting,) = meetings([EAST, stays])
    assert (meeting.time_s, meeting.distance_m) == (18, 0)


def test_two_that_stand_do_not_meet():
    assert meetings([itinerary("a", ((0, 0, 0), 0, 9)), itinerary("b", ((0.1, 0, 0), 0, 9))]) == ()


places = st.tuples(*[st.integers(-5, 5).map(float)] * 3)


@st.composite
def walks(draw, name):
    now, passages = 0.0, []
    for place in draw(st.lists(places, min_size=1, max_size=5)):
        arrives = now + draw(st.integers(1, 4)) if passages else 0.0
        now = arrives + draw(st.integers(0, 3))
        passages.append((place, arrives, now))
    return itinerary(name, *passages, radius_m=1.0)


@examples(60)
@given(walks("a"), walks("b"))
def test_agrees_with_fine_sampling(a, b):
    times = np.linspace(0, 40, 8001)
    first, second = (_sampled(walk, times) for walk in (a, b))
    moving = [_moves(walk, times) for walk in (a, b)]
    under_way = moving[0] | moving[1]
    sampled = np.linalg.norm(first - second, axis=1)[under_way].min(initial=np.inf)
    for meeting in meetings([a, b], clearance_m=50):
        assert meeting.distance_m <= sampled + 1e-9
        assert sampled <= meeting.distance_m + 0.1  # a step of 5 ms at no more than 2 x 17.4 m/s
        assert np.linalg.norm(_sampled(a, [meeting.time_s]) - _sampled(b, [meeting.time_s])) == pytest.approx(
            meeting.distance_m, abs=1e-9
        )
    assert bool(meetings([a, b], clearance_m=50)) == bool(under_way.any())


def _sampled(walk, times):
    known = [time for p in walk.passages for time in (p.arrives_s, p.leaves_s)]
    points = np.repeat([p.place for p in walk.passages], 2, axis=0)
    return np.stack([np.interp(times, known, points[:, axis]) for axis in range(3)], axis=1)


def _moves(walk, times):
    moving = np.zeros(len(times), dtype=bool)
    for before, after in zip(walk.passages, walk.passages[1:], strict=False):
        if before.place != after.place:
            moving |= (times >= before.leaves_s) & (times <= after.arrives_s)
    return moving


@pytest.mark.parametrize(("waits_s", "near"), [(5, 0), (11, 1)])
def test_who_works_at_the_crossing_is_in_the_way_while_it_works(waits_s, near):
    """It is there from 3 s on; the other comes by at 10 s, and within 1 m from 9 s on."""
    works = itinerary("works", ((0, -3, 5), 0, 0), ((0, 0, 5), 3, 3 + waits_s), ((0, 30, 5), 4 + waits_s, 4 + waits_s))
    assert len(meetings([EAST, works])) == near


def test_one_that_crosses_twice_is_named_once_where_it_is_nearest():
    back = itinerary("back", ((-5, 0.6, 5), 0, 5), ((-5, 0.3, 5), 5, 5), ((-5, 9, 5), 6, 14), ((5, 0, 5), 15, 15))
    (meeting,) = meetings([EAST, back])
    assert (meeting.time_s, meeting.distance_m) == (15, 0)


def test_fifty_robots_of_forty_tasks():
    """All 1225 pairs: on rings of their own, 3 m apart, none meets; one that is on the ring of another does."""
    team = [ring(f"r{k}", 10 + 3 * k, k) for k in range(50)]
    assert meetings(team) == ()
    (meeting,) = meetings([*team[:49], ring("last", 10, 5)])
    assert meeting.robots == ("r0", "last")


def ring(name, radius_m, begins_s):
    """Forty tasks of 3 s on a circle, 8 s on the way to each."""
    turns = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    spots = [(radius_m * np.cos(turn), radius_m * np.sin(turn), 0.0) for turn in turns]
    return itinerary(name, *((spot, begins_s + 11.0 * k, begins_s + 11.0 * k + 3) for k, spot in enumerate(spots)))
