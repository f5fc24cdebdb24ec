"""Pictures of the physics world, drawn without a screen: what a pinhole camera would see, and a view from above.

A camera's frame is that of optics: x to the right, y down, z ahead. Shadows, reflections and smoothing are off: they
cost more than all the rest.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Protocol, Self

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError, RenderingError
from muster.mission.values.ranges import require_finite_positive
from muster.motion.grid import Floats
from muster_physics.library import mujoco
from muster_physics.model import SHOW_HEIGHT, SHOW_WIDTH
from muster_physics.optional_parts import BACKENDS
from muster_physics.visual_marks import Mark

Picture = npt.NDArray[np.uint8]
"""(height, width, 3): red, green, blue; the first row is the topmost."""

NEAR_M, FAR_M = 0.02, 300.0
_COSTLY = (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION, mujoco.mjtRndFlag.mjRND_HAZE)


class Drawable(Protocol):
    """A model of MuJoCo's with its state."""

    model: Any
    data: Any


class Shown(Protocol):
    """What can be drawn: a `PhysicsWorld`, whose model is made anew when a robot joins, or a `PosedScene`."""

    @property
    def simulated(self) -> Drawable: ...


@dataclass(frozen=True)
class Lens:
    """A pinhole camera's picture.

    Parameters
    ----------
    width, height
        in pixels.
    focal_px
        focal length in pixels; pixels are square.
    centre_px
        where the axis meets the picture, from its left upper corner; None: in its middle.

    Raises
    ------
    ParameterError
        if a size is not 1 to 1920 by 1 to 1440, or the focal length not above 0.
    """

    width: int
    height: int
    focal_px: float
    centre_px: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if not (1 <= self.width <= SHOW_WIDTH and 1 <= self.height <= SHOW_HEIGHT):
            raise ParameterError(
                f"picture: {self.width} x {self.height} pixels; expected up to {SHOW_WIDTH} x {SHOW_HEIGHT}"
            )
        require_finite_positive(focal_px=self.focal_px)

    @classmethod
    def of_view(cls, width: int, height: int, upright_rad: float) -> Lens:
        """With a field of view of so many radians from the upper edge to the lower one."""
        return cls(width, height, height / 2 / math.tan(upright_rad / 2))


class Renderer:
    """Draws a physics world at the time of the call, with the robots that have joined.

    Use it in a `with`, or call `close`. There may be several at a time.

    Raises
    ------
    RenderingError
        if there is neither EGL nor OSMesa.
    """

    def __init__(self, world: Shown, width: int, height: int) -> None:
        Lens(width, height, 1.0)
        self._world = world
        self._size = (width, height)
        self._open()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Release graphics resources."""
        self._renderer.close()

    def seen_from(
        self,
        position: Floats,
        axes: Floats,
        lens: Lens,
        *,
        marks: Iterable[Mark] = (),
        depth_m: tuple[float, float] = (NEAR_M, FAR_M),
    ) -> Picture:
        """The picture of a camera.

        Parameters
        ----------
        position
            (3,) metres in the map frame.
        axes
            (3, 3): its x to the right, y down, z ahead as columns in the map frame.
        lens
            of the size that this renderer has.
        marks
            what else is in the picture.
        depth_m
            the nearest and the farthest that is seen, along the axis: the closer together, the better what lies almost
            in one plane is told apart.

        Raises
        ------
        ParameterError
            if the lens is of another size.
        """
        if (lens.width, lens.height) != self._size:
            width, height = self._size
            raise ParameterError(f"lens: {lens.width} x {lens.height} pixels; expected {width} x {height}")
        across, down = lens.centre_px or (lens.width / 2, lens.height / 2)
        scale = depth_m[0] / lens.focal_px
        frustum = {
            "frustum_center": scale * (lens.width / 2 - across),
            "frustum_top": scale * down,
            "frustum_bottom": -scale * (lens.height - down),
        }
        return self._drawn(position, axes, frustum, depth_m, marks, orthographic=False)

    def seen_from_above(self, centre: tuple[float, float], height_m: float, *, marks: Iterable[Mark] = ()) -> Picture:
        """A map-like view: north is up, and the picture is `height_m` metres high."""
        x, y = centre
        axes = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
        frustum = {"frustum_center": 0.0, "frustum_top": height_m / 2, "frustum_bottom": -height_m / 2}
        above = np.array([x, y, FAR_M / 2])
        return self._drawn(above, axes, frustum, (NEAR_M, FAR_M), marks, orthographic=True)

    def _drawn(
        self,
        position: Floats,
        axes: Floats,
        frustum: dict[str, float],
        depth_m: tuple[float, float],
        marks: Iterable[Mark],
        *,
        orthographic: bool,
    ) -> Picture:
        if self._simulated is not self._world.simulated:
            self.close()
            self._open()
        scene = self._renderer.scene
        self._renderer.update_scene(self._simulated.data)
        for flag in _COSTLY:
            scene.flags[flag] = 0
        for mark in marks:
            mark.put(scene)
        for camera in scene.camera:  # of the left eye and of the right
            camera.pos, camera.forward, camera.up = position, axes[:, 2], -axes[:, 1]
            (camera.frustum_near, camera.frustum_far), camera.orthographic = depth_m, int(orthographic)
            for name, value in frustum.items():
                setattr(camera, name, value)
        picture: Picture = self._renderer.render()
        return picture

    def _open(self) -> None:
        self._simulated = self._world.simulated
        width, height = self._size
        try:
            self._renderer: Any = mujoco.Renderer(self._simulated.model, height, width)
        except (mujoco.FatalError, ImportError, AttributeError, RuntimeError):  # of MuJoCo or of PyOpenGL
            raise RenderingError(_nothing_draws()) from None


def _nothing_draws() -> str:
    said = os.environ.get("MUJOCO_GL", "")
    if said and said not in BACKENDS:
        return f"pictures: MUJOCO_GL is {said}, with which nothing draws here; expected it unset"
    libraries = " or ".join(BACKENDS.values())
    return (
        f"pictures: nothing draws here (MUJOCO_GL={said}); expected {libraries}, on Debian of the packages libegl1 and "
        "libegl-mesa0, or libosmesa6"
    )
