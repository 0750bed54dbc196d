#!/usr/bin/env python3
"""Seconds and memory of runs whose discs or rays do not fit in memory: writes out_of_core.csv.

    notebooks-data/out_of_core.py build/detp [--quick] > notebooks-data/out_of_core.csv

Uniform discs of a binary PLY file (28 bytes each), and isotropic lines or lines of such a file (24 bytes each); the box tree, whole calls with
--per-disc. Six minutes on two cores, with 3 GB of memory and 3 GB for files; needs numpy. Fails unless all runs of a case find the same bytes.
"""
import hashlib
import os
import subprocess
import sys
import tempfile
import time

import numpy

from answers import Table

random = numpy.random.default_rng(1)
# Few, because a process starts with the memory of the one that makes it, in the system's count of its peak.
rows_at_once = 20_000


def write_table(path, names, count, rows_of):
    header = "".join(f"property float {name}\n" for name in names)
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{header}end_header\n".encode())
        for first in range(0, count, rows_at_once):
            file.write(rows_of(min(rows_at_once, count - first)).astype("<f4").tobytes())


def write_discs(path, count):
    radius = count ** (-1 / 3)  # half the distance between discs
    write_table(path, ("x", "y", "z", "nx", "ny", "nz", "radius"), count,
                lambda rows: numpy.hstack([random.uniform(-1, 1, (rows, 3)), random.normal(size=(rows, 3)), numpy.full((rows, 1), radius)]))


def write_rays(path, count):
    write_table(path, ("ox", "oy", "oz", "dx", "dy", "dz"), count,
                lambda rows: numpy.hstack([random.uniform(-1, 1, (rows, 3)), random.normal(size=(rows, 3))]))


def hash_of(path):
    hash = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            hash.update(block)
    return hash.digest()


def measure(detp, table, case, arguments, found, limits):
    expected = None
    for limit in limits:
        line = [detp, "run", *arguments, "--technique", "box-tree", "--per-disc", found, "--quiet"]
        begin = time.monotonic()
        process = subprocess.Popen(line + (["--memory-limit", limit] if limit else []), stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begin
        hits = hash_of(found)
        if status != 0 or hits != (expected or hits):
            sys.exit(f"with the limit {limit} it fails, or finds something else")
        expected = hits
        table.add(*case, limit or "default", round(seconds, 1), round(1024e-6 * used.ru_maxrss))
        sys.stdout.flush()


def main():
    detp, quick = sys.argv[1], "--quick" in sys.argv
    table = Table("discs,rays,rays_of,memory_limit,seconds,memory")
    with tempfile.TemporaryDirectory() as folder:
        discs, rays, found = (os.path.join(folder, name) for name in ("discs.ply", "rays.ply", "found.csv"))
        count, lines = (400_000, 100_000) if quick else (20_000_000, 3_000_000)
        write_discs(discs, count)
        measure(detp, table, (count, lines, "field"), ["--discs", discs, "--rays", str(lines)], found,
                ("", "64M") if quick else ("", "512M", "256M", "128M"))
        count, lines = (10_000, 100_000) if quick else (100_000, 100_000_000)
        write_discs(discs, count)
        write_rays(rays, lines)
        measure(detp, table, (count, lines, "file"), ["--discs", discs, "--ray-file", rays], found,
                ("", "64M") if quick else ("", "256M", "64M"))
    table.done()


main()
