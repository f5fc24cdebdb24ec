"""One run of a team that carries a mission out by itself, and what must hold of it."""

from collections import Counter
from itertools import combinations
from math import inf

from tests.muster_team.campaign.team_missions import LAST_FAULT_S, SIDE_M, team_scene
from tests.muster_team.runs.joint_work import MOMENT_S, deeds, is_able
from tests.muster_team.runs.simulated_team import SimulatedTeam
from tests.trials import Report

LONGEST_S = 900.0
"""After the last fault a mission is over by then, seconds of virtual time."""

TO_BEGIN_S = 2.0**0.5 * SIDE_M + 30.0
"""No robot needs longer to come to a task from anywhere, and to agree to begin it."""

MISSED = ("window_missed", "deadline_missed", "within_missed")
KINDS = ("starts", "ends", "work_broken_off", "task_refused", *MISSED)


def carried_out(seed):
    """Let the team of a seed carry out its mission, and check what it did."""
    report = Report(seed)
    with report.trying():
        run = Run(team_scene(seed), seed)
        report.check(run.play(), "the robots do not come to rest")
        report.story += run.story()
        for wrong in (*run.wrong_deeds(), *run.left_open()):
            report.check(False, wrong)
        report.counts.update(run.counts())
    return report


class Run:
    """A team, its scene, and what came of it."""

    def __init__(self, scene, seed):
        self.scene = scene
        self.team = SimulatedTeam(self.scene.mission, seed=seed, **self.scene.conditions)
        self.cancelled, self.reasons = set(), Counter()

    def play(self):
        """Whether all come to rest after the last fault."""
        for fault in self.scene.faults:
            self.team.run(fault.at_s)
            self._happen(fault)
        self.team.run(max(LAST_FAULT_S, self.team.world.time_s))
        self.team.net.heal()
        return self.team.run(self.team.world.time_s + LONGEST_S, lambda: self.team.rests)

    def _happen(self, fault):
        team, robot = self.team, "".join(fault.robots[:1])
        if fault.kind in ("cut", "block", "heal"):
            team.net.heal()
            if fault.robots:
                team.net.cut(fault.robots, [name for name in team.robots if name not in fault.robots])
            team.net.block(fault.links)
        elif fault.kind == "strike" and team.run(LAST_FAULT_S, lambda: self._at_joint_work) and len(team.controls) > 1:
            team.crash(self._at_joint_work[0])
        elif fault.kind == "crash" and robot in team.controls and len(team.controls) > 1:
            team.crash(robot)
        elif fault.kind in ("restart", "forget") and robot not in team.controls:
            team.restart(robot, remembers=fault.kind == "restart")
        elif fault.kind == "told" and robot in team.controls:
            self.cancelled.add(fault.event.cancel_task)
            team.controls[robot].take_event(fault.event)

    @property
    def _at_joint_work(self):
        """The robots that have begun a task with others."""
        return [robot for robot in self.team.controls if self.team.net.nodes[robot].joint.under_way]

    @property
    def tasks(self):
        """All tasks by name, also those that were added."""
        added = [fault.event.new_task for fault in self.scene.faults if fault.event and fault.event.new_task]
        known = {fact.task for node in self.team.net.nodes.values() for fact in node.facts if fact.kind == "added"}
        return {
            task.id: task
            for task in (*self.scene.mission.tasks, *added)
            if task in self.scene.mission.tasks or task.id in known
        }

    @property
    def done(self):
        """What was done, by whom, as `deeds` says it."""
        return deeds(self.team, self.tasks.values())

    def wrong_deeds(self):
        """What was done by too few, not together, or not in time."""
        done = self.done
        for name, teams in done.items():
            task = self.tasks[name]
            for members, begun in teams.items():
                if not is_able(task, [self._robot(one) for one in members]):
                    yield f"{name} was done by {members}, who are not enough"
                if begun is None:
                    yield f"{name} was done by {members}, who did not begin at one moment"
                else:
                    yield from self._wrong_times(task, members, begun, done)
            if len(teams) > 1 and self.may_do_once:
                yield f"{name} was done twice: {teams}"
        for task in self.tasks.values():
            for other in task.starts_with:
                begins = [begun for name in (task.id, other) for begun in done.get(name, {}).values()]
                if len(begins) == 2 and None not in begins and abs(begins[0] - begins[1]) > MOMENT_S:
                    yield f"{task.id} and {other} began at {begins}"

    def _lasts_s(self, name, members):
        """How long a task takes these robots: as long as the slowest."""
        return max(self.tasks[name].duration_s / self._robot(one).efficiency for one in members)

    def _wrong_times(self, task, members, begun, done):
        if task.window_s and not any(opens - MOMENT_S <= begun <= closes + MOMENT_S for opens, closes in windows(task)):
            yield f"{task.id} began at {begun:.1f} s, outside of {task.window_s}"
        lasts_s = self._lasts_s(task.id, members)
        if task.deadline_s is not None and begun + lasts_s > task.deadline_s + MOMENT_S:
            yield f"{task.id} began at {begun:.1f} s and lasts {lasts_s:.1f} s, due at {task.deadline_s:.1f} s"
        for before in task.prerequisites:
            lag = task.lags.get(before)
            did = done.get(before, {}).items()
            ends = [at_s + self._lasts_s(before, team) for team, at_s in did if at_s is not None]
            if not ends or min(ends) + (lag.after_s if lag else 0.0) > begun + MOMENT_S:
                yield f"{task.id} began at {begun:.1f} s, before the lag after {before} ({ends})"
            elif lag and lag.within_s is not None and max(ends) + lag.within_s < begun - MOMENT_S:
                yield f"{task.id} began at {begun:.1f} s, too late after {before} ({ends})"

    @property
    def may_do_once(self):
        """Whether nothing has torn the team apart: then nothing is done twice."""
        return not any(fault.kind in ("cut", "block", "crash", "strike") for fault in self.scene.faults)

    def left_open(self):
        """Tasks that were not done, and for which there is no reason; the reasons of the others are counted."""
        known = next(iter(self.team.net.nodes.values())).facts
        over = {fact.task for fact in known if fact.kind == "cancelled"}
        done = self.done.keys()
        for name in self.tasks.keys() - done:
            why = self._reason(self._unit(name), done, over)
            self.reasons[f"not done: {why}"] += 1
            if not why:
                yield f"{name} is {'given up without a reason' if name in over else 'left open'}"

    def _reason(self, unit, done, over):
        """Why tasks that begin together could not be done; empty if they could."""
        if done & set(unit):
            return "begins with one that is done"
        if over & set(unit):
            return self._reason_of_cancelling(unit)
        if not done >= {before for name in unit for before in self.tasks[name].prerequisites}:
            return "waits for what was not done"
        if any(self._is_too_late(self.tasks[name]) for name in unit):
            return "too late"
        if not self._can(unit, self.scene.mission.robots):
            return "never enough robots"
        crew = [self._robot(name) for name in self.team.controls]
        if not self._can(unit, crew):
            return "robots failed"
        return "" if self._can(unit, crew, self._refuses) else "given back"

    def _reason_of_cancelling(self, unit):
        if self.cancelled & set(unit):
            return "cancelled"
        told = {
            data["task"]
            for at_s, _, kind, data in self.team.told
            if kind in MISSED or (kind == "task_refused" and at_s > self._latest_s(self.tasks[data["task"]]))
        }
        return "missed" if told & set(unit) else ""

    def _unit(self, name):
        found = [name]
        for one in found:
            ties = {*self.tasks[one].starts_with, *(t.id for t in self.tasks.values() if one in t.starts_with)}
            found += sorted(ties - set(found))
        return found

    def _is_too_late(self, task):
        """Whether robots cannot be expected to begin a task in time, where they have come to rest."""
        return self.team.world.time_s + TO_BEGIN_S > self._latest_s(task)

    def _latest_s(self, task):
        ends = [closes for _, closes in windows(task)] or [inf]
        deadline_s = inf if task.deadline_s is None else task.deadline_s - task.duration_s
        lags = [
            max(begun or 0.0 for begun in self.done[before].values()) + lag.within_s
            for before, lag in task.lags.items()
            if lag.within_s is not None
        ]
        return min(max(ends), deadline_s, *lags, inf)

    def _can(self, unit, crew, refuses=lambda robot, task: False):
        """Whether disjoint teams are able to do tasks that begin together, each of robots that do not refuse it."""
        if not unit:
            return True
        task, others = self.tasks[unit[0]], unit[1:]
        free = [robot for robot in crew if not refuses(robot, task)]
        return any(
            is_able(task, some) and self._can(others, [robot for robot in crew if robot not in some], refuses)
            for number in range(1, len(free) + 1)
            for some in combinations(free, number)
        )

    def _refuses(self, robot, task):
        """Whether a robot has given a task back, or cannot end it in its shift any more."""
        ends_s = self.team.world.time_s + TO_BEGIN_S + task.duration_s
        given_back = task.id in self.team.net.nodes[robot.id].epoch.refused
        return given_back or (robot.available_until_s is not None and robot.available_until_s < ends_s)

    def _robot(self, name):
        return next(robot for robot in self.scene.mission.robots if robot.id == name)

    def counts(self):
        """What has happened, by name."""
        told = Counter(kind for _, _, kind, _ in self.team.told if kind in KINDS)
        done = self.done
        told["tasks"] = len(self.tasks)
        told["tasks done"] = len(done)
        told["tasks of several done"] = sum(len(members) > 1 for teams in done.values() for members in teams)
        told["done twice"] = sum(len(teams) > 1 for teams in done.values())
        facts = {fact for node in self.team.net.nodes.values() for fact in node.facts if fact.kind == "ready"}
        told["attempts after the first"] = sum(not fact.content.startswith(b"[0,") for fact in facts)
        told += self.reasons
        told.update(f"fault: {fault.kind}" for fault in self.scene.faults)
        return told

    def story(self):
        """What happened, in order."""
        tasks = [
            f"task {t.id}: {t.robots_needed or ''} {t.team and 'team'} {t.needs or ''} {t.requires} "
            f"{t.duration_s:.1f} s with {t.starts_with} after {t.prerequisites} {t.lags or ''} "
            f"in {t.window_s} until {t.deadline_s}"
            for t in self.tasks.values()
        ]
        robots = [
            f"robot {r.id}: {r.skills} {r.abilities} until {r.available_until_s}" for r in self.scene.mission.robots
        ]
        lines = [(fault.at_s, f"-- {fault.kind} {fault.robots} {fault.event or ''}") for fault in self.scene.faults]
        lines += [(at_s, f"{robot} {kind} {data}") for at_s, robot, kind, data in self.team.told]
        return [*robots, *tasks, *(f"{at_s:7.1f} s {what}" for at_s, what in sorted(lines, key=lambda line: line[0]))]


def windows(task):
    return [(opens, inf if closes is None else closes) for opens, closes in task.window_s]
