"""Cameras of the physics world: pictures are rendered, and tags detected in them."""

from __future__ import annotations

import numpy.typing as npt

from muster.perception.camera import Intrinsics, View
from muster.perception.camera_observer import CameraObserver
from muster.perception.detection import TagDetector
from muster.perception.localisation import Uncertainty
from muster.simulation.cameras import Look
from muster_physics.rendering import Lens, Renderer, Shown


class RenderedCameras:
    """Renders what cameras see, with one renderer for each size of picture.

    Raises
    ------
    MissingExtraError
        if what detects tags in pictures is not installed.
    RenderingError
        when looking, if there is no graphics library.
    """

    def __init__(self, world: Shown) -> None:
        self.detector = TagDetector()
        self._world = world
        self._renderers: dict[tuple[int, int], Renderer] = {}

    @property
    def pixel_px(self) -> float:
        """See `Cameras`; what a detector finds is off by less."""
        return Uncertainty().pixel_px

    def look(self, observer: CameraObserver, view: View, body: npt.ArrayLike, now: float) -> Look:
        """See `Cameras`."""
        i = view.intrinsics
        image = self._renderer(i).seen_from(view.position, view.rotation, Lens(i.width, i.height, i.fx, (i.cx, i.cy)))
        return Look(observer.robot, now, image, observer.look(image, body, now))

    def close(self) -> None:
        """Release the renderers' graphics resources."""
        for renderer in self._renderers.values():
            renderer.close()
        self._renderers.clear()

    def _renderer(self, intrinsics: Intrinsics) -> Renderer:
        size = (intrinsics.width, intrinsics.height)
        if size not in self._renderers:
            self._renderers[size] = Renderer(self._world, *size)
        return self._renderers[size]
