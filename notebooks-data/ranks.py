#!/usr/bin/env python3
"""Seconds and memory of runs on several processes, predicted and taken: writes ranks.csv.

    notebooks-data/ranks.py build/detp [--quick] > notebooks-data/ranks.csv

The box tree, one thread each process; the largest run has one process of two threads. Predictions use the costs of a calibration that
this script makes. A quarter of an hour on two cores, with 6 GB; needs mpirun.
"""
import json
import os
import subprocess
import sys
import tempfile

from answers import Detp, Table

CASES = [  # arguments, largest number of processes, threads
    ("--field isotropic --dimension 2 --scene-side 1 --samples 1e6 --disc-radius 0.0005 --rays 4e7", 2, 1),
    ("@cornell --samples 20000 --rays 2e7", 2, 1),
    ("@courtyard --samples 100000 --rays 2e7", 2, 1),
    ("--field isotropic --dimension 2 --scene-side 1 --samples 1e7 --disc-radius 0.00038729833 --rays 1e9", 1, 2),
]
QUICK = [("--field isotropic --dimension 2 --scene-side 1 --samples 1e4 --disc-radius 0.005 --rays 4e6", 2, 1)]


def taken(detp, arguments, processes, share, threads):
    """The answer of a run, and the largest memory of its processes in bytes."""
    mpirun = ["mpirun", "--oversubscribe", "-n", str(processes)] if processes > 1 else []
    line = f"run {arguments} --technique box-tree --threads {threads} --share {share} --format json --quiet"
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    with tempfile.TemporaryFile("w+") as answer:
        process = subprocess.Popen([*mpirun, detp.path, *line.split()], stdout=answer, env={**os.environ, **root})
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{line}: status {status}")
        answer.seek(0)
        return json.load(answer), 1024 * usage.ru_maxrss


def main():
    detp = Detp(__doc__)
    table = Table("rays_of,rays,samples,processes,threads,share,make_seconds,build_seconds,search_seconds,seconds,memory,"
                  "predicted_make,predicted_build,predicted_search,predicted_seconds,predicted_error,predicted_memory")
    with tempfile.NamedTemporaryFile() as costs:
        subprocess.run([detp.path, "calibrate", "-o", costs.name], check=True, capture_output=True)
        for arguments, most, threads in QUICK if detp.quick else CASES:
            for processes, share in [(1, "rays"), (2, "rays"), (2, "discs")][:1 if most == 1 else 3]:
                found, memory = taken(detp, arguments, processes, share, threads)
                choice = detp.ask(f"choose {arguments} --ranks {processes} --threads {threads} --calibration {costs.name} --technique box-tree")
                expected = choice["ranks"]["shares"][share]
                seconds = found["seconds"]
                make = found["trace_seconds"] + seconds["prepare"]
                predicted_make = expected["count_seconds"] + expected["make_seconds"]
                scene = arguments.split()[0] if arguments.startswith("@") else "lines"
                table.add(scene, found["rays"], found["inputs"]["samples"], processes, threads, share, f"{make:.4g}",
                          f"{seconds['build']:.4g}", f"{seconds['total'] - seconds['prepare'] - seconds['build']:.4g}", f"{found['trace_seconds'] + seconds['total']:.4g}", memory,
                          f"{predicted_make:.4g}", f"{expected['build_seconds']:.4g}", f"{expected['search_seconds']:.4g}",
                          f"{expected['predicted_seconds']:.4g}", f"{choice['ranks']['predicted_seconds_error']:.2g}", round(expected["memory"]))
                sys.stdout.flush()
    table.done()


main()
