"""Monte Carlo localisation: tracking, finding a pose without a start, and a robot that is carried elsewhere."""

import math

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.perception.laser import Scanner
from muster.perception.likelihood_field import LikelihoodField
from muster.perception.monte_carlo import MonteCarlo, MonteCarloParameters, kld_count

ROOM = np.array([[0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 2, 4], [2, 4, 2, 3], [2, 3, 0, 3], [0, 3, 0, 0.0]])
SCANNER = Scanner(reach_m=8.0, step_rad=math.radians(2), range_m=0.02)


def anywhere(random, count):
    places = random.uniform([0.1, 0.1], [5.9, 2.9], (count, 2))
    return np.column_stack([places, random.uniform(-math.pi, math.pi, count)])


@pytest.fixture(scope="module")
def field():
    return LikelihoodField.of_walls(ROOM)


def followed(particles, poses, random):
    """The estimate after a robot went through poses, scanning at each."""
    before = poses[0]
    for pose in poses:
        east, north = pose[:2] - before[:2]
        c, s = math.cos(before[2]), math.sin(before[2])
        particles.move(c * east + s * north, c * north - s * east, pose[2] - before[2])
        ranges = SCANNER.measured(SCANNER.ranges(tuple(pose), ROOM), random)
        particles.correct(ranges, SCANNER.bearings)
        before = pose
    return particles.estimate.mean


def straight(x, count=12):
    return np.array([[x + 0.1 * k, 1.0, 0.0] for k in range(count)])


def test_the_field_is_the_distance_to_the_nearest_wall(field):
    points = np.array([[3.0, 1.0], [5.5, 2.0], [1.0, 2.9], [-0.5, 1.0]])
    np.testing.assert_allclose(field.distances(points), [1.0, 0.5, 0.1, 0.5], atol=0.06)


def test_far_outside_no_wall_is_near(field):
    assert field.distances(np.array([[100.0, 100.0]])) > 0.9


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_it_tracks(field, seed):
    way = straight(1.0)
    particles = MonteCarlo(field, anywhere, seed=seed, start=tuple(way[0]))
    found = followed(particles, way, np.random.default_rng(seed))
    np.testing.assert_allclose(found, way[-1], atol=0.1)
    assert len(particles.particles) < 1000


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_it_finds_a_robot_that_does_not_know_where_it_starts(field, seed):
    way = straight(1.0, 25)
    found = followed(MonteCarlo(field, anywhere, seed=seed), way, np.random.default_rng(seed))
    np.testing.assert_allclose(found, way[-1], atol=0.15)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_it_finds_a_robot_that_was_carried_elsewhere(field, seed):
    random = np.random.default_rng(seed)
    first, later = straight(0.5), straight(3.0, 25) + np.array([0.0, 1.2, 0.0])
    particles = MonteCarlo(field, anywhere, seed=seed, start=tuple(first[0]))
    followed(particles, first, random)
    carried = particles.estimate.mean
    assert math.dist(carried[:2], later[0, :2]) > 1.0
    np.testing.assert_allclose(followed(particles, later, random), later[-1], atol=0.15)


@pytest.mark.long
def test_the_same_seed_gives_the_same_particles(field):
    one, two = (MonteCarlo(field, anywhere, seed=5) for _ in range(2))
    for particles in (one, two):
        followed(particles, straight(1.0, 3), np.random.default_rng(0))
    np.testing.assert_array_equal(one.particles, two.particles)


def test_a_scan_without_echoes_changes_nothing(field):
    particles = MonteCarlo(field, anywhere, seed=0)
    before = particles.particles.copy()
    particles.correct(np.full(len(SCANNER.bearings), np.inf), SCANNER.bearings)
    np.testing.assert_array_equal(particles.particles, before)


def test_kld_sampling_wants_what_the_chi_square_quantile_wants():
    stats = pytest.importorskip("scipy.stats")
    for bins in (5, 50, 500):
        exact = stats.chi2.ppf(0.99, bins - 1) / (2 * 0.05)
        assert kld_count(np.array([bins]), 0.05, stats.norm.ppf(0.99))[0] == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize(
    ("key", "value"), [("least", 0), ("most", 10), ("good_fit", 1.5), ("deviation_m", -1.0), ("stray_share", math.nan)]
)
def test_parameters_out_of_range(key, value):
    with pytest.raises(ParameterError, match="most" if key == "least" else key) as error:
        MonteCarloParameters(**{"least": 500, key: value} if key != "least" else {"least": 30_000})
    assert "expected" in str(error.value)


@pytest.mark.parametrize("walls", [np.empty((0, 4)), np.zeros((3, 2)), np.full((1, 4), np.nan)])
def test_walls_that_are_none(walls):
    with pytest.raises(ParameterError, match="walls"):
        LikelihoodField.of_walls(walls)
