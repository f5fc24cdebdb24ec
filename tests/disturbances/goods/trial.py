"""One seed: a disturbed mission with goods and batteries is carried out, and what must hold of it is checked."""

from dataclasses import dataclass

import muster
from muster.mission.goods import by_commodity
from muster.planning.options import PlanningOptions
from muster.running.simulation import Simulation
from tests import trials
from tests.disturbances.further import check_further_rules, with_further_rules
from tests.disturbances.goods.missions import drain_of, mission_of

ENDS_S = 3_000.0
ROUNDING = 1e-6
EMPTY = 1e-6


@dataclass
class Report(trials.Report):
    """Nothing beside what all campaigns report."""


class Watcher:
    """Checks what must hold at every moment."""

    def __init__(self, report, simulation, mission):
        self.report, self.simulation = report, simulation
        self.executor = simulation._executor
        self.slots = {station.id: station.slots for station in mission.stations}
        self.seen = 0
        self.taken, self.brought = {}, {}
        self.failed = set()

    def look(self):
        executor = self.executor
        for event in executor.events[self.seen :]:
            self._take(event)
        self.seen = len(executor.events)
        for station, slots in self.slots.items():
            served = executor.stations.served(station)
            self.report.check(
                len(served) <= slots, f"{len(served)} robots served at {station}, which has {slots} slots"
            )
            self.report.check(
                not (served and station in executor.stations.failed), f"{station} serves though it failed"
            )
        for state in executor.crew.values():
            self._look_at(state)
        self._balance()

    def _take(self, event):
        data = event.data
        self.report.counts[event.kind] += 1
        if event.kind == "ends":
            name, robot = data["task"], data["robot"]
            self.taken.setdefault(name, []).append(robot)
            task = self.executor.ledger.tasks[name]
            if task.delivers is not None:
                at = self.taken.get(task.delivers, [None])[-1]
                self.report.check(at == robot, f"{name} is done by {robot}, but {at} took the load on board")
                self.brought[name] = self.brought.get(name, 0) + 1
        elif event.kind == "robot_fails":
            self.failed.add(data["robot"])
            lost = data.get("reason", "")
            self.report.check("empty" not in lost, f"{data['robot']} is empty in the field at {event.time_s:g} s")

    def _look_at(self, state):
        robot, goods = state.robot, self.executor.goods
        most = by_commodity(robot.load_capacity)
        for name, amount in goods.load(robot.id).items():
            self.report.check(
                amount <= most.get(name, 0.0) + ROUNDING, f"{robot.id} has {amount:g} on board of {most.get(name):g}"
            )
        port = self.simulation.world.ports[robot.id]
        if port.energy is not None:
            self.report.check(port.energy.look().share > EMPTY, f"{robot.id} is empty in the field")

    def _balance(self):
        goods = self.executor.goods
        gone = [goods.delivered, goods.put_down, goods.unloaded, goods.left, *goods.lying.values()]
        gone += [goods.load(robot) for robot in goods.on_board]
        for name, amount in goods.taken.items():
            there = sum(sums.get(name, 0.0) for sums in gone)
            self.report.check(abs(there - amount) <= ROUNDING, f"taken {amount:g}, but {there:g} are known of")


def trial(seed):
    """Carry the mission of a seed out."""
    report = Report(seed)
    with report.trying():
        mission = with_further_rules(mission_of(seed), seed)
        plan = muster.solve(mission, seed=seed, iterations=100)
        options = PlanningOptions(parameters={})
        drain = drain_of(mission, seed)
        report.story += [f"drain {drain}", *(f"{route.robot}: {route.tasks}" for route in plan.routes)]
        simulation = Simulation(mission, plan, seed=seed, drain=drain, planning=options)
        watcher = Watcher(report, simulation, mission)
        try:
            watcher.look()
            while not simulation.done and simulation.time_s < ENDS_S:
                simulation.advance(simulation.time_s + 0.5)
                watcher.look()
        finally:
            report.story += [f"{e.time_s:8.2f} {e.kind} {dict(e.data)}" for e in simulation.events]
        report.counts["missions"] += 1
        _check(report, mission, simulation, watcher)
        check_further_rules(report, simulation._executor)
    report.failures = list(dict.fromkeys(report.failures))
    return report


def _check(report, mission, simulation, watcher):
    executor, told = simulation._executor, simulation.result()
    ledger, lost = executor.ledger, dict(told.tasks_lost)
    report.check(simulation.done, "the mission does not end")
    report.check(set(told.tasks_done) | lost.keys() == set(ledger.tasks), "a task is neither done nor lost")
    report.check(not set(told.tasks_done) & lost.keys(), "a task is done and lost")
    report.check(all(reason.strip("; ") for reason in lost.values()), "a task is lost without a reason")
    report.check(all(count == 1 for count in watcher.brought.values()), f"delivered twice: {watcher.brought}")
    for task in ledger.tasks.values():
        if task.delivers is None:
            continue
        done = task.id in ledger.ends_s
        report.check(not done or task.delivers in ledger.ends_s, f"{task.id} is done, but not {task.delivers}")
        if task.delivers in ledger.ends_s and not done and task.id not in ledger.cancelled:
            held = executor.goods.carrier(task.delivers) is not None or bool(executor.goods.unloaded)
            report.check(held, f"what {task.delivers} took on board is nowhere")
    if not (watcher.failed or any(event.station_fails or event.robot_silent for event in mission.events)):
        stranded = [name for name, why in lost.items() if "on board of" in why]
        report.check(not stranded, f"{stranded}: taken on board, and never delivered")
    report.counts["tasks"] += len(ledger.tasks)
    report.counts["tasks done"] += len(told.tasks_done)
    report.counts["visits of stations"] += sum(row.station_visits for row in told.robots)
    for why in lost.values():
        report.counts[f"lost: {why.split(':')[0].split(' at ')[0][:30]}"] += 1
