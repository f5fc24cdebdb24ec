"""One scene of the family `narrow`, carried out as a user does who says nothing else."""

from random import Random

from tests.trials import Report

import muster
from muster.generation.narrow import KINEMATICS, PLACES

FEWEST, MOST = 2, 200


def trial(seed):
    """Seeds take one kind of place after the other, half of them with at most 20 robots."""
    random, report = Random(f"narrow {seed}"), Report(seed)
    given = {
        "place": list(PLACES)[seed % len(PLACES)],
        "robots": round(FEWEST * (MOST / FEWEST) ** random.random()),
        "kinematics": random.choice(KINEMATICS),
    }
    report.story.append(str(given))
    with report.trying():
        (mission,) = muster.generate("narrow", seed=seed, **given)
        found = muster.simulate(mission, muster.solve(mission, "greedy"), seed=seed)
        tasks = {task.id for task in mission.tasks}
        report.check(set(found.tasks_done) == tasks, f"not done: {sorted(tasks - set(found.tasks_done))}")
        report.check(found.contacts == 0, f"{found.contacts} contacts")
        report.counts[given["place"]] += 1
        report.counts["robots"] += given["robots"]
        report.story.append(f"{len(found.tasks_done)} tasks in {found.mission_time_s:.1f} s")
    return report
