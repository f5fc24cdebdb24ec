"""The study: its tables, its legend, and how its runs are made."""

from __future__ import annotations

from muster.perception.optional_parts import require_physics
from muster_studies.descriptions import captioned, description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, Reproduction, one_by_one
from muster_studies.thesis_6_1 import drift_pictures, pictures
from muster_studies.thesis_6_1.clusters import Clusterings
from muster_studies.thesis_6_1.delays import Delays
from muster_studies.thesis_6_1.drifts import Drifts
from muster_studies.thesis_6_1.errors import TagErrors
from muster_studies.thesis_6_1.flights import Flight, FlightResult, fly
from muster_studies.thesis_6_1.published import points, seed_count
from muster_studies.thesis_6_1.sizes import Sizes
from muster_studies.thesis_6_1.usages import DroneTotals, DroneUsages

_TABLES: tuple[Reproduction[Flight, FlightResult], ...] = (
    DroneUsages(),
    DroneTotals(),
    TagErrors(
        number="6.4",
        title="Thirty tags found by three drones",
        below_m=(0.05, points()["6.4"]["mean_error"]),
        thesis={"error": "thesis"},
    ),
    TagErrors(
        number="6.5",
        title="Six tags found by one drone from the views of Table A.10",
        below_m=(points()["6.5"]["mean_error"], points()["6.5"]["mean_error_real"]),
        thesis={"error_real": "real", "error": "Gazebo"},
    ),
    Clusterings(),
    Delays(),
    Sizes(),
    Drifts(),
)


def _check(effort: Effort) -> None:
    """Check for the parts that cameras need, before the first flight."""
    require_physics("drones with cameras", "mujoco", "cv2", "apriltag", "scipy")


THESIS_6_1 = Repetition(
    **description("thesis-6.1"),
    reproductions=_TABLES,
    perform=one_by_one(fly),
    check=_check,
    extras=("physics",),
    seeds=seed_count,
    figures=captioned("thesis-6.1", {**pictures.DRAWINGS, **drift_pictures.DRAWINGS}),
)
"""Collaborative aerial observation in a physics world."""
