"""The base of the model's classes: each field is declared once, with the kind of its value.

From that one declaration follow reading a file, checking a mission built in Python, writing, the "did you mean" of
unknown keys, the help of the class and the published JSON Schema, so that these cannot disagree.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from typing import Any, ClassVar, TypeVar, dataclass_transform

from muster.mission.errors import Finding, MissionError
from muster.mission.field_help import fields_text
from muster.mission.keywords import require_known
from muster.mission.near_matches import did_you_mean
from muster.mission.source import IN_PYTHON, Source
from muster.mission.value_types import (
    INVALID,
    OTHER_NAMES,
    RESERVED_NAMES,
    Fault,
    JsonSchema,
    Key,
    Kind,
    Path,
    Table,
    refuse,
    shown,
)

C = TypeVar("C")
_SPECIFIED: dict[type[Any], tuple[Field[Any], ...]] = {}


def spec(
    kind: Kind,
    doc: str,
    *,
    default: Any = MISSING,
    unit: str = "",
    instead: tuple[str, Kind, str] | None = None,
    if_used: bool = False,
    key: str = "",
) -> Any:
    """A dataclass field whose values are of `kind`; without `default` it is required.

    Parameters
    ----------
    unit
        of the value, for the help of the class, where the name of the field does not say it.
    instead
        a key of files, its kind and description, that may stand for the field: places in degrees, clock times. They are
        replaced before; `Record` never gets to read the key.
    if_used
        whether tables show it only where some record has it.
    key
        what files call it, where Python keeps the word for itself (`from`); by default the field's name.
    """
    metadata: dict[str, Any] = {"kind": kind, "doc": doc, "unit": unit, "if_used": if_used}
    metadata |= {"key": key} if key else {}
    metadata |= {"instead": instead} if instead else {}
    hashed = False if isinstance(kind, Table) else None  # a mapping has no hash
    if default is MISSING:
        return field(metadata=metadata, hash=hashed)
    return field(default=default, metadata=metadata, hash=hashed)


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(spec, field))
def record(cls: type[C]) -> type[C]:
    """Make a class of fields made by `spec` a frozen, keyword-only dataclass whose help tells of each field."""
    made: Any = dataclass(frozen=True, kw_only=True)(cls)
    made.__init__ = _naming_unknown_fields(made.__init__, made)
    made.__doc__ = f"{cls.__doc__}\n\n{fields_text(specified(made))}"
    return cls


def _naming_unknown_fields(init: Callable[..., None], cls: type[Any]) -> Callable[..., None]:
    @functools.wraps(init)
    def checked(self: Any, *args: Any, **values: Any) -> None:
        try:
            init(self, *args, **values)
        except TypeError:
            require_known(values, [f.name for f in fields(cls)], cls.__name__)
            raise

    return checked


def specified(cls: type[Any]) -> tuple[Field[Any], ...]:
    """The fields of a model class that a file may hold, in order."""
    if cls not in _SPECIFIED:  # looked up for each record that is made
        _SPECIFIED[cls] = tuple(f for f in fields(cls) if "kind" in f.metadata)
    return _SPECIFIED[cls]


def key_of(f: Field[Any]) -> str:
    """What files call a field."""
    return str(f.metadata.get("key", f.name))


def shown_if_used(cls: type[Any]) -> tuple[str, ...]:
    """The names of the fields that tables show only where some record has them."""
    return tuple(f.name for f in specified(cls) if f.metadata["if_used"])


def required(f: Field[Any]) -> bool:
    """Whether a file must hold the field."""
    return f.default is MISSING and f.default_factory is MISSING


class Checked:
    """Checks and converts the fields of a model class by their kinds when one is made in Python."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __post_init__(self) -> None:
        faults: list[Fault] = []
        for f in specified(type(self)):
            value = getattr(self, f.name)
            if value is None and f.default is None:
                continue
            object.__setattr__(self, f.name, f.metadata["kind"].read(value, (key_of(f),), faults))
        if not faults:
            for name, value in self.settled(self.__dict__).items():
                object.__setattr__(self, name, value)
            faults.extend(self.cross_check(self.__dict__))
        if faults:
            raise MissionError(findings(faults, IN_PYTHON))

    @classmethod
    def settled(cls, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """The fields that hold something else than the keys of the same name: their values, from those of the keys."""
        return {}

    def file_values(self) -> Mapping[str, Any]:
        """The inverse of `settled`: the values of keys that are not those of the fields of the same name."""
        return {}

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        """Faults that lie between fields; `values` holds the fields that are given."""
        return ()

    @classmethod
    def schema_extra(cls) -> JsonSchema:
        """What its JSON Schema holds besides its fields."""
        return {}

    @classmethod
    def further_keys(cls, data: Mapping[Any, Any]) -> Mapping[str, Key]:
        """Keys that a file may hold besides the fields, in view of its other keys; their values go into `extra`."""
        return {}


@dataclass(frozen=True)
class Record:
    """A mapping with known keys: one of the model's dataclasses.

    Always reads to an instance. Where a value is wrong, a filler stands in its place, so that the rest can still be
    checked; whoever reads looks at `faults` before using the instance. INVALID in the data was refused before.
    """

    of: type[Checked]
    what: str
    filler: ClassVar[None] = None

    @property
    def expected(self) -> str:
        keys = [key_of(f) for f in specified(self.of) if required(f)]
        if keys:
            return f"{self.what} with the keys {', '.join(keys)}"
        return f"{self.what} with some of the keys {', '.join(map(key_of, specified(self.of)))}"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, self.of):
            return value
        if not isinstance(value, Mapping):
            refuse(self, value, at, faults)
            return self._instance({})
        before = len(faults)
        known = {key_of(f): f for f in specified(self.of)}
        further = {key: one.kind for key, one in self.of.further_keys(value).items()}
        names = (*known, *further)
        hints = (*names, *(f.metadata["instead"][0] for f in known.values() if "instead" in f.metadata))
        faults.extend(_unknown_key(str(key), item, at, hints) for key, item in value.items() if key not in names)
        values = _read_further(further, value, at, faults)
        for name, f in known.items():
            item = value.get(name, INVALID)
            if name in value and not (item is None and f.default is None):
                read = INVALID if item is INVALID else f.metadata["kind"].read(item, (*at, name), faults)
                values[f.name] = read
            elif required(f):
                faults.append(Fault((*at, name), "missing", f.metadata["kind"].expected))
        whole = len(faults) == before and not any(item is INVALID for item in values.values())
        values |= self.of.settled({key: item for key, item in values.items() if item is not INVALID})
        if whole:
            faults.extend(Fault((*at, *f.path), f.value, f.expected) for f in self.of.cross_check(values))
        return self._instance(values)

    def schema(self) -> JsonSchema:
        """A reference to the definition that `json_schema` makes of the class."""
        return {"$ref": f"#/$defs/{self.of.__name__}"}

    def _instance(self, values: Mapping[str, Any]) -> Any:
        """An instance made without checks: they have just been made, and all faults are on the list."""
        instance = object.__new__(self.of)
        for f in fields(self.of):
            value = values.get(f.name, INVALID)
            if value is INVALID:
                value = f.metadata["kind"].filler if required(f) else _default(f)
            object.__setattr__(instance, f.name, value)
        return instance


def _read_further(kinds: Mapping[str, Kind], data: Mapping[str, Any], at: Path, faults: list[Fault]) -> dict[str, Any]:
    """The values of keys that are not fields, as the field `extra`; nothing where there are none."""
    read = {key: kinds[key].read(data[key], (*at, key), faults) for key in kinds if data.get(key) is not None}
    return {"extra": {key: value for key, value in read.items() if value is not INVALID}} if read else {}


def _default(f: Field[Any]) -> Any:
    return f.default if f.default_factory is MISSING else f.default_factory()


def _unknown_key(key: str, value: object, at: Path, known: Iterable[str]) -> Fault:
    if key in RESERVED_NAMES:
        return Fault((*at, key), shown(value), "no such key: the name is kept for a later version")
    if key == "<<":
        return Fault((*at, key), "unknown key", "the keys themselves: merge keys are no part of YAML 1.2")
    if key in OTHER_NAMES:
        return Fault((*at, key), "unknown key", OTHER_NAMES[key])
    hint = did_you_mean(key, known) or f"; known keys: {', '.join(known)}"
    return Fault((*at, key), "unknown key", f"a known key{hint}")


def findings(faults: Iterable[Fault], source: Source) -> list[Finding]:
    """Faults as findings: with file and line, in the order of the files."""
    found = [Finding(*source.place(fault.path), path_text(fault.path), fault.value, fault.expected) for fault in faults]
    return sorted(found, key=lambda finding: (finding.file, finding.line or 0))


def path_text(path: Path) -> str:
    """`("tasks", 3, "position")` as `tasks[3].position`."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text and step else step
    return text
