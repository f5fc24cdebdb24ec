"""What happens in a run, by seed: robots stop, mostly in narrow places, and come back or not; tasks and robots come.

Doors close, and open again or not.
"""

from math import cos, inf, pi, sin
from random import Random

import numpy as np

from muster import Event, Task
from muster.mission.events import MovedRobot
from tests.disturbances.traffic.missions import RADIUS_M, SKILL, newcomer

STOPS = ("fails", "silent", "held", "loses its orders")
"""How a robot stops: execution is told; it is not heard; it hardly moves; it drops its orders and takes no others."""
KINDS = (*STOPS, *STOPS, "removed", "removed", "moved", "moved", "new task", "cancel", "joins")
WITH_DOORS = (*KINDS, *(5 * ("closes",)))
NARROW_M = 2 * RADIUS_M
"""A robot nearer than this to a wall leaves no room for another on that side."""
WAITS_S = 5.0
"""For so long a stop waits for a robot that moves in a narrow place."""
HARDLY = 1e-6
APART_M = 1.5


class Script:
    """The disturbances of one run.

    Attributes
    ----------
    robots, tasks
        all that there are or were, by id; robots in the order in which the world has them.
    down
        the robots that cannot move or be heard now, and how each stopped.
    downs
        (robot, begin, end) of all that ever stopped; the end is inf of those that are still down.
    where
        the places, (2,) metres, of each robot that is down since it stopped: one that is not heard goes on for a while.
    closed
        the doors that are closed now.
    closings
        (door, begin, end) of all that ever closed; the end is inf of those that are still closed.
    told
        (time, kind, what) of all that happened.
    """

    def __init__(self, simulation, mission, space, seed):
        self.simulation, self.mission, self.space = simulation, mission, space
        self.random = Random(f"script {seed}")
        self.down, self.downs, self.told, self._backs = {}, [], [], {}
        self.where = {}
        self.closed, self.closings, self._opens = set(), [], {}
        self.robots = {robot.id: robot for robot in mission.robots}
        self.tasks = {task.id: task for task in mission.tasks}
        count, kinds = self.random.randint(1, 6), WITH_DOORS if space.doors else KINDS
        latest_s = 15 * len(mission.tasks) / len(mission.robots)  # most are still under way then
        self._ahead = sorted((self.random.uniform(1, latest_s), self.random.choice(kinds)) for _ in range(count))
        self._places = dict(zip(self.robots, self._now(), strict=True))

    def look(self):
        """Let happen what is due."""
        now = self.simulation.time_s
        places = dict(zip(self.robots, self._now(), strict=True))
        moving = {name for name, place in places.items() if np.hypot(*(place - self._places.get(name, place))) > 0.05}
        self._places = places
        for robot in self.down:
            self.where[robot].append(places[robot])
        for robot in [name for name, back_s in self._backs.items() if back_s <= now]:
            self._comes_back(robot)
        for door in [name for name, open_s in self._opens.items() if open_s <= now]:
            self._opens_again(door)
        for robot in self.robots:
            if robot not in self.down and self.simulation.status.robots[robot].out:
                self.simulation.report(Event(at_s=0, robot_returns=robot))
        due = [one for one in self._ahead if one[0] <= now]
        for at_s, kind in due:
            if kind in (*STOPS, "removed"):
                robot = self._victim(moving, waits=now < at_s + WAITS_S)
                if robot is None:
                    continue
                self._stops(robot, kind)
            else:
                rare = {
                    "new task": self._new_task,
                    "cancel": self._cancel,
                    "joins": self._joins,
                    "moved": self._moved,
                    "closes": self._closes,
                }
                rare[kind]()
            self._ahead.remove((at_s, kind))

    def _now(self):
        return self.simulation.world.positions[:, :2]

    def _tell(self, kind, what):
        self.told.append((self.simulation.time_s, kind, what))

    def _victim(self, moving, *, waits):
        """A robot that moves in a narrow place, or, in the end, any; None to wait for one."""
        up = [name for name in self.robots if name not in self.down]
        gaps = dict(zip(self.robots, self.space.gap_m(self._now()), strict=True))
        narrow = [name for name in up if name in moving and gaps[name] < NARROW_M]
        if narrow or not waits:
            return self.random.choice(narrow or up) if up else None
        return None

    def _stops(self, robot, kind):
        self.down[robot], self.where[robot] = kind, [self._places[robot]]
        back_s = self.random.choice((None, self.random.uniform(2, 20), self.random.uniform(20, 90)))
        if back_s is not None:
            self._backs[robot] = self.simulation.time_s + back_s
        self.downs.append((robot, self.simulation.time_s, inf))
        self._tell(kind, f"{robot} stops, back after {back_s} s")
        if kind == "removed":
            self.simulation.report(Event(at_s=0, robot_removed=robot))
        elif kind == "fails":
            self.simulation.report(Event(at_s=0, robot_fails=robot))
        elif kind == "silent":
            self.simulation.report(Event(at_s=0, robot_silent=robot))
        elif kind == "held":
            self.simulation.world.slow(robot, HARDLY)
        else:
            self.simulation.world.fail(robot, silent=False)

    def _comes_back(self, robot):
        """Execution is told, now or later, where it puts the robot out, or was told that it failed.

        One that was taken away is put back where that was as soon as there is room.
        """
        if self.down[robot] == "removed":
            others = [at for at in self._places.values() if not np.isnan(at).any()]
            if np.hypot(*(np.array(others).reshape(-1, 2) - self.where[robot][0]).T).min(initial=inf) < APART_M / 2:
                return
        del self._backs[robot]
        kind = self.down.pop(robot)
        self.downs = [
            (name, begin, self.simulation.time_s if name == robot and end == inf else end)
            for name, begin, end in self.downs
        ]
        self._tell("returns", robot)
        world = self.simulation.world
        if kind == "removed":
            self.simulation.report(Event(at_s=0, robot_returns=robot))
        elif kind == "held":
            world.slow(robot, 1.0)
        else:
            world.recover(robot)

    def _closes(self):
        """A door closes, where there is one that is open."""
        doors = sorted(self.space.doors.keys() - self.closed)
        if doors:
            door = self.random.choice(doors)
            open_s = self.random.choice((None, self.random.uniform(2, 60), self.random.uniform(2, 60)))
            if open_s is not None:
                self._opens[door] = self.simulation.time_s + open_s
            self.closed.add(door)
            self.closings.append((door, self.simulation.time_s, inf))
            self._tell("closes", f"{door}, open after {open_s} s")
            self.simulation.report(Event(at_s=0, door_closes=door))

    def _opens_again(self, door):
        del self._opens[door]
        self.closed.remove(door)
        now = self.simulation.time_s
        self.closings = [
            (name, begin, now if (name, end) == (door, inf) else end) for name, begin, end in self.closings
        ]
        self._tell("opens", door)
        self.simulation.report(Event(at_s=0, door_opens=door))

    def _new_task(self):
        task = Task(
            id=f"new_{len(self.told)}",
            position=self._place(RADIUS_M + 0.05),
            duration_s=self.random.choice((0.0, 5.0)),
            requires=(SKILL,) if self.random.random() < 0.2 and any(r.skills for r in self.robots.values()) else (),
        )
        self._tell("new task", f"{task.id} appears at {task.position}, {task.requires}")
        self.simulation.report(Event(at_s=0, new_task=task))
        self.tasks[task.id] = task

    def _cancel(self):
        tasks = [task for task, state in self.simulation.status.tasks.items() if state in ("open", "under way")]
        if tasks:
            task = self.random.choice(tasks)
            self._tell("cancel", task)
            self.simulation.report(Event(at_s=0, cancel_task=task))

    def _joins(self):
        """A robot joins where there is room for it."""
        for _ in range(100):
            place = self._place(RADIUS_M + 0.05)
            if np.nanmin(np.hypot(*(self._now() - place).T), initial=inf) > APART_M:
                robot = newcomer(f"j_{len(self.told)}", place, self.random.choice(self.mission.robots))
                self._tell("joins", f"{robot.id} at {place}")
                self.simulation.report(Event(at_s=0, robot_joins=robot))
                self.robots[robot.id] = robot
                return

    def _moved(self):
        """Somebody puts a robot elsewhere: into the open, or by a metre or two where it is."""
        up = [name for name in self.robots if name not in self.down]
        robot = self.random.choice(up) if up else None
        for _ in range(100 if robot else 0):
            here, near = self._places[robot], self.random.random() < 0.5
            angle, far_m = self.random.uniform(-pi, pi), self.random.uniform(0.3, 2.0)
            aside = here[0] + far_m * cos(angle), here[1] + far_m * sin(angle)
            place = aside if near else self._place(RADIUS_M + 0.05)
            others = [at for name, at in self._places.items() if name != robot and not np.isnan(at).any()]
            room = np.hypot(*(np.array(others) - place).T).min(initial=inf) > APART_M / 2
            if room and self.space.gap_m([place])[0] > RADIUS_M + 0.05:
                self._tell("moved", f"{robot} to {place}")
                self.simulation.report(Event(at_s=0, robot_moved=MovedRobot(robot=robot, position=place)))
                self._places[robot] = np.array(place)
                return

    def _place(self, gap_m):
        """A random place that keeps away from walls."""
        left, low, right, high = self.space.inside.bounds
        while True:
            place = self.random.uniform(left, right), self.random.uniform(low, high)
            if self.space.gap_m([place])[0] > gap_m:
                return place
