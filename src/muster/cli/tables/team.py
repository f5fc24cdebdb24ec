"""Lines of the report about robots that agreed without a centre: ends, silence, splits, refusals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import click

from muster.cli.tables.table import number
from muster.mission.texts.counting import counted

Row = Mapping[str, Any]


def print_team(team: Row | None) -> None:
    """Print what became of the processes of a team, a line each; nothing of what did not happen."""
    if not team:
        return
    for row in team.get("ended", ()):
        _line("process ended", f"{row['robot']} at {number(row.get('at_s'))} s, {row.get('why', '-')}")
    for row in team.get("silent", ()):
        _line("process silent", f"{row['robot']} {_span(row)}, {row.get('why', '-')}")
    for row in team.get("splits", ()):
        groups = " | ".join(", ".join(group) for group in row.get("groups", ()))
        _line("split", f"{groups} {_span(row)}")
    for sender, rows in _by_sender(team.get("refused_statements", ())).items():
        reasons = list(dict.fromkeys(row.get("reason") or "for other reasons" for row in rows))
        more = f", and {counted(len(reasons) - 1, 'other reason')}" if len(reasons) > 1 else ""
        robots = counted(len({row["robot"] for row in rows}), "robot")
        count = counted(sum(row.get("count", 0) for row in rows), "statement")
        _line("refused", f"{count} of {sender or 'others'}, by {robots}: {reasons[0]}{more}")
    for row in team.get("refused_orders", ()):
        task = f"{row['task']} " if row.get("task") else ""
        _line("order refused", f"{task}given to {row['robot']}: {row.get('reason', '-')}")


def _line(name: str, text: str) -> None:
    click.echo(f"{name:<17} {text}")


def _span(row: Row) -> str:
    until_s = row.get("until_s")
    return f"from {number(row.get('from_s'))} s {'on' if until_s is None else f'to {number(until_s)} s'}"


def _by_sender(rows: Any) -> dict[str, list[Row]]:
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(row["sender"], []).append(row)
    return found
