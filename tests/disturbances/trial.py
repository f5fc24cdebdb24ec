"""One seed: a mission carried out under disturbances, and all that must be true of what came of it.

Even seeds have robots that are points (`tests.execution.world`), odd ones robots with bodies (`bodies`).
"""

import math
from collections import Counter
from dataclasses import dataclass

import muster
from muster.execution.executor import Executor
from muster.execution.replanning.reallocation import Reallocation
from muster.execution.replanning.travel import travel_of, way_of
from muster.execution.robots.task_motion import place
from muster.motion import actions
from muster.motion.paths.robot_paths import RobotPaths
from tests import trials
from tests.disturbances.bodies import Bodies, bodily_mission
from tests.disturbances.missions import disturbed_mission
from tests.disturbances.stability import Stability
from tests.execution.world import World, carry_out

STEP = 0.25
ARRIVAL = 0.05  # metres
LONGEST_S = 3000.0  # far more than any of these missions takes, whatever happens
ITERATIONS = 100


@dataclass
class Report(trials.Report):
    """The story: all that happened."""

    bodies: bool = False  # whether robots have bodies, so that they hold each other up


def _may_do(mission, task, robot):
    """Whether a robot has what a task asks for."""
    if not set(task.requires) <= set(robot.skills):
        return False
    if task.only_robots is not None and robot.id not in task.only_robots:
        return False
    if mission.suitability is None:
        return True
    return mission.suitability[robot.type].get(task.type, 0) >= mission.rules.min_suitability


class Watcher:
    """Judges while the mission is carried out, by what the observer is told and by where robots truly are."""

    def __init__(self, report, mission, world):
        self.report, self.mission, self.world = report, mission, world
        self.executor, self.ends = None, Counter()
        self.stability = Stability(report, mission.rules.stability)

    def on_telemetry(self, now, robot, telemetry):
        pass

    def on_event(self, now, kind, data):
        self.report.counts[kind] += 1
        self.report.story.append(f"{now:8.2f}  {kind}  {data}")
        if kind == "robot_stuck" and self.report.bodies:  # only by one that broke down after it had fallen silent
            self.report.check(self.world.beside_broken(data["robot"]), f"{data['robot']} is put out as stuck")
        self.stability.on_event(kind, data, self.executor)
        if kind == "starts":
            self._begins(data["task"], data["robot"], now)
        elif kind == "ends":
            self._ends(data["task"], data["robot"])

    def on_plan(self, now, plan):
        self.stability.on_plan(plan)

    def _begins(self, name, robot, now):
        task = self.executor.ledger.tasks[name]
        early = [other for other in task.prerequisites if not self.executor.ledger.ends_s.get(other, math.inf) <= now]
        self.report.check(not early, f"{name} begins at {now} before {early} ended")
        self.report.check(name not in self.ends, f"{name} begins again after it was done")
        able = self.executor.crew[robot].robot
        self.report.check(_may_do(self.mission, task, able), f"{robot} may not do {name}")
        self.report.check(not isinstance(actions.plan(task, able), actions.Impossible), f"{robot} cannot do {name}")
        self.report.check(now >= able.available_from_s, f"{robot} begins {name} before it is available")

    def _ends(self, name, robot):
        self.ends[name] += 1
        task, position = self.executor.ledger.tasks[name], self.world.position(robot)
        off = math.dist(position, place(actions.plan(task, self.executor.crew[robot].robot).exit))
        self.report.check(off < (ARRIVAL if self.report.bodies else 1e-6), f"{robot} ends {name} {off} m beside it")


def trial(seed):
    """Carry the mission of a seed out and check all that is claimed."""
    report = Report(seed, bodies=seed % 2 == 1)
    report.counts.update(robot_sent_again=0, robot_stuck=0)  # told, also where it never happened
    with report.trying():
        (_among_bodies if report.bodies else _among_points)(report)
    return report


def _among_points(report):
    mission = disturbed_mission(report.seed)
    _run(report, mission, World(mission))


def _among_bodies(report):
    """Nobody touches another either, no robot is put out as stuck, and nothing is lost that one of them could do."""
    mission, avoidance = bodily_mission(report.seed)
    world = Bodies(mission, avoidance, report.seed)
    executor = _run(report, mission, world)
    report.counts["missions: with bodies"] += 1
    report.check(world.contacts == (), f"contacts: {world.contacts}")
    for name, why in executor.lost().items():
        for hand in [] if "unreachable" in why else executor.crew.values():
            report.check(not _could_do(executor, hand, name), f"{name} is lost, though {hand.robot.id} could do it")


def _run(report, mission, world):
    plan = muster.solve(mission, "greedy")
    watcher = Watcher(report, mission, world)
    robot_paths = RobotPaths.of(mission) if mission.travel_rule == "map" else None
    travel = travel_of(mission, robot_paths)
    replan = Reallocation(travel=travel, iterations=ITERATIONS)
    way = way_of(mission, robot_paths)
    executor = Executor(mission, plan, world.ports, way=way, travel=travel, replan=replan, observer=watcher)
    watcher.executor = executor
    watcher.on_plan(0.0, executor.plan)
    carry_out(executor, world, step=STEP, until=LONGEST_S)
    _afterwards(report, mission, executor, watcher)
    return executor


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
        exceeds = hand.used > capacity + room
        report.counts["used more than capacity"] += exceeds
        # Robots with bodies make room, and are held up at work, beyond what they have left.
        report.check(not exceeds or report.bodies, f"{hand.robot.id} used {hand.used} of {capacity}")
        if hand.home is not None and hand.done and not hand.out and not report.bodies:  # others may need the place
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


def _could_do(executor, hand, name):
    """Whether a robot that takes part, with no limit of capacity, may do a task whose prerequisites have ended."""
    ledger, robot, mission = executor.ledger, hand.robot, executor.mission
    task = ledger.tasks[name]
    refused = robot.id in ledger.refusals.get(name, {})
    if hand.out or robot.work_capacity is not None or refused or name in ledger.cancelled or ledger.missing(name):
        return False
    return _may_do(mission, task, robot) and not isinstance(actions.plan(task, robot), actions.Impossible)
