"""The live table of an auction, on standard error and only on a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from muster.model.problem import Problem
from muster_team.knowledge.messages import RoundBids, Sold
from muster_team.processes.node import NodeStatus
from muster_team.processes.team import Team

if TYPE_CHECKING:
    from rich.console import RenderableType

_EVERY_S = 0.1
_SALES_SHOWN = 3
_BESIDE_ROWS = 7 + _SALES_SHOWN
_NAMES_SHOWN = 3


@contextmanager
def auction_table(problem: Problem, transport: str, *, wanted: bool) -> Iterator[Callable[[Team], None]]:
    """A function that shows the progress of the team; it does nothing without a terminal."""
    if not wanted or not sys.stderr.isatty():
        yield lambda team: None
        return
    from rich.console import Console
    from rich.live import Live

    console = Console(stderr=True)
    title = f"{problem.mission.name}: {len(problem.robots)} robots, {len(problem.tasks)} tasks, over {transport}"
    last_s = 0.0
    sales: list[tuple[int, Sold]] = []
    with Live(console=console, transient=True, auto_refresh=False, redirect_stdout=False) as live:

        def show(team: Team) -> None:
            nonlocal last_s
            _note_sales(team, sales)
            if time.monotonic() >= last_s + _EVERY_S:
                last_s = time.monotonic()
                live.update(_picture(title, team, sales, console.height - _BESIDE_ROWS), refresh=True)

        yield show


def _note_sales(team: Team, sales: list[tuple[int, Sold]]) -> None:
    """Keep the last rounds' winners, as far as robots have reported them."""
    for news in team.progress.values():
        status = news.status
        if status.last_sale is not None and (status.round, status.last_sale) not in sales:
            sales.append((status.round, status.last_sale))
    sales.sort(key=lambda sale: sale[0])
    del sales[:-_SALES_SHOWN]


def _picture(title: str, team: Team, sales: list[tuple[int, Sold]], room: int) -> RenderableType:
    from rich import box
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    since = "starting" if team.began_s is None else f"{time.monotonic() - team.began_s:.1f} s"
    table = Table(box=box.SIMPLE_HEAD, title=Text(f"{title}; {since}"), title_justify="left", pad_edge=False)
    for name in ("robot", "epoch", "round", "bids", "messages", "kB", "state"):
        table.add_column(
            name, justify="right" if name in ("epoch", "round", "messages", "kB") else "left", no_wrap=True
        )
    rows = [_row(robot, team) for robot in team.robots]
    if len(rows) > max(room, 1):
        troubled = sorted(rows, key=lambda row: row[-1] in ("bids", "agrees"))  # stable: trouble first, then in order
        rows = [*troubled[: max(room - 1, 1)], (f"... {len(rows) - max(room - 1, 1)} more", *[""] * 6)]
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    won = [Text(f"round {number}: {sold.winner} won {sold.what} for {sold.price:.2f}") for number, sold in sales]
    return Group(table, *won)


def _row(robot: str, team: Team) -> tuple[str, ...]:
    if robot in team.ended:
        return robot, "", "", "", "", "", team.ended[robot]
    if robot not in team.progress:
        return robot, "", "", "", "", "", "starts"
    status = team.progress[robot].status
    volume = sum(status.sent_bytes.values()) / 1000
    return (
        robot,
        str(status.epoch),
        str(status.round),
        _bid(status.bid),
        str(sum(status.sent.values())),
        f"{volume:.1f}",
        _state(status),
    )


def _bid(bids: RoundBids | None) -> str:
    if bids is None:
        return ""
    if not bids.bids:
        return "nothing"
    task, price = min(bids.bids, key=lambda bid: bid[1])
    return f"{task} for {price:.2f}" + (f", and {len(bids.bids) - 1} more" if len(bids.bids) > 1 else "")


def _state(status: NodeStatus) -> str:
    if status.silent:
        more = "" if len(status.silent) <= _NAMES_SHOWN else f" and {len(status.silent) - _NAMES_SHOWN} more"
        return f"hears nothing of {', '.join(status.silent[:_NAMES_SHOWN])}{more}" + ("; agrees" * status.settled)
    return "agrees" if status.settled else "bids"
