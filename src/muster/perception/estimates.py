"""Raw estimates of places of interest: one for each sighting, from all robots ([tcf-thesis] 4.3.3, the list P)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats, Integers

NO_TAG = -1
"""In place of a tag's id, where none was decoded."""


@dataclass(frozen=True, eq=False)
class RawEstimates:
    """Where something was seen.

    Attributes
    ----------
    positions
        (n, d) metres in the map frame; d is 2 on the ground, 3 in space.
    covariances
        (n, d, d) m^2: how much each may be off; None where nobody knows.
    tags
        (n,) the decoded ids, `NO_TAG` where there is none.
    robots
        (n,) the ids of those who saw it.
    times_s
        (n,) when.

    Raises
    ------
    ParameterError
        where shapes do not fit, a number is not finite, or a covariance is not positive definite.
    """

    positions: Floats
    covariances: Floats | None
    tags: Integers
    robots: tuple[str, ...]
    times_s: Floats

    def __post_init__(self) -> None:
        shape = np.shape(self.positions)
        if len(shape) != 2 or shape[1] not in (2, 3):
            raise ParameterError(f"positions: shape {shape}; expected (n, 2) or (n, 3)")
        _check("tags", np.shape(self.tags), shape[:1])
        _check("robots", (len(self.robots),), shape[:1])
        _check("times_s", np.shape(self.times_s), shape[:1])
        for name in ("positions", "times_s"):
            if not np.isfinite(getattr(self, name)).all():
                raise ParameterError(f"{name}: a number that is not finite; expected finite numbers")
        if self.covariances is not None:
            _check("covariances", np.shape(self.covariances), (*shape, shape[1]))
            if not np.isfinite(self.covariances).all() or not (np.linalg.eigvalsh(self.covariances) > 0).all():
                raise ParameterError("covariances: one that is not positive definite; expected all of them to be")

    def __len__(self) -> int:
        return len(self.positions)

    @classmethod
    def at(cls, positions: npt.ArrayLike, tags: npt.ArrayLike | None = None, robot: str = "") -> RawEstimates:
        """Places (n, d) of which nothing else is known, but perhaps the tags; seen by one robot, all at time 0."""
        places = np.asarray(positions, dtype=np.float64)
        ids = np.full(len(places), NO_TAG) if tags is None else np.asarray(tags)
        return cls(places, None, ids.astype(np.int64), (robot,) * len(places), np.zeros(len(places)))

    @classmethod
    def joined(cls, parts: Sequence[RawEstimates], dimensions: int = 2) -> RawEstimates:
        """All estimates of `parts`, in their order; of no parts none, of `dimensions`.

        Raises
        ------
        ParameterError
            if some are on the ground and others in space, or some have covariances and others not.
        """
        if not parts:
            return cls.at(np.empty((0, dimensions)))
        if len({part.positions.shape[1] for part in parts}) > 1:
            raise ParameterError("parts: some with two and some with three coordinates; expected one kind")
        known = [part.covariances for part in parts if part.covariances is not None]
        if known and len(known) < len(parts):
            raise ParameterError("parts: some with and some without covariances; expected one kind")
        return cls(
            np.concatenate([part.positions for part in parts]),
            np.concatenate(known) if known else None,
            np.concatenate([part.tags for part in parts]),
            tuple(robot for part in parts for robot in part.robots),
            np.concatenate([part.times_s for part in parts]),
        )


def _check(name: str, shape: tuple[int, ...], expected: tuple[int, ...]) -> None:
    if shape != expected:
        raise ParameterError(f"{name}: shape {shape}; expected {expected}, as the positions")
