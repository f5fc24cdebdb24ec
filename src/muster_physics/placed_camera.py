"""A camera at any pose in the physics world's scenery, without bodies: for robots that move elsewhere, as on ROS."""

from __future__ import annotations

import numpy as np

from muster.mission.model import Mission
from muster.motion.grid import Floats
from muster.perception.camera import Intrinsics, View
from muster.perception.cameras.images import Image
from muster_physics.buildings import Heights
from muster_physics.physics_world import PhysicsWorld
from muster_physics.posed_scene import PosedScene
from muster_physics.rendering import Lens, Renderer


class PlacedCamera:
    """Renders what a camera sees of a mission's tags and buildings. Use `close` when done.

    Raises
    ------
    RenderingError
        if there is no graphics library.
    """

    def __init__(self, mission: Mission, intrinsics: Intrinsics) -> None:
        i = self._intrinsics = intrinsics
        scene = PosedScene(PhysicsWorld(mission).replica(Heights()), ())
        count = len(mission.robots)
        scene.put(np.full((count, 3), np.nan), np.full((count, 4), np.nan))
        self._lens = Lens(i.width, i.height, i.fx, (i.cx, i.cy))
        self._renderer = Renderer(scene, i.width, i.height)

    def image(self, body: Floats, mount: Floats) -> Image:
        """The picture from a robot whose body is at a pose (4, 4) in the map; `mount` (4, 4) goes to the image."""
        view = View.from_body(self._intrinsics, body, mount)
        return self._renderer.seen_from(view.position, view.rotation, self._lens)

    def close(self) -> None:
        """Release graphics resources."""
        self._renderer.close()
