"""How much energy a robot can have by when, without any rounding off.

A frontier is a list of points (time, energy), rising in both. Energy rises linearly between two points, jumps where two
points have the same time, is constant after the last point, and before the first one the robot is not there.
"""

import itertools
from bisect import bisect_left, bisect_right
from math import inf

TINY = 1e-9


def at(points, time):
    """The energy at a time; -inf before the first point."""
    return _between(points, bisect_right(points, time, key=lambda point: point[0]), time)


def before(points, time):
    """The energy that a time is approached with."""
    return _between(points, bisect_left(points, time, key=lambda point: point[0]), time)


def _between(points, number, time):
    if number == 0:
        return -inf
    if number == len(points):
        return points[-1][1]
    (low, energy), (high, more) = points[number - 1], points[number]
    return energy if high <= low or more == energy else energy + (more - energy) * (time - low) / (high - low)


def shifted(points, seconds, energy):
    """The frontier once so much time and energy is gone; none where there was not so much of it."""
    return kept_from([(time + seconds, level - energy) for time, level in points], 0.0)


def time_of(points, least):
    """The first time with at least so much energy; inf where there is none."""
    if points[-1][1] < least - TINY:
        return inf
    if points[0][1] >= least - TINY:
        return points[0][0]
    for (low, energy), (high, more) in itertools.pairwise(points):
        if more >= least - TINY:
            if more <= energy or high <= low:
                return high
            return min(high, low + (high - low) * max(0.0, least - energy) / (more - energy))
    return inf


def kept_from(points, least):
    """The part with at least so much energy."""
    first = time_of(points, least) if points else inf
    if first == inf:
        return []
    start = max(least, at(points, first))
    return [(first, start), *(point for point in points if point[0] > first and point[1] >= start)]


def kept_to(points, latest):
    """The part that is no later than this."""
    if not points or points[0][0] > latest + TINY:
        return []
    kept = [point for point in points if point[0] <= latest]
    if not kept:
        return [points[0]]
    return kept if len(kept) == len(points) else [*kept, (latest, at(points, latest))]


def begun(points, windows, latest):
    """The frontier where work begins: in one of the windows (in order), and no later than `latest`."""
    found = []
    for opens, closes in windows or ((-inf, inf),):
        part = kept_to(points, min(closes, latest))
        if not part or part[0][0] > min(closes, latest) + TINY:
            continue
        start = max(opens, part[0][0])
        if start > min(closes, latest) + TINY:
            continue
        own = [(start, at(part, start)), *(point for point in part if point[0] > start)]
        if found:
            found.append((own[0][0], found[-1][1]))
        found += own
    return found


def charged(points, rate, full):
    """The frontier after a charge of any length."""
    found = [points[0]]
    for (low, energy), (high, more) in itertools.pairwise(points):
        level = found[-1][1]
        slope = (more - energy) / (high - low) if high > low else inf
        if high > low and slope > rate and energy < level < more:
            cross = (level - energy) / (slope - rate)
            if cross < high - low:
                found.append((low + cross, level + rate * cross))
        found.append((high, max(more, level + rate * (high - low))))
    time, level = found[-1]
    found.append((time + max(0.0, full - level) / rate, full))
    return [*(point for point in found if point[1] < full), *next([point] for point in capped(found, full))]


def capped(points, full):
    """The first point at which the battery is full."""
    yield (time_of([(time, min(level, full)) for time, level in _meeting(points, full)], full), full)


def _meeting(points, full):
    """The points with the one at which a line comes to a level."""
    for (low, energy), (high, more) in itertools.pairwise(points):
        yield low, energy
        if energy < full < more and high > low:
            yield low + (high - low) * (full - energy) / (more - energy), full
    yield points[-1]


def filled(points, rate, full):
    """The frontier after a charge until the battery is full."""
    return [(min(time + max(0.0, full - level) / rate for time, level in points), full)]


def covers(points, others):
    """Whether there is at least as much energy at all times."""
    if points[0][0] > others[0][0]:
        return False
    times = {time for time, _ in (*points, *others) if time >= others[0][0]}
    return all(at(points, t) >= at(others, t) and before(points, t) >= before(others, t) for t in times)
