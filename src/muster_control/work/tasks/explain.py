"""The task that explains a plan.

Explanations in a few sentences.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from muster.allocation.reasons.explanations import Alternative
from muster.allocation.stop import Stop
from muster.planning.explaining import EXPLAIN_TIME_LIMIT_S, left_out, one_task, require_fit
from muster.planning.explaining.explanations import LeftOut, OneTask
from muster.planning.explaining.phrases import award_text, ignored, place, reserve, short, smallest_change
from muster.planning.explaining.tables import Part, tables_on_left_out, tables_on_task
from muster_control.work.missions import mission_of, plan_of

_MOST_NAMED = 5  # robots, or tasks, that are spoken of one by one


def words_on_left_out(found: LeftOut) -> list[str]:
    """Which tasks are left out, and the smallest change with which each could be done."""
    if not found.unassigned:
        return ["No task is left out."]
    said = [_sentence(line) for line in ignored(found.problem)]
    tasks = [item.task for item in found.unassigned]
    more = f" and {len(tasks) - _MOST_NAMED} more" if len(tasks) > _MOST_NAMED else ""
    are = "task is" if len(tasks) == 1 else "tasks are"
    said += [f"{len(tasks)} {are} left out: {', '.join(tasks[:_MOST_NAMED])}{more}."]
    for task, remedy in list(found.changes.items())[:_MOST_NAMED]:
        if remedy is None:
            said.append(f"For {task} no change of one robot was found, the rest of the plan as it is.")
        else:
            said.append(f"{task} could be done by {remedy.robot} with this change: {short(found.problem, remedy)}.")
    return said


def words_on_task(found: OneTask) -> list[str]:
    """For a task that is done the cost with other robots; for one left out the reasons and the smallest change."""
    said = [_sentence(line) for line in (*place(found), *ignored(found.problem))]
    if found.plan.book is not None and found.award is not None:
        said.append(_sentence(award_text(found.problem, found.plan.book, found.award)))
    others = [other for other in found.alternatives if other.robot not in found.team]
    said += _those_who_could(found, [other for other in others if other.reason is None])
    said += _those_who_could_not(others)
    if found.robot is None and (change := smallest_change(found.problem, found.remedies)):
        said.append(_sentence(change))
    note = reserve(found.problem)
    return [*said, *([_sentence(note)] if note else [])]


def _those_who_could(found: OneTask, others: list[Alternative]) -> list[str]:
    """The objective with other robots, the best first."""
    if found.robot is not None and not others:
        return ["No other robot could do it, the rest of the plan as it is."]
    known = sorted((other.objective, other.robot) for other in others if other.objective is not None)
    said = []
    for objective, robot in known[:_MOST_NAMED]:
        more = None if found.robot is None or found.objective is None else objective - found.objective
        if more is None:
            said.append(f"{robot} could do it; the objective would then be {objective:.2f}.")
        elif abs(more) < 0.005:
            said.append(f"{robot} could do it as well, for the same objective.")
        else:
            how = "more" if more > 0 else "less"
            said.append(f"With {robot} the objective would be {abs(more):.2f} {how}: {objective:.2f}.")
    if len(known) > _MOST_NAMED:
        worse = "would cost no less" if found.robot is not None else "could, too"
        said.append(f"{len(known) - _MOST_NAMED} more robots {worse}.")
    return said


def _those_who_could_not(others: list[Alternative]) -> list[str]:
    unable = [(other.robot, other.reason) for other in others if other.reason is not None]
    said = [f"{robot} could not: {why.reason}, {why.detail}." for robot, why in unable[:_MOST_NAMED]]
    return said + ([f"{len(unable) - _MOST_NAMED} more robots could not, either."] if len(unable) > _MOST_NAMED else [])


def _sentence(line: str) -> str:
    """A line with a capital and a full stop, unless it begins with a name."""
    starts = line.startswith(("task ", "rules ", "smallest ", "no ", "capacities "))
    return (line[0].upper() + line[1:] if starts else line) + "."


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
