"""Tasks of a mission that can never be done, alone or together, and stations out of reach; as data and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from muster.allocation.bounds.feasibility import impossible
from muster.allocation.bounds.work_shortfall import Shortfall
from muster.allocation.remedies.conflicts import Conflict, Together, together, without_search
from muster.allocation.remedies.mission_remedies import MissionRemedy
from muster.allocation.stop import Stop
from muster.mission.model import Mission, Station
from muster.mission.plan import Reason, Unassigned
from muster.model.problem import Problem
from muster.motion.actions.unseen_places import Unseen
from muster.motion.map_world import body_of
from muster.motion.maps.free_points import free
from muster.motion.unreachable_places import why_blocked
from muster.planning.explaining.crossings import BlockedWay, blocked_ways
from muster.planning.explaining.unseen_searches import unseen_searches
from muster.planning.judging import admits


@dataclass(frozen=True)
class Possible:
    """Which tasks can never be done.

    Parameters
    ----------
    impossible
        tasks that no robot can ever do.
    together
        whether one plan can do all others.
    unseen
        raster searches of which robots that may do them do not see all.
    blocked
        robots that cannot get past each other, and lanes that do not lead where robots must go.
    cut_off
        stations to which no robot has a way.
    """

    impossible: tuple[Unassigned, ...] = ()
    together: Together = Together()
    unseen: tuple[Unseen, ...] = ()
    blocked: tuple[BlockedWay, ...] = ()
    cut_off: tuple[CutOff, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return what `muster check --format json` prints of it."""
        conflict = self.together.conflict
        return {
            "impossible": [asdict(item) for item in self.impossible],
            "conflict": None if conflict is None else asdict(conflict),
            "unknown": self.together.unknown,
            "shortfalls": [short.as_dict() for short in self.together.shortfalls],
            "remedies": [asdict(remedy) for remedy in self.together.remedies],
            "unseen": [asdict(item) for item in self.unseen],
            "blocked": [asdict(item) for item in self.blocked],
            "cut_off": [asdict(item) for item in self.cut_off],
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Possible:
        """Read the result of `as_dict`, also from JSON."""
        lost = (
            Unassigned(item["task"], tuple(Reason(**reason) for reason in item["reasons"]))
            for item in data["impossible"]
        )
        unseen = tuple(Unseen(**item) for item in data.get("unseen", ()))
        blocked = tuple(BlockedWay(**{**item, "robots": tuple(item["robots"])}) for item in data.get("blocked", ()))
        cut_off = tuple(CutOff(**item) for item in data.get("cut_off", ()))
        short = tuple(map(Shortfall.from_dict, data.get("shortfalls", ())))
        named = ({**item, "robots": tuple(item["robots"])} for item in data.get("remedies", ()))
        remedies = tuple(MissionRemedy(**item) for item in named)
        all_others = Together(_conflict(data["conflict"]), data["unknown"], short, remedies)
        return cls(tuple(lost), all_others, unseen, blocked, cut_off)


def possible(mission: Mission, *, ignored: Sequence[str] = (), time_limit: float | None = None) -> Possible:
    """Find the tasks of a mission that can never be done, and what else of it cannot be as it seems meant.

    Parameters
    ----------
    ignored
        rules that do not hold.
    time_limit
        seconds after which it is not looked at any more whether all tasks can be done in one plan; None: that stays
        unknown.

    Raises
    ------
    MissionError, NotSupportedError
        if the mission cannot be planned at all, or its map is wrong.
    """
    budget = Stop(time_limit=time_limit)
    problem = Problem.compile(mission, ignored=ignored).ready()  # which reads the map
    lost, unseen, blocked = impossible(problem), unseen_searches(problem), blocked_ways(problem)
    cut_off = cut_off_stations(problem)
    if budget.time_left_s is None:
        all_others = without_search(problem)
    else:
        all_others = together(problem, admits, time_limit=budget.time_left_s)
    return Possible(lost, all_others, unseen, blocked, cut_off)


def _conflict(data: Mapping[str, Any] | None) -> Conflict | None:
    if data is None:
        return None
    named = {name: tuple(data[name]) for name in ("tasks", "prerequisites", "robots")}
    return Conflict(**{**data, **named})


@dataclass(frozen=True)
class CutOff:
    """A station to which no robot has a way from where it starts, and why."""

    station: str
    detail: str


def cut_off_stations(problem: Problem) -> tuple[CutOff, ...]:
    """The stations of a problem to which no robot has a way."""
    first = len(problem.tasks) + 2 * len(problem.robots)
    return tuple(
        CutOff(station.id, _why(problem, station))
        for k, station in enumerate(problem.stations)
        if not any(_gets_to(problem, i, first + k) for i in range(len(problem.robots)))
    )


def _gets_to(problem: Problem, i: int, place: int) -> bool:
    return bool(np.isfinite(problem.legs(i, [problem.start(i)], [place])[0, 0]))


def _why(problem: Problem, station: Station) -> str:
    """What is in the way of every body at the station itself; else that there is no way to it."""
    if problem.mission.travel_off_lanes == "map":
        world, point = problem.robot_paths.world, station.position
        reasons = [
            why_blocked(world, point, body)
            for body in dict.fromkeys(map(body_of, problem.robots))
            if not free(world.free_space(body.radius_m, body.kind), np.array([point]))[0]
        ]
        if reasons:
            return "; ".join(dict.fromkeys(reasons))
    return "there is no way to it from where robots start"
