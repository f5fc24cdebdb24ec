"""What became of a block, a line of it, a picture or a region, and how all of them are counted and printed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

RUN, LOOKED_UP, PARSED, SKIPPED = "run", "looked up", "parsed", "skipped"
COMPARED, MEASURED, FAILED, LEFT = "compared", "measured", "failed", "left to another turn"


@dataclass(frozen=True)
class Outcome:
    """One of the words above for something on a page; `detail` is a reason or an explanation."""

    status: str
    kind: str
    where: str
    detail: str = ""


def summary(outcomes: Sequence[Outcome]) -> list[str]:
    """Lines that count what was done, name every reason for which something was skipped, and end with the failures."""
    count = Counter((outcome.status, outcome.kind) for outcome in outcomes)
    lines = [
        f"blocks run           {count[RUN, 'block']} (shell, console, Python)",
        f"commands run         {count[RUN, 'command']}",
        f"commands looked up   {count[LOOKED_UP, 'command']} (targets of make, extras of pip)",
        f"missions parsed      {count[PARSED, 'block']}",
        f"outputs compared     {count[COMPARED, 'output']}",
        f"pictures compared    {count[COMPARED, 'picture']} made again, {count[MEASURED, 'picture']} as stored",
        f"numbers compared     {count[COMPARED, 'number']} with commands, {count[MEASURED, 'number']} as stored",
        f"rows compared        {count[COMPARED, 'row']}, {count[LEFT, 'row']} left to other turns",
        f"commands stored      {count[MEASURED, 'command']} (docs/measured, by --long)",
    ]
    skipped = [outcome for outcome in outcomes if outcome.status == SKIPPED]
    lines.append(f"skipped              {len(skipped)}")
    lines += [f"  {number:3} {reason}" for reason, number in Counter(o.detail for o in skipped).most_common()]
    failed = [outcome for outcome in outcomes if outcome.status == FAILED]
    for outcome in failed:
        lines.append(f"FAILED {outcome.where}: {outcome.kind}")
        lines += [f"    {line}" for line in outcome.detail.splitlines()]
    lines.append(f"{len(failed)} failed" if failed else "everything holds")
    return lines
