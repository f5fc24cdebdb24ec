"""The gate that plans pass before anything is carried out or written: what must hold whoever made them."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from muster.mission.errors import Finding, NotSupportedError, PlanError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.verification.closed_areas import ClosedAreas
from muster.verification.closed_legs import closed_legs
from muster.verification.judge import verify
from muster.verification.known_routes import known_routes
from muster.verification.verdict import Verdict, Violation


def require_admissible(mission: Mission, plan: Plan, file: str, ignore: Collection[str] = ()) -> Verdict:
    """The verdict on a plan that breaks no rule but those to `ignore`; `file` names it in the message.

    Which objective the plan was to minimise makes no difference to that.

    Raises
    ------
    PlanError
        if it breaks one.
    """
    verdict = verify(mission, plan, ignore, plan.objective)
    _refuse(mission, verdict.violations, file)
    return verdict


def require_open_ways(mission: Mission, plan: Plan) -> None:
    """Raise unless every leg and all work of a plan keeps out of the areas that are closed to its robot.

    Nothing that moves robots, simulated ones included, begins with another plan; the rest of the rules is for
    `require_admissible` to check.

    Raises
    ------
    PlanError
        if a route enters one.
    MissionError, MissingExtraError
        if the map is wrong, or Shapely is absent.
    """
    areas, (routes, _) = ClosedAreas(mission), known_routes(mission, plan, teams=True)
    robots = {robot.id: robot for robot in mission.robots}
    found = [one for name, stops in routes.items() for one in closed_legs(mission, areas, robots[name], stops)]
    _refuse(mission, found, "<plan>")


def require_geometry(mission: Mission, what: str) -> None:
    """Raise for a mission whose legs are numbers of a table, which nothing can be driven or drawn along.

    Parameters
    ----------
    what
        needs the geometry of legs: `simulate`.

    Raises
    ------
    NotSupportedError
        if travel is by a table.
    """
    if mission.travel_rule == "matrix":
        expected = f"euclidean or map: {what} needs the ways between places, and a travel table has their lengths alone"
        raise NotSupportedError([Finding(mission.source.file, None, "rules.travel", "matrix", expected)])


def _refuse(mission: Mission, violations: Sequence[Violation], file: str) -> None:
    """Raise for the first of a plan's violations, if there are any."""
    if violations:
        first, *others = violations
        more = f" and {len(others)} more" if others else ""
        parts = ", ".join(part for part in (first.robot, first.task, first.detail) if part)
        expected = f"an admissible plan of mission {mission.name}; muster verify says what is wrong"
        raise PlanError([Finding(file, None, first.kind, f"{parts}{more}", expected)])
