"""The trials of timed missions, with the rule of the example package: `python -m tests.examples.max_tasks_trials N`.

The package is installed for this process alone. The rule is stated once more for the enumeration, in a line.
"""

import json
import sys
from collections import Counter
from dataclasses import replace
from random import Random

from tests.timed_missions import meaning, places, remedied, trial


class Meaning(meaning.Meaning):
    """The meaning of missions, and: a robot does at most `max_tasks` tasks."""

    def faults(self, routes):
        return super().faults(routes) | ({"max-tasks"} if self._too_many(routes) else set())

    def hopeless(self, routes):
        return self._too_many(routes) or super().hopeless(routes)

    def _too_many(self, routes):
        pairs = zip(self.robots, routes, strict=True)
        return self._holds("max-tasks") and any(len(r) > robot.extra.get("max_tasks", len(r)) for robot, r in pairs)


def mission_of(seed, made=trial.timed_mission):
    """A timed mission some of whose robots do at most so many tasks."""
    random, mission = Random(f"most {seed}"), made(seed)
    most = [{"max_tasks": random.choice((1, 1, 2, 2, 3))} if random.random() < 0.7 else {} for _ in mission.robots]
    robots = zip(mission.robots, most, strict=True)
    return replace(mission, robots=tuple(replace(robot, extra=extra) for robot, extra in robots))


def ignored_of(seed, ignored=trial.ignored_in):
    """The rules that are ignored, in a tenth of the trials also this one."""
    return (*ignored(seed), *(("max-tasks",) if Random(f"lax {seed}").random() < 0.1 else ()))


def robot_of(robot, said, ends, changed=remedied._robot):
    """A robot with the changes of a remedy."""
    most = {} if said["max_tasks"] is None else {"max_tasks": said["max_tasks"]["enough"]}
    return replace(changed(robot, said, ends), extra={**robot.extra, **most})


def main(first, count):
    for module in (trial, places, remedied):
        module.Meaning = Meaning
    trial.timed_mission, trial.ignored_in, remedied._robot = mission_of, ignored_of, robot_of
    places.LIMITS = (*places.LIMITS[:-1], "max-tasks", places.LIMITS[-1])
    places.SENTENCES = (*places.SENTENCES, (r"with it (\S+) would have (\d+) tasks, and has room for (\d+)", too_many))
    remedied.UNPROVEN = (*remedied.UNPROVEN, "max-tasks")
    reports = [trial.trial(seed) for seed in range(first, first + count)]
    failures = {report.seed: report.failures for report in reports if report.failures}
    json.dump(
        {"failures": failures, "counts": sum((Counter(report.counts) for report in reports), Counter())}, sys.stdout
    )


def too_many(found, word, name, count, most):
    """Whether a robot would do so many tasks at some place that keeps the rules before, and at most so many."""
    i = next(i for i, robot in enumerate(found.mission.robots) if robot.id == name)
    counts = {len(routes[i]) for routes in found.left(*places.LIMITS[places.LIMITS.index(word) :])}
    return int(count) in counts and int(count) > int(most) == found.mission.robots[i].extra["max_tasks"]


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
