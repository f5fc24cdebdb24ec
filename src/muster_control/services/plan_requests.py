"""Checks planning requests before they are queued, so that a wrong one is refused at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import shown
from muster.planning.options import options_from

PLANS = ("start", "fixed")
"""Plans that a request may name, by their ids."""
_LARGEST_ID = 2**63 - 1
_LONGEST_NAME = 200


def checked_request(asked: Mapping[str, Any], longest_s: float) -> None:
    """Refuse a planning request that no mission can meet; None stands for the default.

    Parameters
    ----------
    asked
        the options of a planning request, and the ids of the plans that it names.
    longest_s
        how long one job may take.

    Raises
    ------
    ParameterError
        naming the option, its value, and what was expected.
    """
    for name in PLANS:
        plan = asked.get(name)
        if plan is not None and (isinstance(plan, bool) or not isinstance(plan, int) or not 0 <= plan <= _LARGEST_ID):
            raise ParameterError(f"{name}: {shown(plan)}; expected the id of a plan")
    options = options_from({name: value for name, value in asked.items() if name not in PLANS})
    if not isinstance(options.allocator, str) or len(options.allocator) > _LONGEST_NAME:
        raise ParameterError(f"allocator: {shown(options.allocator)}; expected the name of an allocator")
    for name, value in options.parameters.items():
        if not 0 < len(name) <= _LONGEST_NAME or not isinstance(value, bool | int | float | str):
            raise ParameterError(f"parameters: {shown({name: value})}; expected names, and numbers or words")
    if options.time_limit is not None and options.time_limit > longest_s:
        raise ParameterError(
            f"time_limit: {options.time_limit:g}; expected at most {longest_s:g} s, the limit of this server"
        )
