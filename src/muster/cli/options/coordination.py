"""Options of the coordinations of installed packages: a flag for each, and the options of its fields."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import wraps
from typing import Any, cast

import click

from muster.cli.options.common import Verb
from muster.cli.options.request import option_name, request_options
from muster.mission.errors import ParameterError
from muster.mission.records import specified
from muster.running.coordination import COORDINATIONS, Coordination

_USABLE = COORDINATIONS.usable()


def coordination_options(verb: Verb) -> Verb:
    """Add the options of all coordinations; the verb gets the name and the settings of the one asked for, or None.

    They are its argument `coordination`.
    """

    @wraps(verb)
    def without(**given: Any) -> Any:
        return verb(**{"coordination": None} | given)

    decorated: Any = without
    for name, of in reversed(_USABLE.items()):
        decorated = _with_options(decorated, name, of)
    return cast("Verb", decorated)


def coordination_parameters() -> Iterator[str]:
    """Yield the names of the parameters that `coordination_options` adds to a verb."""
    for name, of in _USABLE.items():
        yield _parameter(name)
        yield from (f.name for f in specified(of))


def _with_options(verb: Verb, name: str, of: type[Coordination]) -> Verb:
    options = {f.name: option_name(f) for f in specified(of)}

    @wraps(verb)
    def with_flag(*, how: Mapping[str, Any], **given: Any) -> Any:
        asked = given.pop(_parameter(name))
        if how and not asked:
            raise ParameterError(f"{options[min(how)]} given; expected it together with --{name}")
        if asked and "coordination" in given:
            raise ParameterError(f"--{name} given; expected it without --{given['coordination'][0]}")
        return verb(**given | ({"coordination": (name, how)} if asked else {}))

    flag = click.option(f"--{name}", _parameter(name), is_flag=True, help=of.summary)
    return flag(request_options(of)(cast("Verb", with_flag)))


def _parameter(name: str) -> str:
    return name.replace("-", "_")
