"""Random robots that do not overlap."""

import numpy as np

from muster.motion.avoidance import Agents


def random_agents(seed, count, dimensions=2, spacing=4.5, radius=1.5, priorities=None):
    """On a jittered grid, with velocities and wishes in all directions."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(count ** (1 / dimensions)))
    axes = np.meshgrid(*[np.arange(side)] * dimensions)
    grid = spacing * np.stack(axes, axis=-1).reshape(-1, dimensions)[:count]
    jitter = (spacing - 2 * radius) / (2 * np.sqrt(dimensions))
    return Agents(
        positions=grid + random.uniform(-jitter, jitter, grid.shape),
        velocities=random.uniform(-1, 1, grid.shape),
        preferred=random.uniform(-1.2, 1.2, grid.shape),
        radii=np.full(count, radius),
        max_speeds=np.full(count, 2.0),
        priorities=priorities,
    )
