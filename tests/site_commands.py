#!/usr/bin/env python3
"""Runs the commands of the site's own pages: site_commands.py FOLDER-OF-DETP PAGE…

A command must succeed, and each line of output that the page quotes must begin with the first word of a line that it prints. (Times differ from
machine to machine.)
"""

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def commands(page: Path) -> "list[tuple[str, list[str]]]":
    found: "list[tuple[str, list[str]]]" = []
    for block in re.findall(r"^```console\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.M | re.S):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def complaint(environment: "dict[str, str]", page: str, command: str, quoted: "list[str]") -> str:
    with tempfile.TemporaryDirectory() as place:
        ran = subprocess.run(command, shell=True, cwd=place, env=environment, capture_output=True, text=True)
    begins = {line.split()[0] for line in ran.stdout.splitlines() if line.strip()}
    missing = [line for line in quoted if line.split()[0] not in begins]
    if ran.returncode == 0 and not missing:
        return ""
    return f"{page}: {command}: status {ran.returncode}, not printed: {missing}\n{ran.stderr}"


def main() -> int:
    folder, *pages = map(Path, sys.argv[1:])
    environment = {**os.environ, "XDG_CACHE_HOME": "/dev/null", "PATH": f"{folder.resolve()}:{os.environ['PATH']}"}
    all_commands = [(page.name, *one) for page in pages for one in commands(page.resolve())]
    with ThreadPoolExecutor(2) as workers:
        complaints = [text for text in workers.map(lambda one: complaint(environment, *one), all_commands) if text]
    print("\n".join(complaints), file=sys.stderr)
    print(f"{len(all_commands)} commands, {len(complaints)} wrong")
    return 1 if complaints or not all_commands else 0


sys.exit(main())
