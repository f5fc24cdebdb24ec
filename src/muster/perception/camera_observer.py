"""A robot's camera: from an image and the robot's pose to raw estimates ([tcf-thesis], Figure 4.8); sans I/O.

A fault of one image (its size, a tag twice, an invalid pose) becomes a remark, and the mission goes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.perception.camera import Intrinsics, View
from muster.perception.cameras.images import Image
from muster.perception.detection import Sightings, TagDetector
from muster.perception.estimates import RawEstimates
from muster.perception.localisation import Uncertainty, by_size, ground_covariance, on_ground, size_covariance


@dataclass(frozen=True)
class Observation:
    """The result of one image: the tags in it, their estimated positions (x, y) on the ground, and remarks."""

    sightings: Sightings
    estimates: RawEstimates
    remarks: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class CameraObserver:
    """One robot's camera and its assumed errors.

    `mount` is (4, 4) from body to image; images need a `detector`. No estimate is made of a tag farther away than
    `farthest_m`: near the horizon a pixel is worth many metres. With `sizes_m`, of tags by their ids, a tag's position
    is found by its size, wherever it hangs or lies, and a tag of unknown size is left out; without, by where its ray
    meets the ground.
    """

    robot: str
    intrinsics: Intrinsics
    mount: Floats
    detector: TagDetector | None = None
    uncertainty: Uncertainty = Uncertainty()
    ground_m: float = 0.0
    farthest_m: float = 20.0
    sizes_m: Mapping[int, float] | None = None

    def look(self, image: Image, body: npt.ArrayLike, time_s: float) -> Observation:
        """Find tags in an image taken at `time_s` at the estimated pose `body`, (6,) or (4, 4), of the robot."""
        assert self.detector is not None, "images need a detector"
        try:
            return self.locate(self.detector.detect(image, self.intrinsics), body, time_s)
        except ParameterError as error:
            return Observation(Sightings((), ()), RawEstimates.joined([]), (f"{self._when(time_s)}: {error}",))

    def locate(self, sightings: Sightings, body: npt.ArrayLike, time_s: float) -> Observation:
        """Estimate positions of tags seen at `time_s` at the estimated pose `body`, (6,) or (4, 4), of the robot.

        Raises
        ------
        ParameterError
            if the pose is invalid.
        """
        view = View.from_body(self.intrinsics, body, self.mount)
        said = tuple(f"{self._when(time_s)}: tag {tag} is twice in one image" for tag in sightings.repeated)
        estimates = self._on_ground if self.sizes_m is None else self._by_size
        return Observation(sightings, estimates(view, sightings, time_s), said)

    def _by_size(self, view: View, sightings: Sightings, time_s: float) -> RawEstimates:
        assert self.sizes_m is not None
        parts = []
        for seen in sightings.all:
            size = self.sizes_m.get(seen.tag)
            if size is None:
                continue
            place = by_size(view, seen.corners, size).position
            if np.linalg.norm(place - view.position) <= self.farthest_m:
                spread = size_covariance(view, seen.corners, size, self.uncertainty)
                tags, times = np.array([seen.tag], dtype=np.int64), np.array([time_s])
                parts.append(RawEstimates(place[None, :2], spread[None], tags, (self.robot,), times))
        return RawEstimates.joined(parts)

    def _on_ground(self, view: View, sightings: Sightings, time_s: float) -> RawEstimates:
        centres = np.array([sighting.centre for sighting in sightings.all]).reshape(-1, 2)
        tags = np.array([sighting.tag for sighting in sightings.all], dtype=np.int64)
        places = on_ground(view, centres, self.ground_m)
        near = np.linalg.norm(places - view.position, axis=1) <= self.farthest_m  # False where NaN
        covariances = ground_covariance(view, centres[near], self.uncertainty, self.ground_m)
        return RawEstimates(
            places[near, :2], covariances, tags[near], (self.robot,) * int(near.sum()), np.full(near.sum(), time_s)
        )

    def _when(self, time_s: float) -> str:
        return f"{self.robot} at {time_s:.2f} s"
