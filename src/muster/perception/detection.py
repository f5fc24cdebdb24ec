"""AprilTags in an image: family 36h11, by the detector of its authors [wang2016] in apriltag-python.

[tcf-thesis] (4.3.2) uses the centre of a tag's bounding box. Here the centre is where the diagonals of the tag's own
four corners cross, which is the image of the tag's middle from every side; the box's centre is not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.perception.camera import Intrinsics
from muster.perception.cameras.apriltag import new_detector
from muster.perception.cameras.images import Image, grey


@dataclass(frozen=True, eq=False)
class Sighting:
    """One tag in one image.

    Attributes
    ----------
    tag
        the id that was decoded.
    centre
        (2,) pixels: the tag's middle.
    corners
        (4, 2) pixels, of the black square: upper left, upper right, lower right, lower left of the tag upright.
    corrected
        bits of the code that were read wrong and put right.
    margin
        how far, on average, a bit's brightness is from the threshold between black and white; more is surer.
    """

    tag: int
    centre: Floats
    corners: Floats
    corrected: int
    margin: float


@dataclass(frozen=True)
class Sightings:
    """All tags in one image, by id; often none. `repeated` has the ids that are in it more than once."""

    all: tuple[Sighting, ...]
    repeated: tuple[int, ...]

    @classmethod
    def of(cls, seen: Sequence[Sighting]) -> Sightings:
        """Return these, which are in order."""
        times = Counter(sighting.tag for sighting in seen)
        return cls(tuple(seen), tuple(tag for tag, count in times.items() if count > 1))


@dataclass(frozen=True, kw_only=True)
class DetectorParameters:
    """How tags are looked for.

    Attributes
    ----------
    decimate
        squares are looked for in an image as many times smaller; 2 is faster, and loses small tags.
    blur_px
        standard deviation of a blur before that, for noisy images.
    most_corrected
        bits that may have been read wrong, at most 2: more of them, more tags that are none.
    least_margin
        below it a sighting does not count.
    """

    decimate: float = 1.0
    blur_px: float = 0.0
    most_corrected: int = 1
    least_margin: float = 10.0

    def __post_init__(self) -> None:
        if not 1 <= self.decimate <= 8:
            raise ParameterError(f"decimate: {self.decimate}; expected 1 to 8")
        if not 0 <= self.blur_px <= 10:
            raise ParameterError(f"blur_px: {self.blur_px}; expected 0 to 10")
        if self.most_corrected not in (0, 1, 2):
            raise ParameterError(f"most_corrected: {self.most_corrected}; expected 0, 1 or 2")
        if not self.least_margin >= 0:
            raise ParameterError(f"least_margin: {self.least_margin}; expected at least 0")


class TagDetector:
    """Looks for tags; making one takes a while, so make one for many images. Not for two threads at once.

    Raises
    ------
    MissingExtraError
        when made, if apriltag-python or OpenCV is not installed.
    """

    def __init__(self, parameters: DetectorParameters | None = None) -> None:
        self._parameters = parameters or DetectorParameters()
        self._detector = new_detector(
            "detecting tags",
            decimate=self._parameters.decimate,
            blur_px=self._parameters.blur_px,
            most_corrected=self._parameters.most_corrected,
        )

    def detect(self, image: Image, intrinsics: Intrinsics | None = None) -> Sightings:
        """Find all tags that are whole in an image.

        Raises
        ------
        ParameterError
            if it is no image, or not of the size that the intrinsics say, where they are given.
        """
        found = self._detector.detect(np.ascontiguousarray(grey(image, intrinsics)))
        sure = [f for f in found if self._counts(f["hamming"], f["margin"])]
        return Sightings.of([_sighting(f) for f in sorted(sure, key=lambda f: (f["id"], *f["center"]))])

    def _counts(self, corrected: int, margin: float) -> bool:
        return corrected <= self._parameters.most_corrected and margin >= self._parameters.least_margin


def _sighting(found: Mapping[str, Any]) -> Sighting:
    """The detector's corners begin lower left and go against the clock; ours begin upper left and go with it."""
    corners = np.asarray(found["lb-rb-rt-lt"], dtype=np.float64)[::-1]
    centre = np.asarray(found["center"], dtype=np.float64)
    return Sighting(found["id"], centre, corners, found["hamming"], float(found["margin"]))
