"""The input of collision avoidance at one moment: the robots and the static obstacles."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats

_SOME = 5
"""How many values a message shows."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Agents:
    """Robots that share the plane or the space, as discs or balls.

    Parameters
    ----------
    positions, velocities
        (n, 2) or (n, 3): metres and metres a second in the map frame.
    preferred
        the same shape: the velocities that the robots would have, were they alone.
    radii
        (n,) metres, at least 0; inflated, where a margin is wanted.
    max_speeds
        (n,) metres a second, at least 0.
    priorities
        (n,); of two robots the one with the lower number takes all of the avoiding upon itself, equals share it. All 0
        by default.

    Raises
    ------
    ParameterError
        if shapes do not fit together or a number is out of range.
    """

    positions: Floats
    velocities: Floats
    preferred: Floats
    radii: Floats
    max_speeds: Floats
    priorities: Floats | None = None

    def __post_init__(self) -> None:
        positions = _frozen("positions", self.positions)
        if positions.ndim != 2 or positions.shape[1] not in (2, 3):
            raise ParameterError(f"positions: shape {positions.shape}; expected (n, 2) or (n, 3)")
        count = (len(positions),)
        priorities = np.zeros(count) if self.priorities is None else self.priorities
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "velocities", _shaped("velocities", self.velocities, positions.shape))
        object.__setattr__(self, "preferred", _shaped("preferred", self.preferred, positions.shape))
        for name, array in (("radii", self.radii), ("max_speeds", self.max_speeds)):
            object.__setattr__(self, name, _not_negative(name, _shaped(name, array, count)))
        object.__setattr__(self, "priorities", _shaped("priorities", priorities, count))

    @property
    def dimensions(self) -> int:
        """2 or 3."""
        return int(self.positions.shape[1])

    def in_plane(self) -> core.PlaneAgents:
        """The same for the core. Raises ParameterError unless the robots are in the plane."""
        if self.dimensions != 2:
            raise ParameterError(
                f"positions: shape {self.positions.shape}; expected (n, 2): this method is for the plane"
            )
        return core.PlaneAgents(*self._arrays())

    def in_space(self) -> core.SpaceAgents:
        """The same for the core, of robots in space."""
        return core.SpaceAgents(*self._arrays())

    def _arrays(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        assert self.priorities is not None
        return self.positions, self.velocities, self.preferred, self.radii, self.max_speeds, self.priorities


@dataclass(frozen=True, kw_only=True, eq=False)
class Obstacles:
    """Static obstacles.

    Parameters
    ----------
    walls
        (w, 2, 2) metres in the map frame: both ends of line segments, for robots in the plane.
    boxes
        (b, 2, 3) metres in the map frame: lowest and highest corner of boxes along the axes, for robots in space.

    Raises
    ------
    ParameterError
        if a shape is wrong, a number is not finite, or a box's corners are the wrong way round.
    """

    walls: Floats | None = None
    boxes: Floats | None = None

    def __post_init__(self) -> None:
        walls = np.empty((0, 2, 2)) if self.walls is None else _frozen("walls", self.walls)
        boxes = np.empty((0, 2, 3)) if self.boxes is None else _frozen("boxes", self.boxes)
        for name, array, shape in (("walls", walls, (2, 2)), ("boxes", boxes, (2, 3))):
            if array.shape[1:] != shape:
                raise ParameterError(f"{name}: shape {array.shape}; expected (n, {shape[0]}, {shape[1]})")
        if (boxes[:, 0] > boxes[:, 1]).any():
            raise ParameterError("boxes: a lowest corner above the highest; expected lowest <= highest")
        object.__setattr__(self, "walls", walls)
        object.__setattr__(self, "boxes", boxes)

    @classmethod
    def from_polygons(cls, polygons: Iterable[Sequence[tuple[float, float]]]) -> Obstacles:
        """The sides of polygons, each a ring of (x, y) in metres, as walls."""
        sides = [side for ring in polygons for side in itertools.pairwise([*ring, ring[0]])]
        return cls(walls=np.array(sides, dtype=np.float64).reshape(-1, 2, 2))

    def still(self, dimensions: int) -> Floats:
        """The walls, or in 3 dimensions the boxes."""
        found = self.walls if dimensions == 2 else self.boxes
        assert found is not None
        return found


NO_OBSTACLES = Obstacles()


def _frozen(name: str, values: Floats) -> Floats:
    array = np.array(values, dtype=np.float64, order="C")
    if not np.isfinite(array).all():
        raise ParameterError(f"{name}: {array[~np.isfinite(array)][:_SOME].tolist()}; expected finite numbers")
    array.setflags(write=False)
    return array


def _shaped(name: str, values: Floats, shape: tuple[int, ...]) -> Floats:
    array = _frozen(name, values)
    if array.shape != shape:
        raise ParameterError(f"{name}: shape {array.shape}; expected {shape}")
    return array


def _not_negative(name: str, array: Floats) -> Floats:
    if (array < 0).any():
        raise ParameterError(f"{name}: {array[array < 0][:_SOME].tolist()}; expected at least 0")
    return array
