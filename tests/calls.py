"""Checks, on objects of which each holds one source, which folder calls functions of which folder. A folder may call those
that its README.md allows it to include, in "May include:", and those that these may include. No folders may call each other
in a circle. This finds functions that are declared where they are used, which the check of includes (layers.cmake) cannot
see.

Use: calls.py SOURCE BUILD
"""

import collections
import functools
import pathlib
import re
import subprocess
import sys

LIBRARIES = {"model": "detp_model", "sim": "detp_sim", "validate": "detp_validate"}  # the command is always joined, and nothing calls it


def objects_of(build):
    """Folder of the source of each object, by the object's path."""
    found = {}
    for part, library in LIBRARIES.items():
        root = build / part / "CMakeFiles" / f"{library}.dir"
        for path in sorted(root.rglob("*.o")):
            if "Unity" in path.parts or path.name.startswith("cmake_pch"):
                continue
            found[str(path)] = str(pathlib.PurePath(part) / path.relative_to(root).parent)
    return found


def names_of(paths):
    """Yields (object, kind, name) of the symbols of all objects."""
    for first in range(0, len(paths), 200):
        text = subprocess.run(["nm", "-A", *paths[first : first + 200]], check=True, capture_output=True, text=True).stdout
        for line in text.splitlines():
            match = re.match(r"(.*?):[0-9a-f ]*([A-Za-z]) (\S+)$", line)
            if match:
                yield match[1], match[2], match[3]


@functools.cache
def reachable(source, folder):
    """The folders that a folder may include, and those that these may include."""
    line = re.search(r"^May include: (.*)\.$", (source / folder / "README.md").read_text(), re.M)
    direct = [one for one in line[1].split(", ") if not one.startswith("nothing")] if line else []
    return set(direct).union(*(reachable(source, one) for one in direct))


def plain(name):
    return subprocess.run(["c++filt", name], check=True, capture_output=True, text=True).stdout.strip()


def main(source, build):
    folder_of = objects_of(build)
    if not folder_of:
        sys.exit(f"{build} has no objects with one source each; build the preset alone")
    defined, needed = {}, collections.defaultdict(set)
    for path, kind, name in names_of(list(folder_of)):
        if kind in "TDBR":
            defined[name] = path
        elif kind == "U":
            needed[path].add(name)
    calls = collections.defaultdict(dict)
    for path, names in needed.items():
        for name in names:
            there = defined.get(name)
            if there and folder_of[there] != folder_of[path]:
                calls[folder_of[path]].setdefault(folder_of[there], (path, name))
    faults = []
    for folder, others in sorted(calls.items()):
        allowed = reachable(source, folder)
        for other, (path, name) in sorted(others.items()):
            if other not in allowed:
                faults.append(f"{folder} calls {plain(name)} of {other}, which its README.md does not allow ({pathlib.Path(path).name})")
    left = {folder: set(others) for folder, others in calls.items()}
    while True:
        last = [folder for folder, others in left.items() if not others & left.keys()]
        if not last:
            break
        for folder in last:
            del left[folder]
    if left:
        faults.append("these folders call each other in a circle: " + ", ".join(sorted(left)))
    print(f"{len(folder_of)} objects, {sum(map(len, calls.values()))} calls between folders, {len(faults)} faults")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
