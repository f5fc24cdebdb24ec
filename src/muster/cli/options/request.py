"""Options of verbs that follow from the fields of a request: names, units, defaults and help are those of the fields.

The verb gets plain data by field, and the request made of it refuses what is wrong, with the words of Python and of a
server.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field
from functools import wraps
from pathlib import Path
from typing import Any, cast

import click

from muster.cli.options.common import Verb, grouped
from muster.mission.errors import ParameterError
from muster.mission.reading.order_files import OrderFile
from muster.mission.records import Checked, Record, Settings, key_of, specified
from muster.mission.value_types import FLAGS, Choice, Flag, Kind, Many, Share, Table
from muster.mission.values.field_help import unit_of
from muster.running.request_kinds import ByRobot, Orders, Sensors

_METAVARS = {"number": "X", "integer": "N", "string": "TEXT", "array": "X,Y"}


def request_options(of: type[Settings], counts: str = "", without: Sequence[str] = ()) -> Callable[[Verb], Verb]:
    """Add an option for each field of a class; the verb gets what is given as `how`, plain data by field.

    Several classes may stand above each other: each adds to `how`.

    Parameters
    ----------
    counts
        where the fields count: those that count elsewhere alone have no option.
    without
        fields that have no option.
    """
    own = [f for f in _with_options(of) if f.metadata.get("counts", counts) == counts and f.name not in without]
    declared = [(path, f) for f in own for path, f in _parts(f)]

    def decorate(verb: Verb) -> Verb:
        @wraps(verb)
        def with_request(*, how: Mapping[str, Any] | None = None, **given: Any) -> Any:
            asked = dict(how or {})
            for path, f in declared:
                if (text := given.pop(f.name)) not in (None, (), False):
                    _put(asked, path, _value(f, text))
            return verb(how=asked, **given)

        return cast("Verb", grouped(*(_option(f) for _, f in declared))(with_request))

    return decorate


def settings_from(of: type[Settings], texts: Sequence[str]) -> dict[str, Any]:
    """The settings of a fleet by `--setting KEY=VALUE`, as the class of its settings has them; KEY.NAME of mappings.

    Raises
    ------
    ParameterError
        if one has not this form, or stands twice. Whether the fleet has it the class says.
    """
    kinds = {key_of(f): f for f in specified(of)}
    found: dict[str, Any] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        key, _, part = name.strip().partition(".")
        if not equals or not key:
            raise ParameterError(f"--setting: {text}; expected KEY=VALUE")
        if key in found and (not part or part in found[key]):
            raise ParameterError(f"--setting: {name} given twice; expected it once")
        if part:
            found.setdefault(key, {})[part] = value
        else:
            found[key] = _scalar(kinds[key].metadata["kind"], value, share=False) if key in kinds else _number(value)
    return found


def option_name(f: Field[Any]) -> str:
    """The option of a field: as declared, or the field's name without its unit."""
    if f.metadata.get("option"):
        return str(f.metadata["option"])
    stem = re.sub(r"_[a-z0-9]+$", "", f.name) if _unit_in_name(f) else f.name
    return f"--{stem.replace('_', '-')}"


def _unit_in_name(f: Field[Any]) -> bool:
    return not f.metadata["unit"] and bool(unit_of(f))


def _with_options(of: type[Checked]) -> Iterator[Field[Any]]:
    return (f for f in specified(of) if f.metadata.get("option") != "")


def _parts(f: Field[Any]) -> Iterator[tuple[tuple[str, ...], Field[Any]]]:
    """A field with its path; of a record without an option of its own, those of its fields."""
    kind = f.metadata["kind"]
    if isinstance(kind, Record) and "option" not in f.metadata:
        yield from (((f.name, part.name), part) for part in _with_options(kind.of))
    else:
        yield (f.name,), f


def _put(asked: dict[str, Any], path: tuple[str, ...], value: Any) -> None:
    for step in path[:-1]:
        asked = asked.setdefault(step, {})
    asked[path[-1]] = value


def _option(f: Field[Any]) -> Callable[[Any], Any]:
    kind, name = f.metadata["kind"], option_name(f)
    help_text = _help(f)
    if isinstance(kind, Flag):
        return click.option(name, f.name, is_flag=True, help=help_text)
    how: dict[str, Any] = {"metavar": _metavar(f), "help": help_text, "multiple": _takes_many(kind)}
    if isinstance(kind, Orders):
        how["type"] = click.Path(path_type=Path)
    if isinstance(kind, Choice):
        how["shell_complete"] = lambda context, parameter, begun: [w for w in kind.words if w.startswith(begun)]
    return click.option(name, f.name, **how)


def _help(f: Field[Any]) -> str:
    text = f.metadata["doc"]
    plain = isinstance(f.default, str | int | float) and not isinstance(f.default, bool) and f.default != ""
    default = f"  [default: {_shown(f)}]" if plain and f.default is not MISSING else ""
    return f"{text[0].upper()}{text[1:]}.{default}"


def _shown(f: Field[Any]) -> str:
    default: Any = f.default
    value = 100 * default if isinstance(f.metadata["kind"], Share) else default
    return value if isinstance(value, str) else f"{value:g}"


def _metavar(f: Field[Any]) -> str:
    kind = f.metadata["kind"]
    if f.metadata.get("metavar"):
        return str(f.metadata["metavar"])
    if isinstance(kind, Choice):
        return f"[{'|'.join(kind.words)}]"
    unit = "%" if isinstance(kind, Share) else unit_of(f)
    return unit.upper() or _METAVARS[str(kind.schema().get("type", "string"))]


def _takes_many(kind: Kind) -> bool:
    return isinstance(kind, Record | Table | Sensors)


def _value(f: Field[Any], given: Any) -> Any:
    """The value of an option as plain data."""
    kind = f.metadata["kind"]
    if isinstance(kind, Sensors):
        return _sensors(option_name(f), given)
    if _takes_many(kind):
        return _by_name(f, kind, given)
    if isinstance(kind, Orders):
        return OrderFile(given)
    return given if isinstance(given, bool) else _scalar(kind, given)


def _scalar(kind: Kind, text: str, *, share: bool = True) -> Any:
    """The value that a text stands for; the text itself where it stands for none, for the kind to refuse."""
    of = kind.schema().get("type")
    if of in ("number", "integer"):
        number = _number(text)
        return number / 100 if share and isinstance(kind, Share) and not isinstance(number, str) else number
    if of == "boolean":
        return FLAGS.get(text.strip().lower(), text)
    if of == "array":
        parts = [_number(part) if not isinstance(kind, Many) else part for part in text.split(",")]
        return text if any(isinstance(part, str) for part in parts) and not isinstance(kind, Many) else parts
    return text


def _number(text: str) -> int | float | str:
    for read in (int, float):
        try:
            return read(text)
        except ValueError:
            pass
    return text


def _by_name(f: Field[Any], kind: Kind, texts: Sequence[str]) -> dict[str, Any]:
    """The values of NAME=VALUE."""
    option, form = option_name(f), f.metadata["metavar"]
    found: dict[str, Any] = {}
    words = isinstance(kind, Table) and kind.kind.schema().get("type") != "number"
    for text in texts:
        name, equals, value = text.partition("=") if words else text.rpartition("=")
        if not equals and isinstance(kind, ByRobot) and kind.all_alone:
            name, equals = "all", "="
        if not equals or not name or name in found:
            raise ParameterError(f"{option}: {text}; expected {form}, each name at most once")
        found[name] = value if words else _number(value)
    return found


def _sensors(option: str, texts: Sequence[str]) -> dict[str, dict[str, str]]:
    """The sensors of SENSOR[:KEY=VALUE,...], with their parameters as texts."""
    found: dict[str, dict[str, str]] = {}
    for text in texts:
        name, _, settings = text.partition(":")
        if name in found:
            raise ParameterError(f"{option}: {name} twice; expected each sensor at most once")
        found[name] = {}
        for setting in filter(None, settings.split(",")):
            key, equals, value = setting.partition("=")
            if not equals or key in found[name]:
                raise ParameterError(f"{option}: {text}; expected each KEY=VALUE at most once after {name}:")
            found[name][key] = value
    return found
