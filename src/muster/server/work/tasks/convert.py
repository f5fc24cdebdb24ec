"""The task that converts files of other programs to missions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from muster import load
from muster.mission.errors import Finding, MissionError
from muster.mission.value_types import shown
from muster.mission.yaml_writer import yaml_text
from muster.server.work.missions import written_files

_SUFFIXES = (".csv", ".tsp", ".atsp", ".vrp", ".txt", ".plan")
_OPTIONS = ("robots", "suitability", "salesmen", "depot")


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """`{"name", "files", ...}` -> `{"text", "name", "needs"}`: a mission as YAML, its name, the files that it names.

    `name` is which of `files` (base64, by name) is the mission: a task-list CSV, with `robots` and perhaps
    `suitability`, which name others of them; an instance file, perhaps with `salesmen` and `depot`, of which TSPLIB
    needs the first; a `.plan` of QGroundControl, of which all `.plan` files are taken together.
    """
    name, files = arguments["name"], arguments["files"]
    options = {key: arguments[key] for key in _OPTIONS if arguments.get(key) is not None}
    for key in (name, *(options[key] for key in ("robots", "suitability") if key in options)):
        if key not in files or "/" in key:
            raise MissionError([Finding(shown(key), None, "", "no such file", "one of the files that were given")])
    path = Path(name)
    if path.suffix.lower() not in _SUFFIXES:
        raise MissionError([Finding(shown(name), None, "", "not known", f"a file in {', '.join(_SUFFIXES)}")])
    written_files(files)
    mission = load(_folder_of_plans(files) if path.suffix.lower() == ".plan" else path, **options)
    return {"text": yaml_text(mission), "name": mission.name, "needs": sorted(set((mission.travel or {}).values()))}


def _folder_of_plans(files: Mapping[str, str]) -> Path:
    """The one plan that was given; or where they all are."""
    plans = [name for name in files if name.lower().endswith(".plan")]
    return Path(plans[0]) if len(plans) == 1 else Path()
