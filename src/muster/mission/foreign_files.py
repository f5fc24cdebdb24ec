"""Files of other programs that are YAML or JSON and no missions: known by their keys, so that a refusal names them."""

from __future__ import annotations

from collections.abc import Mapping

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


def foreign_form(data: Mapping[str, object]) -> tuple[str, str] | None:
    """Return what a mapping is instead of a mission, and what was expected; None where it is not known."""
    if "schema" in data or "tasks" in data:
        return None
    return next(((form, expected) for keys, form, expected in _BY_KEYS if keys <= data.keys()), None)
