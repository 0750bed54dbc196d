"""Rays and discs for tests."""

from typing import Any, Tuple

import detp
import numpy as np
import numpy.typing as npt


def some_discs(count: int, kind: Any = np.float64) -> Tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Centres and normals."""
    random = np.random.default_rng(1)
    return random.uniform(-1, 1, (count, 3)).astype(kind), random.normal(size=(count, 3)).astype(kind)


def some_rays(count: int, kind: Any = np.float64, seed: int = 2) -> Tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Origins and directions."""
    random = np.random.default_rng(seed)
    return random.uniform(-1, 1, (count, 3)).astype(kind), random.normal(size=(count, 3)).astype(kind)


def same(a: detp.Found, b: detp.Found) -> bool:
    return a.hits.tobytes() == b.hits.tobytes() and a.irradiance.tobytes() == b.irradiance.tobytes()
