"""Whether routes are admissible, by the primitives of the plan model alone: it knows no rule.

For problems in which nobody calls at stations. Loops are the simplest that are right.
"""

import math
from collections import Counter
from itertools import pairwise, permutations

CLOSE = 1e-9


def is_admissible(problem, routes):
    """Whether routes, lists of tasks by robot, keep all that the model says."""
    return Routes(problem, routes).are_admissible()


class Routes:
    """Routes, and what is looked at of them."""

    def __init__(self, problem, routes):
        self.problem, self.model, self.routes = problem, problem.model, routes
        self.crews = {}
        for i, route in enumerate(routes):
            for j in route:
                self.crews.setdefault(j, []).append(i)
        self.lasts = {j: max(problem.work_seconds(i)[j] for i in crew) for j, crew in self.crews.items()}

    def are_admissible(self):
        looked_at = (self.pairs, self.each_once, self.together, self.enough, self.crews_fit, self.tied, self.usages)
        return all(look() for look in (*looked_at, self.stops, self.goods, self.energies, self.times))

    def pairs(self):
        return all(self.problem.may(i, j) for j, crew in self.crews.items() for i in crew)

    def each_once(self):
        return all(max(Counter(route).values(), default=1) == 1 for route in self.routes)

    def together(self):
        """Units are whole, by different robots; nobody does what only follows something left out."""
        whole = all(len(set(unit) & self.crews.keys()) in (0, len(unit)) for unit in self.model.units)
        members = [[i for j in unit for i in self.crews.get(j, ())] for unit in self.model.units]
        apart = all(len(set(crew)) == len(crew) for crew in members)
        return whole and apart and all(k in self.crews for j in self.crews for k in self.model.awaited[j])

    def enough(self):
        """Deliveries are done by who has picked up, and nothing is picked up that nobody delivers."""
        pairs = [(j, k) for j, k in enumerate(self.model.pickups) if k >= 0]
        return all(self.crews.get(j, []) == self.crews.get(k, []) for j, k in pairs)

    def crews_fit(self):
        return all(self._fits(j, crew) for j, crew in self.crews.items())

    def _fits(self, j, crew):
        model = self.model
        if model.sums(j):
            return all(sum(able[i] for i in crew) >= least * (1 - CLOSE) for least, able in model.sums(j).values())
        seats = [fits for count, fits in model.seats(j) for _ in range(count)]
        return len(seats) == len(crew) and any(
            all(fits[i] for fits, i in zip(seats, order, strict=True)) for order in permutations(crew)
        )

    def tied(self):
        same = all(
            set(self.crews[j]) == set(self.crews[k])
            for j in self.crews
            for k in self.model.same_crew[j]
            if k in self.crews
        )
        others = (set(self.crews[j]) & set(self.crews.get(k, ())) for j in self.crews for k in self.model.apart[j])
        return same and not any(others)

    def usage(self, i):
        """What the whole route of a robot uses."""
        problem, route = self.problem, self.routes[i]
        if not route:
            return 0.0
        legs = sum(float(problem.legs(i, [a], [b])[0, 0]) for a, b in pairwise(self._places(i)))
        return legs + sum(float(problem.work_usage(i)[j]) for j in route)

    def _places(self, i):
        problem = self.problem
        ends = problem.robots[i].place_at_end(problem.mission.rules) is not None
        return [problem.start(i), *self.routes[i], *([problem.end(i)] if ends else [])]

    def usages(self):
        most = self.model.capacity
        return all(
            self.usage(i) <= most[i] * (1 + CLOSE) < math.inf or self.usage(i) < math.inf == most[i]
            for i in range(len(self.routes))
        )

    def energies(self):
        return all(self.usage(i) <= most * (1 + CLOSE) for i, most in enumerate(self.model.energy_at_start))

    def stops(self):
        return all(
            not route or len(route) >= least for route, least in zip(self.routes, self.model.least_stops, strict=True)
        )

    def goods(self):
        return all(self._stays_within(meter, i) for meter in self.model.meters for i in range(len(self.routes)))

    def _stays_within(self, meter, i):
        level, room = float(meter.at_start[i]), float(meter.most[i])
        slack = CLOSE * (1 + (room if math.isfinite(room) else 0.0))
        for j in self.routes[i]:
            level += float(meter.change[j])
            if not -slack <= level <= room + slack:
                return False
        return True

    def times(self):
        """Whether the least begins that all arcs allow exist, and nothing ends too late by them."""
        begins = self.begins()
        if begins is None:
            return False
        late = any(
            begins[j] + self.lasts[j] > by + CLOSE * (1 + by)
            for j in self.crews
            if math.isfinite(by := float(self.model.ends_by[j]))
        )
        return not late and all(self._is_over_in_time(i, begins) for i, route in enumerate(self.routes) if route)

    def _is_over_in_time(self, i, begins):
        last, by = self.routes[i][-1], float(self.model.over_by[i])
        home = sum(self._way(i, a, b) for a, b in pairwise(self._places(i)[len(self.routes[i]) :]))
        return begins[last] + self.lasts[last] + home <= by + CLOSE * (1 + abs(by)) if math.isfinite(by) else True

    def _way(self, i, place, to):
        return float(self.problem.travel_seconds(i, [place], [to])[0, 0])

    def begins(self):
        """The least begin of each task, seconds; None where tasks wait in a circle, or for ever."""
        first = dict.fromkeys(self.crews, 0.0)
        ahead, back = [], []
        for i, route in enumerate(self.routes):
            for k, j in enumerate(route):
                way = self._way(i, self._places(i)[k], j)
                if k:
                    ahead.append((route[k - 1], j, self.lasts[route[k - 1]] + way))
                else:
                    first[j] = max(first[j], self.problem.robots[i].available_from_s + way)
        for j in self.crews:
            for k, least, most in self.model.gaps(j):
                ahead.append((k, j, self.lasts[k] + least))
                if math.isfinite(most):
                    back.append((j, k, -most - self.lasts[k]))
        return None if self._waits_in_a_circle(ahead) else self._settled(first, [*ahead, *back])

    def _waits_in_a_circle(self, ahead):
        unit = self.model.unit
        left, arcs = {unit[j] for j in self.crews}, [(unit[a], unit[b]) for a, b, _ in ahead]
        while free := {u for u in left if not any(a in left and b == u for a, b in arcs)}:
            left -= free
        return bool(left)

    def _settled(self, begins, arcs):
        for _ in range(50 * (len(begins) + 2)):
            before = dict(begins)
            for a, b, seconds in arcs:
                begins[b] = max(begins[b], begins[a] + seconds)
            for j in begins:
                unit = [k for k in self.model.units[self.model.unit[j]] if k in begins]
                begins.update(dict.fromkeys(unit, max(begins[k] for k in unit)))
                spans = self.model.openings[j]
                if spans:
                    begins[j] = min(
                        (max(begins[j], a) for a, b in spans if begins[j] <= b + CLOSE * (1 + b)), default=math.inf
                    )
            if any(math.isinf(begin) for begin in begins.values()):
                return None
            if all(begins[j] <= before[j] + 1e-12 for j in begins):
                return begins
        return None

    def _open(self, j, ready):
        """When a task begins that is ready at a time; inf: never."""
        spans = self.model.openings[j] or [(-math.inf, math.inf)]
        begins = (max(ready, opens) for opens, closes in spans if ready <= closes + CLOSE * (1 + closes))
        return min(begins, default=math.inf)
