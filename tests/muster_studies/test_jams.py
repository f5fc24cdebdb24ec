"""Scenes of narrow places, and what methods of avoidance make of them."""

import pytest

from muster.generation.narrow import DIFFERENTIAL, KINEMATICS, RADIUS_M, SHIFT_M, SPEED_MPS
from muster.mission.mission_parts import positions
from muster_studies.jams.space_time import SIDE_M
from muster_studies.jams.study import JAMS, METHODS, RESERVE, SCENES, SPACE_TIME, Job, outcome_of


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("kinematics", KINEMATICS)
def test_scenes_are_the_same_by_seed_and_regular_without(name, kinematics):
    scene = SCENES[name]
    assert scene(kinematics, 3) == scene(kinematics, 3)
    starts, regular = ([robot.position for robot in scene(kinematics, seed).robots] for seed in (3, 0))
    for (x, y), (a, b) in zip(starts, regular, strict=True):
        assert max(abs(x - a), abs(y - b)) <= SHIFT_M
    assert {robot.radius_m for robot in scene(kinematics, 0).robots} == {RADIUS_M}
    assert len({place for _, place in positions(scene(kinematics, 0))}) > 1


@pytest.mark.parametrize("kinematics", KINEMATICS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("seed", range(5))
def test_equal_robots_face_to_face_pass(kinematics, method, seed):
    outcome = outcome_of(Job("face to face, 2", kinematics, method, seed))
    assert (outcome.done, outcome.contacts, outcome.jams) == (2, 0, 0)
    assert outcome.mission_time_s < 20


@pytest.mark.long
@pytest.mark.parametrize("method", [*METHODS, RESERVE])
def test_everybody_gets_through_a_one_way_door(method):
    """Before robots that wait were told from stuck ones, 5 of 20 did by the method that was the default."""
    outcome = outcome_of(Job("one-way door, 20", DIFFERENTIAL, method, 0))
    assert (outcome.done, outcome.out, outcome.contacts) == (20, 0, 0)
    assert outcome.waiting_s > 0


def test_the_table_has_a_row_for_each_method():
    assert JAMS.tables == ("methods", "traffic", "space-time")


def test_the_yardstick_takes_as_long_as_the_robots_that_pass_one_after_the_other():
    """Through a door for one twenty robots pass one a cell, behind the first, who drives to the door."""
    outcome = outcome_of(Job("one-way door, 20", DIFFERENTIAL, SPACE_TIME, 0))
    first_m = 3.0
    assert outcome.done == outcome.tasks == 20
    assert first_m + 19 * SIDE_M < outcome.mission_time_s * SPEED_MPS < 2 * (first_m + 19 * SIDE_M)
