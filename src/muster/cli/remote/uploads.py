"""Missions and plans on their way to a server."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import click

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.yaml_writer import yaml_text

if TYPE_CHECKING:
    from muster.client import Client
    from muster.client.client import MissionText
    from muster.exchange.mission_control import PlanEntry


def parcel(mission: Mission) -> tuple[str, dict[str, bytes]]:
    """A mission's text, and the files that it names by their names, without folders.

    The text is that of its file; it is written anew where the file is no YAML, or names what is not beside it.

    Raises
    ------
    ParameterError
        if the image of a ROS map lies elsewhere than beside the map's file.
    OSError
        if a file cannot be read.
    """
    file, names = Path(mission.source.file), _names(mission)
    as_it_is = all(name == there for name, there in names.items()) and file.suffix.lower() in (".yaml", ".yml")
    text = file.read_text(encoding="utf-8-sig") if as_it_is else yaml_text(_moved(mission, names))
    files = {there: (file.parent / name).read_bytes() for name, there in names.items()}
    if mission.map is not None and mission.map.ros_yaml is not None:
        files |= [_image_of_ros_map(file.parent / mission.map.ros_yaml)]
    return text, files


def kept(control: Client, mission: Mission, *, verbose: bool = False) -> MissionText:
    """The mission as the server keeps it.

    Where it is there already, that is used; where we were the last to save one of its name, it gets a new version;
    otherwise it is a new mission: those of others stay as they are.
    """
    text, files = parcel(mission)
    same_name = [entry.id for entry in control.missions.list() if mission.name in (entry.id, entry.name)]
    there = [control.missions.get(mission_id) for mission_id in same_name]
    found = next((old for old in there if old.text == text and _same_files(control, old, files)), None)
    if found is None:
        me = control.me()["name"]
        ours = next((old for old in there if old.author == me), None)
        if ours is not None:
            found = control.missions.save(ours.mission, text, ours.version, files, "sent by the command")
        else:
            found = control.missions.create(text, files)
    if verbose:
        click.echo(f"the server has it as mission {found.mission}, version {found.version}", err=True)
    return found


def kept_plan(control: Client, mission: Mission, plan: Plan, *, verbose: bool = False) -> PlanEntry:
    """The plan as the server keeps it, with its mission."""
    entry = control.plans.upload(kept(control, mission, verbose=verbose).mission, plan.as_dict())
    if verbose:
        click.echo(f"the server has it as plan {entry.id}", err=True)
    return entry


def _same_files(control: Client, old: MissionText, files: dict[str, bytes]) -> bool:
    if dict(old.files) != {name: len(data) for name, data in files.items()}:
        return False
    return all(control.missions.file(old.mission, name) == data for name, data in files.items())


def _moved(mission: Mission, names: Mapping[str, str]) -> Mission:
    """The mission with its files called otherwise."""
    chart, travel = mission.map, mission.travel
    if chart is not None:
        image, ros_yaml = (name and names[name] for name in (chart.image, chart.ros_yaml))
        chart = replace(chart, image=image, ros_yaml=ros_yaml)
    if travel is not None:
        travel = {kind: names[name] for kind, name in travel.items()}
    return replace(mission, map=chart, travel=travel)


def _names(mission: Mission) -> dict[str, str]:
    """What each file that a mission names is called at a server, which has no folders."""
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
