"""Missions and published tables that ship with the package, as data and by name."""

from muster.library.shipped import (
    MissionSummary,
    as_corrected,
    as_printed,
    mission_names,
    mission_path,
    mission_summary,
    missions,
    published,
    published_names,
)

__all__ = [
    "MissionSummary",
    "as_corrected",
    "as_printed",
    "mission_names",
    "mission_path",
    "mission_summary",
    "missions",
    "published",
    "published_names",
]
