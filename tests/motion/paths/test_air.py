"""The air among prisms: over, under or around, where the shortest way is known, and against finer samples."""

import itertools

import numpy as np
import pytest
import shapely
from tests.motion.paths.brute import sparse_region_lengths as region_lengths

from muster import core
from muster.mission.errors import ParameterError
from muster.motion.free_space import Prism, PrismSpace
from muster.motion.path import Path
from muster.motion.paths import PathFinder, find, travel_lengths
from muster.motion.paths.rings import rings_of

HALL = shapely.box(0, 0, 20, 20)


def test_over_a_wall():
    space = PrismSpace(HALL, (Prism(shapely.box(9, -5, 11, 25), 0, 3),))
    answer = find(space, (5, 10, 1), (15, 10, 1))
    assert answer.length_m == pytest.approx(2 * np.hypot(4, 2) + 2, rel=1e-9)
    assert answer.points[:, 2].max() == 3


def test_over_a_wall_at_a_slant():
    """Laid out flat, the two sides and the top of the wall are one plane, where the way is straight."""
    space = PrismSpace(HALL, (Prism(shapely.box(9, -5, 11, 25), 0, 3),))
    answer = find(space, (5, 4, 0), (14, 17, 1))
    assert answer.length_m == pytest.approx(np.hypot(13, np.hypot(4, 3) + 2 + np.hypot(3, 2)), rel=1e-6)


def test_around_a_tower():
    space = PrismSpace(HALL, (Prism(shapely.box(9, 5, 11, 15), 0, 300),))
    answer = find(space, (5, 10, 1), (15, 10, 4))
    assert answer.length_m == pytest.approx(np.hypot(2 * np.hypot(4, 5) + 2, 3), rel=1e-9)


def test_under_a_bridge():
    space = PrismSpace(HALL, (Prism(shapely.box(9, -5, 11, 25), 2, np.inf),))
    answer = find(space, (5, 10, 4), (15, 10, 4))
    assert answer.length_m == pytest.approx(2 * np.hypot(4, 2) + 2, rel=1e-9)


def test_a_wall_up_to_the_sky_disconnects():
    space = PrismSpace(HALL, (Prism(shapely.box(9, -5, 11, 25), 0, np.inf),))
    assert find(space, (5, 10, 4), (15, 10, 4)).reason == "disconnected"
    assert find(space, (10, 10, 4), (15, 10, 4)).reason == "start blocked"
    assert find(space, (5, 10, 4), (15, 10, -1)).reason == "goal blocked"
    assert find(space, (5, 10, 4), (10, 10, 400)).reason == "goal blocked"


def test_high_above_all_is_straight_and_corners_of_the_region_stay_walls():
    region = HALL.difference(shapely.box(9, -1, 11, 15))
    space = PrismSpace(region, (Prism(shapely.box(2, 2, 3, 3), 0, 3),))
    assert find(space, (2.5, 2.5, 3), (2.5, 15, 50)).length_m == pytest.approx(np.hypot(12.5, 47))
    assert find(space, (5, 10, 50), (15, 10, 50)).length_m == pytest.approx(2 * np.hypot(4, 5) + 2, rel=1e-9)


def test_a_place_in_the_air_needs_a_height():
    with pytest.raises(ParameterError, match=r"expected \(n, 3\)"):
        find(PrismSpace(HALL, ()), (1, 1), (2, 2))


def towers(seed, count=5):
    """Towers, low blocks and hanging beams at random, some with round corners."""
    rng = np.random.default_rng(seed)
    prisms = []
    for k in range(count):
        x, y = rng.uniform(2, 16, 2)
        box = shapely.box(x, y, x + rng.uniform(1, 6), y + rng.uniform(1, 6))
        base = shapely.affinity.rotate(box, rng.uniform(0, 90))
        floor = rng.choice((0.0, 2.0))
        prisms.append(Prism(base.buffer(0.5, quad_segs=4) if k % 2 else base, floor, floor + rng.uniform(1, 8)))
    return PrismSpace(HALL, tuple(prisms))


def outside_of_all(space, points):
    """Samples along the path are in no prism by more than a micrometre."""
    steps = np.linspace(0, 1, 200)[:, np.newaxis]
    for a, b in itertools.pairwise(points):
        line = a + steps * (b - a)
        for prism in space.prisms:
            inner = shapely.contains_xy(prism.polygon.buffer(-1e-6), line[:, 0], line[:, 1])
            assert not (inner & (line[:, 2] > prism.floor_m + 1e-6) & (line[:, 2] < prism.ceiling_m - 1e-6)).any()
        assert (line[:, 2] >= -1e-6).all()


@pytest.mark.parametrize("seed", range(4))
def test_paths_are_free_as_long_as_their_lengths_and_within_half_a_percent(seed):
    space = towers(seed)
    places = np.random.default_rng(seed).uniform((0, 0, 0), (20, 20, 5), (8, 3))
    finder = PathFinder(space)
    lengths = finder.lengths(places)
    assert (lengths == lengths.T).all()
    answers = [[finder.path(a, b) for b in places] for a in places]
    for row in answers:
        for answer in row:
            if isinstance(answer, Path):
                outside_of_all(space, answer.points)
    paths = np.array([[a.length_m if isinstance(a, Path) else np.inf for a in row] for row in answers])
    assert lengths == pytest.approx(paths, rel=1e-9)
    straight = np.linalg.norm(places[:, np.newaxis] - places, axis=2)
    free = np.isfinite(lengths)
    assert (lengths[free] >= straight[free] * (1 - 1e-12)).all()
    assert (lengths[free] > straight[free] * 1.001).any()
    shapes = [(rings_of(prism.polygon), prism.floor_m, prism.ceiling_m) for prism in space.prisms]
    fine = core.AirWays(rings_of(HALL), shapes, lowest=0.0, top=10.0, rise=0.4, run=0.2)
    fine.build(1)
    best = fine.lengths(places, first=0, last=len(places), threads=1)
    upper = np.triu(free, 1)
    assert (lengths[upper] <= 1.005 * best[upper]).all()


def test_nothing_passes_below_what_stands_on_the_ground():
    space = PrismSpace(HALL, (Prism(shapely.box(9, 5, 11, 15), 0, 300),))
    assert find(space, (5, 10, 0), (15, 10, 0)).length_m == pytest.approx(2 * np.hypot(4, 5) + 2, rel=1e-9)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(4))
def test_among_round_towers_the_way_is_that_of_the_plane(seed):
    """They are too high to pass over; the plane's lengths are exact, by other code."""
    rng = np.random.default_rng(seed)
    bases = [
        shapely.Point(p).buffer(r) for p, r in zip(rng.uniform(2, 18, (8, 2)), rng.uniform(0.5, 2, 8), strict=True)
    ]
    space = PrismSpace(HALL, tuple(Prism(base, 0, 500) for base in bases))
    free = HALL.difference(shapely.union_all(bases))
    places = [p for p in rng.uniform(0, 20, (20, 2)) if shapely.contains_xy(free.buffer(-0.01), *p)][:8]
    wanted = region_lengths(free, places)
    found = travel_lengths(space, [(*p, 1.0) for p in places], [(*p, 1.0) for p in places])
    free_of_walls = np.isfinite(wanted)
    assert (np.isfinite(found) == free_of_walls).all()
    assert (found[free_of_walls] >= wanted[free_of_walls] * (1 - 1e-6)).all()
    assert (found[free_of_walls] <= wanted[free_of_walls] * (1 + 1e-6)).all()


def test_exits_and_entries_may_differ():
    space = towers(1)
    rng = np.random.default_rng(9)
    exits, entries = rng.uniform((0, 0, 0), (20, 20, 5), (2, 5, 3))
    there, back = travel_lengths(space, exits, entries), travel_lengths(space, entries, exits)
    assert (there == back.T).all()
    assert np.isfinite(there).any()
