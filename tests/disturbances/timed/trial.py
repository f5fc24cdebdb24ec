"""One seed: a disturbed mission with rules about time and teams is carried out, and what must hold of it is checked."""

from dataclasses import dataclass
from random import Random

import muster
from muster.allocation.registry import ALLOCATORS
from muster.execution.executor import Executor
from muster.execution.replanning.reallocation import Reallocation
from muster.execution.replanning.travel import travel_of
from muster.execution.reports.report import report_of
from muster.mission.task_relations import units_of
from tests import trials
from tests.disturbances.further import check_further_rules, with_further_rules
from tests.disturbances.stability import Stability
from tests.disturbances.timed.missions import mission_of, with_members_failing
from tests.disturbances.timed.still_possible import covers, still_possible
from tests.execution.world import World, carry_out

ENDS_S = 5_000.0
STEP_S = 0.25
ROUNDING_S = 1e-6
PLANNERS = {"greedy": {}, "greedy+genetic": {"iterations": 20}, "search": {"iterations": 100}, "auction": {}}
"""What plans at first, and how long."""
STEPS_AGAIN = 200


@dataclass
class Report(trials.Report):
    """Nothing beside what all campaigns report."""


class Watcher:
    """Hears of every new plan."""

    def __init__(self, stability):
        self.executor, self.stability = None, stability

    def on_telemetry(self, now, robot, telemetry):
        pass

    def on_event(self, now, kind, data):
        self.stability.on_event(kind, data, self.executor)

    def on_plan(self, now, plan):
        self.stability.on_plan(plan)


def trial(seed):
    """Carry the mission of a seed out."""
    report = Report(seed)
    with report.trying():
        mission = with_further_rules(mission_of(seed), seed)
        first, replan = _planners(mission, seed)
        plan = muster.solve(mission, first, seed=seed, **PLANNERS[first])
        mission = with_members_failing(mission, plan, seed)
        world = World(mission)
        report.story += [f"planned by {first}, again by {replan.allocator.name}: {plan.routes}"]
        watcher = Watcher(Stability(report, mission.rules.stability))
        executor = watcher.executor = Executor(mission, plan, world.ports, replan=replan, observer=watcher)
        watcher.on_plan(0.0, executor.plan)
        carry_out(executor, world, step=STEP_S, until=ENDS_S)
        report.story += [f"{e.time_s:8.2f} {e.kind} {dict(e.data)}" for e in executor.events]
        report.counts.update({event.kind: 1 for event in executor.events})
        report.counts["missions"] += 1
        _check(report, executor)
        check_further_rules(report, executor)
    return report


def _planners(mission, seed):
    """What plans the mission at first, and how the rest is planned again: half the time as by default, but shorter."""
    random = Random(f"planners {seed}")
    usable = [name for name in PLANNERS if name != "auction" or not any(robot.min_tasks for robot in mission.robots)]
    again = ALLOCATORS[random.choice(["search", "greedy", "auction"])]
    how = {} if random.random() < 0.5 else {"allocator": again, "parameters": again.parameters()}
    return random.choice(usable), Reallocation(travel=travel_of(mission), iterations=STEPS_AGAIN, **how)


def _check(report, executor):
    ledger, told = executor.ledger, report_of(executor.account)
    report.check(executor.done, "the mission does not end")
    lost = dict(told.tasks_lost)
    report.check(len(told.tasks_done) == len(set(told.tasks_done)), "a task is counted twice")
    report.check(set(told.tasks_done) | lost.keys() == set(ledger.tasks), "a task is neither done nor lost")
    report.check(not set(told.tasks_done) & lost.keys(), "a task is done and lost")
    for task, reason in lost.items():
        report.check(bool(reason.strip("; ")), f"{task} is lost without a reason")
    for teams in still_possible(executor, lost):
        report.check(False, f"lost, but {teams} could do it: {[lost[task] for task in teams]}")
    for name in told.tasks_done:
        _check_done(report, executor, ledger.tasks[name], told)
    for unit in set(units_of(ledger.tasks.values()).values()):
        starts = {round(ledger.starts_s[name], 6) for name in unit if name in ledger.ends_s}
        report.check(len(starts) <= 1, f"{unit} do not begin at the same moment")
    report.counts["team tasks done"] += sum(bool(task.team) for task in told.tasks)
    report.counts["tasks missed"] += len(told.missed)
    report.counts["tasks lost"] += len(lost)


def _check_work(report, executor, name, members):
    """All members were at work from its begin to its end: none failed in between."""
    begin, end = executor.ledger.starts_s[name], executor.ledger.ends_s[name]
    for event in executor.events:
        if event.kind in ("robot_fails", "robot_silent") and event.data.get("robot") in members:
            within = begin + ROUNDING_S < event.time_s < end - ROUNDING_S
            report.check(not within, f"{name} goes on though {event.data['robot']} is out at {event.time_s}")


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
    report.check(covers(task, robots), f"{task.id} is done by too few, or robots that may not: {members}")
    _check_work(report, executor, task.id, members)
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
