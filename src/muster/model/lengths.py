"""Lengths that a problem needs: between its places, and along the way points of its actions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats


@dataclass(frozen=True, eq=False)
class Measured:
    """Lengths that a problem needs, metres; inf where there is no way.

    Parameters
    ----------
    table, classes
        as `Problem.travel`.
    costs, work_classes
        (work classes, n) what tasks cost, and (m,) each robot's class.
    legs
        by work class: for each task whose action has geometry the lengths of the legs between its way points.
    over_map
        whether they are of shortest ways over a map, which have bends.
    seconds
        of the shape of the table: how long ways take that are along lanes, and all ways beside them; empty where the
        lengths tell.
    driven_s
        by work class: how long the work on tasks takes that is travel along lanes, seconds; empty without lanes.
    """

    table: Floats
    classes: npt.NDArray[np.int32]
    costs: Floats
    work_classes: npt.NDArray[np.int32]
    legs: tuple[Mapping[int, tuple[float, ...]], ...]
    over_map: bool = False
    seconds: Floats = field(default_factory=lambda: np.empty(0))
    driven_s: tuple[Mapping[int, float], ...] = ()

    def part(self, robots: Sequence[int], places: Sequence[int], tasks: Sequence[int]) -> Measured:
        """The lengths of some robots between some places, and of some tasks; with the classes of these robots alone."""
        tables, classes = np.unique(self.classes[list(robots)], return_inverse=True)
        rows, work_classes = np.unique(self.work_classes[list(robots)], return_inverse=True)
        number_in = {j: k for k, j in enumerate(tasks)}
        return Measured(
            self.table[tables][:, places][:, :, places],
            classes.astype(np.int32),
            self.costs[rows][:, tasks],
            work_classes.astype(np.int32),
            tuple({number_in[j]: m for j, m in self.legs[row].items() if j in number_in} for row in rows.tolist()),
            self.over_map,
            self.seconds[tables][:, places][:, :, places] if len(self.seconds) else self.seconds,
            tuple({number_in[j]: s for j, s in self.driven_s[row].items() if j in number_in} for row in rows.tolist())
            if self.driven_s
            else (),
        )
