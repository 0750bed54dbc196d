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


def main() -> int:
    folder, *pages = map(Path, sys.argv[1:])
    environment = {**os.environ, "PATH": f"{folder.resolve()}:{os.environ['PATH']}"}
    wrong = 0
    count = 0
    for page in map(Path.resolve, pages):
        for command, quoted in commands(page):
            count += 1
            with tempfile.TemporaryDirectory() as place:
                ran = subprocess.run(command, shell=True, cwd=place, env=environment, capture_output=True, text=True)
            begins = {line.split()[0] for line in ran.stdout.splitlines() if line.strip()}
            missing = [line for line in quoted if line.split()[0] not in begins]
            if ran.returncode != 0 or missing:
                print(f"{page.name}: {command}: status {ran.returncode}, not printed: {missing}\n{ran.stderr}", file=sys.stderr)
                wrong += 1
    print(f"{count} commands, {wrong} wrong")
    return 1 if wrong or not count else 0


sys.exit(main())
