"""What a site says of its robots as a team: their energy, where their routes end, and how they move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from muster.mission.errors import Finding
from muster_files.sites.entries import Entry, some_of
from muster_files.sites.labels import quoted

Made = tuple[Entry, dict[str, Any]]
"""A robot of the site, and its record in the mission."""
_ENERGY = ("endurance_s", "range_m")
_IN_USAGE = ("work_capacity", "battery")
"""Keys of robots in the unit of usage."""


def energy_of(entry: Entry) -> dict[str, float]:
    """Return how long and how far a robot goes, as a mission file has it; of what is said twice the less."""
    stated = entry.values.get("battery")
    found: dict[str, float] = dict(stated) if isinstance(stated, dict) else {}
    for key in _ENERGY:
        value = entry.values.get(key)
        if isinstance(value, float):
            found[key] = min(value, found.get(key, value))
    return found


def choose_usage(made: Sequence[Made], data: dict[str, Any], findings: list[Finding], notes: list[str]) -> None:
    """Let usage be a time in a new mission whose robots are known by how long they go, or work for some time."""
    lasts = any(task.get("duration_s") for task in data.get("tasks", ()))
    timed = [entry for entry, record in made if "endurance_s" in record or ("range_m" in record and lasts)]
    if not timed or data.get("rules", {}).get("usage") == "time":
        return
    told = "none beside a robot's endurance, which makes the unit of usage a second; or a mission among the files"
    for entry, record in made:
        if "work_capacity" in record:
            findings.append(entry.finding("work_capacity", record["work_capacity"], told))
    held = [one for one in data.get("robots", ()) if any(key in one for key in _IN_USAGE)]
    if held and not any("work_capacity" in record for _, record in made):
        findings.append(timed[0].finding("endurance_s", "a time", "Range (km): robots of the mission count in metres"))
    rated = [one for one in data.get("stations", ()) if "charge_per_s" in one]
    if rated:
        findings.append(timed[0].finding("endurance_s", "a time", f"a mission with usage: time for {rated[0]['id']}"))
    data["rules"] = {**data.get("rules", {}), "usage": "time"}
    notes.append("rules: usage: time chosen, so that flight and work both count against the endurance of robots")


def let_return(made: Sequence[Made], data: dict[str, Any], *, is_new: bool, notes: list[str]) -> None:
    """Let robots in the air return to their starts, where nothing says where their routes end."""
    own = [record for _, record in made]
    robots = [*data.get("robots", ())] if is_new else own
    flying = [one for one in robots if one.get("kind") == "air"]
    free = [one for one in flying if one.get("return_to_start") is None and one.get("end_position") is None]
    if not free:
        return
    if is_new and len(flying) == len(robots):
        data["rules"] = {**data.get("rules", {}), "return_to_start": True}
    else:
        for one in free:
            one["return_to_start"] = True
    notes.append(f"return_to_start: true for robots in the air, which land where they started: {_ids(free)}")


def require_kinds(made: Sequence[Made], data: Mapping[str, Any], findings: list[Finding], notes: list[str]) -> None:
    """Require to know how robots move where that makes a difference; note what is taken where it makes none."""
    unsaid = [(entry, record) for entry, record in made if "kind" not in record]
    reason = _why_kind_matters(data) if unsaid else ""
    for entry, record in unsaid if reason else ():
        name = quoted(f"{entry.named_by}=air")
        expected = f"air or ground, as {reason}: a column kind, or --as {name} (or ground) of muster import"
        findings.append(entry.finding("kind", f"robot {record['id']}: missing", expected))
    if unsaid and not reason:
        taken = some_of([str(record["id"]) for _, record in unsaid])
        name = quoted(f"{unsaid[0][0].named_by}=air")
        notes.append(f"taken to move on the ground: {taken}; a column kind, or --as {name}, says other")


def _why_kind_matters(data: Mapping[str, Any]) -> str:
    for zone in data.get("map", {}).get("zones", ()):
        if {*zone.get("forbidden_to", ("ground", "air"))} != {"ground", "air"}:
            return "a closed area is forbidden to one of the two"
        if zone.get("floor_m") is not None or zone.get("ceiling_m") is not None:
            return "a closed area has a height"
    if any("height_m" in (task.get("action") or {}) for task in data.get("tasks", ())):
        return "an area is surveyed from a height"
    places = [one["position"] for group in ("robots", "tasks") for one in data.get(group, ())]
    return "places have heights" if any(len(place) > 2 and place[2] for place in places) else ""


def _ids(robots: Sequence[Mapping[str, Any]]) -> str:
    return some_of([str(one["id"]) for one in robots])
