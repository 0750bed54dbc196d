"""Every other question."""

from __future__ import annotations

import json
from typing import Any, Dict, Optional

from ._declarations import ffi
from ._library import LongCall, Progress, lib


def ask(*words: object, progress: Optional[Progress] = None) -> Dict[str, Any]:
    """What the command `detp WORDS… --format json` prints: `ask("accuracy", "@tree", "--target-noise", "5%")`.

    Raises ValueError for wrong words, OSError for files, MemoryError.
    """
    texts = [ffi.new("char[]", str(word).encode()) for word in words]
    json_text = ffi.gc(ffi.new("char **"), lib.detp_text_free)
    long = LongCall(progress)
    long.run(lib.detp_ask, ffi.new("const char *[]", texts), len(texts), long.callback, ffi.NULL, json_text)
    answer: Dict[str, Any] = json.loads(ffi.string(json_text[0]).decode())
    return answer
