"""Missions and runs that several tests of the kinematic world use."""

import math

import numpy as np

from muster.mission.model import Mission, Robot
from muster.motion.port import Waypoint


def robot(name="r", position=(0.0, 0.0), **given):
    return Robot(id=name, position=position, **given)


def mission(*robots, **given):
    return Mission(robots=robots, tasks=(), **given)


def circle(count, radius, **given):
    """Robots on a circle, the way points on the opposite sides."""
    angles = [2 * math.pi * k / count for k in range(count)]
    places = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    return mission(*(robot(f"r_{k}", place, **given) for k, place in enumerate(places)))


def send_across(world, team):
    for one in team.robots:
        x, y = one.position[:2]
        world.ports[one.id].send([Waypoint((-x, -y, 0.0))])


def until_idle(world, limit_s):
    """When each robot had carried out its order; the robots that had not are not in it."""
    done = {}
    while len(done) < len(world.ports) and world.time_s < limit_s - world.dt_s / 2:
        done.update({one.robot: one.time_s for one in world.advance(limit_s) if one.idle})
    return done


def states(world, steps):
    """Positions (steps + 1, n, 3), headings (steps + 1, n), velocities (steps, n, 3)."""
    positions, headings, velocities = [world.positions], [world.headings], []
    for _ in range(steps):
        world.step()
        positions.append(world.positions)
        headings.append(world.headings)
        velocities.append(world.velocities)
    return np.array(positions), np.array(headings), np.array(velocities)
