#!/usr/bin/env python3
"""Runs the commands of the site's own pages: site_commands.py FOLDER-OF-DETP PAGE…

A command must succeed, and each line of output that the page quotes must begin with the first word of a line that it prints. (Times differ from
machine to machine.) The commands of a page run one after another in one folder, so that files of one are there for the next. Beside a page may
be its programs, which are there, too, and pictures, which the commands must make again: another processor or zlib may change some pixels, at most one in 200.
"""

import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def pixels(png: bytes) -> "list[bytes]":
    """The rows of a picture of 8 bits of red, green and blue, each row as differences from the left, as detp writes them."""
    at, packed, width = 8, b"", 0
    while at < len(png):
        (length,), name = struct.unpack_from(">I", png, at), png[at + 4:at + 8]
        if name == b"IHDR":
            (width,) = struct.unpack_from(">I", png, at + 8)
        if name == b"IDAT":
            packed += png[at + 8:at + 8 + length]
        at += 12 + length
    rows, size = zlib.decompress(packed), 3 * width + 1
    return [rows[i + 1:i + size] for i in range(0, len(rows), size)]


def are_alike(one: bytes, other: bytes) -> bool:
    first, second = pixels(one), pixels(other)
    if [len(row) for row in first] != [len(row) for row in second]:
        return False
    different = sum(a[i:i + 3] != b[i:i + 3] for a, b in zip(first, second) for i in range(0, len(a), 3))
    return 200 * different <= sum(len(row) // 3 for row in first)


def commands(page: Path) -> "list[tuple[str, list[str]]]":
    found: "list[tuple[str, list[str]]]" = []
    for block in re.findall(r"^```console\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.M | re.S):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def complaint(environment: "dict[str, str]", place: str, page: str, command: str, quoted: "list[str]") -> str:
    ran = subprocess.run(command, shell=True, cwd=place, env=environment, capture_output=True, text=True)
    begins = {line.split()[0] for line in ran.stdout.splitlines() if line.strip()}
    missing = [line for line in quoted if line.split()[0] not in begins]
    if ran.returncode == 0 and not missing:
        return ""
    return f"{page}: {command}: status {ran.returncode}, not printed: {missing}\n{ran.stderr}"


def main() -> int:
    folder, *pages = map(Path, sys.argv[1:])
    environment = {**os.environ, "XDG_CACHE_HOME": "/dev/null", "PATH": f"{folder.resolve()}:{os.environ['PATH']}"}

    def complaints_of(page: Path) -> "list[str]":
        with tempfile.TemporaryDirectory() as place:
            for suffix in ("*.py", "*.pov"):
                for program in page.parent.glob(suffix):
                    shutil.copy(program, place)
            found = [complaint(environment, place, page.name, *one) for one in commands(page.resolve())]
            for name in re.findall(r"!\[[^]]*\]\((\w+\.png)\)", page.read_text(encoding="utf-8")):
                made = Path(place, name)
                same = made.exists() and are_alike(made.read_bytes(), Path(page.parent, name).read_bytes())
                found.append("" if same else f"{page.name}: {name} is another picture")
            return found

    with ThreadPoolExecutor(2) as workers:
        answers = [text for all_of_page in workers.map(complaints_of, pages) for text in all_of_page]
    complaints = [text for text in answers if text]
    print("\n".join(complaints), file=sys.stderr)
    print(f"{len(answers)} commands, {len(complaints)} wrong")
    return 1 if complaints or not answers else 0


sys.exit(main())
