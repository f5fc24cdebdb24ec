"""Ways of robots between places, by docs/design.md: straight ones and those of travel tables."""

import math


class OwnTravel:
    """Metres and seconds from a task (None: the robot's start) to a task ("end": where the robot must end)."""

    def __init__(self, mission):
        self._mission = mission
        self._metres, self._seconds = {}, {}

    def has_end(self, i):
        return self._end(i) is not None

    def _end(self, i):
        robot, rules = self._mission.robots[i], self._mission.rules
        if robot.end_position is not None:
            return robot.end_position
        returns = rules.return_to_start if robot.return_to_start is None else robot.return_to_start
        return robot.position if returns else None

    def metres(self, i, a, b):
        key = i, id(a), id(b)
        if key not in self._metres:
            self._metres[key] = self._length(i, a, b)
        return self._metres[key]

    def _length(self, i, a, b):
        robot = self._mission.robots[i]
        if self._mission.rules.travel == "matrix":
            table = self._mission.travel_tables[robot.type]
            from_, to = robot.id if a is None else a.id, robot.id if b == "end" else b.id
            return table.metres[table.places.index(from_)][table.places.index(to)]
        from_ = robot.position if a is None else a.exit or a.position
        to = self._end(i) if b == "end" else b.entry or b.position
        return math.dist(from_, to)

    def seconds(self, i, a, b):
        key = i, id(a), id(b)
        if key not in self._seconds:
            self._seconds[key] = self.metres(i, a, b) / self._mission.robots[i].speed_mps
        return self._seconds[key]
