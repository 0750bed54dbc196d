"""Rays and discs in arrays."""

from __future__ import annotations

from typing import Any, List, Optional

from ._arrays import Array, Numbers, bands, numbers, pointer, vectors, whole_numbers
from ._declarations import ffi
from ._library import make


class Rays:
    """Rays in arrays, which are not copied. They may be changed between calls.

    :param origins: (n, 3), lengths.
    :param directions: (n, 3), of any length except 0.
    :param lengths: how far each ray reaches from its origin, (n,) or one number; without: lines without ends, both ways.
    :param powers: (n,) or one number, in any unit; (n, k) for powers in k bands; without: 1.
    :param photons: (n,) whole numbers, ascending: the photon of each ray. Rays of one photon count as one in standard
        errors; without: each ray is a photon of its own.

    Raises ValueError for arrays of other shapes, TypeError for what are no numbers.
    """

    def __init__(self, origins: Array, directions: Array, lengths: Optional[Numbers] = None,
                 powers: Optional[Numbers] = None, photons: Optional[Array] = None) -> None:
        self._view = view = make("detp_rays")
        first = vectors(origins, "origins", view.origins)
        view.count = count = len(first)
        self._arrays: List[Any] = [first, vectors(directions, "directions", view.directions, count)]
        if lengths is not None:
            self._arrays.append(numbers(lengths, "lengths", view.lengths, count))
            _require_given("lengths", view.lengths)
        if powers is not None:
            first_band, *further = bands(powers, "powers", count)
            self._arrays.append(numbers(first_band, "powers", view.powers, count))
            _require_given("powers", view.powers)
            if further:
                view.further_bands = len(further)
                view.further_powers = many = ffi.new("detp_numbers[]", len(further))
                self._arrays += [many, *(numbers(one, "powers", many[i], count) for i, one in enumerate(further))]
        if photons is not None:
            self._arrays.append(whole_numbers(photons, "photons", count))
            if count > 0:
                view.photons = pointer("uint64_t", self._arrays[-1])

    @property
    def bands(self) -> int:
        """Number of powers of each ray."""
        return 1 + int(self._view.further_bands)

    def __len__(self) -> int:
        return int(self._view.count)

    def __repr__(self) -> str:
        return f"Rays({len(self)})"


class Discs:
    """Discs in arrays, which are not copied; a plan keeps 56 bytes a disc.

    :param centres: (n, 3), lengths.
    :param normals: (n, 3), of any length except 0.
    :param radii: > 0; (n,) or one number.

    Raises as Rays does.
    """

    def __init__(self, centres: Array, normals: Array, radii: Numbers) -> None:
        self._view = view = make("detp_discs")
        first = vectors(centres, "centres", view.centres)
        view.count = count = len(first)
        self._arrays: List[Any] = [first, vectors(normals, "normals", view.normals, count),
                                   numbers(radii, "radii", view.radii, count)]

    def __len__(self) -> int:
        return int(self._view.count)

    def __repr__(self) -> str:
        return f"Discs({len(self)})"


def _require_given(name: str, view: Any) -> None:
    """In C, the number 0 stands for the default."""
    if not view.data and view.of_all == 0:
        raise ValueError(f"{name} must not be 0 for all rays")
