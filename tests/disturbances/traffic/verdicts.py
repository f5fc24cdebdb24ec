"""What must hold of a disturbed run, told from the record's poses and from who was broken when."""

import numpy as np
import shapely

from tests.disturbances.traffic.geometry import FAR_M, joined
from tests.disturbances.traffic.missions import RADIUS_M

STANDS_S = 60.0
"""While no robot is broken none that has something to do stands still for longer."""
STILL_S, STILL_FREE_S, STILL_BROKEN_S = 15.0, 31.0, 122.0
"""For no longer all stand, though one has something to do and none works: while none is broken, the same where robots
pass as they meet (one that has dropped its order is sent again after 30 s), and while one is."""
NOTICED_S = 15.0
"""So long after its return a robot that was broken is taken for that."""
STOPS_S = 1.5
"""Within this time of its being told to a robot has come to a stand."""
MOVED_M = 0.05
ROUNDING_M = 1e-6
UNHEARD_M = {"silent": 2.5, "fails": 0.6}
"""So far from where a robot was last heard it may be: it brakes (0.5 m at 1 m/s), at once if it fails, 0.1 s after it
was heard; a silent one goes on by the order that it has before that."""
PASSES_M = 0.1
"""Where a broken robot leaves so much more room than a body needs, there is a way past it."""


class Poses:
    """The record's poses; a `Recorder`."""

    def __init__(self):
        self.steps, self.events = [], []

    def on_step(self, now, positions, headings, velocities):
        self.steps.append((now, np.array(positions[:, :2])))

    def on_event(self, now, kind, data):
        self.events.append((now, kind, dict(data)))

    def on_telemetry(self, now, robot, telemetry):
        pass

    def on_plan(self, now, plan):
        pass

    def on_report(self, report):
        pass


def check_contacts(report, poses, space, robots):
    """Nobody touches another, nor a wall."""
    names = list(robots)
    for now, places in poses.steps:
        away = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        a, b = np.nonzero(np.triu(away < 2 * RADIUS_M - ROUNDING_M, 1))
        if len(a):
            one, other = names[a[0]], names[b[0]]
            report.check(False, f"{one} and {other} touch at {now:.1f} s: {away[a[0], b[0]]:.3f} m apart")
            break
    for k, name in enumerate(names):
        track = np.array([places[k] for _, places in poses.steps if k < len(places)])
        gaps = space.gap_m(track[~np.isnan(track).any(axis=1)])  # one that was taken away is nowhere
        at = int(gaps.argmin())
        report.check(gaps[at] > RADIUS_M - 1e-3, f"{name} touches a wall at {track[at]}: {gaps[at]:.3f} m")


def check_doors(report, poses, space, closings):
    """Nobody is in a door that is closed, but who was in it or could not stop before it, and has not come out."""
    for door, begin, end in closings:
        within = None
        for now, places in poses.steps:
            if begin < now <= end:
                away = shapely.distance(shapely.points(np.nan_to_num(places, nan=FAR_M)), space.doors[door])
                there = set(np.flatnonzero(away < RADIUS_M - 1e-3).tolist())
                stops = within is None or now <= begin + STOPS_S
                report.check(stops or there <= within, f"{there} enter {door}, closed, at {now:.1f} s")
                within = there


class Standing:
    """For how long robots stand that have something to do."""

    def __init__(self, report, *, reserves):
        self.report, self._still_s = report, STILL_S if reserves else STILL_FREE_S
        self._anchors, self._since = {}, {}
        self.longest_s = {"one": 0.0, "all": 0.0, "all, one broken": 0.0}
        self._all_since, self._with_broken = 0.0, False

    def look(self, now, places, status, down):
        """Places (n, 2) by id; `down` are broken now."""
        moved = set()
        for name, place in places.items():
            anchor = self._anchors.setdefault(name, place)
            if np.hypot(*(place - anchor)) > MOVED_M:
                self._anchors[name] = place
                moved.add(name)
        to_do = {name for name, robot in status.robots.items() if _has_to_do(robot)} - down.keys()
        for name in places:
            if name in moved or name not in to_do or down:
                self._since[name] = now
            self._tell("one", now - self._since.setdefault(name, now), STANDS_S, f"{name} at {places[name]}", now)
        works = any(robot.activity == "working" for robot in status.robots.values())
        if moved or works or not to_do or bool(down) != self._with_broken:
            self._all_since = now
        self._with_broken = bool(down)
        kind, limit_s = ("all, one broken", STILL_BROKEN_S) if down else ("all", self._still_s)
        self._tell(kind, now - self._all_since, limit_s, f"all, {sorted(to_do)} have something to do", now)

    def _tell(self, kind, stood_s, limit_s, who, now):
        if stood_s > self.longest_s[kind]:
            self.report.check(
                not self.longest_s[kind] <= limit_s < stood_s,
                f"deadlock ({kind}): {who} stand for {limit_s:g} s at {now:.1f} s",
            )
            self.longest_s[kind] = stood_s


def _has_to_do(robot):
    """Whether a robot is to go somewhere."""
    return (
        not robot.out and robot.activity != "working" and (robot.route or robot.activity in ("returning", "in traffic"))
    )


def check_lost(report, simulation, script, space):
    """Of every task lost the reason is true: no robot that works, and may do it, has a way to it."""
    result, status = simulation.result(), simulation.status
    places = dict(zip(script.robots, simulation.world.positions[:, :2], strict=True))
    tasks, lost = script.tasks, dict(result.tasks_lost)
    report.check(set(result.tasks_done) | lost.keys() == tasks.keys(), "a task is neither done nor lost")
    report.check(not set(result.tasks_done) & lost.keys(), "a task is done and lost")
    broken = [place for name in script.down for place in _may_stand(script.down[name], script.where[name])]
    parts = space.free(RADIUS_M, broken, margin_m=PASSES_M, closed=script.closed)
    for name, reason in lost.items():
        report.counts[f"lost: {reason.split(':')[0].split(' at ')[0][:30]}"] += 1
        if status.tasks[name] == "cancelled":
            continue
        report.check(bool(reason.strip("; ")), f"{name} is lost without a reason")
        able = [
            robot
            for robot in script.robots.values()
            if robot.id not in script.down
            and not status.robots[robot.id].out  # `check_out` says whether that is right
            and _may_do(robot, tasks[name])
            and joined(parts, places[robot.id], tasks[name].position)
            and (not script.mission.rules.return_to_start or joined(parts, places[robot.id], robot.position))
        ]
        report.check(not able, f"{name} is lost, but {[robot.id for robot in able]} could do it: {reason}")


def _may_stand(kind, places):
    """Where a robot that is down may be for all that is known; one that was taken away is nowhere."""
    yield from () if kind == "removed" else places
    if kind in UNHEARD_M:
        for away_m in np.linspace(UNHEARD_M[kind] / 4, UNHEARD_M[kind], 4):
            for angle in np.linspace(0, 2 * np.pi, 16, endpoint=False):
                yield places[0] + away_m * np.array([np.cos(angle), np.sin(angle)])


def _may_do(robot, task):
    return set(task.requires) <= set(robot.skills) and (task.only_robots is None or robot.id in task.only_robots)


def check_out(report, events, downs):
    """Only robots that are broken are put out for not getting on."""
    for now, kind, data in events:
        if kind == "robot_stuck":
            broken = any(name == data["robot"] and begin <= now <= end + NOTICED_S for name, begin, end in downs)
            report.check(broken, f"{data['robot']} is put out as stuck at {now:.1f} s, though it is not broken")
