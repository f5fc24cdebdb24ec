"""What must hold of every new plan: what it says was moved, what had to be, and how much may be beyond that."""

from muster.mission.plan import teams_of


class Stability:
    """Compares the robots of each task before and after every new plan."""

    def __init__(self, report, most):
        self.report, self.most = report, most
        self.teams, self.out = {}, set()

    def on_event(self, kind, data, executor):
        if kind in ("robot_fails", "robot_silent", "robot_stuck"):
            self.out.add(data["robot"])
        elif kind == "robot_returns":
            self.out.discard(data["robot"])
        elif kind == "replanned":
            self._replanned(data, executor)

    def on_plan(self, plan):
        self.teams = _teams((route.robot, route.tasks) for route in plan.routes)

    def _replanned(self, data, executor):
        crew, check = executor.crew.values(), self.report.check
        teams = _teams((state.robot.id, (*state.done, *(() if state.out else state.route))) for state in crew)
        moved = {name for name, team in teams.items() if self.teams.get(name, team) != team}
        forced = set(data["forced"])
        check(moved == set(data["moved"]), f"moved {moved}, but said {set(data['moved'])}")
        check(forced <= moved | data["dropped"].keys(), f"{forced} are forced, and neither moved nor dropped")
        broken = {name for name in moved if self.teams[name] & self.out}
        check(broken <= forced, f"{broken} have a robot that is out, and are not forced")
        self.report.counts["moved"] += len(moved)
        self.report.counts["moved by force"] += len(forced & moved)
        if self.most is not None:
            check(len(moved - forced) <= self.most, f"{moved - forced} moved, {self.most} may")


def _teams(routes):
    return {task: set(robots) for task, robots in teams_of(routes).items()}
