"""Results of searches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _show

Floats = npt.NDArray[np.float64]


def by_band(columns: Dict[str, Any]) -> Dict[str, Any]:
    """A column for each band of arrays of shape (n, k), as irradiance_0."""
    found: Dict[str, Any] = {}
    for name, values in columns.items():
        if np.ndim(values) == 2:
            found.update({f"{name}_{band}": values[:, band] for band in range(values.shape[1])})
        else:
            found[name] = values
    return found


class _PerDisc:
    """Results with arrays of one element for each disc."""

    def _columns(self) -> Dict[str, Any]:
        raise NotImplementedError

    def to_pandas(self) -> Any:
        """A data frame with a row for each disc. Needs pandas."""
        import pandas

        return pandas.DataFrame(self._columns()).rename_axis("disc")


@dataclass(frozen=True, repr=False)
class Found(_PerDisc):
    """What a search found. Arrays have an element for each disc; of rays with k bands, all but the hits have the shape (n, k)."""

    hits: npt.NDArray[np.uint64]  #: (n,) rays that cross the disc
    irradiance: Floats  #: (n,) their power over the disc's area
    standard_error: Optional[Floats]  #: (n,) of the irradiance; infinite with fewer than two photons
    upper_bound: Optional[Floats]  #: (n,) one-sided, 95 %, of the irradiance
    offsets: Optional[npt.NDArray[np.uint64]]  #: (n + 1,) the pairs in compressed rows: the rays that cross disc i are
    rays: Optional[npt.NDArray[np.uint32]]  #: (total_hits,) rays[offsets[i]:offsets[i + 1]], ascending
    total_hits: int
    seconds: float  #: of the search
    counts: Optional[Dict[str, float]]  #: operations, by name

    def rays_of(self, disc: int) -> npt.NDArray[np.uint32]:
        """The rays that cross a disc, ascending. Raises ValueError if pairs were not asked for."""
        if self.offsets is None or self.rays is None:
            raise ValueError("there are no pairs: search with pairs=True")
        if not 0 <= disc < len(self.hits):
            raise IndexError(f"there is no disc {disc}; there are {len(self.hits)}")
        return self.rays[int(self.offsets[disc]):int(self.offsets[disc + 1])]

    def _columns(self) -> Dict[str, Any]:
        errors = {} if self.standard_error is None else {"standard_error": self.standard_error,
                                                         "upper_bound": self.upper_bound}
        return by_band({"hits": self.hits, "irradiance": self.irradiance, **errors})

    def _rows(self) -> List[Tuple[str, object]]:
        return [("discs", len(self.hits)), ("hits", self.total_hits), ("hits a disc", f"{self.hits.mean():.4g}"),
                ("mean irradiance", _show.means(self.irradiance)), ("search", _show.seconds(self.seconds))]

    def __repr__(self) -> str:
        return f"Found({self.total_hits} hits of {len(self.hits)} discs in {_show.seconds(self.seconds)})"

    def _repr_html_(self) -> str:
        return _show.table("Found", self._rows())


@dataclass(frozen=True, repr=False)
class Estimate(_PerDisc):
    """The result of a search until an error."""

    irradiance: Floats  #: (n,), or (n, k) in k bands
    noise: float  #: relative to the root mean square irradiance, over the discs by area
    noise_low: float  #: with the confidence of the target, each end alone
    noise_high: float
    photons: float
    rays: int
    reached: bool  #: the target; if not, there were no more rays
    #: if no photon met any disc: at most this share of the photons meets one, with 95 %; else None
    share_bound: Optional[float]

    def _columns(self) -> Dict[str, Any]:
        return by_band({"irradiance": self.irradiance})

    def _rows(self) -> List[Tuple[str, object]]:
        return [("noise", f"{self.noise:.3%} ({self.noise_low:.3%} to {self.noise_high:.3%})"),
                ("photons", f"{self.photons:.0f}"), ("rays", self.rays),
                ("ended", "noise below the target" if self.reached else "no more rays")]

    def __repr__(self) -> str:
        return f"Estimate({', '.join(f'{name}: {value}' for name, value in self._rows())})"

    def _repr_html_(self) -> str:
        return _show.table("Estimate", self._rows())
