"""Run the campaign: `python -m tests.state.campaign [SEEDS] [--first SEED] [--processes N]`, or one seed in full.

Each seed is a run with random events, whose process is killed at random moments. What is known afterwards, by the log
or by a checkpoint after a random entry and what follows it, must be what was known before; and the run goes on to its
end.
"""

import random
import sys
from math import inf

from tests import trials
from tests.state.played import SAMPLES, Played, event, known, site

import muster
from muster.execution import Standing
from muster.mission.events import Event
from muster.mission.model import Task
from muster.mission.stations import Battery

CPU_LIMIT_S = 60.0
STEPS_S = (0.5, 2.0, 7.0, 15.0)
REFUSED = ((), ((3.0, 8.0, 0.0),), ((2.0, 2.0, 0.0), (13.0, 8.0, 0.0)))
ENDS_WITHIN_S = 600.0


def trial(seed):
    """Kill one run again and again."""
    report, draw = trials.Report(seed), random.Random(seed)
    mission = site(script(draw), Battery(capacity=120.0) if draw.random() < 0.3 else None)
    with report.trying():
        play(report, draw, Played(mission, muster.solve(mission, "greedy"), duty(draw)))
    return report


def script(draw):
    """Events of the mission file."""
    return [Event(at_s=draw.choice([5.0, 15.0, 40.0]), cancel_task=f"t_{draw.randrange(6)}")] * draw.randrange(2)


def duty(draw):
    """Half of all fleets stay on duty, get orders, and forget what is done."""
    if draw.random() < 0.5:
        return None
    orders = [
        Event(at_s=5.0 * k, new_task=Task(id=f"order_{k}", position=(draw.uniform(0, 30), draw.uniform(0, 30))))
        for k in range(1, draw.randrange(2, 12))
    ]
    return Standing(
        until_s=draw.choice([30.0, 90.0, None]), orders=orders, searches=False, keep_s=draw.choice([5.0, inf])
    )


def play(report, draw, run):
    """Let events happen, and kill the run between them."""
    for point in run.world.ports.values():
        point.refuses = draw.choice(REFUSED)
    for _ in range(draw.randrange(1, 7)):
        run.go_to(run.world.now + draw.choice(STEPS_S))
        kind = draw.choice(sorted(SAMPLES))
        run.report(event(kind, draw.choice(SAMPLES[kind])))
        if draw.random() < 0.5:
            run.go_to(run.world.now + draw.choice((0.0, *STEPS_S)))
            kill(report, draw, run)
    for point in run.world.ports.values():
        point.refuses = ()
    run.report(Event(at_s=0.0, robot_returns="r_2"))
    run.go_to(run.world.now + 1.0)
    kill(report, draw, run)
    until_s = run.world.now + ENDS_WITHIN_S
    while not run.executor.done and run.world.now < until_s:
        run.go_to(run.world.now + 5.0)
    report.check(run.executor.done, f"not over after {ENDS_WITHIN_S:g} s")
    report.counts.update(entry["kind"] for entry in run.log.entries)


def kill(report, draw, run):
    """Kill a run, if what would be known is what is known."""
    before = known(run.executor.state)
    cut = draw.randrange(1, len(run.log.entries) + 1)
    for how, state in (("the log", run.recovered), (f"a checkpoint after entry {cut}", run.recovered_by(cut))):
        after = known(state)
        differ = [name for name in before if before[name] != after[name]]
        report.check(not differ, f"by {how}, at {run.world.now:g} s: {', '.join(differ)} differ")
    run.kill()


if __name__ == "__main__":
    sys.exit(trials.run(trials.parser_of("tests.state.campaign", __doc__), trial, cpu_limit_s=CPU_LIMIT_S))
