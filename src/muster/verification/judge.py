"""The judge: a plan recomputed from the mission alone, in time linear in tasks, robots and prerequisites."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.model import OBJECTIVES, Mission
from muster.mission.plan import Plan
from muster.mission.supported_features import require_supported
from muster.mission.value_types import shown
from muster.verification.admissibility import broken_rules, capacity_of, known_routes
from muster.verification.measure import MeasuredRoute, equality_index, measured
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
    routes = [measured(mission, travel, robot, tasks_of.get(robot.id, ())) for robot in mission.robots]
    unit = "s" if mission.rules.usage == "time" else "m"
    violations += broken_rules(mission, ignored, routes, unit, travel.tolerance)
    times = schedule(routes, awaited_in(routes, ignored="prerequisite" in ignored))
    if isinstance(times, Deadlock):
        violations.append(Violation("deadlock", None, None, times.detail))
    verdict = _verdict(mission, ignored, objective, routes, None if isinstance(times, Deadlock) else times, unit)
    return replace(verdict, violations=(*violations, *false_statements(mission, plan, verdict, travel.tolerance)))


def _verdict(
    mission: Mission,
    ignored: Collection[str],
    objective: str,
    routes: Sequence[MeasuredRoute],
    times: Mapping[str, Times] | None,
    unit: str,
) -> Verdict:
    """Put the figures together, before anything is found wrong; without `times` the plan has no schedule."""
    usages = [route.usage for route in routes]
    steps = [step for route in routes for step in route.steps]
    return Verdict(
        violations=(),
        objective_name=objective,
        ignored=tuple(ignored),
        usage_unit=unit,
        total_cost=sum(usages),  # [tcf-thesis] (3.11)
        max_usage=max(usages),
        average=sum(step.arrival_usage for step in steps) / len(steps) if steps else 0.0,
        makespan_s=None if times is None else max((time.ends for time in times.values()), default=0.0),
        equality_index=equality_index(usages),
        tasks_completed=len(steps),
        tasks_total=len(mission.tasks),
        weight_completed=sum((step.task.priority for step in steps), start=0.0),
        routes=tuple(_figures(route, capacity_of(mission, ignored, route.robot), times) for route in routes),
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
