"""Published rows with misprints: as printed, corrected, and described."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from muster.library import as_corrected, as_printed


def errata(record: Mapping[str, Any]) -> Iterator[str]:
    """The misprints of a row: the printed value, the right one, and why."""
    for key, value in record.items():
        if isinstance(value, dict) and "erratum" in value:
            there, right = _shown(value["printed"]), _shown(value["corrected"])
            yield f"{key.replace('_', ' ')} printed {there}, right {right}: {value['erratum']}"


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.2f}"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def printed(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row as the document prints it."""
    return dict(as_printed(dict(record)))


def corrected(record: Mapping[str, Any]) -> dict[str, Any]:
    """A row with misprints corrected."""
    return dict(as_corrected(dict(record)))
