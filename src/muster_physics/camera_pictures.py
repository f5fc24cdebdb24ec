"""Pictures of what cameras saw during a mission: one of each tag by each robot."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.detection import Sighting
from muster.perception.optional_parts import require_physics
from muster.simulation.cameras import Look
from muster_physics.camera_view import with_sightings


class CameraPictures:
    """Receives each look of a camera (`on_look`), and keeps the pictures in which tags are largest.

    Parameters
    ----------
    folder : Path
        Folder for a picture of each tag by each robot, with all tags in it drawn; it is made where it does not exist.

    Raises
    ------
    MissingExtraError
        if OpenCV is not installed.
    """

    def __init__(self, folder: Path) -> None:
        require_physics("pictures of cameras", "cv2")
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._largest: dict[tuple[str, int], float] = {}

    def __call__(self, look: Look) -> None:
        """Write the picture for those tags that are larger in it than in all before."""
        import cv2

        better = [s for s in look.observation.sightings.all if _size(s) > self._largest.get((look.robot, s.tag), 0.0)]
        if not better or look.image is None:
            return
        drawn = with_sightings(np.asarray(look.image), look.observation.sightings)
        for sighting in better:
            self._largest[look.robot, sighting.tag] = _size(sighting)
            file = self._folder / f"{look.robot}-tag-{sighting.tag}.png"
            if not cv2.imwrite(str(file), drawn[:, :, ::-1]):
                raise ParameterError(f"{file}: cannot be written; expected a folder with permission to write")


def _size(sighting: Sighting) -> float:
    """Area in the picture, square pixels."""
    x, y = sighting.corners.T
    return float(abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2)
