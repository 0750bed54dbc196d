"""Answers from numbers alone: isotropic lines, and samples uniform in a cube or on its faces."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _show
from ._arrays import pointer
from ._declarations import ffi
from ._library import call, lib, make
from .costs import Costs, handle_of
from .plans import counts_of

_text_bytes = 1000

#: One sphere of the sphere cache: r_i, n_i, rays in its list, m_i, and the ray-sphere tests of one rebuild.
sphere_type = np.dtype([(name, np.float64) for name in ("radius", "rays", "listed", "rebuilds", "rebuild_cost")])


def _workload(rays: float, samples: float, disc_radius: float, scene_side: float, dimension: float) -> Any:
    workload = make("detp_workload")
    workload.rays, workload.samples = rays, samples
    workload.disc_radius, workload.scene_side, workload.dimension = disc_radius, scene_side, dimension
    return workload


@dataclass(frozen=True)
class Choice:
    """The technique that closed forms choose."""

    technique: str
    parameters: Dict[str, Any]
    predicted_seconds: float
    threads: int

    def _repr_html_(self) -> str:
        return _show.table("Choice", [("technique", self.technique), ("parameters", _show.parameters(self.parameters)),
                                      ("predicted", _show.seconds(self.predicted_seconds)), ("threads", self.threads)])


def choose(*, rays: float, samples: float, disc_radius: float, scene_side: float, dimension: float = 3,
           costs: Optional[Costs] = None, threads: int = 0) -> Choice:
    """The fastest technique for so many rays and samples.

    :param disc_radius: in the unit of scene_side.
    :param scene_side: of the cube.
    :param dimension: 3: samples fill the cube; 2: they lie on its faces.
    :param costs: default: the built-in ones.
    :param threads: at most; 0: all cores.

    Raises ValueError for numbers out of range.
    """
    facts = make("detp_plan_facts")
    text = ffi.new("char[]", _text_bytes)
    call(lib.detp_choose, _workload(rays, samples, disc_radius, scene_side, dimension), handle_of(costs), threads, text,
         _text_bytes, facts)
    return Choice(ffi.string(facts.technique).decode(), json.loads(ffi.string(facts.parameters)),
                  float(facts.predicted_seconds), int(facts.threads))


@dataclass(frozen=True)
class Prediction:
    """Closed forms of one technique."""

    technique: str
    parameters: Dict[str, Any]  #: those given, and the best ones of the others
    counts: Dict[str, float]  #: expected numbers of operations
    build_seconds: float
    rebuild_seconds: float  #: T_R: making lists
    intersect_seconds: float  #: T_I: ray-disc tests, and recording hits
    seconds: float  #: all of it
    threads: int
    spheres: npt.NDArray[Any]  #: S_1 … S_k of a sphere cache, at most 4096, with the fields of `sphere_type`

    def _rows(self) -> List[Tuple[str, object]]:
        return [("parameters", _show.parameters(self.parameters)), ("time", _show.seconds(self.seconds)),
                ("T_R", _show.seconds(self.rebuild_seconds)), ("T_I", _show.seconds(self.intersect_seconds)),
                *((name, f"{count:.6g}") for name, count in self.counts.items() if count > 0)]

    def _repr_html_(self) -> str:
        return _show.table(self.technique, self._rows())


def predict(technique: str, *, rays: float, samples: float, disc_radius: float, scene_side: float, dimension: float = 3,
            published: bool = False, costs: Optional[Costs] = None, threads: int = 1, **parameters: Any) -> Prediction:
    """Closed forms of a technique: `predict("sphere-cache", ratio=0.65, rays=1e5, …)`.

    The workload as for `choose`.

    :param parameters: of the technique; those that are not given become the best ones.
    :param published: the formulas of the paper (sphere-cache, with a ratio; k is theirs unless spheres are given).

    Raises ValueError for numbers out of range and for techniques without a closed form.
    """
    workload = _workload(rays, samples, disc_radius, scene_side, dimension)
    given = json.dumps(parameters).encode()
    text = ffi.new("char[]", _text_bytes)
    found = make("detp_prediction")

    def ask() -> None:
        call(lib.detp_predict, workload, technique.encode(), given, published, handle_of(costs), threads, text,
             _text_bytes, found)

    ask()
    spheres = np.zeros(min(int(found.k), 4096), sphere_type)
    if len(spheres) > 0:
        found.spheres, found.room = pointer("detp_sphere", spheres), len(spheres)
        ask()
    return Prediction(technique, json.loads(ffi.string(text)), counts_of(found.counts), found.build_seconds,
                      found.rebuild_seconds, found.intersect_seconds, found.seconds, int(found.threads), spheres)
