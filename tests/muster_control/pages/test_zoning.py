"""What is said of a zone that was drawn."""

from muster_control.pages.editing.zone_form import lies_outside

GROUND = {"boundary": [[0, 0], [9, 0], [9, 9], [0, 9]]}


def test_a_zone_beyond_the_boundary_is_known():
    assert lies_outside(GROUND, [[8.78, 8], [12, 8], [12, 12]])
    assert not lies_outside(GROUND, [[1, 1], [2, 1], [2, 2]])
    assert not lies_outside({"image": "floor.png"}, [[8, 8], [12, 8], [12, 12]])
