"""Closed routes from one depot or several: published instances, and missions of the same kinds by a seed.

A file of `routing_instances` has a line `x y` for each depot, an empty line, and such a line for each task. Robots
return to where they start; tasks take no work. Missions are compared by the longest route or by the total: their own
objective is max for the instances of He and Hao [he2022] [he2023], total for the others.
"""

from __future__ import annotations

from importlib.resources import files

import numpy as np

from muster.generation.clustered import closed_routes, pairs
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster_studies.instances.references import numbered

_FOLDER = "routing_instances"
_SIDE_M = 1000.0

LONGEST_ROUTES = numbered("longest_routes")
"""By instance and number of robots: the least longest route published, recomputed from the routes [he2026]."""

SHORTER_ROUTES = numbered("shorter_routes")
"""By instance and number of robots: the longest route of `shorter_plan`, which is less than the least published."""


def routing_instance(name: str, robots: int, objective: str = "max") -> Mission:
    """A shipped instance: kroa200, mtsp100, mtsp150, rand100, rat783, md2, md4, md12, md24 or cc64.

    Parameters
    ----------
    robots
        all at the depot; where there are several depots, as many: one at each.

    Raises
    ------
    ParameterError
        for any other name or number.
    """
    file = files("muster_studies.instances") / _FOLDER / f"{name}.txt"
    if not file.is_file():
        names = sorted(
            path.name.removesuffix(".txt") for path in (files("muster_studies.instances") / _FOLDER).iterdir()
        )
        raise ParameterError(f"instance: {name}; expected {' or '.join(names)}")
    depots, tasks = (_places(part) for part in file.read_text(encoding="utf-8").split("\n\n"))
    if len(depots) == 1:
        depots *= robots
    if not 1 <= len(depots) == robots:
        raise ParameterError(f"robots: {robots}; expected {len(depots) or 'one at least'}, the depots of {name}")
    return closed_routes(depots, tasks, objective, f"{name}-{robots}")


def shorter_plan(name: str, robots: int) -> Plan:
    """A plan of a shipped instance whose longest route is less than the least published (`SHORTER_ROUTES`).

    `search` found it in 45 s of processor time with `plans` 8. A file of `routing_plans` has a line for each robot,
    with the numbers of its tasks.
    """
    text = (files("muster_studies.instances") / "routing_plans" / f"{name}-{robots}.txt").read_text(encoding="utf-8")
    return Plan(routes=tuple(Route(f"r_{k}", tuple(line.split())) for k, line in enumerate(text.splitlines())))


def uniform_tour(places: int, seed: int) -> Mission:
    """One robot at the first of so many random places of a square of 1000 m; the others are its tasks."""
    depot, *tasks = pairs(np.random.default_rng(seed).uniform(0, _SIDE_M, (places, 2)))
    return closed_routes([depot], tasks, "total", f"tour-{places}-{seed}")


def _places(text: str) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in map(str.split, text.strip().splitlines())]
