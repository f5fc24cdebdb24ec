"""How many iterations random algorithms get.

The thesis' own counts take the core a fraction of a second. The greater ones are chosen so that each run stays within
the time that the published run took, and all of them together within a quarter of an hour on two processors.
"""

from __future__ import annotations

from muster_studies.effort import Effort

_SCENARIO = 200_000
_HILL_CLIMBING = 2_000_000
_SALESMEN = {"eil51-5-thesis": 300_000, "eil51-3-thesis": 150_000, "eil51-7-thesis": 150_000}
_OTHER_SALESMEN = 120_000


def budgets(effort: Effort, mission: str, allocator: str, published: int) -> tuple[int, ...]:
    """Numbers of iterations, each of which makes a case: the published one, then a greater one."""
    if effort.iterations is not None:
        return (effort.iterations,)
    if effort.quick:
        return (published,)
    return published, _greater(mission, allocator)


def _greater(mission: str, allocator: str) -> int:
    if "hill-climbing" in allocator:
        return _HILL_CLIMBING
    if mission.endswith("-thesis"):
        return _SALESMEN.get(mission, _OTHER_SALESMEN)
    return _SCENARIO
