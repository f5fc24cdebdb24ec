"""The ledger of an import as a table for people: what was not read, by file, kind and reason."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.import_ledger import Ledger

_MOST_ROWS = 40
_WIDEST = 48


def ledger_lines(ledger: Ledger) -> Iterator[str]:
    """Yield the lines of the table; none where everything was read that says anything."""
    rows = [row for row in ledger.not_read if not row.minor]
    if not rows:
        return
    width = min(_WIDEST, max(len(row.told) for row in rows))
    yield "not read:"
    for file in dict.fromkeys(row.file for row in rows):
        mine = [row for row in rows if row.file == file]
        read, lost = ledger.count("read", file), ledger.count("passed over", file)
        yield f"  {file}: {read:,} elements read, {lost:,} passed over"
        for row in mine[:_MOST_ROWS]:
            yield f"    {row.count:>6,}  {row.told:<{width}}  {row.how}: it {row.said}"
        if len(mine) > _MOST_ROWS:
            yield f"    and {len(mine) - _MOST_ROWS} more kinds; --format json names all"
