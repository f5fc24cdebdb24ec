"""Films and stills of `muster simulate`: options are checked before the run, files are written after it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import click

from muster.cli.options.common import Finite
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.perception.optional_parts import require_physics
from muster.running.run_outputs import BegunOutput, Say
from muster.running.worlds import has_ability, world_named, worlds_that
from muster.simulation.declaration import BODIES

if TYPE_CHECKING:
    from muster_physics.film import Footage

_FILE = click.Path(path_type=Path)


class _Films:
    """See `RunOutput`. From Python `film` may be a `Footage`, of which the caller makes films."""

    options: ClassVar[Mapping[str, Callable[[Any], Any]]] = {
        "film": click.option("--film", type=_FILE, metavar="FILE", help="Film it, in the physics world (.mp4, .gif)."),
        "film_speed": click.option(
            "--film-speed",
            type=Finite(0.01, 1e6),
            metavar="X",
            help="X times real time.  [default: a film of at most 24 s]",
        ),
        "still": click.option(
            "--still",
            type=_FILE,
            metavar="FILE",
            help="Draw how it ended from above, in the physics world (.png).",
        ),
    }
    files = ("film", "still")
    not_at_server = "it keeps where bodies are, and not how they look"

    def require_possible(self, world: str, given: Mapping[str, Any]) -> None:
        """See `RunOutput`."""
        film, still = given["film"], given["still"]
        if given["film_speed"] is not None and film is None:
            raise ParameterError("--film-speed given; expected it together with --film")
        if film is None and still is None:
            return
        if not has_ability(world_named(world), BODIES):
            option = "--film" if film is not None else "--still"
            filmed = worlds_that(lambda make: has_ability(make, BODIES))
            raise ParameterError(
                f"{option} given; expected it together with --world {filmed}: only there are bodies to see"
            )
        require_physics("a film or a still", "mujoco", "cv2")
        from muster_physics.film import check_film, check_still

        if film is not None:
            check_film(film)
        if still is not None:
            check_still(still)

    def begin(self, mission: Mission, world: str, given: Mapping[str, Any]) -> BegunOutput | None:
        """See `RunOutput`."""
        film, still = given.get("film"), given.get("still")
        if film is None and still is None:
            return None
        from muster_physics.film import Footage, check_film

        if isinstance(film, Footage):
            return BegunOutput(observers=(film,), on_world=film.on_world)
        if film is not None:
            check_film(film)
        footage = Footage(mission)
        write = partial(_write, footage, film, given.get("film_speed"), still)
        return BegunOutput(observers=(footage,), on_world=footage.on_world, write=write)


def _write(footage: Footage, film: str | Path | None, speed: float | None, still: Path | None, say: Say) -> None:
    """Write the film and the still."""
    from muster_physics.film import write_film, write_still

    if still is not None:
        write_still(still, footage)
    if film is not None:
        say(f"drawing {film}; Ctrl-C leaves it as long as it is then")
        made = write_film(film, footage, speed=speed)
        say(f"{film}: {made.duration_s:.1f} s at {made.speed:g} times real time")


FILMS = _Films()
