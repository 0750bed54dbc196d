"""Runs in scenes."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _show
from ._declarations import ffi
from ._library import LongCall, Progress, call, lib, make, owned
from .found import Floats, _PerDisc, by_band

PathLike = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True, repr=False)
class Run(_PerDisc):
    """What a run found. Arrays have an element for each disc; with k bands, the last three have the shape (n, k)."""

    centres: Floats  #: (n, 3) where the discs are
    normals: Floats  #: (n, 3)
    radii: Floats  #: (n,)
    hits: npt.NDArray[np.uint64]  #: (n,) rays that cross the disc
    irradiance: Floats  #: (n,)
    standard_error: Optional[Floats]  #: (n,) of the irradiance; infinite with fewer than two photons
    upper_bound: Optional[Floats]  #: (n,) one-sided, 95 %, of the irradiance
    faces: Optional[npt.NDArray[np.uint32]]  #: (m, 3) the discs at the corners of the scene's triangles, if each vertex has one
    answer: Dict[str, Any]  #: what the command prints as JSON: technique, counts, seconds, predictions, errors

    def _columns(self) -> Dict[str, Any]:
        places = {name: self.centres[:, axis] for axis, name in enumerate("xyz")}
        errors = {} if self.standard_error is None else {"standard_error": self.standard_error,
                                                         "upper_bound": self.upper_bound}
        return by_band({**places, "radius": self.radii, "hits": self.hits, "irradiance": self.irradiance, **errors})

    @property
    def positions(self) -> Floats:
        """(n, 3) the centres; with `faces`, the vertices of the scene's mesh."""
        return self.centres

    def to_ply(self, path: PathLike) -> None:
        """Writes the discs with what was found, as points or, with `faces`, as a mesh with properties of its vertices. Raises OSError."""
        self._write(path, ".ply")

    def to_vtk(self, path: PathLike) -> None:
        """The same as VTK PolyData (.vtp), which ParaView opens. Raises OSError."""
        self._write(path, ".vtp")

    def _write(self, path: PathLike, suffix: str) -> None:
        if not os.fspath(path).endswith(suffix):
            raise ValueError(f"the file's name must end in {suffix} (got {os.fspath(path)})")
        normals = {name: self.normals[:, axis] for axis, name in enumerate(("nx", "ny", "nz"))}
        columns: Dict[str, Any] = {"disc": np.arange(len(self.hits)), **self._columns(), **normals}
        kinds = {"disc": lib.DETP_INDEX, "hits": lib.DETP_COUNT}
        kept = [np.ascontiguousarray(values, np.float64) for values in columns.values()]
        names = [ffi.new("char[]", name.encode()) for name in columns]
        all_columns = ffi.new("detp_column[]", [
            {"name": text, "numbers": ffi.from_buffer("double[]", values), "kind": kinds.get(name, lib.DETP_REAL)}
            for name, text, values in zip(columns, names, kept)])
        corners = ffi.NULL if self.faces is None else ffi.from_buffer("uint32_t[]", np.ascontiguousarray(self.faces))
        call(lib.detp_results_write, os.fsencode(path), all_columns, len(columns), len(self.hits), corners,
             0 if self.faces is None else len(self.faces))

    def _rows(self) -> List[Tuple[str, object]]:
        return [("technique", self.answer["technique"] or self.answer["estimator"]), ("discs", len(self.hits)),
                ("rays", self.answer["rays"]), ("hits", self.answer["hits"]),
                ("mean irradiance", self.answer["mean_irradiance"]),
                ("seconds", _show.seconds(self.answer["seconds"]["total"]))]

    def __repr__(self) -> str:
        return f"Run({', '.join(f'{name}: {value}' for name, value in self._rows())})"

    def _repr_html_(self) -> str:
        return _show.table("Run", self._rows())


def run(scene: Optional[PathLike] = None, *, progress: Optional[Progress] = None,
        **options: object) -> Run:
    """What the command `detp run` does, with the result in arrays: `run("@cornell", rays=1e5, technique="grid")`.

    :param scene: a mesh file or a built-in scene; None: `discs` and `ray_file` name files.
    :param progress: called with what is done; the work stops if it raises.
    :param options: those of the command, with underscores: `target_noise="5%"`, `disc_radius="2%"`, `standard_error=True`.

    Raises ValueError for wrong options, OSError for files, MemoryError; what `progress` raises.
    """
    words = [] if scene is None else [os.fspath(scene)]
    for name, value in options.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if value is not True:
            words.append(repr(value) if isinstance(value, float) else str(value))
    texts = [ffi.new("char[]", os.fsencode(word)) for word in words]
    handle = owned("detp_run")
    long = LongCall(progress)
    long.run(lib.detp_run_create, ffi.new("const char *[]", texts), len(texts), long.callback, ffi.NULL, handle)
    view = make("detp_run_view")
    call(lib.detp_run_look, handle[0], view)
    count = int(view.discs)

    def rows(pointer: Any) -> Any:
        found = array(pointer, view.bands, np.float64)
        return found if found is None or view.bands == 1 else found.reshape(count, view.bands)

    def array(pointer: Any, width: int, kind: Any) -> Any:
        return np.frombuffer(ffi.buffer(pointer, 8 * count * width), kind).copy() if pointer != ffi.NULL else None

    return Run(centres=array(view.centres, 3, np.float64).reshape(count, 3),
               normals=array(view.normals, 3, np.float64).reshape(count, 3), radii=array(view.radii, 1, np.float64),
               hits=array(view.hits, 1, np.uint64), irradiance=rows(view.irradiance),
               standard_error=rows(view.standard_error), upper_bound=rows(view.upper_bound),
               faces=None if view.triangles == 0 else np.frombuffer(
                   ffi.buffer(view.corners, 12 * view.triangles), np.uint32).copy().reshape(-1, 3),
               answer=json.loads(ffi.string(view.json).decode()))
