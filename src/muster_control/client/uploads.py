"""A mission as it is sent to a server: its text, and the files that it names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.yaml_writer import YAML_SUFFIXES, yaml_text


def packed_mission(mission: Mission) -> tuple[str, dict[str, bytes]]:
    """A mission's text, and the files that it names by their names, without folders.

    The text is that of the mission's file, or written anew if the file is no YAML or names files of other folders.

    Raises
    ------
    ParameterError
        if the image of a ROS map lies elsewhere than beside the map's file.
    OSError
        if a file cannot be read.
    """
    file, names = Path(mission.source.file), _names(mission)
    as_it_is = all(name == there for name, there in names.items()) and file.suffix.lower() in YAML_SUFFIXES
    text = file.read_text(encoding="utf-8-sig") if as_it_is else yaml_text(_moved(mission, names))
    files = {there: (file.parent / name).read_bytes() for name, there in names.items()}
    if mission.map is not None and mission.map.ros_yaml is not None:
        files |= [_image_of_ros_map(file.parent / mission.map.ros_yaml)]
    return text, files


def _moved(mission: Mission, names: Mapping[str, str]) -> Mission:
    """The mission with its files renamed."""
    chart, travel = mission.map, mission.travel
    if chart is not None:
        image, ros_yaml = (name and names[name] for name in (chart.image, chart.ros_yaml))
        chart = replace(chart, image=image, ros_yaml=ros_yaml)
    if travel is not None:
        travel = {kind: names[name] for kind, name in travel.items()}
    return replace(mission, map=chart, travel=travel)


def _names(mission: Mission) -> dict[str, str]:
    """The name on the server, which has no folders, of each file that a mission names."""
    chart = mission.map
    named = [] if chart is None else [name for name in (chart.image, chart.ros_yaml) if name is not None]
    names: dict[str, str] = {}
    for name in dict.fromkeys((*named, *(mission.travel or {}).values())):
        plain = PurePosixPath(name).name
        names[name] = plain if plain not in names.values() else f"{len(names)}-{plain}"
    return names


def _image_of_ros_map(file: Path) -> tuple[str, bytes]:
    from muster.motion.maps.ros_yaml import read_ros_map

    image = read_ros_map(file).image
    if PurePosixPath(image).name != image:
        raise ParameterError(f"{file}: image: {image}; expected it beside the file, to be sent to a server")
    return image, (file.parent / image).read_bytes()
