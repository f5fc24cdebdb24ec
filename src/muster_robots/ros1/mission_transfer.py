"""Transfers missions between processes, and reads those that users set on the parameter server."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.reading.thesis_csv import read_csv_for
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.texts.text_files import read_text
from muster.mission.value_types import shown
from muster.mission.yaml_writer import YAML_SUFFIXES, yaml_text
from muster_robots.ros1.ros import rospy

Heard = Callable[[int], Sequence[Mapping[str, object]]]
"""Gives the robots that are heard, with keys of a mission file, by the number of coordinates of a position."""
Load = Callable[[str], Mission]
"""Muster's own loader: of a file, or of the name of a shipped mission."""


def packed(mission: Mission) -> dict[str, Any]:
    """A mission as JSON can hold it: YAML, and the file from whose folder other files are found."""
    return {"file": str(Path(mission.source.file).absolute()), "text": yaml_text(mission)}


def unpacked(parcel: Mapping[str, Any]) -> Mission:
    """The inverse of `packed`."""
    return parse_yaml(parcel["text"], Path(parcel["file"]))


def mission_on(parameter: str, load: Load, heard: Heard) -> Mission:
    """The mission that a parameter holds or names.

    It may be the text of a mission file, the mapping that `rosparam load` makes of one, the name of a shipped mission,
    or the path of a file. A task list (.csv) and a mission without robots are for the robots that are heard.

    Parameters
    ----------
    parameter
        its name; the parameter `suitability` beside it names the table of suitability of a task list.
    heard
        gives those robots.

    Raises
    ------
    MusterError
        with all that is wrong with it, or if there is none.
    """
    said: Any = rospy.get_param(parameter, None)
    if isinstance(said, dict):
        said = json.dumps(said)
    if not isinstance(said, str) or not said.strip():
        expected = "a mission in YAML, the name of a shipped one, or the path of a file"
        raise MusterError(f"{parameter}: {'missing' if said is None else shown(said)}; expected {expected}")
    if "\n" in said or said.lstrip().startswith("{"):
        return parse_yaml(said, Path(parameter), heard)
    path = Path(said)
    if path.suffix.lower() == ".csv":
        table = rospy.get_param(f"{parameter.rpartition('/')[0]}/suitability", None)
        return read_csv_for(heard, path, None if table is None else Path(str(table)))
    if path.suffix.lower() in YAML_SUFFIXES and path.is_file():
        return parse_yaml(read_text(path), path, heard)
    return load(said)


def in_lines(error: MusterError) -> str:
    """What is wrong, for the message of a service: one finding a line, and not hundreds."""
    lines = str(error).splitlines()
    more = [f"and {len(lines) - _MOST} more"] if len(lines) > _MOST else []
    return "\n".join(lines[:_MOST] + more)


_MOST = 20
