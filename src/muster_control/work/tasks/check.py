"""The task that checks a mission: its errors, and tasks that can never be done, alone or together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from muster.mission.errors import MissionError, NotSupportedError
from muster.mission.model import Mission
from muster.mission.yaml_writer import plain
from muster.planning.explaining import Possible, possible
from muster_control.work.errors import MOST_FINDINGS
from muster_control.work.floor_plans import floor_of
from muster_control.work.missions import mission_of


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"mission"}` -> `{"errors", "impossible", "conflict", "unknown", "summary", "mission", "floor"}`.

    The first four are as `muster check --format json` prints them; `mission` is the mission as plain data, as a mission
    file holds it, places in metres, and `floor` its floor plan; both are left out with `brief`. They and the `summary`
    are None where it cannot be read. Rules that are to `ignore` do not hold; whether one plan can do all stays unknown
    without a `time_limit` for it.
    """
    answer: dict[str, Any] = {"errors": [], **Possible().as_dict(), "summary": None, "mission": None, "floor": None}
    try:
        mission = mission_of(arguments["mission"])
        answer["summary"] = summary(mission)
        if not arguments.get("brief"):
            answer |= {"mission": plain(mission), "floor": floor_of(mission)}
        found = possible(mission, ignored=arguments.get("ignore", ()), time_limit=arguments.get("time_limit"))
    except (MissionError, NotSupportedError) as error:
        return answer | {"errors": [finding.as_dict() for finding in error.findings[:MOST_FINDINGS]]}
    return answer | found.as_dict()


def summary(mission: Mission) -> dict[str, Any]:
    """The summary of a mission in a list."""
    counted = {"robots": len(mission.robots), "tasks": len(mission.tasks), "dimensions": mission.dimensions}
    return {"name": mission.name, **counted}
