"""detp: which technique finds all hits of rays and small discs fastest, how long it takes, and how accurate the result is.

Searches of rays and discs in arrays: `plan`, `Plan.search`, `Plan.search_until`, `find_hits`. From numbers alone: `choose`,
`predict`. Irradiance in a scene: `run` by photons, `gather` without rays. Every question
of the command `detp`: `ask`.
"""

from ._declarations import ffi as _ffi
from ._library import Progress, Stopped, lib as _lib
from .ask import ask
from .costs import Costs
from .found import Estimate, Found
from .gather import Gathered, gather
from .numbers import Choice, Prediction, choose, predict
from .plans import Batch, NextRays, Plan, find_hits, plan
from .problem import Discs, Rays
from .run import Run, run

__version__: str = _ffi.string(_lib.detp_version()).decode()
__all__ = ["Batch", "Choice", "Costs", "Discs", "Estimate", "Found", "Gathered", "NextRays", "Plan", "Prediction",
           "Progress", "Rays", "Run", "Stopped", "ask", "choose", "find_hits", "gather", "plan", "predict", "run"]
