"""One seed: a team in narrow places is disturbed, and what must hold of the run is checked.

No robot stands for long that has something to do, nobody touches, the run ends, and what is lost cannot be done.
"""

from contextlib import closing
from dataclasses import dataclass
from random import Random

import muster
from muster import Simulation
from tests import trials
from tests.disturbances.traffic.geometry import Space
from tests.disturbances.traffic.missions import mission_of
from tests.disturbances.traffic.script import Script
from tests.disturbances.traffic.verdicts import Poses, Standing, check_contacts, check_doors, check_lost, check_out

ENDS_S = 600.0
"""No run may last longer."""
LOOK_S = 1.0


@dataclass
class Report(trials.Report):
    """Figures: the longest times for which robots stood, by kind."""


def trial(seed):
    """Carry the mission of a seed out."""
    report = Report(seed)
    with report.trying():
        mission = mission_of(seed)
        traffic = Random(f"option {seed}").choice(("auto", "auto", "reserve"))
        space, poses = Space(mission.map), Poses()
        plan = muster.solve(mission, "greedy", seed=seed)
        with closing(Simulation(mission, plan, traffic=traffic, seed=seed, recorder=poses)) as simulation:
            script = Script(simulation, mission, space, seed)
            standing = Standing(report, reserves=simulation._traffic is not None)
            report.story.append(f"{mission.name}, {len(mission.robots)} robots, {traffic}")
            _carry_out(simulation, script, standing)
            _check(report, simulation, script, standing, poses, space)
        report.counts[f"runs: {mission.name}"] += 1
    return report


def _carry_out(simulation, script, standing):
    while not simulation.done and simulation.time_s < ENDS_S:
        until_s = simulation.time_s + LOOK_S
        while not simulation.done and simulation.time_s < until_s - 1e-9:
            simulation.advance(until_s)
        if not simulation.done:
            script.look()
            places = dict(zip(script.robots, simulation.world.positions[:, :2].copy(), strict=True))
            standing.look(simulation.time_s, places, simulation.status, script.down)


def _check(report, simulation, script, standing, poses, space):
    report.check(simulation.done, f"the run does not end in {ENDS_S:g} s")
    check_contacts(report, poses, space, script.robots)
    check_doors(report, poses, space, script.closings)
    check_out(report, poses.events, script.downs)
    check_lost(report, simulation, script, space)
    report.figures.append(standing.longest_s)
    report.counts["tasks done"] += len(simulation.result().tasks_done)
    report.counts.update(kind for _, kind, _ in script.told)
    told = [*poses.events, *((at_s, f"--- {kind}", what) for at_s, kind, what in script.told)]
    report.story += [f"{at_s:8.2f} {kind} {data}" for at_s, kind, data in sorted(told, key=lambda one: one[0])]


def sum_up(figures):
    """The longest times of all runs."""
    longest = {kind: max(one[kind] for one in figures) for kind in figures[0]}
    return "stood at most: " + ", ".join(f"{kind}: {seconds:.1f} s" for kind, seconds in longest.items())
