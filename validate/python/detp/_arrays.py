"""numpy's arrays as views of the C interface, and back."""

from __future__ import annotations

from typing import Any, List, Optional, Union

import numpy as np
import numpy.typing as npt

from ._declarations import ffi
from ._library import lib

#: Anything that numpy takes as an array of numbers. float32 and float64 are not copied, whatever their strides, unless these
#: are 0 or negative; other numbers are converted to float64.
Array = npt.ArrayLike
Numbers = Union[float, npt.ArrayLike]


def _floats(array: Array, name: str) -> npt.NDArray[Any]:
    floats = np.asarray(array)
    if floats.dtype not in (np.float32, np.float64) or not floats.dtype.isnative:
        if floats.dtype.kind not in "iuf":
            raise TypeError(f"{name} must be numbers (got {floats.dtype})")
        floats = floats.astype(np.float64)
    if len(floats.shape) > 0 and len(floats) > 1 and floats.strides[0] <= 0:
        floats = np.ascontiguousarray(floats)
    return floats


def _type(array: npt.NDArray[Any]) -> int:
    return int(lib.DETP_FLOAT if array.dtype == np.float32 else lib.DETP_DOUBLE)


def vectors(array: Array, name: str, view: Any, count: Optional[int] = None) -> npt.NDArray[Any]:
    """Sets a detp_vectors. Returns the array to which it refers, of shape (n, 3)."""
    floats = _floats(array, name)
    if floats.ndim != 2 or floats.shape[1] != 3:
        raise ValueError(f"{name} must have the shape (n, 3) (got {floats.shape})")
    _require_count(floats, name, count)
    address, step = floats.ctypes.data, floats.strides[1]
    if len(floats) > 0:
        view.x, view.y, view.z = (ffi.cast("void *", address + k * step) for k in range(3))
    view.stride = floats.strides[0] if len(floats) > 1 else floats.itemsize
    view.type = _type(floats)
    return floats


def numbers(array: Numbers, name: str, view: Any, count: int) -> npt.NDArray[Any]:
    """Sets a detp_numbers, from one number for all or from an array of shape (n,)."""
    floats = _floats(array, name)
    view.type = _type(floats)
    if floats.ndim == 0:
        view.of_all = float(floats)
        return floats
    if floats.ndim != 1:
        raise ValueError(f"{name} must be one number, or have the shape (n,) (got {floats.shape})")
    _require_count(floats, name, count)
    view.data = ffi.cast("void *", floats.ctypes.data)
    view.stride = floats.strides[0] if len(floats) > 1 else floats.itemsize
    return floats


def bands(array: Numbers, name: str, count: int) -> List[Any]:
    """The columns of an array of shape (n, k); anything else as it is."""
    given = np.asarray(array)
    if given.ndim != 2:
        return [array]
    if given.shape[1] == 0:
        raise ValueError(f"{name} must have one band or more (got the shape {given.shape})")
    _require_count(given, name, count)
    floats = _floats(given, name)
    return [floats[:, band] for band in range(given.shape[1])]


def whole_numbers(array: Array, name: str, count: int) -> npt.NDArray[np.uint64]:
    given = np.asarray(array)
    if given.ndim != 1 or given.dtype.kind not in "iu":
        raise ValueError(f"{name} must be whole numbers of shape (n,) (got {given.dtype} of shape {given.shape})")
    _require_count(given, name, count)
    if given.dtype.kind == "i" and len(given) > 0 and given.min() < 0:
        raise ValueError(f"{name} must not be negative")
    return np.ascontiguousarray(given, dtype=np.uint64)


def pointer(kind: str, array: npt.NDArray[Any]) -> Any:
    """To the first element of an array of the library's results."""
    return ffi.cast(kind + " *", array.ctypes.data)


def _require_count(array: npt.NDArray[Any], name: str, count: Optional[int]) -> None:
    if count is not None and len(array) != count:
        raise ValueError(f"{name} must have {count} elements (got {len(array)})")
