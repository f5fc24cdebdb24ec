"""The node uav_camera on ROS 1: `python -m muster.cli.uav_camera r_0 --mission yard.yaml`."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.options import Finite
from muster.mission.errors import MusterError, ParameterError

if TYPE_CHECKING:
    from muster.bridges.ros1.uav_camera import Taken
    from muster.perception.camera import Intrinsics
    from muster.perception.images import Image

_IMAGES = (".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".ppm")


@click.command()
@click.argument("robot")
@click.option("--mission", metavar="MISSION", help="Render what the robot's camera would see of this mission's tags.")
@click.option("--images", "source", metavar="SOURCE", help="A folder of images, a film, or the number of a camera.")
@click.option("--calibration", metavar="FILE", help="The camera's calibration, as ROS writes it; needed with --images.")
@click.option("--rate", type=Finite(0.1, 100.0), metavar="HZ", help="Images a second.  [default: the mission's, or 2]")
@click.option("--repeat", is_flag=True, help="Begin a folder of images again at its end.")
@click.option("--namespace", default="", metavar="NAME", help="In which the robot's own is.  [default: the root]")
@click.option("--frame", default="map", show_default=True, metavar="FRAME", help="The mission's frame, for tf.")
@click.option("--master", metavar="URI", help="The ROS master.  [default: ROS_MASTER_URI]")
def command(
    robot: str,
    mission: str | None,
    source: str | None,
    calibration: str | None,
    rate: float | None,
    repeat: bool,
    namespace: str,
    frame: str,
    master: str | None,
) -> None:
    """Publish the images of a ROBOT's camera, and its camera_info, on ROS 1, until Ctrl-C."""
    if (mission is None) == (source is None):
        raise ParameterError("expected either --mission, for a simulated robot, or --images")
    if mission is not None:
        if calibration is not None:
            raise ParameterError("--calibration given with --mission; expected it together with --images")
        _run_simulated(robot, mission, rate, namespace, frame, master)
    elif source is not None:
        if calibration is None:
            raise ParameterError("--calibration: missing; expected the camera's calibration file")
        _run_real(robot, source, calibration, rate or 2.0, repeat, namespace, master)


def _run_simulated(
    robot: str, mission: str, rate: float | None, namespace: str, frame: str, master: str | None
) -> None:
    """Where the robot says that it is, the physics world's renderer draws what its camera sees."""
    from muster import load
    from muster.bridges.discovery import topics_in
    from muster.bridges.ros1.map_frame import MapFrame
    from muster.bridges.ros1.node import become_node
    from muster.bridges.ros1.uav_camera import UavCamera, seen_from_poses
    from muster.perception.camera import intrinsics_of_mission, mount_of_mission
    from muster.perception.optional_parts import require_physics

    require_physics("rendering images", "mujoco")
    from muster.simulation.physics.placed_camera import PlacedCamera

    loaded, topics = load(mission), topics_in(namespace)(robot)
    camera = next((one.camera for one in loaded.robots if one.id == robot), None)
    if camera is None:
        raise ParameterError(f"robot {robot}: no camera in {loaded.name}; expected a robot of it with `camera`")
    intrinsics, mount = intrinsics_of_mission(camera), mount_of_mission(camera)
    placed = PlacedCamera(loaded, intrinsics)
    become_node(f"uav_camera{topics.replace('/', '_')}", master)
    taken = seen_from_poses(topics, MapFrame(frame), lambda body: placed.image(body, mount))
    UavCamera(topics, intrinsics, rate_hz=rate or camera.rate_hz, mount=mount).run(taken)


def _run_real(
    robot: str, source: str, calibration: str, rate_hz: float, repeat: bool, namespace: str, master: str | None
) -> None:
    from muster.bridges.discovery import topics_in
    from muster.bridges.ros1.node import become_node
    from muster.bridges.ros1.uav_camera import UavCamera
    from muster.perception.calibration import read_intrinsics

    intrinsics, topics = read_intrinsics(calibration), topics_in(namespace)(robot)
    taken = _checked(_images(source, repeat), intrinsics)
    become_node(f"uav_camera{topics.replace('/', '_')}", master)
    UavCamera(topics, intrinsics, rate_hz=rate_hz).run(taken)


def _images(source: str, repeat: bool) -> Iterator[Image]:
    from muster.perception.images import images_from, read_image

    folder = Path(source)
    if not folder.is_dir():
        return images_from(int(source) if source.isdigit() else source)
    files = sorted(file for file in folder.iterdir() if file.suffix.lower() in _IMAGES)
    if not files:
        raise ParameterError(f"--images: {source}; expected a folder with images ({', '.join(_IMAGES)})")
    return (read_image(file) for file in (cycle(files) if repeat else files))


def _checked(images: Iterator[Image], intrinsics: Intrinsics) -> Iterator[Taken]:
    """Images with no stamp of their own; one of another size than the calibration's ends the node."""
    for image in images:
        height, width = image.shape[:2]
        if (width, height) != (intrinsics.width, intrinsics.height):
            right = f"{intrinsics.width} x {intrinsics.height}, as the calibration has it"
            raise ParameterError(f"image: {width} x {height} pixels; expected {right}")
        yield None, image


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the node; an expected failure is a line and exit code 2, Ctrl-C is 130."""
    try:
        command.main(args=arguments, prog_name="python -m muster.cli.uav_camera", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except MusterError as error:
        click.echo(str(error), err=True)
        sys.exit(2)
    except (KeyboardInterrupt, click.Abort):
        sys.exit(130)


if __name__ == "__main__":
    main()
