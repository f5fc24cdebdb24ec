"""The instances of `muster bench --only paths`, in short."""

import math

import pytest

from muster_studies.benches.paths import query, towers


@pytest.mark.parametrize("hanging", [0.0, 0.5])
def test_a_query_among_prisms(hanging):
    row = query("few", towers(8, hanging), (1, 1, 1), (99, 99, 1), "shortest", 1, "")
    length_m = float(row.note.removesuffix(" m long"))
    assert math.dist((1, 1), (99, 99)) - 0.1 < length_m < 145


def test_such_a_share_hangs():
    space = towers(100, 0.5)
    assert len(space.prisms) == 100
    assert sum(prism.floor_m > 0 for prism in space.prisms) == 50
