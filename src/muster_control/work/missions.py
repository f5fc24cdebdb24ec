"""Reads the missions and plans of a worker's tasks, in its own folder and from no other."""

from __future__ import annotations

import base64
import os
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA, Mission
from muster.mission.plan import Plan
from muster.mission.reading.from_data import mission_from
from muster.mission.reading.plan_reader import plan_from
from muster.mission.reading.yaml_reader import parse_data
from muster.mission.records import findings
from muster.mission.value_types import Fault, shown
from muster.mission.value_types import Path as Keys
from muster.mission.yaml_writer import YAML_SUFFIXES

_HALF_CHARACTER = re.compile("[\ud800-\udfff]")
_HERE = "mission"  # the folder of the mission's own file, within the worker's


def mission_of(given: Mapping[str, Any]) -> Mission:
    """The mission in `{"text", "files", "name"}`: its YAML, and the files that it names (base64, by name).

    The files are written into a subfolder of the working directory, which becomes the working directory.

    Raises
    ------
    MissionError
        with everything that is wrong with it; also if it names a file that is not among `files`.
    """
    files = written_files(given.get("files") or {})
    file = _file_name(str(given.get("name") or "mission"))
    text = given["text"]
    if _HALF_CHARACTER.search(text):
        raise MissionError([Finding(str(file), None, "", "half a character", "a text that UTF-8 can hold")])
    data, source, faults = parse_data(text, file, "a mission: schema, robots, tasks")
    astray = list(_astray(data, files))
    if astray:
        raise MissionError(findings(astray, source))
    if "schema" not in data:
        faults.append(Fault(("schema",), "missing", SCHEMA))
    return mission_from(data, source, faults)


def plan_of(given: object, name: str = "plan") -> Plan:
    """The plan in plain data, as a plan file holds it.

    Raises
    ------
    PlanError
        with everything that is wrong with it.
    """
    return plan_from(given, name)


def written_files(files: Mapping[str, str]) -> frozenset[str]:
    """Write files (base64, by name) into the folder of the mission and change to it; returns their paths.

    Raises
    ------
    MissionError
        for a name that leads out of the folder.
    """
    Path(_HERE).mkdir()
    places = {name: Path(_normal(Path(_HERE, name))) for name in files}
    for name, place in places.items():
        if place.is_absolute() or not place.parts or place.parts[0] == ".." or not name.isprintable():
            expected = "a name of a file beside the mission"
            raise MissionError([Finding(shown(name), None, "", "leads elsewhere", expected)])
    for name, place in places.items():
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(base64.b64decode(files[name], validate=True))
        except (OSError, ValueError) as error:
            raise MissionError([Finding(shown(name), None, "", str(error), "a file in base64")]) from None
    os.chdir(_HERE)
    return frozenset(map(_normal, files))


def _normal(name: str | Path) -> str:
    """A normalised file name."""
    return os.path.normpath(name)


def _file_name(name: str) -> Path:
    """The file name of a mission in messages."""
    plain = name.isprintable() and "/" not in name and not name.startswith(".")
    stem = name if plain else "mission"
    return Path(stem if stem.endswith(YAML_SUFFIXES) else f"{stem}.yaml")


def _astray(data: Mapping[str, Any], files: Collection[str]) -> Iterator[Fault]:
    """Faults for files that a mission names and that were not sent with it."""
    for keys, name in _named(data):
        if _normal(name) not in files:
            yield Fault(keys, shown(name), "one of the files that are with the mission")
            continue
        picture = _picture_of_map(name) if keys[-1] == "ros_yaml" else None
        if picture is not None and _normal(Path(name).parent / picture) not in files:
            yield Fault(keys, f"{shown(name)}, whose image is {shown(picture)}", "an image that is with the mission")


def _named(data: Mapping[str, Any]) -> Iterator[tuple[Keys, str]]:
    """All values of a mission that name files."""
    for group, keys in (("map", ("ros_yaml", "image")), ("travel", None)):
        table = data.get(group)
        if isinstance(table, dict):
            for key, value in table.items():
                if isinstance(value, str) and (keys is None or key in keys):
                    yield (group, key), value


def _picture_of_map(name: str) -> str | None:
    """The image that a map file of ROS names; None if it cannot be read, which is reported where the map is used."""
    from muster.motion.maps.ros_yaml import read_ros_map

    try:
        return read_ros_map(Path(name)).image
    except MissionError:
        return None
