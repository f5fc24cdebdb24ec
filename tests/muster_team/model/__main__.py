"""Explore the shipped core: `python -m tests.muster_team.model [PARTS] [--first PART] [--most WORLDS]`.

Parts are numbered from 0. For each it says how many worlds and steps there are within its bounds. Where a promise is
not kept it says which, and the steps that lead there, and ends with 1.
"""

import argparse
import gc
import sys
from dataclasses import fields

from tests.muster_team.model.team import PARTS, explorer
from tests.muster_team.model.world import Bounds


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.muster_team.model", description=__doc__)
    parser.add_argument("parts", type=int, nargs="?", default=len(PARTS), help="how many")
    parser.add_argument("--first", type=int, default=0, help="the number of the first part")
    parser.add_argument("--most", type=int, help="worlds of each part after which it is cut")
    asked = parser.parse_args()
    gc.set_threshold(100_000, 50, 1_000)  # what is kept is much, and holds no cycles
    ends = []
    for name in list(PARTS)[asked.first : asked.first + asked.parts]:
        found = explorer(PARTS[name], most=asked.most).explore()
        sys.stdout.write("\n".join((f"{name} ({_told(PARTS[name])}):", *_lines(found), "")))
        sys.stdout.flush()
        ends.append(bool(found.fault))
    return int(any(ends))


def _lines(found):
    yield f"  {found.worlds:,} worlds, {found.steps:,} steps; {found.states:,} states of robots, {found.calls:,} calls"
    yield f"  {found.quiet:,} quiet worlds, {found.beyond:,} in higher epochs; agreed within {found.slowest} quanta"
    if found.left:
        yield f"  cut: {found.left:,} worlds were reached and not looked at"
    yield from (f"  {step}" for step in found.trace)
    yield f"  {found.fault or ('no fault' if found.left else 'exhausted, no fault')}"


def _told(bounds):
    """The bounds that differ from none."""
    asked = {field.name: getattr(bounds, field.name) for field in fields(Bounds)}
    return ", ".join(f"{name} {value}" for name, value in asked.items() if value)


if __name__ == "__main__":
    sys.exit(main())
