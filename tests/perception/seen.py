"""Raw estimates as drones with cameras make them, without the cameras."""

import numpy as np

from muster.perception.estimates import RawEstimates

NORTH = np.array([0.0, 1.0])
EAST = np.array([1.0, 0.0])


def seen(truth, counts, along_m, across_m=0.05, seed=0):
    """Estimates of things at `truth` (n, 2), each seen so many times from the south and decoded, in an order of chance.

    They scatter by `along_m` (n,) along the view, and less across it, as in Figure 6.5 of the thesis.
    """
    random = np.random.default_rng(seed)
    tags = random.permutation(np.repeat(np.arange(len(truth)), counts))
    along, across = random.normal(size=(2, len(tags)))
    shifts = np.outer(along * np.asarray(along_m)[tags], NORTH) + np.outer(across * across_m, EAST)
    return RawEstimates.at(np.asarray(truth)[tags] + shifts, tags, "r_0")
