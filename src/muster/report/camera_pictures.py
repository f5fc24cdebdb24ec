"""Pictures of what cameras saw during a mission: one of each tag by each robot, and a map of all."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.perception.detection import Sighting
from muster.perception.matching import error_table
from muster.perception.optional_parts import require_physics
from muster.perception.point_search import PointSearch
from muster.report.camera_view import with_sightings
from muster.report.files import save_figure
from muster.report.found import plot_found
from muster.simulation.cameras import Look

FARTHEST_M = 1.0
"""What was found farther than this from every tag is where nothing is."""


class CameraPictures:
    """Collects every camera image; see `Simulation`.

    Parameters
    ----------
    folder
        for each robot and tag the picture in which the tag is largest, with all tags in it drawn; it is made where it
        does not exist. None: no pictures are kept.

    Raises
    ------
    MissingExtraError
        if pictures are wanted and OpenCV is not installed.
    """

    def __init__(self, folder: Path | None = None) -> None:
        if folder is not None:
            require_physics("pictures of cameras", "cv2")
            folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._largest: dict[tuple[str, int], float] = {}
        self._search = PointSearch()

    def __call__(self, look: Look) -> None:
        """Process one camera image."""
        self._search.take(look.observation.estimates, look.time_s)
        if self._folder is not None and look.image is not None:
            self._keep(look, self._folder)

    def plot(self, mission: Mission, file: Path) -> None:
        """Draw a map of all estimates, of what was found and of what is there ([tcf-thesis], Figure 6.4).

        Raises
        ------
        InputError
            if the file cannot be written.
        MissingExtraError
            if matplotlib is not installed.
        """
        points = [find.point for find in self._search.finds]
        truth = _named(mission)
        table = error_table([point.position for point in points], truth, farthest_m=FARTHEST_M)
        title = f"{mission.name}: found by cameras"
        save_figure(plot_found(self._search.raw, points, table, truth, title), file)

    def _keep(self, look: Look, folder: Path) -> None:
        """Write the picture for those tags that are larger in it than in all before."""
        import cv2

        better = [s for s in look.observation.sightings.all if _size(s) > self._largest.get((look.robot, s.tag), 0.0)]
        if not better or look.image is None:
            return
        drawn = with_sightings(np.asarray(look.image), look.observation.sightings)
        for sighting in better:
            self._largest[look.robot, sighting.tag] = _size(sighting)
            file = folder / f"{look.robot}-tag-{sighting.tag}.png"
            if not cv2.imwrite(str(file), drawn[:, :, ::-1]):
                raise ParameterError(f"{file}: cannot be written; expected a folder with permission to write")


def _size(sighting: Sighting) -> float:
    """Area in the picture, square pixels."""
    x, y = sighting.corners.T
    return float(abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2)


def _named(mission: Mission) -> dict[str, tuple[float, float]]:
    """The places of tags by their ids; the second one of an id is `7 (2)`."""
    seen: Counter[int] = Counter()
    named = {}
    for tag in mission.tags:
        seen[tag.id] += 1
        name = str(tag.id) + (f" ({seen[tag.id]})" if seen[tag.id] > 1 else "")
        named[name] = (tag.position[0], tag.position[1])
    return named
