"""The task that explains a plan."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from muster.allocation.stop import Stop
from muster.planning.explaining import EXPLAIN_TIME_LIMIT_S, left_out, one_task, require_fit
from muster.planning.explaining.tables import Part, tables_on_left_out, tables_on_task
from muster_control.work.missions import mission_of, plan_of
from muster_control.work.tasks.sentences import words_on_left_out, words_on_task


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission", "plan", "task", "ignore"}` -> what `muster explain --format json` prints, and `words` and `tables`.

    Without `task`: why tasks are left out. `words` are sentences, `tables` are the lines and tables of the command.
    """
    mission, plan = mission_of(arguments["mission"]), plan_of(arguments["plan"])
    task, ignore = arguments.get("task"), arguments.get("ignore", ())
    stop = Stop(time_limit=EXPLAIN_TIME_LIMIT_S)
    require_fit(mission, plan, "plan", ignore)
    if task is None:
        missing = left_out(mission, plan, ignore, stop)
        return _said(missing.as_dict(), words_on_left_out(missing), tables_on_left_out(missing))
    found = one_task(mission, plan, task, ignore, stop)
    return _said(found.as_dict(), words_on_task(found), tables_on_task(found))


def _said(data: dict[str, Any], words: list[str], tables: list[Part]) -> dict[str, Any]:
    return {**data, "words": words, "tables": [part if isinstance(part, str) else asdict(part) for part in tables]}
