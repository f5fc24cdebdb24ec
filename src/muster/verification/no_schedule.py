"""Says why routes have no schedule: stops that wait for each other in a cycle, or bounds that raise each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

from muster.mission.plan import tie_order
from muster.verification.schedule_nodes import Bound, Links, place_name
from muster.verification.station_queues import Name, Turn
from muster.verification.verdict import Violation


def cycle_fault(links: Links, cycle: Sequence[Name]) -> Violation:
    """The deadlock of a cycle of nodes, step by step, and what makes each: `r_1: 2 -> 16; prerequisite: 16 -> 14`."""
    steps = [_link(links, node, later) for node, later in pairwise([*cycle, cycle[0]])]
    # Prerequisites have no cycle and routes have none, so a route's step follows on another link somewhere.
    starts = [k for k in range(len(steps)) if steps[k][0] and not steps[k - 1][0]] or [0]
    first = starts[tie_order([steps[k][1] for k in starts])[0]]
    parts = []
    for label, group in groupby([*steps[first:], *steps[:first]], key=lambda link: link[0] or "prerequisite"):
        (_, stop, later), *others = group
        parts.append(f"{label}: {' -> '.join([stop, later, *(other for _, _, other in others)])}")
    return Violation("deadlock", None, None, "; ".join(parts))


def _link(links: Links, node: Name, later: Name) -> tuple[str, str, str]:
    """What makes one node come before another: a robot, nothing for a prerequisite, or a queue; and the two."""
    for before, robot, _ in links.nodes[later].legs:
        if before is not None and links.node_of[before] == node:
            return robot, place_name(before), place_name(links.stop_after(robot, before))
    for name, _, _ in links.nodes[later].awaited:
        if links.node_of[name] == node:
            return "", name, links.waiting(later, name)
    assert isinstance(node, Turn)
    assert isinstance(later, Turn)
    return f"served at {later.station}", node.robot, later.robot


@dataclass(frozen=True)
class Rising:
    """Bounds that raise each other for ever.

    Parameters
    ----------
    raised_by
        what has raised the begin of a node last, where no window has.
    seconds
        how long each stop takes.
    """

    links: Links
    raised_by: Mapping[Name, Bound]
    seconds: Mapping[Name, float]

    def fault(self, delayed: Name) -> Violation:
        """The cycle of such bounds, in order; `delayed` is a node that they raise."""
        name = delayed
        for _ in self.links.nodes:
            name = self._raised_from(name)
        cycle = [name]
        while (before := self._raised_from(cycle[0])) != name:
            cycle.insert(0, before)
        bounds = [self.raised_by[node] for node in cycle if node in self.raised_by]
        late = next((bound.delays for bound in bounds if bound.delays), delayed)
        lasting = [bound.before for bound in bounds if not bound.delays]
        work = ", ".join(f"{place_name(one)} takes {self.seconds[one]:,.10g} s" for one in lasting)
        said = "; ".join([*map(self._said, (node for node in cycle if node in self.raised_by)), work])
        detail = f"no times keep all of these: {said}" if work else "its lags and windows leave no times"
        return Violation("prerequisite", None, self.links.nodes[late].tasks[0].id, detail)

    def _raised_from(self, name: Name) -> Name:
        """The node that has raised the begin of a node; itself where a window has."""
        bound = self.raised_by.get(name)
        if bound is None:
            return name
        return bound.delays or self.links.node_of[bound.before]

    def _said(self, name: Name) -> str:
        bound = self.raised_by[name]
        after = f"{bound.seconds:,.10g} s after {place_name(bound.before)} ends"
        if bound.delays:
            return f"{self.links.waiting(bound.delays, bound.before)} begins at most {after}"
        if bound.robot:
            return f"{bound.robot} comes to {place_name(self.links.stop_after(bound.robot, bound.before))} {after}"
        if bound.queues:
            assert isinstance(name, Turn)
            assert isinstance(bound.before, Turn)
            return f"{name.robot} is served at {name.station} after {bound.before.robot}"
        return f"{self.links.waiting(name, bound.before)} begins at least {after}"
