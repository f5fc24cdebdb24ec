"""One seed: a disturbed mission with rules about time and teams is carried out, and what must hold of it is checked."""

from dataclasses import dataclass

from muster.execution.executor import Executor
from muster.execution.report import report_of
from muster.execution.teams import lacking, units_of
from tests import trials
from tests.disturbances.timed.missions import mission_of
from tests.disturbances.timed.planner import plan_of, planned_again
from tests.execution.world import World, carry_out

ENDS_S = 5_000.0
STEP_S = 0.25
ROUNDING_S = 1e-6


@dataclass
class Report(trials.Report):
    """Nothing beside what all campaigns report."""


def trial(seed):
    """Carry the mission of a seed out."""
    report = Report(seed)
    with report.trying():
        mission = mission_of(seed)
        world = World(mission)
        executor = Executor(mission, plan_of(mission), world.ports, replan=planned_again)
        carry_out(executor, world, step=STEP_S, until=ENDS_S)
        report.story += [f"{e.time_s:8.2f} {e.kind} {dict(e.data)}" for e in executor.events]
        report.counts.update({event.kind: 1 for event in executor.events})
        report.counts["missions"] += 1
        _check(report, executor)
    return report


def _check(report, executor):
    ledger, told = executor.ledger, report_of(executor.account)
    report.check(executor.done, "the mission does not end")
    lost = dict(told.tasks_lost)
    report.check(len(told.tasks_done) == len(set(told.tasks_done)), "a task is counted twice")
    report.check(set(told.tasks_done) | lost.keys() == set(ledger.tasks), "a task is neither done nor lost")
    report.check(not set(told.tasks_done) & lost.keys(), "a task is done and lost")
    for task, reason in lost.items():
        report.check(bool(reason.strip("; ")), f"{task} is lost without a reason")
    for name in told.tasks_done:
        _check_done(report, executor, ledger.tasks[name], told)
    for unit in set(units_of(ledger.tasks.values()).values()):
        starts = {round(ledger.starts_s[name], 6) for name in unit if name in ledger.ends_s}
        report.check(len(starts) <= 1, f"{unit} do not begin at the same moment")
    report.counts["team tasks done"] += sum(bool(task.team) for task in told.tasks)
    report.counts["tasks missed"] += len(told.missed)
    report.counts["tasks lost"] += len(lost)


def _check_done(report, executor, task, told):
    """A task done was begun when it might be, by enough robots, and is reported where it was late."""
    ledger, begin, end = executor.ledger, executor.ledger.starts_s[task.id], executor.ledger.ends_s[task.id]
    inside = not task.window_s or any(
        first - ROUNDING_S <= begin <= (end_s if end_s is not None else begin) + ROUNDING_S
        for first, end_s in task.window_s
    )
    report.check(inside, f"{task.id} is begun at {begin}, outside its windows {task.window_s}")
    members = ledger.members(task.id)
    robots = [executor.crew[name].robot for name in members]
    report.check(len(set(members)) == len(members), f"{task.id}: a robot stands twice in {members}")
    report.check(not lacking(task, robots), f"{task.id} is done by too few: {members}")
    for name in members:
        report.check(executor.crew[name].done.count(task.id) == 1, f"{name} does not tell that it did {task.id}")
    late = task.deadline_s is not None and end > task.deadline_s + ROUNDING_S
    report.check(late == (task.id in told.deadlines_missed_s), f"{task.id}: a deadline missed is not reported")
    for before in task.prerequisites:
        lag = task.lag(before)
        earliest = ledger.ends_s[before] + lag.after_s
        report.check(begin >= earliest - ROUNDING_S, f"{task.id} is begun at {begin}, before {earliest}")
        over = lag.within_s is not None and begin > ledger.ends_s[before] + lag.within_s + ROUNDING_S
        report.check(over == (task.id in told.within_exceeded_s), f"{task.id}: begun too late, and not reported")
    for other in task.same_robot_as:
        if other in ledger.ends_s:
            report.check(set(ledger.members(other)) == set(members), f"{task.id} and {other}: not the same robots")
    for other in (*task.other_robot_than, *task.starts_with):
        if other in ledger.ends_s:
            report.check(not set(ledger.members(other)) & set(members), f"{task.id} and {other}: a common robot")
