"""One run without faults: robots agree on what the auction in one process finds, and do it when its plan says."""

from random import Random

from tests.muster_team.campaign.carried_out import Run
from tests.muster_team.campaign.team_missions import calm_scene
from tests.muster_team.networks import all_agree, network
from tests.muster_team.trials.random_missions import random_mission, with_times
from tests.trials import Report

from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.allocation.stop import Stop
from muster.model.problem import Problem
from muster.verification import verify
from muster_team.negotiators.participation import plan_of
from muster_team.runs.robot_control import LATENESS

AGREE_S = 60.0
LATER_S = 1.5
"""By how much each task of a plan may begin later: robots look at the clock now and then, and tell the others first."""


def like_the_centre(seed):
    """Robots that lose messages, but not each other, agree on the routes and sales of the auction in one process."""
    report, random = Report(seed), Random(f"like the centre {seed}")
    with report.trying():
        mission = random_mission(random, robots=random.randint(2, 6), tasks=random.randint(3, 10), once=0.0)
        problem, terms = Problem.compile(with_times(mission, random)).ready(), _terms(random)
        central = AUCTION.solve(problem, Stop(), params=terms)
        net = network(problem, terms, seed=seed, loss=random.choice((0.0, 0.3)), delay_s=random.uniform(0.001, 0.1))
        net.start()
        report.check(net.run(AGREE_S, lambda: all_agree(net)), "no agreement")
        for node in net.nodes.values():
            if node.stage.epoch > 1:  # so many messages were lost in a row that a robot was taken for lost
                report.counts["agreed later than in the first epoch"] += 1
                continue
            plan = plan_of(problem, node)
            report.check(plan.routes == central.routes, f"{node.robot} has {plan.routes}, the centre {central.routes}")
            report.check(plan.book.awards == central.book.awards, f"{node.robot} heard of other sales than the centre")
    return report


def _terms(random):
    bids = [None, *(bid for bid in BIDS if bid != "average-as-printed")]
    return Parameters(bid=random.choice(bids), placement=random.choice(PLACEMENTS), winner=random.choice(WINNERS))


def calm(seed):
    """Robots of which none fails carry out what they have agreed on, at the first attempt and as planned."""
    report = Report(seed)
    with report.trying():
        run = CalmRun(calm_scene(seed), seed)
        report.check(run.play(), "the robots do not come to rest")
        report.story += run.story()
        for wrong in (*run.wrong_deeds(), *run.left_open(), *run.not_as_planned()):
            report.check(False, wrong)
        report.counts.update(run.counts())
    return report


class CalmRun(Run):
    """A team that nothing happens to."""

    def not_as_planned(self):
        """What was done by others than planned, not at the first attempt, later, or not as long as it takes."""
        mission = self.scene.mission
        plan = AUCTION.solve(Problem.compile(mission).ready(), Stop(), params=Parameters())
        planned = _visits(verify(mission, plan))
        later_s = LATER_S * (1 + len(mission.tasks))
        if any(lag.within_s is not None for task in mission.tasks for lag in task.lags.values()):
            later_s += LATENESS * max((begin_s for _, begin_s, _ in planned.values()), default=0.0)
        if self._is_tight(planned, later_s):
            return
        done = {name: next(iter(teams.items())) for name, teams in self.done.items()}
        for name, (members, begin_s, _) in planned.items():
            if name not in done:
                yield f"{name} was not done, and there was time for it"
            elif set(done[name][0]) != members:
                yield f"{name} was done by {done[name][0]}, and {sorted(members)} had it"
            elif done[name][1] is not None and not begin_s - 1.0 <= done[name][1] <= begin_s + later_s:
                yield f"{name} began at {done[name][1]:.1f} s, planned {begin_s:.1f} s"
        yield from (f"{name} was done, and nobody had it" for name in done.keys() - planned.keys())
        if (again := self.counts()["attempts after the first"]) > 0:
            yield f"{again} attempts after the first"
        yield from self._wrong_ends(planned)

    def _is_tight(self, planned, later_s):
        """Whether a task of the plan would not be in time any more if the plan were so much later."""
        tasks = {task.id: task for task in self.scene.mission.tasks}
        robots = {robot.id: robot for robot in self.scene.mission.robots}
        for name, (members, begin_s, end_s) in planned.items():
            task = tasks[name]
            limits = [
                end_s + later_s > robots[one].available_until_s for one in members if robots[one].available_until_s
            ]
            limits += [task.deadline_s is not None and end_s + later_s > task.deadline_s]
            limits += [closes is not None and begin_s <= closes < begin_s + later_s for _, closes in task.window_s]
            lags = [lag for lag in task.lags.values() if lag.within_s is not None]
            limits += [lag.within_s - lag.after_s < 2 * later_s for lag in lags]
            if any(limits):
                return True
        return False

    def _wrong_ends(self, planned):
        ends = {data["task"]: at_s for at_s, _, kind, data in self.team.told if kind == "ends"}
        for name, (_, begin_s, end_s) in planned.items():
            begun = next(iter(self.done.get(name, {}).values()), None)
            if begun is not None and not end_s - begin_s - 0.5 <= ends[name] - begun <= end_s - begin_s + LATER_S + 1.0:
                yield f"{name} took {ends[name] - begun:.1f} s, planned {end_s - begin_s:.1f} s"


def _visits(verdict):
    """For each planned task its robots, its begin and its end."""
    found = {}
    for route in verdict.routes:
        for visit in route.visits:
            members, *_ = found.get(visit.task, (set(),))
            found[visit.task] = members | {route.robot}, visit.starts_s, visit.ends_s
    return found
