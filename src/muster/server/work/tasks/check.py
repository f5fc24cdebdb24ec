"""What is wrong with a mission, and which tasks can never be done."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from muster.allocation.feasibility import impossible
from muster.allocation.problem import Problem
from muster.mission.errors import MissionError, NotSupportedError
from muster.mission.model import Mission
from muster.mission.yaml_writer import plain
from muster.server.work.errors import MOST_FINDINGS
from muster.server.work.missions import mission_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission"}` -> `{"errors", "impossible", "summary", "mission"}`; the last two None where it cannot be read.

    With `brief` the mission is left out.

    `errors` and `impossible` are as `muster check --format json` prints them; `mission` is the mission as plain data,
    as a mission file holds it, places in metres.
    """
    answer: dict[str, Any] = {"errors": [], "impossible": [], "summary": None, "mission": None}
    try:
        mission = mission_of(arguments["mission"])
        answer |= {"summary": summary(mission), "mission": None if arguments.get("brief") else plain(mission)}
        problem = Problem.compile(mission).ready()  # which reads the map
    except (MissionError, NotSupportedError) as error:
        return answer | {"errors": [finding.as_dict() for finding in error.findings[:MOST_FINDINGS]]}
    return answer | {"impossible": [asdict(task) for task in impossible(problem)]}


def summary(mission: Mission) -> dict[str, Any]:
    """What a list of missions shows of one."""
    counted = {"robots": len(mission.robots), "tasks": len(mission.tasks), "dimensions": mission.dimensions}
    return {"name": mission.name, **counted}
