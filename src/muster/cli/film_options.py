"""Films and stills of `muster simulate`: options are checked before the run, files are written after it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.perception.optional_parts import require_physics

if TYPE_CHECKING:
    from muster.report.film import Footage


def require_filmable(world: str, film: Path | None, speed: float | None, still: Path | None) -> None:
    """Refuse, before the run, films that cannot be made."""
    if speed is not None and film is None:
        raise ParameterError("--film-speed given; expected it together with --film")
    if film is None and still is None:
        return
    if world != "physics":
        option = "--film" if film is not None else "--still"
        raise ParameterError(f"{option} given; expected it together with --world physics: only there are bodies to see")
    require_physics("a film or a still", "mujoco", "cv2")
    from muster.report.film import check_film, check_still

    if film is not None:
        check_film(film)
    if still is not None:
        check_still(still)


def footage_of(mission: Mission) -> Footage:
    """The footage that the run is recorded into."""
    from muster.report.film import Footage

    return Footage(mission)


def draw_footage(footage: Footage, film: Path | None, speed: float | None, still: Path | None, *, quiet: bool) -> None:
    """Write the film and the still, and report them on standard error."""
    from muster.report.film import write_film, write_still

    if still is not None:
        write_still(still, footage)
    if film is not None:
        if not quiet:
            click.echo(f"drawing {film}; Ctrl-C leaves it as long as it is then", err=True)
        made = write_film(film, footage, speed=speed)
        if not quiet:
            click.echo(f"{film}: {made.duration_s:.1f} s at {made.speed:g} times real time", err=True)
