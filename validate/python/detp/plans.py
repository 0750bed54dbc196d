"""Plans, and their searches."""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional, Tuple, Union

import numpy as np

from . import _show
from ._arrays import pointer
from ._declarations import ffi
from ._library import LongCall, Progress, call, lib, make, owned
from .costs import Costs, handle_of
from .found import Estimate, Found
from .problem import Discs, Rays


@dataclass
class Batch:
    """The next rays of a search until an error."""

    rays: Rays
    photons: float = 0  #: emitted, with those that gave no ray; 0: as many as rays
    scale: float = 1  #: irradiance of these rays times scale is that as if they were all photons


#: Makes about so many rays of whole photons; None: there are no more. Photons of different calls are independent.
NextRays = Callable[[int], Union[Rays, Batch, None]]


def plan(discs: Discs, rays: Rays, *, costs: Optional[Costs] = None, expected_rays: float = 0, farthest: float = 0,
         front_facing: bool = False, threads: int = 0, once: bool = False,
         progress: Optional[Progress] = None) -> Plan:
    """Chooses technique and parameters by a pilot, and builds the index.

    :param discs: of all searches; copied.
    :param rays: some or all of those that will be searched.
    :param costs: default: the built-in ones, of another machine.
    :param expected_rays: number of rays of each search; 0: as many as are shown.
    :param farthest: most distance of a ray's origin from the centre of the discs; 0: 1000 times their extent.
    :param front_facing: only rays that arrive at a disc's front hit.
    :param threads: most threads, for planning and for each search; 0: all cores.
    :param once: the plan is executed once or twice, so that planning must be short.
    :param progress: called with what is done, and with the share of the work.

    Raises ValueError, with the number of the bad element, for malformed rays or discs; MemoryError; what `progress` raises.
    """
    options = make("detp_plan_options")
    options.costs = handle_of(costs)
    options.rays, options.farthest = expected_rays, farthest
    options.front_facing, options.threads, options.once = front_facing, threads, once
    long = LongCall(progress)
    options.progress = long.callback
    handle = owned("detp_plan")
    long.run(lib.detp_plan_create, discs._view, rays._view, options, handle)
    return Plan(handle)


class Plan:
    """Technique, parameters and index for some discs. Threads may search it at once. Made by `plan`."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle
        facts = make("detp_plan_facts")
        call(lib.detp_plan_describe, handle[0], facts)
        self.technique: str = ffi.string(facts.technique).decode()
        self.parameters: Dict[str, Any] = json.loads(ffi.string(facts.parameters))
        self.discs = int(facts.discs)
        self.threads = int(facts.threads)  #: of a search
        self.predicted_seconds = float(facts.predicted_seconds)  #: of a search, building the index included
        self.predicted_seconds_again = float(facts.predicted_seconds_again)  #: of a repeated one, in the same memory
        #: the wait for one search of rays in memory, predicted, by part (`detp run` also reads and traces)
        self.whole: Dict[str, float] = {"read": 0.0, "trace": 0.0, "prepare": float(facts.prepare_seconds),
                                        "search": self.predicted_seconds - float(facts.prepare_seconds),
                                        "total": self.predicted_seconds}
        self.peak_bytes = float(facts.peak_bytes)  #: predicted memory of rays, discs and a first search of them
        self.predicted_error = float(facts.predicted_error)  #: its standard error; 0: not known
        self.planning_seconds = float(facts.planning_seconds)
        self._local = threading.local()

    def with_radius(self, radius: float, expected_rays: float = 0) -> Plan:
        """The same samples with discs of another radius, all alike, for progressive estimation. Takes microseconds; the
        first search builds the index. Raises ValueError for a radius or a number of rays out of range."""
        handle = owned("detp_plan")
        call(lib.detp_plan_with_radius, self._handle[0], radius, expected_rays, handle)
        return Plan(handle)

    def search(self, rays: Rays, *, pairs: bool = False, standard_error: bool = False, counts: bool = False,
               threads: int = 0, progress: Optional[Progress] = None) -> Found:
        """Finds every pair of a ray and a disc that it crosses, each exactly once.

        The same rays and discs give the same bytes, with any technique and any number of threads.

        :param pairs: also which ray crosses which disc.
        :param standard_error: also errors and bounds.
        :param counts: also numbers of operations, which takes some time.
        :param threads: 0: those of the plan.
        :param progress: as for `plan`.

        Raises as `plan` does.
        """
        found = make("detp_found")
        hits = np.empty(self.discs, np.uint64)
        shape = (self.discs,) if rays.bands == 1 else (self.discs, rays.bands)
        found.bands = rays.bands
        irradiance = np.empty(shape)
        found.hits, found.irradiance = pointer("uint64_t", hits), pointer("double", irradiance)
        errors = np.empty((2, *shape)) if standard_error else None
        if errors is not None:
            found.standard_error, found.upper_bound = pointer("double", errors[0]), pointer("double", errors[1])
        options = make("detp_search_options")
        options.pairs, options.count, options.threads = pairs, counts, threads
        long = LongCall(progress)
        options.progress = long.callback
        scratch = self._scratch()
        long.run(lib.detp_search, self._handle[0], rays._view, scratch[0], options, found)
        offsets, rows = self._pairs(scratch, int(found.total_hits)) if pairs else (None, None)
        return Found(hits, irradiance, None if errors is None else errors[0], None if errors is None else errors[1],
                     offsets, rows, int(found.total_hits), float(found.seconds),
                     counts_of(found.counts) if counts else None)

    def search_until(self, next_rays: NextRays, noise: float, *, confidence: float = 0.95, most_rays: float = 1e9,
                     bands: int = 1, noise_of: Optional[int] = None, progress: Optional[Progress] = None) -> Estimate:
        """Searches batches of rays until the noise is below the target.

        :param next_rays: makes the next rays.
        :param noise: relative to the root mean square irradiance, over the discs by area: 0.05.
        :param confidence: that the noise of this run is smaller.
        :param most_rays: ends the search without the target.
        :param bands: of the rays' powers.
        :param noise_of: the number of the band whose noise is meant; None: of the sum of all bands.

        Raises ValueError for targets out of range and for malformed rays; what `next_rays` and `progress` raise.
        """
        target = make("detp_target")
        target.noise, target.confidence, target.most_rays = noise, confidence, most_rays
        if noise_of is not None:
            if not 0 <= noise_of < bands:
                raise ValueError(f"noise_of is {noise_of}, but bands are numbered from 0 to {bands - 1}")
            target.noise_of = 1 + noise_of
        estimate = make("detp_estimate")
        estimate.bands = bands
        irradiance = np.empty(self.discs if bands == 1 else (self.discs, bands))
        estimate.irradiance = pointer("double", irradiance)
        long = LongCall(progress)
        kept: List[Batch] = []  # until the next call

        def give(wanted: int, rays: Any, photons: Any, scale: Any) -> int:
            made = next_rays(wanted)
            if made is None:
                return 1
            batch = made if isinstance(made, Batch) else Batch(made)
            kept[:] = [batch]
            rays[0] = batch.rays._view[0]
            photons[0], scale[0] = batch.photons, batch.scale
            return 0

        callback = ffi.callback("int(void *, uint64_t, detp_rays *, double *, double *)",
                                lambda _, *arguments: long.guarded(2, give, *arguments), error=2)
        long.run(lib.detp_search_until, self._handle[0], callback, ffi.NULL, target, long.callback, ffi.NULL, estimate)
        return Estimate(irradiance, estimate.noise, estimate.noise_low, estimate.noise_high, estimate.photons,
                        int(estimate.rays), estimate.reason == lib.DETP_REACHED, estimate.share_bound or None)

    def _scratch(self) -> Any:
        """Of this thread."""
        if not hasattr(self._local, "scratch"):
            scratch = owned("detp_scratch")
            call(lib.detp_scratch_create, scratch)
            self._local.scratch = scratch
        return self._local.scratch

    def _pairs(self, scratch: Any, total: int) -> Tuple[Any, Any]:
        offsets = np.empty(self.discs + 1, np.uint64)
        rays = np.empty(total, np.uint32)
        call(lib.detp_pairs, scratch[0], pointer("uint64_t", offsets), pointer("uint32_t", rays), total)
        return offsets, rays

    def _rows(self) -> List[Tuple[str, object]]:
        error = f" ± {self.predicted_error:.1g}" if self.predicted_error > 0 else ""
        return [("technique", self.technique), ("parameters", _show.parameters(self.parameters)),
                ("predicted", f"{self.predicted_seconds:.3g}{error} s"), ("discs", self.discs), ("threads", self.threads)]

    def __repr__(self) -> str:
        return f"Plan({', '.join(f'{name}: {value}' for name, value in self._rows())})"

    def _repr_html_(self) -> str:
        return _show.table("Plan", self._rows())


def find_hits(discs: Discs, rays: Rays, *, front_facing: bool = False, threads: int = 0,
              progress: Optional[Progress] = None) -> Found:
    """All pairs of a ray and a disc that it crosses, each exactly once, without a plan of one's own. Raises as `plan`."""
    made = plan(discs, rays, front_facing=front_facing, threads=threads, once=True, progress=progress)
    return made.search(rays, pairs=True, progress=progress)


def counts_of(counts: Any) -> Dict[str, float]:
    return {name: getattr(counts, name) for name, _ in ffi.typeof("detp_counts").fields}
