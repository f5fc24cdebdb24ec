"""The node uav_camera on ROS 1 and ROS 2: `python -m muster_robots.cli.uav_camera r_0 --mission yard.yaml`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options.common import Finite
from muster.mission.errors import MusterError, ParameterError

if TYPE_CHECKING:
    from muster.motion.frames import Floats
    from muster.perception.camera import Intrinsics
    from muster.perception.cameras.images import Image
    from muster_robots.ros1.uav_camera import Taken

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
@click.option("--ros", type=click.Choice(["1", "2"]), default="1", show_default=True, help="Which ROS.")
@click.option("--master", metavar="URI", help="The ROS master of ROS 1.  [default: ROS_MASTER_URI]")
@click.option("--domain", type=int, metavar="N", help="Domain of ROS 2.  [default: ROS_DOMAIN_ID, or 0]")
@click.option("--by", type=click.Choice(["dds", "rclpy"]), help="Middleware of ROS 2, as of `muster ros2`.")
def command(
    robot: str,
    mission: str | None,
    source: str | None,
    calibration: str | None,
    rate: float | None,
    repeat: bool,
    **where: Any,
) -> None:
    """Publish the images of a ROBOT's camera, and its camera_info, until Ctrl-C."""
    if (mission is None) == (source is None):
        raise ParameterError("expected either --mission, for a simulated robot, or --images")
    if mission is not None:
        if calibration is not None:
            raise ParameterError("--calibration given with --mission; expected it together with --images")
        _run_simulated(robot, mission, rate, where)
    elif source is not None:
        if calibration is None:
            raise ParameterError("--calibration: missing; expected the camera's calibration file")
        _run_real(robot, source, calibration, rate or 2.0, repeat, where)


def _run_simulated(robot: str, mission: str, rate: float | None, where: Mapping[str, Any]) -> None:
    """Where the robot says that it is, a world that has pictures draws what its camera sees."""
    from muster import load
    from muster.perception.camera import intrinsics_of_mission, mount_of_mission
    from muster.running.worlds import placed_camera

    loaded = load(mission)
    camera = next((one.camera for one in loaded.robots if one.id == robot), None)
    if camera is None:
        raise ParameterError(f"robot {robot}: no camera in {loaded.name}; expected a robot of it with `camera`")
    intrinsics, mount = intrinsics_of_mission(camera), mount_of_mission(camera)
    placed = placed_camera(loaded, intrinsics)

    def picture(body: Floats) -> Image:
        return placed.image(body, mount)

    _publish(robot, intrinsics, rate or camera.rate_hz, where, picture=picture, mount=mount)


def _run_real(
    robot: str, source: str, calibration: str, rate_hz: float, repeat: bool, where: Mapping[str, Any]
) -> None:
    from muster.perception.cameras.calibration import read_intrinsics

    intrinsics = read_intrinsics(calibration)
    _publish(robot, intrinsics, rate_hz, where, images=_checked(_images(source, repeat), intrinsics))


def _publish(
    robot: str,
    intrinsics: Intrinsics,
    rate_hz: float,
    where: Mapping[str, Any],
    *,
    images: Iterator[Taken] | None = None,
    picture: Callable[[Floats], Image] | None = None,
    mount: Floats | None = None,
) -> None:
    """Publish images, or where there are none what `picture` draws from the robot's poses, on ROS 1 or ROS 2."""
    from muster_robots.discovery import topics_in

    topics_of = topics_in(where["namespace"])
    if where["ros"] == "1":
        from muster_robots.ros1.extra import require_rospy

        require_rospy(("sensor_msgs", "visualization_msgs"))
        from muster_robots.ros1 import uav_camera as ros1
        from muster_robots.ros1.map_frame import MapFrame
        from muster_robots.ros1.node import become_node

        topics = topics_of(robot)
        become_node(f"uav_camera{topics.replace('/', '_')}", where["master"])
        drawn = None if picture is None else ros1.seen_from_poses(topics, MapFrame(where["frame"]), picture)
        ros1.UavCamera(topics, intrinsics, rate_hz=rate_hz, mount=mount).run(images or drawn or iter(()))
        return
    from muster_robots.ros2 import uav_camera as ros2
    from muster_robots.ros2.names import ros_name
    from muster_robots.ros2.open_middleware import open_middleware

    middleware, topics = open_middleware(where["by"], where["domain"]), topics_of(ros_name(robot))
    seen = None if picture is None else ros2.seen_from_poses(middleware, topics, picture)
    ros2.Ros2Camera(middleware, topics, intrinsics, rate_hz=rate_hz).run(images or seen or iter(()))


def _images(source: str, repeat: bool) -> Iterator[Image]:
    from muster.perception.cameras.images import images_from, read_image

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
        command.main(args=arguments, prog_name="python -m muster_robots.cli.uav_camera", standalone_mode=False)
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
