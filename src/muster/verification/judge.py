"""The judge: a plan recomputed from the mission alone. A plan without reasons takes time linear in its size."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.model import OBJECTIVES, Mission
from muster.mission.objectives import objective_values
from muster.mission.plan import Plan
from muster.mission.supported_features import require_supported
from muster.mission.value_types import shown
from muster.verification.book import book_faults
from muster.verification.case import Case
from muster.verification.known_routes import known_routes
from muster.verification.left_out import left_out_faults
from muster.verification.measure import MeasuredRoute, equality_index, measured
from muster.verification.rules import rules_that_hold
from muster.verification.schedule import Deadlock, Times, awaited_in, schedule
from muster.verification.statements import false_statements
from muster.verification.travel import Travel
from muster.verification.verdict import RouteFigures, Verdict, Violation, Visit


def verify(mission: Mission, plan: Plan, ignore: str | Collection[str] = (), objective: str | None = None) -> Verdict:
    """Judge a plan: recompute its figures and find everything that is wrong with it (docs/design.md, Meaning).

    A task or robot that does not exist, or stands twice, is left out, and the rest is judged. A leg without a way
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
    tasks_of, violations = known_routes(mission, plan)
    travel = Travel(mission)
    routes = tuple(measured(mission, travel, robot, tasks_of.get(robot.id, ())) for robot in mission.robots)
    times = schedule(routes, awaited_in(routes, ignored="prerequisite" in ignored))
    case = Case(
        mission=mission,
        travel=travel,
        routes=routes,
        ignored=ignored,
        deadlocked=isinstance(times, Deadlock),
    )
    violations += _broken_rules(case)
    if isinstance(times, Deadlock):
        violations.append(Violation("deadlock", None, None, times.detail))
    verdict = _verdict(case, objective, None if isinstance(times, Deadlock) else times)
    violations += left_out_faults(case, plan)
    violations += false_statements(plan, verdict, travel.tolerance)
    violations += book_faults(mission, plan)
    return replace(verdict, violations=tuple(violations))


def _broken_rules(case: Case) -> Iterator[Violation]:
    """Every broken rule, robot by robot in the order of the routes; deadlocks are for the schedule to find."""
    rules = rules_that_hold(case)
    for route in case.routes:
        for rule in rules:
            yield from rule.violations(case, route)


def _verdict(case: Case, objective: str, times: Mapping[str, Times] | None) -> Verdict:
    """Put the figures together, before anything is found wrong; without `times` the plan has no schedule."""
    usages = [route.usage for route in case.routes]
    steps = [step for route in case.routes for step in route.steps]
    ends = [] if times is None else [time.ends for time in times.values()]
    values = objective_values(usages, [step.arrival_usage for step in steps], ends)
    routes = tuple(_figures(route, case.capacity_of(route.robot), times) for route in case.routes)
    return Verdict(
        violations=(),
        objective_name=objective,
        ignored=case.ignored,
        usage_unit=case.unit,
        total_cost=values["total"],  # [tcf-thesis] (3.11)
        max_usage=values["max"],
        average=values["average"],
        makespan_s=None if times is None else values["makespan"],
        equality_index=equality_index(usages),
        tasks_completed=len(steps),
        tasks_total=len(case.mission.tasks),
        weight_completed=sum((step.task.priority for step in steps), start=0.0),
        routes=routes,
    )


def _figures(route: MeasuredRoute, capacity: float | None, times: Mapping[str, Times] | None) -> RouteFigures:
    visits = tuple(_visits(route, times)) if times is not None else ()
    return RouteFigures(
        robot=route.robot.id,
        tasks=tuple(step.task.id for step in route.steps),
        travel=route.travel,
        work=route.work,
        usage=route.usage,
        capacity=capacity,
        leaves_s=route.robot.available_from_s,
        visits=visits,
        back_s=visits[-1].ends_s + route.last_leg.seconds if visits and route.last_leg else None,
    )


def _visits(route: MeasuredRoute, times: Mapping[str, Times]) -> Iterator[Visit]:
    for step in route.steps:
        time = times[step.task.id]
        yield Visit(step.task.id, time.arrives, time.starts, time.ends, step.arrival_usage)
