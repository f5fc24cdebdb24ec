"""The judge: a plan recomputed from the mission alone. A plan without reasons takes time linear in its size."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.model import OBJECTIVES, Mission, Task
from muster.mission.objectives import lateness, objective_values
from muster.mission.plan import Plan
from muster.mission.supported_features import require_supported
from muster.mission.system.garbage import collector_paused
from muster.mission.value_types import shown
from muster.verification.book import book_faults
from muster.verification.case import Case
from muster.verification.known_routes import known_routes, other_mission
from muster.verification.left_out import left_out_faults
from muster.verification.loads import Hold
from muster.verification.measure import MeasuredRoute, Service, Step, all_measured, equality_index
from muster.verification.rules import rules_that_hold
from muster.verification.schedule import schedule
from muster.verification.schedule_nodes import Deadlock, Schedule, Times
from muster.verification.statements import false_statements
from muster.verification.travel import Travel
from muster.verification.verdict import RouteFigures, Stop, Verdict, Violation, Visit

TimesOf = Mapping[str, Sequence[Times]]
"""By robot those at the stops of its route, in order."""


@collector_paused()
def verify(mission: Mission, plan: Plan, ignore: str | Collection[str] = (), objective: str | None = None) -> Verdict:
    """Judge a plan: recompute its figures and find everything that is wrong with it (docs/design.md, Meaning).

    A task, station or robot that does not exist, and a task or robot that stands twice, is left out, and the rest is
    judged. A leg without a way
    counts nothing.

    Parameters
    ----------
    ignore
        rules that do not hold, of IGNORABLE. What the plan says of itself in `ignored` has no effect.
    objective
        the one that the plan was to minimise; the mission's by default.

    Raises
    ------
    NotSupportedError
        if the mission asks for what is not supported yet (see `require_supported`).
    MissionError, MissingExtraError
        for travel over a map: if the map is wrong, or the extra that reads maps is absent.
    ParameterError
        for an unknown objective or rule.
    """
    require_supported(mission)
    ignored = ignored_rules(ignore)
    objective = mission.rules.objective if objective is None else objective
    if objective not in OBJECTIVES:
        raise ParameterError(f"objective: {shown(objective)}; expected {' or '.join(OBJECTIVES)}")
    stops_of, violations = known_routes(mission, plan, teams="team" not in ignored)
    travel = Travel(mission)
    routes = all_measured(mission, travel, stops_of)
    found = schedule(routes, ignored)
    case = Case(
        mission=mission,
        travel=travel,
        routes=routes,
        ignored=ignored,
        deadlocked=isinstance(found, Deadlock),
    )
    violations = [*other_mission(mission, plan), *violations, *_broken_rules(case)]
    violations += [found.violation] if isinstance(found, Deadlock) else found.broken
    verdict = _verdict(case, objective, None if isinstance(found, Deadlock) else found)
    left_out, undecided = left_out_faults(case, plan)
    violations += left_out
    violations += false_statements(plan, verdict, travel.tolerance)
    violations += book_faults(mission, plan)
    return replace(verdict, violations=tuple(violations), reasons_undecided=undecided)


def _broken_rules(case: Case) -> Iterator[Violation]:
    """Every broken rule, robot by robot in the order of the routes; deadlocks are for the schedule to find."""
    rules = rules_that_hold(case)
    for route in case.routes:
        for rule in rules:
            yield from rule.violations(case, route)


def _verdict(case: Case, objective: str, found: Schedule | None) -> Verdict:
    """Put the figures together, before anything is found wrong; None: the plan has no schedule."""
    times = None if found is None else found.times
    usages = [route.usage for route in case.routes]
    done: dict[str, Task] = {}
    arrivals: dict[str, float] = {}  # of a team the largest
    for step in (step for route in case.routes for step in route.steps):
        done[step.task.id] = step.task
        arrivals[step.task.id] = max(step.arrival_usage, arrivals.get(step.task.id, 0.0))
    ends = {} if times is None else dict(_ends(case.routes, times))
    late = lateness((done[name].priority, end, done[name].due_s) for name, end in ends.items())
    routes = tuple(_figures(case, route, found) for route in case.routes)
    back = [route.back_s for route in routes if route.back_s is not None]
    returns = back if case.mission.rules.makespan_includes_return else []
    values = objective_values(usages, list(arrivals.values()), [*ends.values(), *returns], late)
    return Verdict(
        violations=(),
        objective_name=objective,
        ignored=case.ignored,
        usage_unit=case.unit,
        total_cost=values["total"],  # [tcf-thesis] (3.11)
        max_usage=values["max"],
        average=values["average"],
        makespan_s=None if times is None else values["makespan"],
        lateness=None if times is None else values["lateness"],
        equality_index=equality_index(usages),
        tasks_completed=len(done),
        tasks_total=len(set(case.alternatives.values())),
        weight_completed=sum((task.priority for task in done.values()), start=0.0),
        routes=routes,
    )


def _ends(routes: Sequence[MeasuredRoute], times: TimesOf) -> Iterator[tuple[str, float]]:
    for route in routes:
        for stop, time in zip(route.stops, times[route.robot.id], strict=True):
            if isinstance(stop, Step):
                yield stop.task.id, time.ends


def _figures(case: Case, route: MeasuredRoute, found: Schedule | None) -> RouteFigures:
    name = route.robot.id
    own = None if found is None else found.times[name]
    return RouteFigures(
        robot=name,
        tasks=tuple(step.task.id for step in route.steps),
        travel=route.travel,
        work=route.work,
        usage=route.usage,
        capacity=case.capacity_of(route.robot),
        leaves_s=route.robot.available_from_s if found is None else found.leaves[name],
        visits=() if own is None else tuple(_visits(route, own)),
        back_s=found.back[name] if found and own and route.last_leg else None,
        stops=() if own is None else tuple(_stops(case, route, own)),
    )


def _visits(route: MeasuredRoute, times: Sequence[Times]) -> Iterator[Visit]:
    for stop, time in zip(route.stops, times, strict=True):
        if isinstance(stop, Step):
            yield Visit(stop.task.id, time.arrives, time.starts, time.ends, stop.arrival_usage)


def _stops(case: Case, route: MeasuredRoute, times: Sequence[Times]) -> Iterator[Stop]:
    loads = Hold(route, case.task, case.deliverer).along_route()
    for stop, time, load in zip(route.stops, times, loads, strict=True):
        energy = stop.energy
        yield Stop(
            name=stop.place_id,
            is_station=isinstance(stop, Service),
            arrives_s=time.arrives,
            starts_s=time.starts,
            ends_s=time.ends,
            arrival_level=None if energy is None else energy.arrives,
            level_after=None if energy is None else energy.leaves,
            charged=stop.charge.amount if isinstance(stop, Service) and stop.is_charged else None,
            load_after=load,
        )
