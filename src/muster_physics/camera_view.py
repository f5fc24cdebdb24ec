"""Camera images with the detected tags drawn into them, for pictures and films."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from muster.perception.detection import Sightings
from muster.perception.optional_parts import require_physics

_OUTLINE, _UPPER_EDGE, _REPEATED = (0, 190, 90), (60, 120, 255), (220, 30, 30)


def with_sightings(image: npt.NDArray[np.uint8], sightings: Sightings) -> npt.NDArray[np.uint8]:
    """Draw each tag's outline, its upper edge in blue, and its id; in red where the id is there more than once.

    Takes an image (height, width) or (height, width, 3), and gives a new one (height, width, 3), RGB.

    Raises
    ------
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics("drawing into images", "cv2")
    import cv2

    drawn = np.repeat(image[:, :, None], 3, axis=2) if image.ndim == 2 else image.copy()
    for sighting in sightings.all:
        color = _REPEATED if sighting.tag in sightings.repeated else _OUTLINE
        # OpenCV counts from the middle of the first pixel; four bits of fractions
        corners = np.round((sighting.corners - 0.5) * 16).astype(np.int32)
        cv2.polylines(drawn, [corners], isClosed=True, color=color, thickness=2, lineType=cv2.LINE_AA, shift=4)
        cv2.polylines(drawn, [corners[:2]], False, _UPPER_EDGE, 2, cv2.LINE_AA, 4)
        at = sighting.corners.max(axis=0).astype(int)
        cv2.putText(
            drawn, str(sighting.tag), (int(at[0]), int(at[1])), cv2.FONT_HERSHEY_SIMPLEX, 0.5, color, 1, cv2.LINE_AA
        )
    return drawn
