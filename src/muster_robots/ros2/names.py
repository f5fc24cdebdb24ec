"""Ids of a mission as valid ROS names of topics and frames."""

from __future__ import annotations

import re
from collections.abc import Iterable

from muster.mission.errors import ParameterError


def ros_name(name: str) -> str:
    """Letters, digits and underscores, not beginning with a digit, as names of topics have to be in ROS 1 and 2."""
    made = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return made if made[:1].isalpha() else f"r_{made.lstrip('_')}"


def ros_names(ids: Iterable[str]) -> dict[str, str]:
    """The name of each id.

    Raises
    ------
    ParameterError
        if two ids would have the same name.
    """
    names: dict[str, str] = {}
    for one in ids:
        same = [other for other, name in names.items() if name == ros_name(one)]
        if same:
            raise ParameterError(f"robots {same[0]!r} and {one!r}: both are {ros_name(one)} in ROS; expected other ids")
        names[one] = ros_name(one)
    return names
