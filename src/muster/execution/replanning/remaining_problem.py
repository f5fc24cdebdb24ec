"""The remaining mission as a problem, for planning again while robots are under way.

Each robot stands where it is, or will be when its work under way is done. What it has done is one task at the beginning
of its route, which stays (`allocation.fixed`): it costs what the robot has used, lasts as long as the work under way
still takes, and has the name of that work, so that dependants wait for it. So usages, the greatest of them, capacities
and times are those of the whole mission, and prerequisites that have ended are gone.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from muster.allocation.fixed import admissible_alone
from muster.execution.replanning.relations import BY_WHICH_TASKS_ARE_BOUND, UNBOUND, Binding
from muster.execution.replanning.travel import Spot, Travel
from muster.execution.replanning.worthwhile import Heading
from muster.mission.goods import Amount, as_amount, by_commodity
from muster.mission.model import Mission, Robot, Station, Task
from muster.mission.task_relations import tasks_named_by
from muster.model.energy_under_way import Held, with_held
from muster.model.measured_energy import EnergyLeft
from muster.model.parts import Begun
from muster.model.problem import Problem
from muster.model.robot_limits import NO_LIMITS, RobotLimits
from muster.model.rules.relation import tied_among
from muster.model.under_way import UnderWay
from muster.motion.port import Place
from muster.state.reasons import begins_with, in_one_line

SO_FAR = "so far"
_ROUNDING = 1e-9  # relative; by how much a capacity is above what cannot be helped


@dataclass(frozen=True, kw_only=True)
class RobotSnapshot:
    """Where one robot that takes part stands in the mission.

    Parameters
    ----------
    robot, home
        who it is; where its route must end.
    spot
        where it is, or will be when the work under way is done.
    free_s
        when that is.
    used
        usage until then, in the mission's unit.
    task
        the work under way; None: there is none.
    measured
        what of its energy is left, as it last reported; None: it does not report that.
    energy
        what it holds then; None: usage does not empty it.
    load
        what it has on board then, by commodity.
    done
        what it has done by then, work under way included.
    left_s
        when it left its start; None: it has not.
    limits
        what rules ask of it, whatever it does.
    heading
        the task that it is on the way to, or waits at; None: there is none.
    """

    robot: Robot
    home: Place | None
    spot: Spot
    free_s: float
    used: float
    task: str | None
    measured: EnergyLeft | None = None
    energy: Held | None = None
    load: Mapping[str, float] = field(default_factory=dict)
    done: tuple[Task, ...] = ()
    left_s: float | None = None
    limits: RobotLimits = NO_LIMITS
    heading: Heading | None = None

    @property
    def has_past(self) -> bool:
        return self.task is not None or self.used > 0 or bool(self.done)


@dataclass(frozen=True, kw_only=True)
class RemainingMission:
    """What is left of a mission at a time.

    Parameters
    ----------
    mission
        its rules; robots and tasks are those below.
    ignored
        rules that do not hold, of IGNORABLE.
    crew
        the robots that take part.
    tasks
        open tasks that are not under way; `ended` are done.
    delays_s
        by how much tasks take longer.
    refusals
        for a task the robots that cannot do it, and why.
    routes
        for each robot of the crew the tasks that it was to do, in order, without work under way; `former` for each
        task the robot that was to do it, also one that is out, or the names of its team.
    bindings
        for a task the robots that relations to tasks that have begun leave to it.
    expired
        tasks that can not begin any more, as things are, and why.
    stations
        those that serve.
    aboard
        by robot the tasks that deliver what it has on board; they stand among `tasks` as what the robot puts down.
    objective
        of the plan; None: the mission's.
    on_duty
        whether the fleet stays on duty: where its route ends a robot has energy to get to a station.
    """

    mission: Mission
    ignored: Collection[str]
    now_s: float
    crew: Sequence[RobotSnapshot]
    tasks: Sequence[Task]
    ended: Collection[str]
    delays_s: Mapping[str, float]
    refusals: Mapping[str, Mapping[str, str]]
    routes: Mapping[str, Sequence[str]]
    former: Mapping[str, str]
    bindings: Mapping[str, Binding] = field(default_factory=dict)
    expired: Mapping[str, str] = field(default_factory=dict)
    stations: tuple[Station, ...] = ()
    aboard: Mapping[str, Sequence[str]] = field(default_factory=dict)
    objective: str | None = None
    on_duty: bool = False

    @property
    def headings(self) -> dict[str, Heading]:
        """By robot that is on the way to a task, or waits at it, that task."""
        return {one.robot.id: one.heading for one in self.crew if one.heading is not None}


def frozen(rest: RemainingMission) -> RemainingMission:
    """The same, without anything that changes while the mission goes on: for another thread."""
    return replace(
        rest,
        ended=frozenset(rest.ended),
        delays_s=dict(rest.delays_s),
        refusals={task: dict(why) for task, why in rest.refusals.items()},
        expired=dict(rest.expired),
    )


@dataclass(frozen=True)
class RemainingProblem:
    """The rest as a problem, and why it does not have some tasks."""

    problem: Problem
    hopeless: Mapping[str, str]


def remaining_problem(rest: RemainingMission, travel: Travel) -> RemainingProblem:
    """The problem that the rest is. There must be a crew."""
    found = _problem_of(rest, travel)
    late = _late(rest, found.problem)
    if not late:
        return found
    refusals = {task.id: {**rest.refusals.get(task.id, {}), **late} for task in rest.tasks}
    return _problem_of(replace(rest, refusals=refusals), travel)


def _problem_of(rest: RemainingMission, travel: Travel) -> RemainingProblem:
    tasks, hopeless = _tasks_with_hope(rest, travel)
    past = _past(rest)
    mission = _mission(rest, [*past.values(), *tasks])
    ignored = tuple(rule for rule in rest.ignored if rule not in BY_WHICH_TASKS_ARE_BOUND)
    problem = Problem.compile(mission, rest.objective, ignored=ignored)
    spots = {past[s.robot.id].id: s.spot for s in rest.crew if s.robot.id in past}
    known = travel.measured(problem, spots, {s.robot.id: s.spot for s in rest.crew})
    problem = _delayed(rest, replace(problem, known=known, begun=_begun(rest, problem)))
    problem = _with_energy(rest, _bearable(problem, past))
    measured = {snapshot.robot.id: snapshot.measured for snapshot in rest.crew}
    energy_left = tuple(measured[robot.id] for robot in problem.robots)
    done = {past[s.robot.id].id: s.done for s in rest.crew if s.robot.id in past}
    problem = replace(problem, aboard=_aboard(rest, problem), energy_left=energy_left, past=done)
    index = problem.task_index
    began = tuple((index[past[robot.id].id],) if robot.id in past else () for robot in problem.robots)
    return RemainingProblem(replace(_with_energy_to_end(problem, began), fixed=began), hopeless)


def _with_energy(rest: RemainingMission, problem: Problem) -> Problem:
    """With what robots hold: before the past, which is yet to be taken off."""
    energies = {snapshot.robot.id: snapshot.energy for snapshot in rest.crew}
    if not any(energies.values()):
        return problem
    kept = [_usage_to_station(problem, i) if rest.on_duty else 0.0 for i in range(len(problem.robots))]
    return with_held(problem, [energies[robot.id] for robot in problem.robots], kept)


def _usage_to_station(problem: Problem, i: int) -> float:
    """What robot i uses at most from the end of a route of it to the nearest station there; 0 if there is none."""
    first = len(problem.tasks) + 2 * len(problem.robots)
    stations = enumerate(problem.stations)
    serving = [first + k for k, one in stations if one.gives_energy and problem.model.may_call(i, k)]
    ends = [problem.end(i)] if problem.robots[i].end_position is not None else range(len(problem.tasks))
    if not serving or not len(ends):
        return 0.0
    least = problem.legs(i, ends, serving).min(axis=1)
    return float(least[np.isfinite(least)].max(initial=0.0))


def _aboard(rest: RemainingMission, problem: Problem) -> tuple[tuple[int, ...], ...]:
    """By robot the tasks that deliver what it has on board; empty: nobody has such."""
    index = problem.task_index
    found = [[index[name] for name in rest.aboard.get(robot.id, ()) if name in index] for robot in problem.robots]
    return tuple(map(tuple, found)) if any(found) else ()


def _with_energy_to_end(problem: Problem, began: Sequence[Sequence[int]]) -> Problem:
    """Robots whose energy does not bring them to their ends, be it by way of a station, need not go there."""
    if not problem.levels:
        return problem
    robots = list(problem.robots)
    for i, robot in enumerate(robots):
        if math.isinf(problem.levels[i]) or robot.end_position is None or not began[i]:
            continue
        if not admissible_alone(problem, i, began[i]):
            robots[i] = robot.changed(end_position=None)
    return replace(problem, robots=tuple(robots))


def _begun(rest: RemainingMission, problem: Problem) -> tuple[Begun, ...]:
    """What robots have begun, of which none needs to be over before it is available."""
    known = {snapshot.robot.id: snapshot for snapshot in rest.crew}
    return tuple(
        Begun((from_s, known[robot.id].free_s), known[robot.id].left_s, from_s)
        for robot in problem.robots
        for from_s in (robot.available_from_s,)
    )


def _late(rest: RemainingMission, problem: Problem) -> dict[str, str]:
    """Robots whose routes would have to be over before they can be back, and why they can do no task more."""
    over_s = {robot.id: begun.over_s for robot, begun in zip(problem.robots, problem.begun, strict=True)}
    found = {one.robot.id: one.limits.too_late(over_s[one.robot.id], 0.0, one.left_s) for one in rest.crew}
    return {robot: f"{late}, even without it" for robot, late in found.items() if late}


def _past(rest: RemainingMission) -> dict[str, Task]:
    """For each robot that has one, its past as a task."""
    names = {task.id for task in rest.tasks}
    past = {}
    for snapshot in rest.crew:
        if snapshot.has_past:
            name = snapshot.task or f"{snapshot.robot.id} {SO_FAR}"
            while name in names:  # as for all but the first of a team
                name += "'"
            names.add(name)
            past[snapshot.robot.id] = _past_task(rest, snapshot, name)
    return past


def _past_task(rest: RemainingMission, snapshot: RobotSnapshot, name: str) -> Task:
    in_time = rest.mission.rules.usage == "time"
    used = max(0.0, snapshot.used)  # a count that is resumed may begin below 0
    lasts = used if in_time else max(0.0, snapshot.free_s - rest.now_s)
    return Task(
        id=name,
        type=None if rest.mission.suitability is None else SO_FAR,
        position=snapshot.spot.point[: rest.mission.dimensions],
        actuation_cost=0.0 if in_time else used,
        duration_s=lasts * snapshot.robot.efficiency,
    )


def _tasks_with_hope(rest: RemainingMission, travel: Travel) -> tuple[list[Task], dict[str, str]]:
    """The tasks that can be planned, as they are now; and why the others cannot."""
    hopeless: dict[str, str] = {}
    hopeful: dict[str, Task] = {}
    tied = {task.id for task in rest.tasks if tasks_named_by(task)}
    for task in rest.tasks:
        robots, why = _robots_for(rest, task)
        if task.id in rest.expired:
            hopeless[task.id] = rest.expired[task.id]
        elif not travel.knows(task.id):
            hopeless[task.id] = "unreachable: the travel tables have no row for it"
        elif robots is not None and not robots:
            hopeless[task.id] = why
        else:
            named = task.waiting_for(_open_prerequisites(rest, task)) if task.id in tied else task
            hopeful[task.id] = _for_robots(named, robots)
    if not tied:
        return list(hopeful.values()), hopeless
    units = _units(rest)
    _drop_units_without_hope(units, hopeful, hopeless)
    _drop_transports_without_hope(rest, hopeful, hopeless)
    sure = {snapshot.task for snapshot in rest.crew if snapshot.task is not None}
    waiting = dict(hopeful)
    while ready := [name for name, task in waiting.items() if sure.issuperset(task.prerequisites)]:
        for name in ready:
            sure.add(name)
            del waiting[name]
    for name, task in waiting.items():
        before_it = ", ".join(other for other in task.prerequisites if other not in sure)
        hopeless[name] = f"prerequisite: {before_it} comes before it and is not going to be done"
    hopeful = {name: task for name, task in hopeful.items() if name in sure}
    _drop_units_without_hope(units, hopeful, hopeless)
    _drop_transports_without_hope(rest, hopeful, hopeless)
    return [tied_among(task, hopeful) for task in hopeful.values()], hopeless


def _units(rest: RemainingMission) -> list[tuple[str, ...]]:
    """The sets of several tasks that begin together."""
    model = UnderWay(rest.mission, rest.tasks, rest.ignored)
    return [unit for unit in {model.unit(task.id) for task in rest.tasks} if len(unit) > 1]


def _for_robots(task: Task, robots: tuple[str, ...] | None) -> Task:
    return task if task.only_robots == robots else task.changed(only_robots=robots)


def _open_prerequisites(rest: RemainingMission, task: Task) -> tuple[str, ...]:
    if "prerequisite" in rest.ignored:
        return ()
    return tuple(name for name in task.prerequisites if name not in rest.ended)


def _drop_units_without_hope(
    units: Iterable[Sequence[str]], hopeful: dict[str, Task], hopeless: dict[str, str]
) -> None:
    """Of tasks that begin together none is planned if one cannot be."""
    for unit in units:
        lost = [name for name in unit if name not in hopeful]
        for name in unit if lost else ():
            if hopeful.pop(name, None) is not None:
                hopeless[name] = f"{begins_with(lost[0])}, which is not going to be done"


def _drop_transports_without_hope(rest: RemainingMission, hopeful: dict[str, Task], hopeless: dict[str, str]) -> None:
    """What is taken on board is delivered: of two tasks that are one transport none is planned if one cannot be."""
    for task in rest.tasks:
        for name, other in ((task.id, task.delivers), (task.delivers, task.id)):
            if name is not None and other is not None and name in hopeful and other not in hopeful:
                del hopeful[name]
                does = "takes on what it delivers" if name == task.id else "delivers what it takes on"
                hopeless[name] = f"load: {other}, which {does}, is not going to be done"


def _robots_for(rest: RemainingMission, task: Task) -> tuple[tuple[str, ...] | None, str]:
    """The only robots of the crew that may do a task, None: all; and why there is none, if so."""
    refused = rest.refusals.get(task.id, {})
    binding = rest.bindings.get(task.id, UNBOUND)
    lock = task.only_robots
    if lock is None and not refused and binding == UNBOUND:
        return None, ""
    crew = [snapshot.robot.id for snapshot in rest.crew]
    meant = crew if lock is None else [name for name in lock if name in crew]
    allowed = [name for name in meant if binding.allows(name)]
    robots = tuple(name for name in allowed if name not in refused)
    if meant and not allowed:
        return robots, f"{binding.reason}; none of them takes part" if binding.only else binding.reason
    if lock is not None and not meant:
        return robots, f"lock: only {', '.join(lock)} may do it, and takes no part any more"
    return robots, in_one_line(refused.items())


def _delayed(rest: RemainingMission, problem: Problem) -> Problem:
    """With delays, as durations that are right for the robot that has the task, else for the fastest."""
    fastest = max(problem.robots, key=lambda robot: robot.speed_mps).id
    tasks = list(problem.tasks)
    for name in (task.id for task in rest.tasks if rest.delays_s.get(task.id)):
        j = problem.task_index.get(name)
        if j is not None:
            i = problem.robot_index.get(rest.former.get(name, ""), problem.robot_index[fastest])
            lasts = float(problem.work_seconds(i)[j]) + rest.delays_s[name]
            tasks[j] = _lasting(tasks[j], lasts * problem.robots[i].efficiency)
    return replace(problem, tasks=tuple(tasks))


def _lasting(task: Task, duration_s: float) -> Task:
    """A task of another duration, which is that of its action where it has its own."""
    if task.action is not None and task.action.duration_s is not None:
        return replace(task, action=replace(task.action, duration_s=duration_s))
    return task.changed(duration_s=duration_s)


def _mission(rest: RemainingMission, tasks: Sequence[Task]) -> Mission:
    """The mission of which the problem is made. Travel is handed to the problem apart."""
    mission, crew = rest.mission, [snapshot.robot.id for snapshot in rest.crew]
    travel = "euclidean" if mission.driven_lanes is None else "lanes"
    rules = replace(mission.rules, travel=travel, capacity_reserve=0.0, return_to_start=False)
    scores = mission.suitability
    return mission.what_is_left(
        rules=rules,
        map=None,
        travel=None,
        travel_tables={},
        suitability=None if scores is None else {kind: {**row, SO_FAR: 1.0} for kind, row in scores.items()},
        robots=tuple(_robot(rest, snapshot) for snapshot in rest.crew),
        tasks=tuple(tasks),
        stations=tuple(one for station in rest.stations if (one := station.for_robots(crew)) is not None),
    )


def _robot(rest: RemainingMission, snapshot: RobotSnapshot) -> Robot:
    """A robot from now on. The reserve is kept of what it has left, so that detours may use it up by and by."""
    robot, mission = snapshot.robot, rest.mission
    capacity = robot.work_capacity
    if capacity is not None:
        left = max(0.0, capacity - snapshot.used)
        capacity = snapshot.used + left * (1 - mission.rules.capacity_reserve)
    # Usage of time is the past's duration, of which waiting is no part: it is put before the past.
    leaves = snapshot.free_s - snapshot.used if mission.rules.usage == "time" else rest.now_s
    if not snapshot.has_past:
        leaves = snapshot.free_s
    available_from_s = max(0.0, leaves if snapshot.has_past else max(leaves, robot.available_from_s))
    return robot.busy(available_from_s, snapshot.free_s).changed(
        position=snapshot.spot.point[: mission.dimensions],
        end_position=None if snapshot.home is None else snapshot.home[: mission.dimensions],
        return_to_start=False,
        work_capacity=capacity,
        load_at_start=_load_of(snapshot, rest),
    )


def _load_of(snapshot: RobotSnapshot, rest: RemainingMission) -> Amount | None:
    """What a robot has on board as a mission has it, no more than it can carry."""
    if "load" in rest.ignored:
        return None
    most = snapshot.robot.load_capacity
    room = None if most is None else by_commodity(most)
    return as_amount({k: v if room is None else min(v, room.get(k, 0.0)) for k, v in snapshot.load.items()})


def _bearable(problem: Problem, past: Mapping[str, Task]) -> Problem:
    """With capacities, and times to be over by, raised to what robots have used and need to go home, and no more.

    A robot that has no way home need not go there.
    """
    robots, begun = [], list(problem.begun)
    for i, robot in enumerate(problem.robots):
        if robot.id in past:
            j = problem.task_index[past[robot.id].id]
            home = 0.0
            if robot.end_position is not None:
                home = float(problem.legs(i, [j], [problem.end(i)])[0, 0])
            if math.isinf(home):
                robot, home = robot.changed(end_position=None), 0.0
            least = (float(problem.work_usage(i)[j]) + home) * (1 + _ROUNDING) + _ROUNDING
            begun[i] = replace(begun[i], over_s=_back_s(problem, i, j) * (1 + _ROUNDING))
            if robot.work_capacity is not None and robot.work_capacity < least:
                robot = robot.changed(work_capacity=least)
        robots.append(robot)
    return replace(problem, robots=tuple(robots), begun=tuple(begun))


def _back_s(problem: Problem, i: int, j: int) -> float:
    """When a robot is at its end if it does nothing after its past, task j."""
    robot = problem.robots[i]
    ends_s = robot.available_from_s + float(problem.work_seconds(i)[j])
    home_s = 0.0 if robot.end_position is None else float(problem.travel_seconds(i, [j], [problem.end(i)])[0, 0])
    return ends_s if math.isinf(home_s) else problem.back(i, ends_s, j)
