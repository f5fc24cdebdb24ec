"""A simulated robot as a program: the command-line options and the end that ROS 1 and ROS 2 have in common."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import click

from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.motion.kinematics.registry import KINEMATICS
from muster_robots.discovery import topics_in

F = TypeVar("F", bound=Callable[..., None])
_ABOVE_0 = click.FloatRange(min=0, min_open=True)
_OPTIONS = [
    click.argument("robot"),
    click.option("--namespace", default="", metavar="NAME", help="In which its own is.  [default: the root]"),
    click.option("--at", type=float, nargs=2, default=(0.0, 0.0), metavar="X Y", help="Where it starts, in metres."),
    click.option("--height", type=float, default=0.0, metavar="Z", help="How high."),
    click.option("--heading", type=float, default=0.0, metavar="DEG", help="From east, anticlockwise."),
    click.option("--kind", type=click.Choice(["ground", "air"]), default="ground", show_default=True),
    click.option("--kinematics", type=click.Choice(list(KINEMATICS)), default="differential-drive", show_default=True),
    click.option("--speed", "speed_mps", type=_ABOVE_0, default=1.0, show_default=True, help="m/s."),
    click.option("--yaw-rate", "yaw_rate_radps", type=_ABOVE_0, default=1.5, show_default=True, help="rad/s."),
    click.option("--radius", "radius_m", type=click.FloatRange(0), default=0.2, show_default=True, help="Metres."),
    click.option("--type", metavar="TYPE", help="Its row of a mission's suitability table."),
    click.option(
        "--maps",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        metavar="MISSION",
        help="It maps the obstacles of a mission with a lidar, and tells its map.",
    ),
    click.option(
        "--rate", "rate_hz", type=click.FloatRange(1, 200), default=20.0, show_default=True, help="Poses a second."
    ),
]


@dataclass(frozen=True)
class Wanted:
    """The robot that was asked for.

    Parameters
    ----------
    namespace
        in which its own namespace is; "" for the root.
    rate_hz
        of its steps and its poses.
    says
        of itself, with keys of a robot in a mission file.
    maps
        the file of the mission whose obstacles it maps, if it does.
    """

    robot: Robot
    namespace: str
    rate_hz: float
    says: dict[str, Any]
    maps: Path | None = None

    def topics(self, name: str) -> str:
        """Its own namespace, such as `/r_0`, by its name in ROS."""
        return topics_in(self.namespace)(name)


def robot_options(command: F) -> F:
    """Give a command the options of which `wanted` makes a robot."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def wanted(
    robot: str,
    namespace: str,
    at: tuple[float, float],
    height: float,
    heading: float,
    rate_hz: float,
    maps: Path | None = None,
    **body: Any,
) -> Wanted:
    """What `robot_options` asked for."""
    says = {name: value for name, value in body.items() if value is not None}
    it = replace(Robot(id=robot, position=(*at, height), heading_deg=heading), **says)
    return Wanted(it, namespace, rate_hz, says, maps)


def run(command: click.Command, module: str, arguments: Sequence[str] | None) -> None:
    """Run a robot's program; an expected failure is a line and exit code 2, Ctrl-C is 130."""
    try:
        command.main(args=arguments, prog_name=f"python -m {module}", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        raise SystemExit(2) from None
    except MusterError as error:
        click.echo(str(error), err=True)
        raise SystemExit(2) from None
    except (KeyboardInterrupt, click.Abort):
        raise SystemExit(130) from None
