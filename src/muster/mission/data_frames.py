"""Tables as pandas DataFrames; pandas is loaded when one is made (extra `frames`)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

from muster.mission.extras import needs_extra

if TYPE_CHECKING:
    from pandas import DataFrame


def data_frame(rows: Iterable[Mapping[str, Any]], columns: Iterable[str]) -> DataFrame:
    """A DataFrame of rows; with these columns, also where there is no row.

    Raises
    ------
    MissingExtraError
        without pandas.
    """
    with needs_extra("frames", "a DataFrame"):
        from pandas import DataFrame
    return DataFrame(list(rows), columns=list(columns))


def frame_of_records(kind: type[Any], records: Iterable[Any]) -> DataFrame:
    """A DataFrame with a row for each instance of a dataclass and a column for each of its fields.

    A column of numbers that are all missing is one of numbers (NaN), as where some are.
    """
    frame = data_frame(map(asdict, records), [f.name for f in fields(kind)])
    numbers = [f.name for f in fields(kind) if str(f.type) in ("int | None", "float | None")]
    missing = [name for name in numbers if frame[name].isna().all()]
    return frame.astype(dict.fromkeys(missing, float))
