"""The missions of a comparison: files, shipped ones, folders, families of random ones."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator
from glob import glob
from pathlib import Path

from muster.generation.generate import generate
from muster.generation.registry import GENERATORS
from muster.library import mission_names
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.mission.yaml_writer import YAML_SUFFIXES
from muster.planning.loading import load
from muster_studies.comparison.specs import Spec, listed, spec_of

MissionSpec = str | Path | Mission
"""A mission, a file, a pattern of files, a folder of mission files, a shipped name, or a family of random missions
with its parameters: `uniform:tasks=40:count=20`. A text may hold several, with commas between them."""


def missions_of(given: MissionSpec | Iterable[MissionSpec]) -> dict[str, Mission]:
    """The missions that are meant, by name.

    Raises
    ------
    MissionError, ParameterError
        if one cannot be read or made, there is none, or two that differ have one name.
    """
    found: dict[str, Mission] = {}
    for mission in _each([given] if isinstance(given, str | Path | Mission) else given):
        if found.get(mission.name, mission) != mission:
            raise ParameterError(f"missions: two have the name {mission.name}; expected names of their own")
        found[mission.name] = mission
    if not found:
        raise ParameterError("missions: none; expected one at least")
    return found


def _each(given: Iterable[MissionSpec]) -> Iterator[Mission]:
    for one in given:
        if isinstance(one, Mission):
            yield one
        elif isinstance(one, Path):
            yield from _of_path(one)
        elif isinstance(one, str):
            yield from _of_path(Path(one)) if Path(one).exists() else _of_texts(listed([one]))
        else:
            raise ParameterError(f"missions: {shown(one)}; expected a Mission, a file, a name or a family")


def _of_texts(texts: Iterable[str]) -> Iterator[Mission]:
    for text in texts:
        if Path(text).exists():
            yield from _of_path(Path(text))
        elif any(sign in text for sign in "*?["):
            yield from _of_pattern(text)
        elif text in mission_names():
            if text in GENERATORS:
                logging.getLogger("muster").warning(
                    "missions: %s: the shipped mission; the family is %s:seed=0", text, text
                )
            yield load(text)
        else:
            yield from _of_family(text)


def _of_family(text: str) -> Iterator[Mission]:
    """The random missions of a family; anything else is read as a file, which says what is wrong."""
    spec = spec_of(text) if ":" in text else Spec(text)
    if spec.name in GENERATORS:
        yield from generate(spec.name, **spec.values)
    elif Path(text).suffix or not (hint := did_you_mean(spec.name, [*GENERATORS, *mission_names()])):
        yield load(text)
    else:
        raise ParameterError(f"missions: {text}; expected a file, a shipped mission or a family{hint}")


def _of_pattern(pattern: str) -> Iterator[Mission]:
    files = sorted(glob(pattern, recursive=True))  # noqa: PTH207  (absolute patterns too)
    if not files:
        raise ParameterError(f"missions: {pattern}; expected a pattern that a file has")
    return (mission for file in files for mission in _of_path(Path(file)))


def _of_path(path: Path) -> Iterator[Mission]:
    """The mission of a file; those of a folder of mission files; a folder of anything else as `load` reads it."""
    inside = sorted(file for file in path.iterdir() if file.suffix.lower() in YAML_SUFFIXES) if path.is_dir() else []
    for file in inside or [path]:
        yield load(file)
