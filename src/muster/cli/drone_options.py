"""The options of `muster simulate` for drones and batteries: --wind, --gusts, --rotors, --battery, --drain."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from muster.mission.errors import ParameterError

IN_THIS_PROCESS = ("wind", "gusts", "rotors", "batteries", "drain")


def drone_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options; `conditions_of` makes keyword arguments of a simulation of them."""
    for option in reversed(
        (
            click.option("--wind", metavar="EAST,NORTH[,UP]", help="Velocity of the air in m/s, with --world physics."),
            click.option(
                "--gusts",
                type=click.FloatRange(min=0),
                metavar="M/S",
                help="Gusts, by the wind speed at 6 m: 7.7 light, 15 moderate; with --world physics.",
            ),
            click.option("--rotors", is_flag=True, help="Drones rotor by rotor, with --world physics."),
            click.option(
                "--battery",
                "batteries",
                multiple=True,
                metavar="ROBOT=SHARE",
                help="A battery that begins with this share, 0 to 1; `all` for every robot.",
            ),
            click.option(
                "--drain",
                multiple=True,
                metavar="ROBOT=FACTOR",
                help="A battery that drains so many times as fast as by usage; FACTOR alone for every robot.",
            ),
        )
    ):
        verb = option(verb)
    return verb


def conditions_of(
    wind: str | None, gusts: float | None, batteries: tuple[str, ...], drain: tuple[str, ...], *, rotors: bool
) -> dict[str, Any]:
    """Keyword arguments for what was given: `wind`, `batteries`, `drain`, `rotor_level`."""
    from muster.simulation import Wind

    found: dict[str, Any] = {}
    if wind is not None or gusts is not None:
        found["wind"] = Wind(velocity_mps=_velocity(wind), gusts_mps=gusts or 0.0)
    if batteries:
        found["batteries"] = _charges(batteries)
    if drain:
        found["drain"] = _drains(drain)
    if rotors:
        found["rotor_level"] = True
    return found


def _velocity(text: str | None) -> tuple[float, float, float]:
    if text is None:
        return 0.0, 0.0, 0.0
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (2, 3):
        raise ParameterError(f"--wind: {text}; expected EAST,NORTH or EAST,NORTH,UP in m/s, such as 3,-1")
    east, north, up = (*numbers, 0.0)[:3]
    return east, north, up


def _drains(texts: tuple[str, ...]) -> dict[str, float]:
    drains: dict[str, float] = {}
    for text in texts:
        robot, _, factor = text.rpartition("=")
        robot = robot or "all"
        if robot in drains:
            raise ParameterError(f"--drain: {text}; expected each robot at most once, as ROBOT=FACTOR, or FACTOR alone")
        try:
            drains[robot] = float(factor)
        except ValueError:
            raise ParameterError(f"--drain: {text}; expected a number above 0, or ROBOT=FACTOR") from None
    return drains


def _charges(texts: tuple[str, ...]) -> dict[str, float]:
    charges: dict[str, float] = {}
    for text in texts:
        robot, _, share = text.rpartition("=")
        if not robot or robot in charges:
            raise ParameterError(f"--battery: {text}; expected each robot at most once, as ROBOT=SHARE or all=SHARE")
        try:
            charges[robot] = float(share)
        except ValueError:
            raise ParameterError(f"--battery: {text}; expected a number from 0 to 1 after {robot}=") from None
    return charges
