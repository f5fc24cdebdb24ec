"""The task that checks a planning request before it is queued: its allocator and parameters."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_named
from muster.mission.errors import ParameterError
from muster.planning.options import PlanningOptions, options_from


def run(arguments: Mapping[str, Any], report: Callable[[dict[str, Any]], None]) -> dict[str, Any]:
    """The options of a planning request, by name -> `{}`; raises the errors of the command."""
    checked_options(arguments)
    return {}


def checked_options(given: Mapping[str, Any]) -> PlanningOptions:
    """The options of a planning request, with parameters that the allocator has and a server allows.

    Raises
    ------
    ParameterError
    """
    options = options_from(given)
    make_parameters(allocator_named(str(options.allocator)), dict(options.parameters))
    _require_modest(options.parameters)
    return options


def _require_modest(parameters: Mapping[str, Any]) -> None:
    """Refuse more threads than processors, and clusters."""
    if parameters.get("ray", "none") != "none":
        raise ParameterError("ray: given; expected no cluster of a plan that a server makes")
    threads, most = parameters.get("threads", 1), os.cpu_count() or 1
    if isinstance(threads, int) and threads > most:
        raise ParameterError(f"threads: {threads}; expected at most {most}, the processors of this server")
