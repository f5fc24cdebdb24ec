"""Types of columns that are equal in SQLite and PostgreSQL."""

from __future__ import annotations

import json
import math
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import DateTime, Dialect, Float, String
from sqlalchemy.types import TypeDecorator

from muster.mission.errors import ParameterError


class Instant(TypeDecorator[datetime]):
    """An aware datetime. SQLite has no time zones and stores UTC."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        if value is None:
            return None
        if value.tzinfo is None:
            raise ParameterError(f"{value}: a time without its zone; expected an aware datetime")
        return value.astimezone(UTC)

    def process_result_value(self, value: Any, dialect: Dialect) -> datetime | None:
        if value is None:
            return None
        at: datetime = value
        return at.replace(tzinfo=UTC) if at.tzinfo is None else at.astimezone(UTC)


class Number(TypeDecorator[float]):
    """A finite number. SQLite stores NaN as NULL, and may return a whole number as int."""

    impl = Float
    cache_ok = True

    def process_bind_param(self, value: float | None, dialect: Dialect) -> float | None:
        if value is not None and not math.isfinite(value):
            raise ParameterError(f"{value}; expected a finite number")
        return value

    def process_result_value(self, value: float | None, dialect: Dialect) -> float | None:
        return None if value is None else float(value)


class Text(TypeDecorator[str]):
    """A text without U+0000 and lone surrogates, which the databases cannot store."""

    impl = String
    cache_ok = True

    def process_bind_param(self, value: str | None, dialect: Dialect) -> str | None:
        for character in value or "":
            if character == "\0" or "\ud800" <= character <= "\udfff":
                raise ParameterError(f"a text has the character U+{ord(character):04X}; expected one without it")
        return value


def as_json(value: Any) -> str:
    """Strict JSON, which every database and every browser reads: no NaN, no Infinity."""
    try:
        return json.dumps(value, allow_nan=False, separators=(",", ":"))
    except ValueError as error:
        raise ParameterError(f"{error}; expected finite numbers, as JSON has them") from None
    except TypeError as error:
        raise ParameterError(f"{error}; expected plain data") from None
