"""How results look in notebooks."""

from __future__ import annotations

from html import escape
from typing import Any, Dict, Iterable, Tuple

import numpy as np


def table(title: str, rows: Iterable[Tuple[str, object]]) -> str:
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in rows)
    return f"<table><caption>{escape(title)}</caption>{cells}</table>"


def means(values: Any) -> str:
    """The mean over the discs, of each band."""
    return ", ".join(f"{mean:.4g}" for mean in np.atleast_1d(values.mean(axis=0)))


def seconds(value: float) -> str:
    return f"{value:.3g} s"


def parameters(values: Dict[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in values.items()) or "none"
