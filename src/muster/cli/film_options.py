"""Films and stills of `muster simulate`: what is asked for is checked before the run, and drawn after."""

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
    """Find out before the mission is carried out that it cannot be filmed so."""
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
    """What is to be filled while the mission is carried out."""
    from muster.report.film import Footage

    return Footage(mission)


def draw_footage(footage: Footage, film: Path | None, speed: float | None, still: Path | None, *, quiet: bool) -> None:
    """Draw what is asked for, and say of it on standard error."""
    from muster.report.film import write_film, write_still

    if still is not None:
        write_still(still, footage)
    if film is not None:
        if not quiet:
            click.echo(f"drawing {film}; Ctrl-C leaves it as long as it is then", err=True)
        made = write_film(film, footage, speed=speed)
        if not quiet:
            click.echo(f"{film}: {made.duration_s:.1f} s at {made.speed:g} times real time", err=True)
