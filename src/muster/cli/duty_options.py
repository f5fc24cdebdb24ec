"""Options of fleets that stay on duty: `--stay`, `--until`, `--orders`."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options import Finite
from muster.mission.errors import ParameterError

if TYPE_CHECKING:
    from muster.execution import Standing

_OPTIONS = (
    click.option("--stay", is_flag=True, help="Stay on duty when all tasks are done, until --until or Ctrl-C."),
    click.option(
        "--until",
        type=Finite(0.0, 1e9),
        metavar="S",
        help="With --stay: take orders for so many seconds, then end what is open.",
    ),
    click.option(
        "--orders",
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="Tasks that come meanwhile, by time: events as JSON lines, or .csv with at_s,id,x,y.",
    ),
)


def duty_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """The options; the verb gets `stay`, `until` and `orders`."""
    for option in reversed(_OPTIONS):
        verb = option(verb)
    return verb


def standing_of(orders: Path | None, until: float | None, *, stay: bool) -> Standing | None:
    """The fleet that stays on duty; None: it ends when its tasks are done.

    With orders and without `--stay` it stays until the last of them is done.

    Raises
    ------
    ParameterError
        for an end without `--stay`.
    MissionError
        if the file is wrong: line, field, value, and what was expected.
    """
    from muster.execution import Standing
    from muster.mission.order_files import OrderFile

    if until is not None and not stay:
        raise ParameterError("--until given; expected it together with --stay")
    if not stay and orders is None:
        return None
    on_duty_s = math.inf if until is None else until
    return Standing(until_s=on_duty_s if stay else None, orders=() if orders is None else OrderFile(orders))
