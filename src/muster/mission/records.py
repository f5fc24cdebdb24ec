"""The base of the model's classes: each field is declared once, with the kind of its value.

From that one declaration follow reading a file, checking a mission built in Python, writing, the "did you mean" of
unknown keys, the help of the class and the published JSON Schema, so that these cannot disagree.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from functools import partial
from typing import Any, ClassVar, NamedTuple, TypeVar, dataclass_transform

from muster.mission.errors import Finding, MissionError, MusterError, ParameterError
from muster.mission.source import IN_PYTHON, Source
from muster.mission.texts.near_matches import did_you_mean
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
    read_column,
    refuse,
    shown,
)
from muster.mission.values.field_help import fields_text
from muster.mission.values.keywords import require_known

C = TypeVar("C")
_SPECIFIED: dict[type[Any], tuple[Field[Any], ...]] = {}
_MISSING = object()
Instead = tuple[str, Kind, str]
"""A key of files that may stand for another: its name, the kind of its value, and what it means."""


class Check(NamedTuple):
    """A field that is checked when an instance is made: its name, the kind of its values, its default and its path."""

    name: str
    kind: Kind
    default: Any
    at: Path


_CHECKS: dict[type[Any], tuple[Check, ...]] = {}
_Fillers = tuple[tuple[str, Callable[[], Any]], ...]


def spec(
    kind: Kind,
    doc: str,
    *,
    default: Any = MISSING,
    unit: str = "",
    instead: Instead | tuple[Instead, ...] | None = None,
    unless: JsonSchema | None = None,
    if_used: bool = False,
    key: str = "",
    **more: Any,
) -> Any:
    """A dataclass field whose values are of `kind`; without `default` it is required.

    Parameters
    ----------
    unit
        of the value, for the help of the class, where the name of the field does not say it.
    instead
        a key of files, its kind and description, or several such, that may stand for the field: places in degrees,
        clock times. They are replaced before; `Record` never gets to read the key.
    unless
        the JSON Schema of records of which files may leave the field out, though it is required: it follows from others
        and is put in before.
    if_used
        whether tables show it only where some record has it.
    key
        what files call it, where Python keeps the word for itself (`from`); by default the field's name.
    more
        further metadata: how a command calls it, where the field counts; `beside` is the field without which it has no
        meaning.
    """
    metadata: dict[str, Any] = {"kind": kind, "doc": doc, "unit": unit, "if_used": if_used} | more
    metadata |= {"key": key} if key else {}
    metadata |= {"instead": instead if isinstance(instead[0], tuple) else (instead,)} if instead else {}
    metadata |= {"unless": unless} if unless else {}
    hashed = False if isinstance(kind, Table) else None  # a mapping has no hash
    if default is MISSING:
        return field(metadata=metadata, hash=hashed)
    return field(default=default, metadata=metadata, hash=hashed)


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(spec, field))
def record(cls: type[C]) -> type[C]:
    """Make a class of fields made by `spec` a frozen, keyword-only dataclass whose help tells of each field."""
    made: Any = dataclass(frozen=True, kw_only=True)(cls)
    made.__init__ = _naming_unknown_fields(made.__init__, made)
    made.__doc__ = _with_parameters(inspect.cleandoc(cls.__doc__ or ""), fields_text(_told(made)))
    return cls


def _told(cls: type[Any]) -> tuple[Field[Any], ...]:
    """The fields of which the help of a class tells."""
    return (*specified(cls), *(f for f in fields(cls) if "doc" in f.metadata and "kind" not in f.metadata))


def _with_parameters(words: str, parameters: str) -> str:
    """A docstring with the section of its parameters, which comes before that of its errors."""
    summary, errors, raised = words.partition("\n\nRaises\n")
    return f"{summary}\n\n{parameters.strip()}{errors}{raised}"


def _naming_unknown_fields(init: Callable[..., None], cls: Any) -> Callable[..., None]:
    @functools.wraps(init)
    def checked(self: Any, *args: Any, **values: Any) -> None:
        try:
            init(self, *args, **values)
        except TypeError:
            require_known(values, [f.name for f in fields(cls)], cls.called())
            raise

    return checked


def specified(cls: type[Any]) -> tuple[Field[Any], ...]:
    """The fields of a model class that a file may hold, in order."""
    if cls not in _SPECIFIED:  # looked up for each record that is made
        _SPECIFIED[cls] = tuple(f for f in fields(cls) if "kind" in f.metadata)
    return _SPECIFIED[cls]


def checks_of(cls: type[Any]) -> tuple[Check, ...]:
    """Return what is checked of the fields of a class when an instance is made in Python."""
    if cls not in _CHECKS:
        _CHECKS[cls] = tuple(Check(f.name, f.metadata["kind"], f.default, (key_of(f),)) for f in specified(cls))
    return _CHECKS[cls]


def all_keys(cls: type[Any]) -> tuple[Field[Any], ...]:
    """Its fields that a file may hold, and those of the classes beside it."""
    return (*specified(cls), *(f for part in cls.beside() for f in specified(part)))


def key_of(f: Field[Any]) -> str:
    """What files call a field."""
    return str(f.metadata.get("key", f.name))


def shown_if_used(cls: type[Any]) -> tuple[str, ...]:
    """The names of the fields that tables show only where some record has them."""
    return tuple(f.name for f in all_keys(cls) if f.metadata["if_used"])


def instead_of(f: Field[Any]) -> tuple[Instead, ...]:
    """The keys of files that may stand for a field."""
    return tuple(f.metadata.get("instead", ()))


def required(f: Field[Any]) -> bool:
    """Whether a file must hold the field."""
    return f.default is MISSING and f.default_factory is MISSING


class Checked:
    """Checks and converts the fields of a model class by their kinds when one is made in Python."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    tied: ClassVar[frozenset[str] | None] = None
    """The fields without any of which `settled` and `cross_check` have nothing to do; None: they always have."""

    def __post_init__(self) -> None:
        self._check(checks_of(type(self)))

    def _check(self, checks: Iterable[Check]) -> None:
        """Read some fields, and check what lies between all of them."""
        faults: list[Fault] = []
        for name, kind, default, at in checks:
            value = getattr(self, name)
            if value is not default:  # a default is a value that is read as itself
                object.__setattr__(self, name, kind.read(value, at, faults))
        if not faults:
            for name, value in self.settled(self.__dict__).items():
                object.__setattr__(self, name, value)
            faults.extend(self.cross_check(self.__dict__))
        if faults:
            raise self.refusal(faults)

    @classmethod
    def refusal(cls, faults: Sequence[Fault]) -> MusterError:
        """Return the error of wrong values."""
        return MissionError(findings(faults, IN_PYTHON))

    @classmethod
    def called(cls) -> str:
        """Return how messages about unknown fields call the class; empty where they name the field alone."""
        return cls.__name__

    @classmethod
    def is_tied(cls, given: Iterable[str]) -> bool:
        """Whether `settled` and `cross_check` have anything to do where these fields are given."""
        return cls.tied is None or not cls.tied.isdisjoint(given)

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

    @classmethod
    def beside(cls) -> tuple[type[Checked], ...]:
        """The classes of which a file may hold the fields besides its own; their values go into `extra`, too."""
        return ()


class Settings(Checked):
    """Base of classes whose fields are parameters of a function or command: a wrong value is a `ParameterError`.

    The message is the same whether a value comes from Python, from a command line or from a request to a server.
    """

    @classmethod
    def refusal(cls, faults: Sequence[Fault]) -> MusterError:
        """See `Checked`; the first fault alone."""
        fault = faults[0]
        return ParameterError(f"{path_text(fault.path)}: {fault.value}; expected {fault.expected}")

    @classmethod
    def called(cls) -> str:
        """See `Checked`."""
        return ""


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
        if type(value) is not dict and not isinstance(value, Mapping):
            refuse(self, value, at, faults)
            return self.instance({})
        before = len(faults)
        keys = _keys(self.of, tuple(value))
        further = self.of.further_keys(value)
        if keys.unknown:
            faults.extend(_unknown_keys(self.of, keys.unknown, further, value, at))
        values: dict[str, Any] = (
            {"extra": extra} if further and (extra := read_further(self.of, value, at, faults)) else {}
        )
        for name, kind, read_as, may_be_null in keys.fields:
            item = value.get(name, _MISSING)
            if item is _MISSING:
                faults.append(Fault((*at, name), "missing", kind.expected))
            elif item is INVALID:
                values[read_as] = INVALID
            elif not (item is None and may_be_null):
                values[read_as] = kind.read(item, (*at, name), faults)
        given = {name: item for name, item in values.items() if item is not INVALID}
        whole = len(faults) == before and len(given) == len(values)
        if self.of.is_tied(given):
            given |= self.of.settled(given)
            if whole:
                faults.extend(Fault((*at, *f.path), f.value, f.expected) for f in self.of.cross_check(given))
        return self.instance(given)

    def read_column(self, values: Sequence[Any]) -> Sequence[Any] | None:
        """By groups of the same keys, and in each of them key by key."""
        kinds = set(map(type, values))
        if kinds == {self.of}:
            return values
        if kinds != {dict}:
            return None
        groups: dict[tuple[Any, ...], list[int]] = {}
        for k, given in enumerate(map(tuple, values)):
            groups.setdefault(given, []).append(k)
        read: list[Any] = [None] * len(values)
        for given, members in groups.items():
            instances = self._read_group(given, [values[k] for k in members])
            if instances is None:
                return None
            for k, instance in zip(members, instances, strict=True):
                read[k] = instance
        return read

    def _read_group(self, keys: tuple[Any, ...], values: Sequence[dict[Any, Any]]) -> list[Any] | None:
        """Mappings that have the same keys."""
        wanted = _keys(self.of, keys)
        if wanted.unknown or not wanted.fields or len(wanted.fields) > len(keys):
            return None
        columns: list[Sequence[Any]] = []
        for name, kind, _, may_be_null in wanted.fields:
            given = [value[name] for value in values]
            column = None if may_be_null and None in given else read_column(kind, given)
            if column is None:
                return None
            columns.append(column)
        names = [key.read_as for key in wanted.fields]
        records = [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]
        if self.of.is_tied(names):
            for one in records:
                one |= self.of.settled(one)
                if any(self.of.cross_check(one)):
                    return None
        return list(map(self.instance, records))

    def schema(self) -> JsonSchema:
        """A reference to the definition that `json_schema` makes of the class."""
        return {"$ref": f"#/$defs/{self.of.__name__}"}

    def instance(self, given: dict[str, Any]) -> Any:
        """An instance made without checks: they have just been made, and all faults are on the list.

        It holds what is given; for all else the class has the default.
        """
        for name, filler in _fillers(self.of):
            if name not in given:
                given[name] = filler()
        instance = object.__new__(self.of)
        object.__setattr__(instance, "__dict__", given)
        return instance


class _FieldKey(NamedTuple):
    """A key of a file, with the kind of its value, the field that it is read as, and whether null stands for none."""

    name: str
    kind: Kind
    read_as: str
    may_be_null: bool


class _Keys(NamedTuple):
    """What the keys of a mapping mean to a class: its fields that are given or required, in order; and the others."""

    fields: tuple[_FieldKey, ...]
    unknown: tuple[Any, ...]


def _keys(cls: type[Checked], given: tuple[Any, ...]) -> _Keys:
    """Most records of a file have the same keys, so this is found once for all of them."""
    if (found := _KEYS.get((cls, given))) is None:
        known = {key_of(f): f for f in specified(cls)}
        looked_up = [(name, f) for name, f in known.items() if name in given or required(f)]
        own = tuple(_FieldKey(name, f.metadata["kind"], f.name, f.default is None) for name, f in looked_up)
        found = _Keys(own, tuple(key for key in given if key not in known))
        if len(_KEYS) >= _MOST_KEYS:
            _KEYS.clear()
        _KEYS[cls, given] = found
    return found


_KEYS: dict[tuple[type[Checked], tuple[Any, ...]], _Keys] = {}
_MOST_KEYS = 4096  # a server reads the files of many


def _fillers(cls: type[Checked]) -> _Fillers:
    """What makes a value for a field that is not given, where the class itself has none."""
    if cls not in _FILLERS:
        own = [f for f in fields(cls) if f.default is MISSING]
        made = [(f.name, f.default_factory) for f in own if f.default_factory is not MISSING]
        required_ones = [(f.name, partial(getattr, f.metadata["kind"], "filler")) for f in own if required(f)]
        _FILLERS[cls] = (*required_ones, *made)
    return _FILLERS[cls]


_FILLERS: dict[type[Checked], _Fillers] = {}


def _unknown_keys(
    cls: type[Checked], unknown: Iterable[Any], further: Mapping[str, Key], data: Mapping[Any, Any], at: Path
) -> Iterator[Fault]:
    """The faults of keys that are none of the fields, nor further ones."""
    own = specified(cls)
    hints = (*map(key_of, own), *further, *(key for f in own for key, _, _ in instead_of(f)))
    return (_unknown_key(str(key), data[key], at, hints) for key in unknown if key not in further)


def read_further(cls: type[Checked], data: Mapping[str, Any], at: Path, faults: list[Fault]) -> dict[str, Any]:
    """The values of keys that are not fields, for the field `extra`."""
    keys, before = cls.further_keys(data), len(faults)
    given = {key: one for key, one in keys.items() if data.get(key) is not None}
    read = {key: one.kind.read(data[key], (*at, key), faults) for key, one in given.items()}
    if len(faults) == before:
        for part in cls.beside():
            faults.extend(replace(fault, path=(*at, *fault.path)) for fault in part.cross_check(_of(part, read)))
    return {key: value for key, value in read.items() if value is not INVALID}


def part_of(cls: type[C], extra: Mapping[str, Any]) -> C:
    """What `extra` holds of the keys of a class, which were checked when they were read, as an instance of it."""
    return Record(cls, cls.__name__).instance(_of(cls, extra))  # type: ignore[arg-type, no-any-return]


def _of(cls: type[Any], extra: Mapping[str, Any]) -> dict[str, Any]:
    return {f.name: extra[key_of(f)] for f in specified(cls) if key_of(f) in extra}


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
    found = [
        Finding(
            *source.place(fault.path),
            source.name_in_file(fault.path) or path_text(source.path(fault.path)),
            fault.value,
            fault.expected,
        )
        for fault in faults
    ]
    return sorted(dict.fromkeys(found), key=lambda finding: (finding.file, finding.line or 0))


def path_text(path: Path) -> str:
    """`("tasks", 3, "position")` as `tasks[3].position`."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text and step else step
    return text
