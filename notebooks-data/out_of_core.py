#!/usr/bin/env python3
"""Seconds and memory of runs whose discs do not fit in memory: writes out_of_core.csv.

    notebooks-data/out_of_core.py build/detp [--quick] > notebooks-data/out_of_core.csv

Lines through uniform discs of a binary PLY file (28 bytes each), the box tree, whole calls with --per-disc. Three minutes on two cores, with 3 GB of
memory and 2 GB for temporary files; needs numpy. Fails unless all runs find the same bytes.
"""
import hashlib
import os
import subprocess
import sys
import tempfile
import time

import numpy

from answers import Table


def write_discs(path, count):
    random = numpy.random.default_rng(1)
    header = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "radius"))
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{header}end_header\n".encode())
        for first in range(0, count, 1_000_000):
            rows = numpy.empty((min(1_000_000, count - first), 7), "<f4")
            rows[:, :3] = random.uniform(-1, 1, (len(rows), 3))
            rows[:, 3:6] = random.normal(size=(len(rows), 3))
            rows[:, 6] = count ** (-1 / 3)  # half the distance between discs
            file.write(rows.tobytes())


def hash_of(path):
    """Not all at once: a process starts with the memory of the one that makes it, in the system's count of its peak."""
    hash = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            hash.update(block)
    return hash.digest()


def main():
    detp, quick = sys.argv[1], "--quick" in sys.argv
    count, rays = (400_000, 100_000) if quick else (20_000_000, 3_000_000)
    table = Table("discs,rays,memory_limit,seconds,memory")
    with tempfile.TemporaryDirectory() as folder:
        discs, found = os.path.join(folder, "discs.ply"), os.path.join(folder, "found.csv")
        write_discs(discs, count)
        expected = None
        for limit in ("", "64M") if quick else ("", "512M", "256M", "128M"):
            line = [detp, "run", "--discs", discs, "--rays", str(rays), "--technique", "box-tree", "--per-disc", found]
            begin = time.monotonic()
            process = subprocess.Popen(line + (["--memory-limit", limit] if limit else []) + ["--quiet"],
                                       stdout=subprocess.DEVNULL)
            _, status, used = os.wait4(process.pid, 0)
            seconds = time.monotonic() - begin
            hits = hash_of(found)
            if status != 0 or hits != (expected or hits):
                sys.exit(f"with the limit {limit} it fails, or finds something else")
            expected = hits
            table.add(count, rays, limit or "default", round(seconds, 1), round(1024e-6 * used.ru_maxrss))
    table.done()


main()
