"""Reports of missions that were not carried out to their end: the part that was carried out beside its plan."""

from __future__ import annotations

from dataclasses import replace

from muster.execution.reports.report import Account, Report
from muster.mission.objectives import objective_values

IN_PART = "not carried out to its end: planned is what was planned of the part that was carried out"
_OF_USAGE = ("total", "max", "total+max")
"""Objectives that follow from the robots' usages."""


def broken_off(report: Report, account: Account, reason: str) -> Report:
    """The report of a mission that ends before it is over: tasks under way are lost too, for that reason."""
    told = {*report.tasks_done, *(task for task, _ in report.tasks_lost)}
    under_way = tuple((task.id, reason) for task in account.ledger.open if task.id not in told)
    lost, remarks = report.tasks_lost + under_way, (*report.remarks, IN_PART)
    return compared_in_part(replace(report, tasks_lost=lost, remarks=remarks), account)


def compared_in_part(report: Report, account: Account) -> Report:
    """Return the report of a mission that was not carried out to its end: planned is what was planned of that part."""
    planned = account.planned_so_far
    robots = tuple(replace(row, usage_planned=planned.get(row.robot, 0.0)) for row in report.robots)
    of_usage = objective_values(planned.values(), (), ()) if report.objective.name in _OF_USAGE else {}
    objective = replace(report.objective, planned=of_usage.get(report.objective.name))
    return replace(report, robots=robots, objective=objective)
