"""Progressive estimation: each pass has new photons and smaller discs, and the index is planned only once."""

import detp
import numpy as np

random = np.random.default_rng(1)
floor = np.column_stack([random.uniform(0, 1, (5000, 2)), np.zeros(5000)])
up = np.broadcast_to([0.0, 0.0, 1.0], floor.shape)


def photons(count: int) -> detp.Rays:
    """From a lamp of the power 1 at the ceiling, which shines down on the floor."""
    origins = np.column_stack([random.uniform(0.4, 0.6, (count, 2)), np.ones(count)])
    directions = np.column_stack([random.uniform(-0.5, 0.5, (count, 2)), -np.ones(count)])
    return detp.Rays(origins, directions, lengths=np.inf, powers=1 / count)


radius = 0.05
plan = detp.plan(detp.Discs(floor, up, radius), photons(20000))
mean = np.zeros(len(floor))
for number in range(1, 9):
    found = plan.search(photons(20000))
    mean += (found.irradiance - mean) / number
    print(f"pass {number}: radius {radius:.4f}, {plan.technique}, {found.total_hits} hits, mean irradiance {mean.mean():.4f}")
    radius *= np.sqrt((number + 0.7) / (number + 1))
    plan = plan.with_radius(radius)
