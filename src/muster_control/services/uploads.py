"""Limits of uploaded missions: sizes, and names of files."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import Any

from muster.mission.errors import Finding, MissionError, ParameterError
from muster.mission.texts.text_files import LARGEST_FILE as LARGEST_FILES
from muster.mission.value_types import shown
from muster_files.sites.readers import READERS

LONGEST_TEXT = 16 * 2**20
MOST_FILES = 64
LONGEST_FILE_NAME = 120
FILE_NAME = r"[^\W_][\w. ()+-]*"
_EXPECTED_NAME = f"letters, digits, and ._-+() or spaces between, at most {LONGEST_FILE_NAME}, no folders"


def check_sizes(text: str, files: Mapping[str, bytes]) -> None:
    """Refuse missions that are too large, and file names that lead out of the mission's folder or are hidden.

    Raises
    ------
    ParameterError
        if something does not fit.
    """
    if len(text) > LONGEST_TEXT:
        raise ParameterError(f"a mission of {len(text)} characters; expected at most {LONGEST_TEXT}")
    if len(files) > MOST_FILES:
        raise ParameterError(f"a mission with {len(files)} files; expected at most {MOST_FILES}")
    size = sum(len(data) for data in files.values())
    if size > LARGEST_FILES:
        raise ParameterError(f"a mission with files of {size} bytes; expected at most {LARGEST_FILES}")
    for name in files:
        require_file_name(name)


def require_file_name(name: str) -> None:
    """Raise ParameterError unless a file of a mission may have this name."""
    if (
        len(name) > LONGEST_FILE_NAME
        or not re.fullmatch(FILE_NAME, name)
        or name.endswith((".", " "))
        or not name.isprintable()
    ):
        raise ParameterError(f"a file called {shown(name)}; expected {_EXPECTED_NAME}")


def mission_input(text: str, files: Mapping[str, bytes], name: str) -> dict[str, Any]:
    """A mission as an argument of worker tasks."""
    packed = {file: base64.b64encode(data).decode("ascii") for file, data in files.items()}
    return {"text": text, "files": packed, "name": name}


def as_text(name: str, data: bytes) -> str:
    """The text of a file.

    Raises
    ------
    MissionError
        if it is not UTF-8.
    """
    try:
        return data.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        line = 1 + data.count(b"\n", 0, error.start)
        found = Finding(name, line, "", f"byte {error.start} is not UTF-8", "a text in UTF-8")
        raise MissionError([found]) from None


def site_files(text: str, names: Iterable[str]) -> list[str]:
    """Which files beside a mission are of a site that is to be added to it: those that the mission does not name."""
    return [name for name in names if PurePath(name).suffix.lower().lstrip(".") in READERS and name not in text]


def answers_of(kinds: str, **survey: float | None) -> dict[str, Any]:
    """What a user says of a site, as arguments of the worker task `convert`; without what is not said.

    Parameters
    ----------
    kinds
        what features are: `Search areas=survey; drones=air`.
    survey
        `height_m`, `fov_deg` and `width_m` of areas to survey.

    Raises
    ------
    ParameterError
        for a text that does not name a feature and its kind.
    """
    found = {}
    for text in filter(None, map(str.strip, kinds.replace("\n", ";").split(";"))):
        name, equals, kind = text.removeprefix("--as ").strip("\"' ").rpartition("=")
        if not equals or not name or not kind:
            raise ParameterError(f"as: {shown(text)}; expected NAME=KIND, as Search areas=survey")
        found[name.strip()] = kind.strip()
    stated = {key: value for key, value in survey.items() if value is not None}
    return ({"kinds": found} if found else {}) | stated


def findings_of(errors: list[dict[str, Any]]) -> list[Finding]:
    """The findings of a worker."""
    return [Finding(**error) for error in errors]
