"""What an operation costs."""

from __future__ import annotations

from typing import Any, Optional

from ._declarations import ffi
from ._library import LongCall, Progress, call, lib, owned


class Costs:
    """Seconds of each operation: `built_in`, `stored` or `measured`. Never changes."""

    def __init__(self, handle: Any, what: str) -> None:
        self._handle = handle
        self._what = what

    @staticmethod
    def built_in() -> Costs:
        """Those of another machine: predicted seconds may be off by a factor of two."""
        handle = owned("detp_costs")
        call(lib.detp_costs_built_in, handle)
        return Costs(handle, "built in")

    @staticmethod
    def stored() -> Costs:
        """Those that `detp calibrate` or `measured` stored for this machine; the built-in ones if there are none."""
        handle = owned("detp_costs")
        call(lib.detp_costs_stored, handle)
        return Costs(handle, "stored")

    @staticmethod
    def measured(seconds: float = 17, store: bool = False, progress: Optional[Progress] = None) -> Costs:
        """Measured now, in about so many seconds.

        :param store: for `stored`.
        """
        handle = owned("detp_costs")
        long = LongCall(progress)
        long.run(lib.detp_costs_measured, seconds, store, long.callback, ffi.NULL, handle)
        return Costs(handle, "measured")

    def __repr__(self) -> str:
        return f"Costs({self._what})"


def handle_of(costs: Optional[Costs]) -> Any:
    return ffi.NULL if costs is None else costs._handle[0]
