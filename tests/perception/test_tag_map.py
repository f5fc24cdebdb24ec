"""Tags that robots see while they drift: one place a tag, as sure as the robots were, and no surer by looking again."""

import math

import numpy as np
import pytest

from muster.motion.frames import wrapped
from muster.perception import dead_reckoning
from muster.perception.dead_reckoning import Odometry, Seen
from muster.perception.errors import ReckoningErrors
from muster.perception.estimates import RawEstimates
from muster.perception.joint_estimate import HEADING
from muster.perception.point_search import FoundCriteria, FoundPoint
from muster.perception.points_of_interest import PointOfInterest, radius_95
from muster.perception.tag_map import TagMap

NOTHING = RawEstimates.joined([])
SIGHT_M = 0.02
DRIFTS = ReckoningErrors(way_share=0.05, aside_share=0, turn_share=0, turn_per_m=0.1, slip=0, skid=0)
SURE = (1e-3, 1e-3, 1e-3, 1e-3)


def standing(x=0.0, y=0.0, heading=0.0, deviation=1e-3):
    return dead_reckoning.standing_at([x, y, 0, heading], [deviation, deviation, 1e-3, deviation], DRIFTS)


def sighting(x, y):
    return Seen(np.array([x, y]), SIGHT_M**2 * np.eye(2))


def looked(tags, robot, estimate, *seen, times=1):
    """The estimate after a robot has seen tags, (id, x, y) ahead and to the left; and what is news."""
    news = []
    for _ in range(times):
        what = [(tag, sighting(x, y)) for tag, x, y in seen]
        estimate, new = tags.take(robot, estimate, what, NOTHING, float(len(news)))
        news += new
    return estimate, news


def test_a_tag_is_found_when_it_was_seen_often_enough():
    tags = TagMap(FoundCriteria(sightings=3))
    _, news = looked(tags, "d", standing(1.0, 2.0, math.pi / 2), (4, 1.0, 0.0), times=5)
    (find,) = news
    assert (find.tag, find.number) == (4, 0)
    assert find.point.position == pytest.approx([1.0, 3.0])
    assert (tags.finds[0].point.sightings, tags.finds[0].point.robots, tags.seen) == (5, ("d",), {4})


def test_looking_again_makes_nobody_surer_than_the_robot_is():
    tags = TagMap()
    looked(tags, "d", standing(deviation=0.3), (4, 1.0, 0.0), times=100)
    (find,) = tags.finds
    assert np.sqrt(np.diag(find.point.covariance)) == pytest.approx([0.3, math.hypot(0.3, 0.3)], rel=0.05)


def test_robots_know_one_tag_apart_from_each_other():
    """Two that are as unsure: the mean, by half of the variance."""
    tags = TagMap()
    looked(tags, "d", standing(0.0, 0.0, deviation=0.1), (4, 5.0, 0.0), times=3)
    before = tags.finds[0].point.covariance
    looked(tags, "e", standing(10.2, 0.0, math.pi, deviation=0.1), (4, 5.0, 0.0), times=3)
    (find,) = tags.finds
    assert find.point.position == pytest.approx([5.1, 0.0], abs=0.02)
    assert find.point.covariance[0, 0] == pytest.approx(before[0, 0] / 2, rel=0.05)
    assert find.point.robots == ("d", "e")


@pytest.mark.parametrize("robots", [("d", "d"), ("d", "e")])
def test_two_tags_of_an_id_are_two_places_where_robots_know_that(robots):
    tags = TagMap(FoundCriteria(sightings=1))
    estimate, _ = looked(tags, robots[0], standing(), (4, 1.0, 0.0))
    looked(tags, robots[1], estimate if robots[0] == robots[1] else standing(), (4, 3.0, 0.0))
    assert [find.point.position.round(2).tolist() for find in tags.finds] == [[1, 0], [3, 0]]
    assert [find.number for find in tags.finds] == [0, 1]


def test_what_fits_no_mark_and_is_no_other_tag_is_left_out():
    tags = TagMap()
    estimate, _ = looked(tags, "d", standing(), (4, 1.0, 0.0), times=3)
    after, news = looked(tags, "d", estimate, (4, 1.5, 0.0))
    assert news == []
    assert after.mean == pytest.approx(estimate.mean)
    assert len(tags.finds) == 1


def test_it_is_news_when_a_place_turns_out_to_be_elsewhere():
    tags = TagMap(FoundCriteria(moved_m=0.25))
    looked(tags, "d", standing(deviation=0.5), (4, 1.0, 0.0), times=3)
    _, news = looked(tags, "e", standing(0.8, 0.0, deviation=0.01), (4, 1.0, 0.0))
    (again,) = news
    assert again.number == 0
    assert again.point.position == pytest.approx([1.8, 0.0], abs=0.02)


def test_what_was_found_before_counts_as_one_estimate():
    tags = TagMap()
    point = PointOfInterest(np.array([5.0, 0.0]), 0.01 * np.eye(2), 7, ("e",), 4)
    tags.resume([FoundPoint(4, 0, 3.0, point)])
    looked(tags, "d", standing(deviation=0.1), (4, 5.2, 0.0))
    (find,) = tags.finds
    assert (find.at_s, find.point.sightings, find.point.robots) == (3.0, 8, ("d", "e"))
    assert 5.05 < find.point.position[0] < 5.15


def driven(seed, *, rounds=2, steps=40, step_m=0.25):
    """A robot that drives around a square and sees tags in it: its estimate, its true pose, the map, and the tags."""
    random, tags, places = np.random.default_rng(seed), TagMap(), [(2.0, 2.0), (8.0, 1.0), (7.5, 8.0), (2.0, 7.0)]
    pose, estimate = np.zeros(3), standing()
    for k in range(rounds * 4 * steps):
        turn = math.pi / 2 if k % steps == steps - 1 else 0.0
        amid = pose[2] + turn / 2
        pose = pose + np.array([step_m * math.cos(amid), step_m * math.sin(amid), turn])
        counted = step_m / (1 + DRIFTS.way_share * random.normal())
        turned = turn + DRIFTS.turn_per_m * counted * random.normal()
        estimate = dead_reckoning.moved(estimate, Odometry(0.1, (counted, 0.0, 0.0), turned), DRIFTS)
        if k % 5 == 0:
            c, s = math.cos(pose[2]), math.sin(pose[2])
            seen = [np.array([[c, s], [-s, c]]) @ (np.array(place) - pose[:2]) for place in places]
            near = [(tag, *(at + random.normal(0, SIGHT_M, 2))) for tag, at in enumerate(seen) if np.hypot(*at) < 4]
            estimate, _ = looked(tags, "d", estimate, *near)
    return estimate, pose, tags, np.array(places)


@pytest.mark.long
@pytest.mark.parametrize("runs", [12, pytest.param(100, marks=pytest.mark.long)])
def test_errors_are_as_large_as_estimates_say(runs):
    """The heading drifts by 0.3 rad a round, so that places lie along arcs."""
    poses, places = [], []
    for seed in range(runs):
        estimate, pose, tags, truth = driven(seed)
        error, covariance = estimate.error_of([*pose[:2], wrapped(pose[2])])
        poses.append(error @ np.linalg.solve(covariance, error) / 3)
        assert sorted(find.tag for find in tags.finds) == [0, 1, 2, 3]  # one place a tag
        for find in tags.finds:
            off = find.point.position - truth[find.tag]
            places.append(off @ np.linalg.solve(find.point.covariance, off) / 2)
            assert np.linalg.norm(off) < 3 * radius_95(find.point.covariance)
    wide = 3 / math.sqrt(runs)  # places of a run are off together
    assert np.mean(poses) == pytest.approx(1.0, abs=wide * math.sqrt(2 / 3))
    assert np.mean(places) == pytest.approx(1.0, abs=wide)


def test_a_radius_holds_95_of_100():
    random = np.random.default_rng(1)
    for least in (0.0, 0.3, 0.7, 1.0):
        covariance = np.diag([least**2, 1.0])
        drawn = random.normal(0, 1, (100_000, 2)) * [least, 1.0]
        assert np.mean(np.hypot(*drawn.T) < radius_95(covariance)) == pytest.approx(0.95, abs=0.004)


def test_the_heading_is_known_by_what_is_seen_again():
    estimate, *_ = driven(1, rounds=1)
    assert estimate.deviations[HEADING] < 0.2
