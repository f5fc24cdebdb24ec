"""SPIKE: profiles by hand, cylinders in the paper's arena, and what is no landmark."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.laser import Scanner
from muster.perception.spikes import SpikeParameters, landmarks, spikes

SCANNER = Scanner()
ARENA = np.array([[-1, -1, 1, -1], [1, -1, 1, 1], [1, 1, -1, 1], [-1, 1, -1, -1]], dtype=float)
SEARCH = SpikeParameters(depth_m=0.07)


@pytest.mark.parametrize(
    ("profile", "runs"),
    [
        ([2, 2, 1, 2, 2], [(2, 3)]),
        ([2, 1, 1, 1.05, 2], [(1, 4)]),
        ([math.inf, 1, math.inf, math.inf, 1, 1, math.inf], [(1, 2), (4, 6)]),
        ([1, 2, 2], []),  # cut off by the end of the field
        ([2, 1, 1], []),
        ([3, 3, 2, 1, 1, 3], [(3, 5)]),  # the further one is half hidden
        ([3, 1, 1, 2, 2, 3], [(1, 3)]),
        ([2, 2.5, 3, 2.5, 2], []),  # a corner of a room
        ([2, 1.95, 1.9, 1.95, 2], []),  # less deep than a spike
    ],
)
def test_spikes_of_a_profile(profile, runs):
    assert [(run.start, run.stop) for run in spikes(np.array(profile, dtype=float), 0.1)] == runs


@given(
    st.tuples(st.floats(-0.7, 0.7), st.floats(-0.7, 0.7)),
    st.floats(0.2, 1.2),
    st.floats(-1.8, 1.8),
    st.floats(-math.pi, math.pi),
    st.floats(0.03, 0.06),
    st.booleans(),
)
def test_a_cylinder_in_the_arena(place, away, bearing, heading, radius, known):
    """Without noise within a step of the scanner: 5 mm at most in the 2 m arena, and nothing else is taken for one."""
    x, y = place
    direction = heading + bearing
    disc = np.array([[x + away * math.cos(direction), y + away * math.sin(direction), radius]])
    assume(np.abs(disc[0, :2]).max() <= 0.85)
    ranges = SCANNER.ranges((x, y, heading), ARENA, disc)
    found = landmarks(ranges, SCANNER.bearings, SpikeParameters(depth_m=0.07, radius_m=radius if known else None))
    (mark,) = found
    assert math.dist(mark.position, (away * math.cos(bearing), away * math.sin(bearing))) < 0.005
    assert abs(mark.radius_m - radius) < 0.005
    assert mark.range_m == pytest.approx(away, abs=0.005)
    assert mark.bearing_rad == pytest.approx(bearing, abs=SCANNER.step_rad)


@given(st.floats(-math.pi, math.pi))
def test_the_robots_heading_does_not_matter(heading):
    """What turns with the robot is where it was, in its frame, but for the beams that happen to hit."""
    c, s = math.cos(heading), math.sin(heading)
    discs = np.array([[0.8 * c, 0.8 * s, 0.05], [-0.6 * s, 0.6 * c, 0.04]])
    marks = landmarks(SCANNER.ranges((0, 0, heading), ARENA, discs), SCANNER.bearings, SEARCH)
    expected = [(0.8, 0.0), (0.0, 0.6)]
    assert len(marks) == 2
    for mark, place in zip(marks, expected, strict=True):
        assert math.dist(mark.position, place) < 0.004


def test_noise_costs_little():
    """1 cm of noise, 50 scans: the mean is the truth, and each within 2 cm."""
    disc = np.array([[0.7, 0.3, 0.04]])
    exact = SCANNER.ranges((0, 0, 0), ARENA, disc)
    random = np.random.default_rng(5)
    noisy = Scanner(range_m=0.01)
    marks = [landmarks(noisy.measured(exact, random), SCANNER.bearings, SEARCH) for _ in range(50)]
    assert all(len(found) == 1 for found in marks)
    places = np.array([found[0].position for found in marks])
    assert np.hypot(*(places - disc[0, :2]).T).max() < 0.02
    assert np.hypot(*(places.mean(axis=0) - disc[0, :2])) < 0.003


def test_a_box_is_no_cylinder():
    """Of the size of a landmark, and larger."""

    def seen(half, away=0.6):
        corners = np.array([[away, -half], [away, half], [away + 2 * half, half], [away + 2 * half, -half]])
        box = np.hstack([corners, np.roll(corners, -1, axis=0)])
        return landmarks(
            SCANNER.ranges((0, 0, 0), np.vstack([ARENA, box])), SCANNER.bearings, SpikeParameters(misfit_m=0.002)
        )

    assert seen(0.05) == ()
    assert seen(0.15) == ()


def test_a_known_radius_takes_no_other_circle():
    disc = np.array([[0.6, 0.0, 0.12]])
    ranges = SCANNER.ranges((0, 0, 0), ARENA, disc)
    assert len(landmarks(ranges, SCANNER.bearings, SpikeParameters(radius_m=0.12))) == 1
    assert landmarks(ranges, SCANNER.bearings, SpikeParameters(radius_m=0.03, misfit_m=0.005)) == ()


def test_one_beam_is_enough():
    """The range of the one beam is that of the circle's nearest point: D - r, with r = D sin(half a step)."""
    ranges = np.full(667, math.inf)
    ranges[333] = 3.0
    (mark,) = landmarks(ranges, SCANNER.bearings, SpikeParameters(smallest_m=0.001))
    half = math.sin(SCANNER.step_rad / 2)
    assert mark.position == pytest.approx((3 / (1 - half), 0))
    assert mark.radius_m == pytest.approx(3 * half / (1 - half))


def test_nothing_in_reach_has_no_landmarks():
    assert landmarks(np.full(667, math.inf), SCANNER.bearings) == ()


def test_refusals():
    with pytest.raises(ParameterError, match=r"^depth_m: 0; expected a finite number above 0$"):
        SpikeParameters(depth_m=0)
    with pytest.raises(ParameterError, match=r"^smallest_m: 0.3; expected at most largest_m, 0.2$"):
        SpikeParameters(smallest_m=0.3)
    with pytest.raises(ParameterError, match=r"shapes \(3,\), \(667,\); expected \(n,\) twice"):
        landmarks(np.zeros(3), SCANNER.bearings)
