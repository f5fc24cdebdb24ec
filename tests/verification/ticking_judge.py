"""A slow second judge of goods, batteries and stations: robots live through their routes, second by second.

It is for missions on a line whose numbers are whole, without time limits, lags, teams and relations.
"""

from muster.mission.goods import by_commodity
from muster.mission.plan import tie_order

LONGEST_S = 3000


class Life:
    """One robot, its load and its battery."""

    def __init__(self, team, robot, route, rank):
        self.team, self.robot, self.rank = team, robot, rank
        self.left = list(route.tasks)
        self.charged = [stop.charged for stop in route.stops] or [None] * len(self.left)
        self.turns = [(stop.begin_s, stop.arrive_s) for stop in route.stops] or [None] * len(self.left)
        self.x, self.now = robot.position[0], robot.available_from_s
        self.level = robot.battery.capacity * robot.battery.at_start if robot.battery else None
        self.load = dict(by_commodity(robot.load_at_start))
        self.carried = {}  # of pairs, by the task that takes on board
        self.usage = 0
        self.ends = None  # of the work or service that it is at
        self.stops, self.broken, self.had_stops = [], set(), bool(self.left)
        self.leave()

    def leave(self):
        """Go to the next stop; it arrives there at `arrives`."""
        if not self.left:
            self.arrives = None
            if self.had_stops and self.team.returns(self.robot):
                self.drive(self.robot.position[0])
            return
        place = self.team.place(self.left[0])
        self.arrives = self.now + abs(place.position[0] - self.x)
        self.drive(place.position[0])
        self.level_there = self.level

    def drive(self, x):
        self.draw(abs(x - self.x))
        self.x = x

    def draw(self, usage):
        self.usage += usage
        if self.level is not None:
            self.level -= usage
            if self.level < self.robot.battery.capacity * self.robot.battery.reserve - 1e-9:
                self.broken.add("battery")

    def begin(self, now):
        name = self.left[0]
        station = self.team.stations.get(name)
        seconds = self.work(self.team.tasks[name]) if station is None else self.serve(station)
        self.started, self.ends = now, now + seconds

    def work(self, task):
        cost, seconds = task.actuation_cost, task.actuation_cost if task.duration_s is None else task.duration_s
        self.draw(seconds if self.team.mission.rules.usage == "time" else cost)
        for name, amount in by_commodity(task.load).items():
            self.load[name] = self.load.get(name, 0) + amount
        if any(other.delivers == task.id for other in self.team.tasks.values()):
            self.carried[task.id] = by_commodity(task.load)
        for name, amount in self.carried.pop(task.delivers, {}).items():
            self.load[name] -= amount
        return seconds

    def serve(self, station):
        if "unload" in station.services:
            self.load = {}
            for load in self.carried.values():
                for name, amount in load.items():
                    self.load[name] = self.load.get(name, 0) + amount
        if self.level is None or station.services == ("unload",):
            return 0
        full = self.robot.battery.capacity
        level = max(0, self.level)
        stated = self.charged[len(self.stops)]
        amount = full - level if stated is None or "swap" in station.services else stated
        if stated is not None and stated > full - level + 1e-5 * full:
            self.broken.add("battery")
        self.level = min(full, level + amount)
        return station.swap_s if "swap" in station.services else min(full, amount) / station.charge_per_s

    def end(self, now):
        name = self.left.pop(0)
        shown = {kind: value for kind, value in self.load.items() if abs(value) > 1e-9}
        self.stops.append((name, self.arrives, self.started, now, self.level_there, self.level, shown))
        room = self.robot.load_capacity
        for kind, value in self.load.items():
            if value < -1e-9 or (room is not None and value > by_commodity(room).get(kind, 0) + 1e-9):
                self.broken.add("load")
        self.team.ended[name] = now
        self.now, self.ends = now, None
        self.leave()


class TickingJudge:
    """What comes of a plan: of each robot its stops and what it breaks; whether all come to their ends."""

    def __init__(self, mission, plan, *, half=0.5):
        self.mission = mission
        self.tasks = {task.id: task for task in mission.tasks}
        self.stations = {station.id: station for station in mission.stations}
        self.planned = {name for route in plan.routes for name in route.tasks}
        self.ended = {}
        rank = {k: r for r, k in enumerate(tie_order([robot.id for robot in mission.robots]))}
        routes = {route.robot: route for route in plan.routes}
        self.lives = [Life(self, robot, routes[robot.id], rank[k]) for k, robot in enumerate(mission.robots)]
        self.order = self._stated_orders()
        now = 0.0
        while any(life.left for life in self.lives) and now < LONGEST_S:
            self.second(now)
            now += half
        self.deadlocked = any(life.left for life in self.lives)
        self.broken = {(kind, life.robot.id) for life in self.lives for kind in life.broken} | self._pairs()

    def place(self, name):
        return self.tasks.get(name) or self.stations[name]

    def returns(self, robot):
        return self.mission.rules.return_to_start

    def _stated_orders(self):
        """By station who is served when: (what the plan states, rank, place in the route)."""
        orders = {}
        for life in self.lives:
            for k, name in enumerate(life.left):
                if name in self.stations:
                    orders.setdefault(name, []).append((life.turns[k], life.rank, k))
        return {name: sorted(turns) for name, turns in orders.items() if all(turn[0] is not None for turn in turns)}

    def second(self, now):
        """Let happen what happens at this moment; first all that waits for no station, then who is served next."""
        while self._moved(now) or self._served(now):
            pass

    def _moved(self, now):
        for life in self.lives:
            if life.ends is not None and life.ends <= now:
                life.end(now)
                return True
            if self._there(life, now) and life.left[0] in self.tasks:
                awaited = set(self.tasks[life.left[0]].prerequisites) & self.planned
                if all(self.ended.get(name, now + 1) <= now for name in awaited):
                    life.begin(now)
                    return True
        return False

    def _there(self, life, now):
        return life.ends is None and life.left and life.arrives <= now

    def _served(self, now):
        """Serve the one of all that wait that has been there longest, if there is a slot for it."""
        waiting = [life for life in self.lives if self._there(life, now) and life.left[0] in self.stations]
        passed = set()
        for life in sorted(waiting, key=lambda life: (life.arrives, life.rank)):
            name = life.left[0]
            busy = sum(1 for one in self.lives if one.ends is not None and one.left[0] == name)
            own = (life.turns[len(life.stops)], life.rank, len(life.stops))
            is_next = self.order[name][0] == own if name in self.order else name not in passed
            passed.add(name)
            if is_next and busy < self.stations[name].slots:
                if name in self.order:
                    self.order[name].pop(0)
                life.begin(now)
                return True
        return False

    def _pairs(self):
        found = set()
        robot_of = {name: life.robot.id for life in self.lives for name, *_ in life.stops}
        place = {name: k for life in self.lives for k, (name, *_) in enumerate(life.stops)}
        for task in self.tasks.values():
            p = task.delivers
            if p is None:
                continue
            if task.id in robot_of and (robot_of.get(p) != robot_of[task.id] or place[p] > place[task.id]):
                found.add(("load", robot_of[task.id]))
            if p in robot_of and task.id not in robot_of:
                found.add(("load", robot_of[p]))
        return found
