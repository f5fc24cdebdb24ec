"""Every admissible plan of a small mission, by building them all."""

from itertools import chain, combinations, product

ROUNDING = 1e-9


class EveryPlan:
    """Each plan is built by appending units of work, tasks that begin together, in some order of the graph."""

    def __init__(self, meaning, most=None):
        """`most`: how many plans are looked at; None: all. `complete` tells whether those were all."""
        self.meaning, self._most = meaning, most
        self._teams = [self._teams_of(j) for j in range(len(meaning.tasks))]
        self._seen, self.admissible, self.complete = set(), [], True
        self._build(tuple(() for _ in meaning.robots))

    def _teams_of(self, j):
        robots = range(len(self.meaning.robots))
        sets = chain.from_iterable(combinations(robots, size) for size in range(1, len(robots) + 1))
        return [members for members in sets if self.meaning.is_team(j, members)]

    def _build(self, routes):
        if routes in self._seen or self.meaning.hopeless(routes):
            return
        self._seen.add(routes)
        if self._most is not None and len(self._seen) > self._most:
            self.complete = False
            return
        if not self.meaning.faults(routes):
            self.admissible.append(routes)
        done = {j for route in routes for j in route}
        for unit in self.meaning.units:
            if done.isdisjoint(unit) and all(done.issuperset(self.meaning.before[j]) for j in unit):
                for longer in self._with_unit(routes, unit):
                    self._build(longer)

    def _with_unit(self, routes, unit):
        """Routes with the unit at the end of those of its robots, who are different for different tasks."""
        for teams in product(*(self._teams[j] for j in unit)):
            by_robot = {i: j for j, members in zip(unit, teams, strict=True) for i in members}
            if len(by_robot) == sum(map(len, teams)):
                yield tuple((*route, by_robot[i]) if i in by_robot else route for i, route in enumerate(routes))

    def best(self):
        """((weight, objective, tie), routes) of the best of all plans."""
        values = [(self.meaning.value(routes), routes) for routes in self.admissible]
        weight = max(value[0] for value, _ in values)
        return min((value[1:], value, routes) for value, routes in values if value[0] >= weight - ROUNDING)[1:]

    def done(self):
        """The sets of tasks that admissible plans do."""
        return {frozenset(j for route in routes for j in route) for routes in self.admissible}
