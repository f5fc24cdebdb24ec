"""Robots that see each other share what they know, and never become surer than they may be."""

import math

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception.collaborative_localisation import by_teammate
from muster.perception.errors import GroundErrors
from muster.perception.kalman import Estimate

ERRORS = GroundErrors(range_m=0.02, bearing_rad=0.01)


def lost(place=(0.0, 0.0, 0.0), spread=(1.0, 1.0, 0.02)):
    return Estimate(np.array(place), np.diag(spread) ** 2)


def test_a_teammate_that_knows_its_place_brings_a_lost_robot_back():
    mate = Estimate(np.array([3.0, 4.0]), 0.01**2 * np.eye(2))
    true = np.array([0.6, -0.3, 0.0])
    seen = math.dist(true[:2], mate.mean), math.atan2(4.3, 2.4)
    found = by_teammate(lost(), mate, *seen, ERRORS)
    assert math.dist(found.mean[:2], true[:2]) < 0.2
    assert np.trace(found.covariance[:2, :2]) < 0.1


def test_a_teammate_that_knows_less_changes_little():
    own, mate = lost(spread=(0.05, 0.05, 0.01)), Estimate(np.array([3.0, 4.0]), 25.0 * np.eye(2))
    found = by_teammate(own, mate, 5.0, math.atan2(4.0, 3.0), ERRORS)
    assert np.linalg.norm(found.mean - own.mean) < 0.02


def test_the_same_knowledge_told_again_and_again_makes_nobody_sure():
    """Two robots that only see each other: as independent sightings their errors would seem to shrink without end."""
    one, two = lost(), Estimate(np.array([2.0, 0.0, 0.0]), np.diag([1.0, 1.0, 0.02]) ** 2)
    for _ in range(50):
        one, two = by_teammate(one, two, 2.0, 0.0, ERRORS), by_teammate(two, one, 2.0, math.pi, ERRORS)
    assert one.deviations[:2].min() > 0.7
    assert two.deviations[:2].min() > 0.7


def test_a_sighting_that_does_not_fit_is_left_out():
    own = lost(spread=(0.05, 0.05, 0.01))
    mate = Estimate(np.array([3.0, 4.0]), 0.01 * np.eye(2))
    assert by_teammate(own, mate, 50.0, 0.0, ERRORS) is own


def test_two_robots_at_one_place_have_no_bearing():
    with pytest.raises(ParameterError, match="another place"):
        by_teammate(lost(), Estimate(np.zeros(2), np.eye(2)), 0.0, 0.0, ERRORS)
