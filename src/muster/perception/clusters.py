"""Clusters of raw estimates of one object each: by k-means, by density, by the decoded tag.

Each gives labels (n,): the number of each estimate's cluster, from 0, or `LONE`.

- `by_means`: k-means, [tcf-thesis] (4.46); the number of clusters must be known. It minimises the sum of
  squares over all estimates. So where one object is seen a thousand times and another five times, it costs less to
  split the thousand and to join the five to a neighbour. So the thesis missed its tag 1 by 1.142 m (Table 6.4).
- `by_density`: DBSCAN [ester1996]. It finds the number of clusters, and does not depend on how often an object is
  seen. Objects nearer to each other than their estimates scatter become one.
- `by_tag`: estimates with one id are one object, unless they lie apart: then the id is there more than once.
- `linked`: single-linkage clusters, which `by_tag` uses; it adds new places to earlier clusters.
"""

from __future__ import annotations

from collections import deque

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.perception.estimates import NO_TAG, RawEstimates
from muster.perception.optional_parts import require_physics

Labels = npt.NDArray[np.int64]

LONE = -1
"""The label of an estimate that belongs to no cluster."""

_ROUNDS = 300


def by_means(positions: Floats, count: int, seed: int = 0, starts: int = 10) -> Labels:
    """k-means: the least inertia (4.46) of so many starts, each by Lloyd's rounds from centres drawn as k-means++ does.

    Raises
    ------
    ParameterError
        if there are fewer estimates than clusters, or a number is below 1.
    """
    for name, value in (("count", count), ("starts", starts)):
        if value < 1:
            raise ParameterError(f"{name}: {value}; expected at least 1")
    if len(positions) < count:
        raise ParameterError(f"count: {count}; expected at most {len(positions)}, the number of estimates")
    random = np.random.default_rng(seed)
    runs = [_lloyd(positions, _spread(positions, count, random)) for _ in range(starts)]
    return min(runs, key=lambda labels: inertia(positions, labels))


def inertia(positions: Floats, labels: Labels) -> float:
    """(4.46): the sum of squared distances from the estimates to the means of their clusters, m^2."""
    return float(sum(((group - group.mean(axis=0)) ** 2).sum() for group in _groups(positions, labels)))


def by_density(positions: Floats, radius_m: float, least: int = 3) -> Labels:
    """DBSCAN: clusters grow from estimates that have `least` (themselves counted) within `radius_m`.

    Raises
    ------
    ParameterError
        if the radius is not above 0, or `least` below 1.
    MissingExtraError
        if SciPy is not installed.
    """
    if not radius_m > 0:
        raise ParameterError(f"radius_m: {radius_m}; expected metres above 0")
    if least < 1:
        raise ParameterError(f"least: {least}; expected at least 1")
    require_physics("clusters by density", "scipy")
    from scipy.spatial import KDTree

    labels = np.full(len(positions), LONE, dtype=np.int64)
    if len(positions) == 0:
        return labels
    tree = KDTree(positions)
    is_core = tree.query_ball_point(positions, radius_m, return_length=True) >= least
    cluster = 0
    for seed in np.flatnonzero(is_core):
        if labels[seed] != LONE:
            continue
        labels[seed] = cluster
        growing = deque([seed])
        while growing:
            near = np.array(tree.query_ball_point(positions[growing.popleft()], radius_m))
            new = near[labels[near] == LONE]
            labels[new] = cluster
            growing.extend(new[is_core[new]])
        cluster += 1
    return labels


def by_tag(raw: RawEstimates, apart_m: float) -> Labels:
    """Clusters of one decoded id each; one id gives several where no step shorter than `apart_m` leads across.

    Estimates without a tag are `LONE`.

    Raises
    ------
    ParameterError
        if `apart_m` is not above 0.
    """
    labels = np.full(len(raw), LONE, dtype=np.int64)
    for tag in np.unique(raw.tags[raw.tags != NO_TAG]):
        of_tag = np.flatnonzero(raw.tags == tag)
        count = int(labels.max()) + 1
        labels[of_tag] = count + np.unique(linked(raw.positions[of_tag], apart_m), return_inverse=True)[1]
    return labels


def linked(places: Floats, apart_m: float, before: Labels | None = None) -> Labels:
    """Places (n, d) are of one cluster if steps no longer than `apart_m`, each to another place, lead across.

    Each cluster has the number of its first place for a label. `before` (m,) are the labels of the first m places.

    Raises
    ------
    ParameterError
        if `apart_m` is not above 0.
    """
    if not apart_m > 0:
        raise ParameterError(f"apart_m: {apart_m}; expected metres above 0")
    labels, known = np.arange(len(places)), 0 if before is None else len(before)
    labels[:known] = before if before is not None else ()
    for k in range(known, len(places)):
        near = np.linalg.norm(places[:k] - places[k], axis=1) <= apart_m
        met = np.unique(labels[:k][near])
        if len(met):
            labels[k] = met[0]
        if len(met) > 1:
            labels[:k][np.isin(labels[:k], met)] = met[0]
    return labels


def _spread(positions: Floats, count: int, random: np.random.Generator) -> Floats:
    """First centres (count, d) of k-means++ [arthur2007]: each drawn by its squared distance from those before."""
    centres = [positions[random.integers(len(positions))]]
    nearest = np.full(len(positions), np.inf)
    while len(centres) < count:
        nearest = np.minimum(nearest, ((positions - centres[-1]) ** 2).sum(axis=1))
        total = nearest.sum()
        share = nearest / total if total > 0 else None  # all estimates are at centres: any will do
        centres.append(positions[random.choice(len(positions), p=share)])
    return np.array(centres)


def _lloyd(positions: Floats, centres: Floats) -> Labels:
    """Each estimate to its nearest centre, each centre to the mean of its estimates, until none moves."""
    labels = np.zeros(len(positions), dtype=np.int64)
    for _ in range(_ROUNDS):
        new = ((centres**2).sum(axis=1) - 2 * positions @ centres.T).argmin(axis=1)
        for cluster in range(len(centres)):
            if (mine := new == cluster).any():  # an empty one stays where it is
                centres[cluster] = positions[mine].mean(axis=0)
        if np.array_equal(new, labels):
            break
        labels = new
    return labels


def _groups(positions: Floats, labels: Labels) -> list[Floats]:
    return [positions[labels == label] for label in np.unique(labels[labels != LONE])]
