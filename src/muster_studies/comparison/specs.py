"""Texts that name something with values for its parameters: `genetic:population_size=40`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.value_types import FLAGS


@dataclass(frozen=True)
class Spec:
    """A name, and values by the names of parameters."""

    name: str
    values: dict[str, Any] = field(default_factory=dict)


def spec_of(text: str) -> Spec:
    """Read NAME[:PARAMETER=VALUE]...; the name may hold a colon itself, as MODULE:NAME does.

    Raises
    ------
    ParameterError
        if a value is missing or given twice.
    """
    parts = text.split(":")
    head = [part for part in parts if "=" not in part]
    if parts[: len(head)] != head or not all(head):
        raise ParameterError(f"{text}: expected NAME[:PARAMETER=VALUE]...")
    values: dict[str, Any] = {}
    for part in parts[len(head) :]:
        name, _, value = part.partition("=")
        key = name.strip().replace("-", "_")
        if not key or not value.strip():
            raise ParameterError(f"{text}: {part}; expected PARAMETER=VALUE")
        if key in values:
            raise ParameterError(f"{text}: {key} given twice; expected it once")
        values[key] = _value(value.strip())
    return Spec(":".join(head), values)


def listed(texts: Iterable[str]) -> list[str]:
    """Each text that stands between commas."""
    return [part.strip() for text in texts for part in text.split(",") if part.strip()]


def _value(text: str) -> Any:
    if text.lower() in FLAGS:
        return FLAGS[text.lower()]
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
