"""Answers of a server as the dataclasses of `exchange.mission_control`; unknown keys of newer servers are ignored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from datetime import datetime
from typing import Any, TypeVar

Word = TypeVar("Word")


def read(kind: type[Word], data: Mapping[str, Any]) -> Word:
    """One word: a Job, a Run, ... of plain data."""
    known = {f.name for f in fields(kind)}  # type: ignore[arg-type]  # a dataclass
    return kind(**{name: _value(name, value) for name, value in data.items() if name in known})


def _value(name: str, value: Any) -> Any:
    is_time = isinstance(value, str) and (name == "at" or name.endswith("_at"))
    return datetime.fromisoformat(value) if is_time else value
