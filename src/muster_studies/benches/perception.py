"""Speed of cameras: part of `muster bench`."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import closing

from muster.perception.camera import View, intrinsics_of_mission, mount_of_mission
from muster.perception.camera_observer import CameraObserver
from muster.perception.detection import TagDetector
from muster.planning.loading import load
from muster_studies.benches.measurement import Measurement

MISSION = "16T-3R-tags"
OVER_TAGS = (10.2, 3.2, 2.0, 0.0, 0.0, math.radians(35))
"""A drone's pose (6,) from which it sees three of the mission's tags."""
PICTURES = 50


def perception(runs: int) -> list[Measurement]:
    """Pictures a second that a drone renders and searches for tags; processor time, one core.

    Raises
    ------
    MissingExtraError
        if the extra `physics` is not installed.
    """
    from muster_physics import PhysicsWorld
    from muster_physics.rendered_cameras import RenderedCameras
    from muster_physics.rendering import Lens, Renderer

    mission = load(MISSION)
    camera = mission.robots[0].camera
    assert camera is not None
    lens, mount, detector = intrinsics_of_mission(camera), mount_of_mission(camera), TagDetector()
    drone = CameraObserver(robot="r_0", intrinsics=lens, mount=mount, detector=detector)
    view = View.from_body(lens, OVER_TAGS, mount)
    world = PhysicsWorld(mission)
    world.step()  # the model is made
    size = lens.width, lens.height
    with closing(RenderedCameras(world)) as sight, Renderer(world, *size) as renderer:
        look = sight.look(drone, view, OVER_TAGS, 0.0)
        image = look.image
        assert image is not None
        whole = [_rate(lambda: sight.look(drone, view, OVER_TAGS, 0.0)) for _ in range(runs)]
        pinhole = Lens(*size, lens.fx, (lens.cx, lens.cy))
        drawn = [_rate(lambda: renderer.seen_from(view.position, view.rotation, pinhole)) for _ in range(runs)]
        detected = [_rate(lambda: detector.detect(image, lens)) for _ in range(runs)]
    seen = f"{len(look.observation.sightings.all)} tags in it"
    rows = (("drawn and detected", whole, ">= 30"), ("drawn", drawn, ""), ("detected", detected, ""))
    name = f"camera of {size[0]} x {size[1]}"
    return [Measurement.over_runs(f"{name}, {what}", "1 / CPU s", rates, aim, seen) for what, rates, aim in rows]


def _rate(look: Callable[[], object]) -> float:
    begin = time.process_time()
    for _ in range(PICTURES):
        look()
    return PICTURES / (time.process_time() - begin)
