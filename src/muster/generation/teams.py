"""Tasks that need several equal robots at once, by the generator of [dai2024], number for number.

All robots move at 0.2 m/s on a square of 1 m and return to where they start; the objective is the makespan, with the
way back. The same seed gives the instance that the published generator makes of it.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole

SPEED_MPS = 0.2
LONGEST_S = 5.0
TEAM_RULES = Rules(objective="makespan", return_to_start=True, makespan_includes_return=True)
_MOST_OF_A_TEAM = 5


@record
class Teams(Checked):
    """What missions of the family `teams` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=20)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=50)
    most: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "a task needs one to so many robots", default=5)


def counted_teams(seed: int, robots: int = 20, tasks: int = 50, most: int = _MOST_OF_A_TEAM) -> Mission:
    """Equal robots at one depot; each task needs 1 to `most` of them [dai2024].

    With the defaults seeds 0 to 49 are its published test set.
    """
    draw = np.random.default_rng(seed)
    depot = draw.random((1, 2))[0]
    draw.random((robots, 1))  # what each robot costs, which the benchmark does not use
    places, work_s = draw.random((tasks, 2)), LONGEST_S * draw.random((tasks, 1))[:, 0]
    needed = draw.integers(1, most + 1, tasks)
    return Mission(
        name=f"counted-teams-{robots}-{tasks}-{seed}",
        rules=TEAM_RULES,
        robots=tuple(Robot(id=f"r_{k}", position=point(depot), speed_mps=SPEED_MPS) for k in range(robots)),
        tasks=tuple(
            Task(id=str(j), position=point(places[j]), duration_s=float(work_s[j]), robots_needed=int(needed[j]))
            for j in range(tasks)
        ),
    )


def point(place: npt.NDArray[np.float64]) -> tuple[float, float]:
    """A place (2,) as a position."""
    return float(place[0]), float(place[1])


def _make(given: Teams, seed: int) -> Mission:
    if given.most > given.robots:
        raise ParameterError(f"teams: most: {given.most}; expected at most robots ({given.robots})")
    return counted_teams(seed, given.robots, given.tasks, given.most)


TEAMS = Generator(
    name="teams",
    summary="equal robots from one depot; each task needs one to five of them at once",
    source="the published generator of [dai2024], number for number; seeds 0 to 49 are its test set",
    parameters=Teams,
    make=_make,
)
