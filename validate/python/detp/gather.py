"""Irradiance by backward paths."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _show
from ._arrays import pointer
from ._declarations import ffi
from ._library import LongCall, Progress, lib, make
from .found import Floats, _PerDisc, by_band
from .problem import Discs


@dataclass(frozen=True, repr=False)
class Gathered(_PerDisc):
    """Irradiance at samples. Arrays have an element for each; in colours, all but the hits have the shape (n, 3)."""

    hits: npt.NDArray[np.uint64]  #: (n,) paths that brought light
    irradiance: Floats  #: (n,) at the sample, not blurred
    standard_error: Floats  #: (n,) infinite if fewer than two paths brought light; weak where a few bring most
    upper_bound: Floats  #: (n,) one-sided, 95 %; infinite if no path of any sample brought light
    missed_share: float  #: of all light that lands on surfaces, what no backward path finds; the irradiance is without it
    missed_bound: float  #: one-sided, 95 %, of that share; 0: all light is found
    seconds: float  #: without reading the scene

    def _columns(self) -> Dict[str, Any]:
        return by_band({"hits": self.hits, "irradiance": self.irradiance, "standard_error": self.standard_error,
                        "upper_bound": self.upper_bound})

    def _rows(self) -> List[Tuple[str, object]]:
        missed = [] if self.missed_bound == 0 else [("missed", f"{self.missed_share:.2%} (at most {self.missed_bound:.2%})")]
        return [("samples", len(self.hits)), ("mean irradiance", _show.means(self.irradiance)), *missed,
                ("paths", _show.seconds(self.seconds))]

    def __repr__(self) -> str:
        return f"Gathered({', '.join(f'{name}: {value}' for name, value in self._rows())})"

    def _repr_html_(self) -> str:
        return _show.table("Gathered", self._rows())


def gather(scene: Union[str, os.PathLike[str]], discs: Discs, *, paths: int = 64, seed: int = 1,
           front_facing: bool = False, rgb: bool = False, threads: int = 0,
           progress: Optional[Progress] = None) -> Gathered:
    """Irradiance at the discs' centres by paths that start there and look for the lights: no bias, no photons.

    Light of points, spots and directional lights by way of mirrors, gloss or glass is not found: see `Gathered.missed_share`.
    The same seed gives the same bytes with any number of threads.

    :param scene: a mesh file, or a built-in scene as "@cornell", with its own lights, or without any an area light.
    :param discs: samples; their radii do not matter.
    :param paths: for each sample, on each side that counts.
    :param front_facing: only light on the side of the normal counts.
    :param rgb: in red, green and blue, by the colours of the scene's materials: arrays of shape (n, 3).
    :param threads: 0: all cores.
    :param progress: called with what is done, and with the share of the work.

    Raises ValueError for malformed samples, unknown scenes and scenes without light; OSError for files; what `progress` raises.
    """
    if not 1 <= paths <= 2**32:
        raise ValueError(f"number of paths must be 1 to {2**32} (got {paths})")
    count = len(discs)
    hits = np.empty(count, np.uint64)
    of_each = np.empty((3, count, 3) if rgb else (3, count))
    gathered = make("detp_gathered")
    gathered.hits = pointer("uint64_t", hits)
    gathered.irradiance, gathered.standard_error, gathered.upper_bound = (pointer("double", one) for one in of_each)
    options = make("detp_gather_options")
    options.paths, options.seed, options.front_facing, options.threads = paths, seed, front_facing, threads
    options.rgb = rgb
    long = LongCall(progress)
    options.progress = long.callback
    name = ffi.new("char[]", os.fsencode(scene))
    long.run(lib.detp_gather, name, discs._view, options, gathered)
    return Gathered(hits, of_each[0], of_each[1], of_each[2], float(gathered.missed_share), float(gathered.missed_bound),
                    float(gathered.seconds))
