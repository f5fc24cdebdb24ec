"""The mission of a part of a problem, cut down so that it can be sent to another machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from muster.mission.model import Mission, Robot, Task, TravelTable
from muster.mission.source import IN_PYTHON


def cut_down(mission: Mission, robots: Sequence[Robot], tasks: Sequence[Task]) -> Mission:
    """The mission's rules and tables, as far as these robots and tasks go, and these robots.

    It has no tasks and no events: a task may be locked to a robot of another part, which the mission of a part would
    not know. A problem has its tasks itself.
    """
    kinds = {robot.type for robot in robots}
    names = [*(robot.id for robot in robots), *(task.id for task in tasks), *(s.id for s in mission.stations)]
    return mission.at_once(
        robots=tuple(robots),
        tasks=(),
        travel=_of(kinds, mission.travel),
        travel_tables={kind: _cut(table, names) for kind, table in mission.travel_tables.items() if kind in kinds},
        source=IN_PYTHON,
    )


def _of(kinds: set[str | None], files: Mapping[str, str] | None) -> Mapping[str, str] | None:
    return None if files is None else {kind: file for kind, file in files.items() if kind in kinds}


def _cut(table: TravelTable, names: Sequence[str]) -> TravelTable:
    index = {place: k for k, place in enumerate(table.places)}
    kept = [index[name] for name in names]
    return TravelTable(tuple(names), tuple(tuple(table.metres[a][b] for b in kept) for a in kept))
