"""The kinds of values of a `RunRequest` that missions do not have."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from muster.mission.errors import ParameterError
from muster.mission.events import Event
from muster.mission.ignorable_rules import IGNORABLE, ignored_rules
from muster.mission.reading.order_files import OF_TASKS, OrderFile
from muster.mission.records import Record
from muster.mission.value_types import Fault, JsonSchema, Path, Table, is_list, refuse
from muster.planning.options import PlanningOptions, options_from

_EVENT = Record(Event, "an event")


@dataclass(frozen=True)
class ByRobot(Table):
    """A number by robot, or for `all`; none is an empty mapping.

    Attributes
    ----------
    all_alone : bool
        Whether a number alone, on a command line, is that of all robots.
    """

    all_alone: bool = False

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`."""
        return {} if isinstance(value, Mapping) and not value else super().read(value, at, faults)


class Rules:
    """The kind of rules to ignore: their names, or one of them."""

    filler: ClassVar[tuple[str, ...]] = ()
    expected = f"a list of {', '.join(IGNORABLE)}"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`; an unknown rule is a `ParameterError`."""
        if not isinstance(value, str) and not isinstance(value, Iterable):
            return refuse(self, value, at, faults)
        return ignored_rules(value)  # type: ignore[arg-type]

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "array", "items": {"enum": list(IGNORABLE)}}


class Replanning:
    """The kind of options of planning again."""

    filler: ClassVar[None] = None
    expected = "a mapping of options of planning"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`; an unknown or wrong option is a `ParameterError`."""
        if isinstance(value, PlanningOptions):
            return value
        return options_from(value) if isinstance(value, Mapping) else refuse(self, value, at, faults)

    def file_form(self, value: PlanningOptions) -> dict[str, Any]:
        """Return the options that are not the defaults."""
        usual, asked = PlanningOptions().as_dict(), value.as_dict()
        if not isinstance(value.allocator, str):
            raise ParameterError("allocator: a function; expected the name of an allocator of the server")
        return {name: item for name, item in asked.items() if item != usual[name]}

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "object"}


class Orders:
    """The kind of orders: events that concern tasks, as objects or plain data, or an iterable that has no end."""

    filler: ClassVar[tuple[()]] = ()
    expected = "a list of events that concern tasks"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`."""
        if isinstance(value, str | Mapping) or not isinstance(value, Iterable):
            return refuse(self, value, at, faults)
        if not is_list(value):
            return value  # read as time goes on
        events = [_EVENT.read(item, (*at, k), faults) for k, item in enumerate(value)]
        for k, event in enumerate(events):
            if isinstance(event, Event) and all(getattr(event, kind) is None for kind in OF_TASKS):
                faults.append(Fault((*at, k), "no order", f"one of {', '.join(OF_TASKS)}"))
        return tuple(events)

    def file_form(self, value: Iterable[Event]) -> tuple[Event, ...]:
        """Return the events; an iterable may be endless, so only lists and files have this form."""
        if not isinstance(value, OrderFile) and not is_list(value):
            raise ParameterError(f"orders: {type(value).__name__}; expected a list or a file of orders for a server")
        return tuple(value)

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "array", "items": {"type": "object"}}


class Sensors:
    """The kind of sensors by which robots localise themselves: names, or names with parameters."""

    filler: ClassVar[None] = None
    expected = "sensors: names, or a mapping from names to parameters"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`; an unknown sensor or wrong parameter is a `ParameterError`."""
        if isinstance(value, str):
            value = [name for name in value.split(",") if name]
        if is_list(value):
            value = {name: {} for name in value}
        if not isinstance(value, Mapping):
            return refuse(self, value, at, faults)
        if not value:
            return None
        from muster.running.localisation import sensors_of

        sensors_of(value)
        return value

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "object"}


class FleetSettings:
    """The kind of a fleet's settings: what the fleet declares, or plain data of it."""

    filler: ClassVar[Mapping[str, Any]] = {}
    expected = "settings of the fleet by name"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        """See `Kind`; `RunRequest` reads it as the fleet declares it."""
        known = isinstance(value, Mapping) or hasattr(type(value), "__dataclass_fields__")
        return value if known else refuse(self, value, at, faults)

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "object"}
