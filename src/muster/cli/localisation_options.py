"""The options of `muster simulate` about poses: what robots steer by, and by which sensors they localise themselves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from muster.mission.errors import ParameterError

POSES = ("true", "estimate")


def pose_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """--pose and --localise; the verb gets `pose` and `sensors`, the texts of the latter."""
    pose = click.option(
        "--pose",
        type=click.Choice(POSES),
        help="What robots steer by.  [default: estimate with --localise or noise of poses or odometry, else true]",
    )
    localise = click.option(
        "--localise",
        "sensors",
        multiple=True,
        metavar="SENSOR[:KEY=VALUE,...]",
        help="odometry, inertial, tags, lasers, scans, motion-capture, gps, rtk; see docs/estimation.md.",
    )
    return pose(localise(verb))


def localise_of(sensors: tuple[str, ...]) -> dict[str, dict[str, str]] | None:
    """The sensors of `--localise`, with their parameters as texts; None where none is named."""
    found: dict[str, dict[str, str]] = {}
    for text in sensors:
        name, _, settings = text.partition(":")
        if name in found:
            raise ParameterError(f"--localise: {name} twice; expected each sensor at most once")
        found[name] = {}
        for setting in filter(None, settings.split(",")):
            key, equals, value = setting.partition("=")
            if not equals or key in found[name]:
                raise ParameterError(f"--localise: {text}; expected each KEY=VALUE at most once after {name}:")
            found[name][key] = value
    return found or None
