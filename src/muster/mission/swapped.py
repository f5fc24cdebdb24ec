"""A plan where a mission is expected, and the other way round: one line instead of a hundred unknown keys."""

from __future__ import annotations

import re
from collections.abc import Mapping

PLAN_AS_MISSION = "a mission (schema: muster/1); this is a plan: the MISSION comes first, then the PLAN"
MISSION_AS_PLAN = "a plan (schema: muster-plan/1); this is a mission: the MISSION comes first, then the PLAN"
_MISSION = re.compile(r"""^[\s{"']*schema["']?\s*:\s*["']?muster/1\b""", re.MULTILINE)
_BEGINNING = 4096  # characters in which a mission says that it is one


def is_plan(data: Mapping[str, object]) -> bool:
    """Return whether plain data is a plan: it says so, or has routes and nothing of a mission."""
    said = str(data.get("schema", ""))
    return said.startswith("muster-plan") or ("routes" in data and not said and not {"robots", "tasks"} & data.keys())


def is_mission(text: str) -> bool:
    """Return whether a text is a mission in YAML or JSON: its schema says so, and it has no routes."""
    return _MISSION.search(text[:_BEGINNING]) is not None and '"routes"' not in text
