"""The options of a planning request, checked without an allocator and without a mission.

Python, the command, the client and the server all make these options, so that all refuse the same values with the same
texts. No heavy module is imported.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import IGNORABLE, ignored_rules
from muster.mission.model import OBJECTIVES
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.value_types import shown
from muster.traffic.names import DEFAULT, TRAFFIC

if TYPE_CHECKING:
    from muster.allocation.algorithms.function_allocator import AllocatingFunction
    from muster.allocation.allocator import Allocator

DEFAULT_ALLOCATOR = "search"
BOUNDS = ("quick", "exact")
LARGEST_SEED = 2**64 - 1


def _option(default: Any, text: str) -> Any:
    """A field with the help text that the command and the description of the API show."""
    return field(default=default, metadata={"help": text})


@dataclass(frozen=True, kw_only=True)
class PlanningOptions:
    """How a mission is planned.

    Parameters
    ----------
    allocator
        the name of an algorithm (`muster solve --list-allocators`), an allocator, or a function that makes
        routes.
    parameters
        of the allocator, by name.
    objective
        instead of the mission's own.
    time_limit, iterations
        when an anytime allocator stops, in seconds and in iterations; 5 s if neither is given. With `iterations` alone
        the same seed gives the same plan.
    seed
        of all random choices.
    ignore
        rules that do not hold.
    bound
        `quick` or `exact`: prove how good the plan is, as its `lower_bound`.
    rewire
        fill waiting time with later tasks of the same robot.
    traffic
        `reserve`: routes spread over the passages for one that robots share, and the plan says how long it takes with
        its traffic; `free`: neither; `auto`: as `reserve` where the mission gives lanes or its map has such passages.

    Raises
    ------
    ParameterError
        for a value that no mission and no allocator can have.
    """

    allocator: str | Allocator | AllocatingFunction = _option(DEFAULT_ALLOCATOR, "The algorithm.")
    parameters: Mapping[str, Any] = field(
        default_factory=dict, metadata={"help": "Parameters of the allocator, by name."}
    )
    objective: str | None = _option(None, "Instead of the mission's own.")
    time_limit: float | None = _option(None, "Seconds of planning.")
    iterations: int | None = _option(None, "Stop after so many; then a seed gives one plan.")
    seed: int = _option(0, "Seed of all random choices.")
    ignore: tuple[str, ...] = _option((), "Rules that do not hold.")
    bound: str | None = _option(None, "Prove how good the plan is: at once, or by an exact solver.")
    rewire: bool = _option(False, "Fill waiting with later tasks of the same robot: sooner, for some usage.")
    traffic: str = _option(
        DEFAULT, "reserve: routes spread over passages for one; free: not; auto: where the mission has such passages."
    )

    def __post_init__(self) -> None:
        object.__setattr__(self, "ignore", _rules(self.ignore))
        for name, (fits, expected) in _KINDS.items():
            value = getattr(self, name)
            if not fits(value):
                raise ParameterError(f"{name}: {_shown(value)}; expected {expected}{_near(name, value)}")

    def as_dict(self) -> dict[str, Any]:
        """As plain data, from which `options_from` makes them again; an allocator must be a name."""
        data = {f.name: getattr(self, f.name) for f in fields(PlanningOptions)}
        return data | {"ignore": list(self.ignore), "parameters": dict(self.parameters)}


OPTIONS = tuple(f.name for f in fields(PlanningOptions))
HELP: Mapping[str, str] = {f.name: f.metadata["help"] for f in fields(PlanningOptions)}


def options_from(data: Mapping[str, Any]) -> PlanningOptions:
    """The options in plain data, where None stands for the default.

    Raises
    ------
    ParameterError
        for an unknown name, or as `PlanningOptions` does.
    """
    for name in data:
        if name not in OPTIONS:
            raise ParameterError(f"{shown(name)}: unknown; expected {', '.join(OPTIONS)}{did_you_mean(name, OPTIONS)}")
    return PlanningOptions(**{name: value for name, value in data.items() if value is not None})


def _rules(given: object) -> tuple[str, ...]:
    if isinstance(given, str) or not isinstance(given, Collection):
        raise ParameterError(f"ignore: {shown(given)}; expected a list of {', '.join(IGNORABLE)}")
    return ignored_rules(given)


def _is_allocator(value: object) -> bool:
    return bool(value) if isinstance(value, str) else callable(value) or hasattr(value, "algorithm")


def _is_time(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < math.inf)


def _is_whole(value: object, largest: float = math.inf) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= largest


def _are_parameters(value: object) -> bool:
    return isinstance(value, Mapping) and all(isinstance(name, str) for name in value)


_KINDS: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "allocator": (_is_allocator, "a name, an Allocator or a function"),
    "parameters": (_are_parameters, "names and values of the allocator's parameters"),
    "objective": (lambda value: value is None or value in OBJECTIVES, " or ".join(OBJECTIVES)),
    "time_limit": (_is_time, "seconds, at least 0"),
    "iterations": (lambda value: value is None or _is_whole(value), "a whole number of at least 0"),
    "seed": (lambda value: _is_whole(value, LARGEST_SEED), "a whole number from 0 to 2**64 - 1"),
    "bound": (lambda value: value is None or value in BOUNDS, " or ".join(BOUNDS)),
    "rewire": (lambda value: isinstance(value, bool), "true or false"),
    "traffic": (lambda value: value in TRAFFIC, " or ".join(TRAFFIC)),
}
_CHOICES: Mapping[str, tuple[str, ...]] = {"objective": OBJECTIVES, "bound": BOUNDS, "traffic": TRAFFIC}


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else shown(value)


def _near(name: str, value: object) -> str:
    return did_you_mean(value, _CHOICES[name]) if name in _CHOICES and isinstance(value, str) else ""
