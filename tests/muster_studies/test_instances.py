"""Missions of the field's benchmarks: the published instances, number for number."""

import pytest

import muster
from muster.generation.teams import counted_teams
from muster.generation.windows import windows_mission
from muster_studies.instances.coalitions import ONE_SKILL, SEVERAL_SKILLS, SKILL_SETS
from muster_studies.instances.lattice import lattice_mission
from muster_studies.instances.solomon import REFERENCES, solomon_instance


@pytest.mark.parametrize(("name", "robots"), REFERENCES)
def test_a_shipped_instance_is_a_mission(name, robots):
    mission = solomon_instance(name, robots)
    assert (len(mission.robots), len(mission.tasks)) == (robots, 100)
    assert mission.rules.objective == "total"
    assert mission.rules.return_to_start
    assert mission.name == f"{name}-{robots}"
    assert {robot.load_capacity for robot in mission.robots} == {task.load for task in mission.tasks} == {None}
    assert {robot.position for robot in mission.robots} == {(40.0, 50.0) if "C" in name else (35.0, 35.0)}
    assert all(task.duration_s > 0 and len(task.window_s) == 1 for task in mission.tasks)


def test_an_instance_that_is_not_shipped_is_told():
    with pytest.raises(muster.ParameterError, match="instance: C999; expected C101 or C201 or R101 or R201 or RC101"):
        solomon_instance("C999", 3)


def test_counted_teams_are_those_of_the_published_test_set():
    mission = counted_teams(0)
    assert {robot.position for robot in mission.robots} == {(0.6369616873214543, 0.2697867137638703)}
    first, second = mission.tasks[:2]
    assert first.position == (0.6706244146936303, 0.6471895115742501)
    assert (first.duration_s, first.robots_needed) == (4.830310403920351, 4)
    assert (second.duration_s, second.robots_needed) == (2.811159211142285, 2)
    assert (len(mission.robots), len(mission.tasks)) == (20, 50)


def test_skill_sets_are_the_published_instances():
    several, one = SEVERAL_SKILLS.instance(0), ONE_SKILL.instance(0)
    assert several.robots[0].position == (0.20026136112610582, 0.29082354092342033)
    assert dict(several.robots[0].abilities) == {"skill_0": 1, "skill_1": 1, "skill_2": 1, "skill_4": 1}
    assert several.tasks[0].duration_s == 0.309512632371281
    assert dict(several.tasks[0].needs) == {"skill_0": 1, "skill_3": 2, "skill_4": 2}
    assert one.tasks[0].position == (0.6203012089660142, 0.9479768357258342)
    assert dict(one.tasks[0].needs) == {"skill_1": 1, "skill_2": 1}


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("skill_set", SKILL_SETS.values(), ids=SKILL_SETS)
@pytest.mark.parametrize("seed", range(3))
def test_the_robots_together_can_do_every_task(skill_set, seed):
    mission = skill_set.mission(seed)
    assert muster.check(mission).impossible == ()
    species = {tuple(sorted(robot.abilities)) for robot in mission.robots}
    assert len(species) == skill_set.parameters.species


def test_a_lattice_has_a_task_at_each_of_its_places():
    mission = lattice_mission(2, 3, robots=4)
    places = {task.position[:2] for task in mission.tasks}
    assert places == {(0, 0), (10, 0), (20, 0), (0, 10), (10, 10), (20, 10)}
    assert [robot.position[:2] for robot in mission.robots] == [(0, 0)] * 4


@pytest.mark.parametrize("seed", range(20))
def test_random_windows_are_as_the_text_says(seed):
    mission = windows_mission(seed)
    assert 3 <= len(mission.robots) <= 10
    assert 9 <= len(mission.tasks) <= 60
    for task in mission.tasks:
        ((opens, closes),) = task.window_s
        assert 0 <= opens <= 400
        assert 30 <= closes - opens <= 1600
        assert 20 <= task.duration_s <= 40
