"""What a file is instead of a mission or plan, so that a refusal names it: the other of both, or another program's."""

from __future__ import annotations

import re
from collections.abc import Mapping

PLAN_AS_MISSION = "a mission (schema: muster/1); this is a plan: the MISSION comes first, then the PLAN"
MISSION_AS_PLAN = "a plan (schema: muster-plan/1); this is a mission: the MISSION comes first, then the PLAN"
_SAYS_MISSION = re.compile(r"""^[\s{"']*schema["']?\s*:\s*["']?muster/1\b""", re.MULTILINE)
_BEGINNING = 4096  # characters in which a mission says that it is one
_MISSION = "a mission: schema, robots, tasks"
_LANES = f"{_MISSION}; the lanes of a mission are `lanes: {{nodes, edges}}`"
_BY_KEYS: tuple[tuple[frozenset[str], str, str], ...] = (
    (frozenset(("levels", "building_name")), "a navigation graph of Open-RMF", _LANES),
    (frozenset(("levels",)), "a building map of Open-RMF", _LANES),
    (frozenset(("rmf_fleet",)), "a fleet configuration of Open-RMF", _MISSION),
    (
        frozenset(("image", "resolution", "origin")),
        "a map of ROS",
        f"{_MISSION}; map: {{ros_yaml: FILE}} names it there",
    ),
    (frozenset(("fileType", "mission")), "a plan of QGroundControl", "this file with the suffix .plan"),
)


def is_plan(data: Mapping[str, object]) -> bool:
    """Return whether plain data is a plan: it says so, or has routes and nothing of a mission."""
    said = str(data.get("schema", ""))
    return said.startswith("muster-plan") or ("routes" in data and not said and not {"robots", "tasks"} & data.keys())


def is_mission(text: str) -> bool:
    """Return whether a text is a mission in YAML or JSON: its schema says so, and it has no routes."""
    return _SAYS_MISSION.search(text[:_BEGINNING]) is not None and '"routes"' not in text


def foreign_form(data: Mapping[str, object]) -> tuple[str, str] | None:
    """Return what a mapping is instead of a mission, and what was expected; None where it is not known."""
    if "schema" in data or "tasks" in data:
        return None
    return next(((form, expected) for keys, form, expected in _BY_KEYS if keys <= data.keys()), None)
