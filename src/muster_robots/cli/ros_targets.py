"""The options of `muster ros` and `ros2` for target_localization: what robots' cameras see."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import wraps
from typing import TYPE_CHECKING, Any, cast

import click

from muster.cli.options.common import Finite, Verb
from muster.mission.errors import ParameterError

if TYPE_CHECKING:
    from muster_robots.target_search import SearchSettings


@dataclass(frozen=True, kw_only=True)
class TargetOptions:
    """How targets are found by robots' cameras; see `SearchSettings`."""

    locate: str
    tag_size: float | None
    calibrations: Mapping[str, str]

    def as_text(self) -> str:
        """As JSON, for the node."""
        return json.dumps({"locate": self.locate, "tag_size": self.tag_size, "calibrations": dict(self.calibrations)})

    def settings(self) -> SearchSettings:
        """With the calibration files read.

        Raises
        ------
        InputError, ParameterError
            if a file or a number is wrong.
        """
        from muster.perception.cameras.calibration import read_intrinsics
        from muster_robots.target_search import SearchSettings

        return SearchSettings(
            locate="size" if self.locate == "size" else "ground",
            tag_size_m=self.tag_size,
            calibrations={robot: read_intrinsics(file) for robot, file in self.calibrations.items()},
        )


def targets_from(text: str) -> TargetOptions:
    """The inverse of `TargetOptions.as_text`."""
    return TargetOptions(**json.loads(text))


def target_options(verb: Verb) -> Verb:
    """The options that the verb gets as `targets`: `TargetOptions`, or None without --find-targets."""

    @wraps(verb)
    def with_targets(
        *, find_targets: bool, locate: str | None, tag_size: float | None, calibrations: tuple[str, ...], **given: Any
    ) -> Any:
        asked = {"--locate": locate, "--tag-size": tag_size, "--calibration": calibrations or None}
        named = [name for name, value in asked.items() if value is not None]
        if named and not find_targets:
            raise ParameterError(f"{named[0]} given; expected it together with --find-targets")
        if not find_targets:
            return verb(targets=None, **given)
        files = _by_robot(calibrations)
        targets = TargetOptions(locate=locate or "ground", tag_size=tag_size, calibrations=files)
        targets.settings()  # what is wrong is said before anything is started
        return verb(targets=targets, **given)

    declared = (
        click.option("--find-targets", is_flag=True, help="Tags that robots' cameras see become tasks, by `found`."),
        click.option(
            "--locate",
            type=click.Choice(["ground", "size"]),
            help="A tag is where its ray meets the ground, or by its size.  [default: ground]",
        ),
        click.option(
            "--tag-size", type=Finite(0.001, 100.0), metavar="M", help="Side of tags that the mission does not list."
        ),
        click.option(
            "--calibration",
            "calibrations",
            multiple=True,
            metavar="ROBOT=FILE",
            help="A camera's calibration file.  [default: what camera_info says]",
        ),
    )
    decorated: Any = with_targets
    for option in reversed(declared):
        decorated = option(decorated)
    return cast("Verb", decorated)


def _by_robot(texts: tuple[str, ...]) -> dict[str, str]:
    named: dict[str, str] = {}
    for text in texts:
        robot, _, file = text.partition("=")
        if not file or robot in named:
            raise ParameterError(f"--calibration: {text}; expected ROBOT=FILE, once for each robot")
        named[robot] = file
    return named
