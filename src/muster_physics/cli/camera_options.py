"""Pictures of what cameras saw, by `muster simulate --cameras`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import click

from muster.cli.outputs import require_folder
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.running.camera_search import require_tags
from muster.running.run_outputs import BegunOutput
from muster.running.worlds import placed_camera_of, world_named, worlds_that


class _CameraPictures:
    """See `RunOutput`."""

    options: ClassVar[Mapping[str, Callable[[Any], Any]]] = {
        "cameras": click.option(
            "--cameras",
            type=click.Path(path_type=Path),
            metavar="DIR",
            help="Write what cameras saw of each tag, largest; with --world physics.",
        )
    }
    files: tuple[str, ...] = ()
    not_at_server = "it keeps no pictures of cameras"

    def require_possible(self, world: str, given: Mapping[str, Any]) -> None:
        """See `RunOutput`; what the mission says comes first."""

    def begin(self, mission: Mission, world: str, given: Mapping[str, Any]) -> BegunOutput | None:
        """See `RunOutput`."""
        folder = given.get("cameras")
        if folder is None:
            return None
        require_tags(mission, "--cameras")
        if placed_camera_of(world_named(world)) is None:
            drawn = worlds_that(lambda make: placed_camera_of(make) is not None)
            raise ParameterError(f"--cameras: no pictures in the {world} world; expected --world {drawn}")
        require_folder(folder, "--cameras")
        from muster_physics.camera_pictures import CameraPictures

        return BegunOutput(on_look=CameraPictures(folder))


CAMERA_PICTURES = _CameraPictures()
