"""Explanations in a few sentences."""

from __future__ import annotations

from muster.allocation.reasons.explanations import Alternative
from muster.planning.explaining.explanations import LeftOut, OneTask
from muster.planning.explaining.phrases import award_text, ignored, place, reserve, short, smallest_change

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
