"""The assignment problem by an auction with rising prices.

[bertsekas1988]; persons and objects need not be equal in number [bertsekas1992]: a forward auction, in which persons
raise the prices of the objects that they want most by at least epsilon, and then a reverse auction, in which objects
without a person lower theirs. Epsilon is scaled: both are repeated with a fifth of it, from the prices reached. At the
end epsilon-complementary slackness holds: each person's object is within epsilon of the best for it at these prices,
so that the sum of benefits is within (number of persons) times epsilon of the greatest.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from muster.mission.values.arrays import Floats, Indices

_SCALE = 5.0
_NOBODY = -1


def assign(benefit: Floats, epsilon: float) -> Indices:
    """(persons,) the object of each person; `benefit` is (persons, objects), with no more persons than objects, finite.

    Raises
    ------
    ValueError
        if there are more persons than objects, or epsilon is not above 0.
    """
    persons, objects = benefit.shape
    if persons > objects or not epsilon > 0:
        raise ValueError("expected no more persons than objects, and an epsilon above 0")
    prices = np.zeros(objects)
    if not persons:
        return np.empty(0, dtype=np.int64)
    current = max(epsilon, float(benefit.max() - benefit.min()) / 4.0)
    while True:
        assigned = reverse(benefit, prices, forward(benefit, prices, current), current)
        if current == epsilon:
            return assigned
        current = max(epsilon, current / _SCALE)


def forward(benefit: Floats, prices: Floats, epsilon: float) -> Indices:
    """Until each person has an object, one that has none bids for the best at these prices; raises `prices`."""
    persons, objects = benefit.shape
    assigned = np.full(persons, _NOBODY, dtype=np.int64)
    owner = np.full(objects, _NOBODY, dtype=np.int64)
    waiting = deque(range(persons))
    while waiting:
        person = waiting.popleft()
        best, value, second = _two_best(benefit[person] - prices)
        prices[best] += value - second + epsilon
        if owner[best] != _NOBODY:
            assigned[owner[best]] = _NOBODY
            waiting.append(int(owner[best]))
        owner[best], assigned[person] = person, best
    return assigned


def reverse(benefit: Floats, prices: Floats, assigned: Indices, epsilon: float) -> Indices:
    """Until no object without a person costs more than the cheapest with one, the former bid for persons."""
    persons, objects = benefit.shape
    profits = benefit[np.arange(persons), assigned] - prices[assigned]
    least = float(prices[assigned].min())
    free = np.ones(objects, dtype=np.bool_)
    free[assigned] = False
    while len(dear := np.flatnonzero(free & (prices > least))):
        one = int(dear[0])
        person, value, second = _two_best(benefit[:, one] - profits)
        if least >= value - epsilon:
            prices[one] = least
            continue
        step = min(value - least, value - second + epsilon)
        prices[one] = value - step
        profits[person] += step
        free[assigned[person]], free[one] = True, False
        assigned[person] = one
    return assigned


def _two_best(values: Floats) -> tuple[int, float, float]:
    """The index of the greatest, it, and the second greatest (the greatest itself if it is alone)."""
    best = int(np.argmax(values))
    if len(values) == 1:
        return best, float(values[best]), float(values[best])
    second = float(np.partition(values, len(values) - 2)[-2])
    return best, float(values[best]), second
