"""Runs by the rules of the League of Robot Runners, judged step by step, and faults that the judge finds."""

from dataclasses import replace

import numpy as np
import pytest
from tests.traffic.league import league, random_league

from muster.mission.errors import ParameterError
from muster.traffic.lifelong.league_faults import league_faults
from muster.traffic.lifelong.league_run import run_league

OPEN = ["......"] * 6
ROOMS = ["....#....", "....#....", ".........", "....#....", "#.#####.#", "....#....", ".........", "....#...."]
DEAD_ENDS = [".#.#.#.#.", ".#.#.#.#.", ".........", ".........", ".#.#.#.#.", ".#.#.#.#."]
CORRIDOR = ["#.#########", "...........", "#####.#####"]
RING = ["....", ".##.", "...."]


def judged(instance, steps, **settings):
    run = run_league(instance, steps, checks=settings.pop("checks", 3000), **settings)
    assert league_faults(run) == []
    return run


@pytest.mark.parametrize(
    ("rows", "robots", "least"),
    [(OPEN, 1, 3), (OPEN, 8, 20), (OPEN, 25, 20), (ROOMS, 12, 10), (DEAD_ENDS, 8, 10), (CORRIDOR, 2, 2), (RING, 6, 5)],
)
@pytest.mark.parametrize("seed", [0, 1])
def test_tasks_are_finished_and_the_judge_finds_nothing(rows, robots, least, seed):
    assert judged(random_league(rows, robots, seed), 100, seed=seed).finished >= least


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", range(30))
def test_random_maps(seed):
    random = np.random.default_rng(seed)
    cells = random.random((random.integers(3, 14), random.integers(3, 14))) < random.uniform(0, 0.4)
    cells[0, :3] = False
    rows = ["".join("#" if cell else "." for cell in row) for row in cells]
    robots = int(random.integers(1, max(2, (~cells).sum())))
    judged(random_league(rows, robots, seed, random.uniform(0.3, 2)), 150, seed=seed)


@pytest.mark.long
def test_a_dense_map_does_not_jam():
    random = np.random.default_rng(0)
    cells = random.random((24, 24)) < 0.15
    rows = ["".join("#" if cell else "." for cell in row) for row in cells]
    instance = random_league(rows, 180, 0)
    half, whole = (judged(instance, steps, checks=50_000).finished for steps in (200, 400))
    assert whole - half > 0.6 * half > 60


def test_one_robot_takes_the_fewest_steps():
    # East, a turn to the south, south; then two turns, and back north.
    run = judged(league(["...", "#..", "##."], [0], [[8], [2]], 1), 9)
    assert run.actions == ["FFRFFRRFF"]
    assert [event[:1] + event[2:] for event in run.events] == [(5, 0, 1), (9, 1, 1)]


def test_a_robot_visits_the_cells_of_a_task_in_order():
    run = judged(league(["....."], [0], [[3, 1, 4]], 1), 11)
    assert [event[0] for event in run.events] == [3, 7, 12][:2]
    assert run.finished == 0
    assert judged(league(["....."], [0], [[3, 1, 4]], 1), 12).finished == 1


def test_a_cell_twice_in_a_task_takes_a_step_each_time():
    assert [event[0] for event in judged(league(["..."], [0], [[2, 2]], 1), 3).events] == [2, 3]


@pytest.mark.parametrize("rows", [["...", "..."], ["...", ".#.", "..."]])
def test_robots_follow_one_another_around_a_full_ring(rows):
    ring = [0, 1, 2, *((5, 4, 3) if len(rows) == 2 else (5, 8, 7, 6, 3))]
    run = judged(league(rows, ring, list(zip(ring, [*ring[1:], ring[0]], strict=True)), 2 * len(ring)), 30)
    assert all("F" in actions for actions in run.actions)
    assert run.finished >= len(ring)


def test_a_full_map_without_a_ring_stands():
    run = judged(league(["..."], [0, 1, 2], [[2], [0], [1]], 3), 20)
    assert "F" not in "".join(run.actions)


def test_tasks_in_parts_without_a_robot_stay_open():
    rows = ["..#..", "..#.."]
    run = judged(league(rows, [0], [[1], [3, 4], [5], [0, 4]], 3), 30)
    assert run.impossible == 3  # in the end they take the place of all others
    done = {event[2] % 4 for event in run.events}
    assert done <= {0, 2}
    assert len(run.revealed) == run.finished + 3


def test_each_part_has_its_own_tasks():
    run = judged(league(["..#.."], [0, 4], [[1], [3], [0], [4]], 4), 40)
    assert {(robot, cell % 4 in (0, 2)) for _, robot, cell, _ in run.events} == {(0, True), (1, False)}


def test_fewer_tasks_than_robots():
    run = judged(random_league(OPEN, 10, 0, ratio=0.3), 100)
    assert run.finished > 10
    assert sum(run.busy_steps) <= 3 * 100


@pytest.mark.parametrize("rows", [OPEN, ROOMS])
def test_the_same_seed_gives_the_same_run(rows):
    instance = random_league(rows, 12, 3)
    one, again, other = (run_league(instance, 60, checks=3000, seed=seed) for seed in (5, 5, 6))
    assert (one.actions, one.events, one.assignments) == (again.actions, again.events, again.assignments)
    assert one.actions != other.actions


def test_a_run_may_end_early():
    seen = []
    run = run_league(
        random_league(OPEN, 5, 0), 50, checks=100, progress=lambda step, done: seen.append((step, done)) or step < 7
    )
    assert (run.steps, league_faults(run)) == (7, [])
    assert [step for step, _ in seen] == list(range(1, 8))
    assert seen[-1][1] == run.finished


@pytest.mark.parametrize(("steps", "checks", "seed"), [(0, 1, 0), (1, -1, 0), (1, 1, -1)])
def test_wrong_settings(steps, checks, seed):
    with pytest.raises(ParameterError, match="expected"):
        run_league(random_league(OPEN, 1, 0), steps, checks=checks, seed=seed)


def changed(text, at, letter):
    return text[:at] + letter + text[at + 1 :]


def run_of_two(actions, **changes):
    """Return a run of two robots in a row of four cells, at its ends; the task of each is its own start."""
    instance = league(["....", "####"], [0, 3], [[0], [3]], 2)
    run = judged(instance, 2)
    return replace(run, actions=list(actions), **changes)


@pytest.mark.parametrize(
    ("actions", "fault"),
    [
        (("WW", "W"), "lengths"),
        (("WX", "WW"), "letters"),
        (("WW", "FW"), "robot 1 is not in a free cell at step 1"),
        (("RF", "WW"), "robot 0 is not in a free cell at step 2"),
        (("CF", "WW"), "robot 0 is not in a free cell at step 2"),
    ],
)
def test_the_judge_finds_wrong_moves(actions, fault):
    assert any(fault in found for found in league_faults(run_of_two(actions)))


def test_the_judge_finds_collisions():
    instance = league(["....", "####"], [0, 2], [[0], [2]], 2)
    run = judged(instance, 4)
    assert any("robots 0 and 1 are in one cell at step 2" in f for f in league_faults(with_moves(run, "FFWW", "WWWW")))
    assert any("robots 0 and 1 swap cells at step 3" in f for f in league_faults(with_moves(run, "FWFW", "RRFW")))
    assert not any("cell at" in f or "swap" in f for f in league_faults(with_moves(run, "FFWW", "FWWW")))


def with_moves(run, *actions):
    return replace(run, actions=list(actions))


@pytest.fixture(scope="module")
def run():
    return judged(random_league(OPEN, 6, 0), 60)


def test_the_judge_finds_wrong_claims(run):
    for claim, fault in [
        ({"finished": run.finished + 1}, "finished: "),
        ({"events": run.events[1:]}, "events: "),
        ({"revealed": run.revealed[:-1]}, "tasks are revealed; expected 9"),
        ({"assignments": run.assignments[1:]}, "events: "),
    ]:
        assert any(fault in found for found in league_faults(replace(run, **claim))), claim


def test_the_judge_finds_wrong_assignments(run):
    step, robot, task, _ = next(event for event in run.events if event[3] == 1 and len(cells_of(run, event[2])) > 1)
    other = 0 if robot else 1
    for assignment, fault in [
        ((step, robot, -1), "which it has begun"),
        ((0, other, 10_000), "which is not revealed"),
        ((step, other, task), "have task"),
    ]:
        wrong = replace(run, assignments=[*run.assignments, assignment])
        assert any(fault in found for found in league_faults(wrong)), assignment


def cells_of(run, task):
    return run.instance.tasks[task % len(run.instance.tasks)]
