"""Standing fleets on a grid of lanes beside a loop of PIBT: the loop moves as robots can, and both do all orders."""

import numpy as np
import pytest

from muster_studies.benches.joint_paths import warehouse
from muster_studies.benches.lifelong_lanes import ORDERS_EACH, Burst, PibtLoop, compared


class Watched(PibtLoop):
    """Checks each step: robots stay, or go to a cell beside theirs, and never meet or change places."""

    def _move(self):
        before = list(self._at)
        super()._move()
        assert len(set(self._at)) == len(before)
        assert all(b == a or b in self._beside[a] for a, b in zip(before, self._at, strict=True))
        moved = {(a, b) for a, b in zip(before, self._at, strict=True) if a != b}
        assert not any((b, a) in moved for a, b in moved)


@pytest.mark.parametrize("robots", [1, 12, 60])
def test_robots_of_the_loop_do_all_orders_and_never_meet(robots):
    loop = Watched(Burst.of(warehouse(2, 1, 4), robots, seed=robots), seed=1)
    assert loop.run(most_steps=5000) == robots * ORDERS_EACH


def test_places_are_free_cells_and_lanes_join_those_side_by_side():
    blocked = warehouse(2, 1, 4)
    burst = Burst.of(blocked, 5, seed=0)
    assert len(burst.cells) == np.count_nonzero(~blocked)
    assert (np.abs(burst.cells[burst.pairs[:, 0]] - burst.cells[burst.pairs[:, 1]]).sum(axis=1) == 1).all()
    assert len(set(burst.starts)) == 5
    assert len(burst.mission.lanes.edges) == len(burst.pairs)


def test_muster_does_as_much_as_the_loop_without_a_contact():
    rows = {row.name.partition(": ")[2]: row for row in compared((2, 1, 4), 6)}
    assert rows["orders lost"].median == rows["contacts"].median == 0
    assert rows["orders lost"].note.endswith("loop: 0")
    assert rows["orders done a second"].median >= float(rows["orders done a second"].aim.removeprefix(">= "))
