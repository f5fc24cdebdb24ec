"""One seed: a mission carried out under disturbances, and all that must be true of what came of it."""

import math
from collections import Counter
from dataclasses import dataclass, field

import muster
from muster.execution.doing import place
from muster.execution.executor import Executor
from muster.execution.reallocation import Reallocation
from muster.execution.travel import travel_of, way_of
from muster.motion import actions
from muster.motion.roads import Roads
from tests.disturbances.missions import disturbed_mission
from tests.execution.world import World, carry_out

STEP = 0.25
LONGEST_S = 3000.0  # far more than any of these missions takes, whatever happens
ITERATIONS = 100


@dataclass
class Report:
    """What was wrong, and how often what happened."""

    seed: int
    failures: list[str] = field(default_factory=list)
    counts: Counter = field(default_factory=Counter)
    happened: list[str] = field(default_factory=list)

    def check(self, holds, what):
        self.counts["checks"] += 1
        if not holds:
            self.failures.append(what)


class Watcher:
    """Judges while the mission is carried out, by what the observer is told and by where robots truly are."""

    def __init__(self, report, mission, world):
        self.report, self.mission, self.world = report, mission, world
        self.executor, self.robot_of, self.out, self.ends = None, {}, set(), Counter()

    def on_telemetry(self, now, robot, telemetry):
        pass

    def on_event(self, now, kind, data):
        self.report.counts[kind] += 1
        self.report.happened.append(f"{now:8.2f}  {kind}  {data}")
        if kind in ("robot_fails", "robot_silent", "robot_stuck"):
            self.out.add(data["robot"])
        elif kind == "robot_returns":
            self.out.discard(data["robot"])
        elif kind == "starts":
            self._begins(data["task"], data["robot"], now)
        elif kind == "ends":
            self._ends(data["task"], data["robot"])
        elif kind == "replanned":
            self._replanned(data)

    def on_plan(self, now, plan):
        self.robot_of = {name: route.robot for route in plan.routes for name in route.tasks}

    def _begins(self, name, robot, now):
        task = self.executor.ledger.tasks[name]
        early = [other for other in task.prerequisites if not self.executor.ledger.ends_s.get(other, math.inf) <= now]
        self.report.check(not early, f"{name} begins at {now} before {early} ended")
        self.report.check(name not in self.ends, f"{name} begins again after it was done")
        able = self.executor.crew[robot].robot
        fit = set(task.requires) <= set(able.skills) and (task.only_robots is None or robot in task.only_robots)
        if self.mission.suitability is not None:
            score = self.mission.suitability[able.type].get(task.type, 0)
            fit = fit and score >= self.mission.rules.min_suitability
        self.report.check(fit, f"{robot} may not do {name}")
        self.report.check(not isinstance(actions.plan(task, able), actions.Impossible), f"{robot} cannot do {name}")
        self.report.check(now >= able.available_from_s, f"{robot} begins {name} before it is available")

    def _ends(self, name, robot):
        self.ends[name] += 1
        task, point = self.executor.ledger.tasks[name], self.world.ports[robot]
        off = math.dist(point.position, place(actions.plan(task, self.executor.crew[robot].robot).exit))
        self.report.check(off < 1e-6, f"{robot} ends {name} {off} m beside it")

    def _replanned(self, data):
        """Stability: what changed robot by the plans themselves, but for what had to."""
        most = self.mission.rules.stability
        after = {name: hand.robot.id for hand in self.executor.crew.values() for name in (*hand.done, *hand.route)}
        changed = {name for name, robot in after.items() if self.robot_of.get(name, robot) != robot}
        self.report.check(changed == set(data["moved"]), f"moved {changed}, but said {set(data['moved'])}")
        free = {name for name in changed if self.robot_of[name] not in self.out}
        self.report.counts["moved"] += len(changed)
        if most is not None:
            self.report.check(len(free - set(data["forced"])) <= most, f"{free} changed robot, at most {most} may")


def trial(seed):
    """Carry the mission of a seed out and check all that is claimed; an error is a failure like any other."""
    report = Report(seed)
    try:
        _run(report, disturbed_mission(seed))
    except Exception as error:
        report.failures.append(f"{type(error).__name__}: {error}")
    return report


def _run(report, mission):
    plan = muster.solve(mission, "greedy")
    world = World(mission)
    watcher = Watcher(report, mission, world)
    roads = Roads.of(mission) if mission.travel_rule == "map" else None
    travel = travel_of(mission, roads)
    replan = Reallocation(travel=travel, iterations=ITERATIONS)
    way = way_of(mission, roads)
    executor = Executor(mission, plan, world.ports, way=way, travel=travel, replan=replan, observer=watcher)
    watcher.executor = executor
    watcher.on_plan(0.0, executor.plan)
    carry_out(executor, world, step=STEP, until=LONGEST_S)
    _afterwards(report, mission, executor, watcher)


def _afterwards(report, mission, executor, watcher):
    ledger, lost = executor.ledger, executor.lost()
    report.check(executor.done, f"not over after {LONGEST_S} s")
    known = {task.id for task in mission.tasks} | {e.new_task.id for e in mission.events if e.new_task}
    refused = report.counts["event_refused"]
    report.check(set(ledger.tasks) == known or refused, f"tasks {known - set(ledger.tasks)} never appeared")
    report.check(set(ledger.ends_s) | set(lost) == set(ledger.tasks), "a task is neither done nor lost")
    report.check(not set(ledger.ends_s) & set(lost), f"{set(ledger.ends_s) & set(lost)} both done and lost")
    report.check(all(lost.values()), "a task is lost without a reason")
    report.check(set(watcher.ends.values()) <= {1}, "a task is done twice")
    report.check(set(watcher.ends) == set(ledger.ends_s), "what ended is not what is done")
    delayed = sum(ledger.delays_s.values())
    for hand in executor.crew.values():
        starts = [ledger.starts_s[name] for name in hand.done]
        report.check(starts == sorted(starts), f"{hand.robot.id} did not keep the order of its route")
        room = delayed + STEP * (2 + 2 * len(ledger.tasks)) if hand.in_time else 1e-5
        capacity = math.inf if hand.robot.work_capacity is None else hand.robot.work_capacity
        report.check(hand.used <= capacity + room, f"{hand.robot.id} used {hand.used} of {capacity}")
        if hand.home is not None and hand.done and not hand.out:
            off = math.dist(hand.position, hand.home)
            report.check(off < 1e-6, f"{hand.robot.id} ends {off} m from its end")
    report.counts["missions"] += 1
    report.counts[f"missions: {mission.travel_rule}"] += 1
    for name in ledger.ends_s:
        action = ledger.tasks[name].action
        report.counts[f"done: {'no action' if action is None else action.name}"] += 1
    report.counts["tasks"] += len(ledger.tasks)
    report.counts["done"] += len(ledger.ends_s)
    for why in lost.values():
        report.counts[f"lost: {why.split(':')[0].split(' at ')[0][:30]}"] += 1
