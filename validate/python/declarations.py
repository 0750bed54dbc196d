"""Makes the module `_declarations` of the package from detp.h: `python3 declarations.py detp.h FOLDER`."""

import re
import sys
from pathlib import Path
from typing import Any

import cffi


def declarations(header: str) -> str:
    """The C declarations of detp.h, as a C compiler would see them, without comments."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    text = text.replace("\\\n", " ")
    kept, open_blocks = [], []  # of each open block: whether its lines count
    for line in text.splitlines():
        word = line.strip()
        if word.startswith(("#ifdef", "#if ")):
            open_blocks.append(False)  # __cplusplus and the compiler's attributes
        elif word.startswith("#ifndef"):
            open_blocks.append(True)
        elif word.startswith("#else"):
            open_blocks[-1] = not open_blocks[-1]
        elif word.startswith("#endif"):
            open_blocks.pop()
        elif not word.startswith("#") and all(open_blocks):
            kept.append(line.replace("DETP_API ", ""))
    return "\n".join(kept)


def main() -> None:
    header, folder = map(Path, sys.argv[1:])
    ffi = cffi.FFI()
    ffi.cdef(declarations(header.read_text(encoding="utf-8")))
    no_source: Any = None  # declarations alone; only some versions of the types of cffi allow None
    ffi.set_source("detp._declarations", no_source)
    ffi.emit_python_code(str(folder / "_declarations.py"))


if __name__ == "__main__":
    main()
