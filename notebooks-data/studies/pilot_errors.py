#!/usr/bin/env python3
"""How often are the counts and the seconds that a pilot predicts within twice the errors that it states? Writes a table, and prints a summary of it.

    notebooks-data/studies/pilot_errors.py build/detp TABLE.csv --seeds 6001:6150 [--calibration FILE]
    notebooks-data/studies/pilot_errors.py build/detp --quick

Each seed is a search: of a tiny object on a huge floor, of dense objects in a closed room, or of clusters in empty space. `detp choose` chooses by a
pilot, without brute force, with the built-in unit costs or those of a file that `detp calibrate` wrote. `detp run` runs the choice. The table has a
row for each count and for the seconds (median of five runs). One thread; half a second for each search. Seeds that the table has are kept and not run
again. --quick prints two searches.

Scenes, predictions, errors and counts are those of the C++ program that made the tables of pilot_errors.md. That program took the seconds of the
processor where they were fewer than those of the clock; `detp run` has those of the clock, so nothing else should run.
"""
import csv
import statistics
import sys
import tempfile

import sparse_scenes
from philox import TESTS, uniform4
from runs import Detp, Table, option

JUDGED = ["cull_tests", "culls", "listed", "visits", "disc_tests", "made", "hits"]
ROUNDING = 1e-6


def between(least, most, uniform):
    """With a uniform logarithm."""
    return least * (most / least) ** uniform


def add_search(detp, table, seed, calibration, folder):
    uniform = uniform4(seed, TESTS, 0, 1)
    field = "isotropic" if uniform[0] < 0.3 else "photons"
    rays, radius = round(between(20000, 200000, uniform[1])), between(0.002, 0.035, uniform[2])
    kind = ["tiny object", "furnished room", "clusters"][seed % 3]
    mesh, discs, paths = f"{folder}/mesh.obj", f"{folder}/discs.npy", f"{folder}/rays.npy"
    with open(mesh, "w") as file:
        file.write([sparse_scenes.tiny_object, sparse_scenes.furnished_room, sparse_scenes.clusters][seed % 3](seed))
    made = detp.ask(f"scene {mesh} --rays {rays} --disc-radius {100 * radius!r}% --field {field} --seed {seed} --threads 1"
                    f" --write-discs {discs} --write-rays {paths}")
    files = f"--discs {discs} --ray-file {paths} --seed {seed} --threads 1 --calibration {calibration}"
    answer = detp.ask(f"choose {files} --disable brute-force")
    choice = next(one for one in answer["candidates"] if "why_not" not in one)
    if "predicted_error" not in choice:
        print(f"seed {seed}: the choice has a closed form, not a pilot", file=sys.stderr)
        return
    shape = choice["parameters"]
    found = detp.ask(f"run {files} --technique box-tree --fan-out {shape['fan_out']} --leaf {shape['leaf']} --repeat 5")
    search = [seed, kind, "lines" if field == "isotropic" else field, made["rays"], made["samples"], f"{radius:.4f}",
              f"{shape['fan_out']}/{shape['leaf']}"]
    judged = [(name, choice["predicted"][name], choice["predicted_error"][name], found["counts"][name]) for name in JUDGED]
    judged.append(("seconds", choice["predicted_seconds"], choice["predicted_seconds_error"], statistics.median(found["seconds"]["all"])))
    for name, predicted, error, right in judged:
        table.add(*search, name, f"{predicted:.9g}", f"{error:.6g}", f"{right:.9g}")


def print_summary(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    print("| | predictions | within two errors | within 10 % | error over value, median | wrong, error 0 |\n|---|---|---|---|---|---|")
    for quantity in dict.fromkeys(row["quantity"] for row in rows):
        of = [[float(row[name]) for name in ["predicted", "error", "found"]] for row in rows if row["quantity"] == quantity]
        inside = sum(abs(predicted - found) <= 2 * error + ROUNDING * found for predicted, error, found in of)
        close = sum(abs(predicted - found) <= 0.1 * found for predicted, _, found in of)
        wrong = sum(error == 0 and abs(predicted - found) > ROUNDING * found for predicted, error, found in of)
        relative = statistics.median([error / found for _, error, found in of if found > 0] or [0])
        print(f"| {quantity} | {len(of)} | {100 * inside / len(of):.0f} % | {100 * close / len(of):.0f} % | {100 * relative:.0f} % | {wrong} |")


def main():
    detp = Detp(__doc__)
    path = None if detp.quick else sys.argv[2]
    table = Table("seed,kind,field,rays,discs,radius,shape,quantity,predicted,error,found", path)
    kept = {row["seed"] for row in table.kept}
    first, last = (int(seed) for seed in option("--seeds", "1:2" if detp.quick else "1:60").split(":"))
    calibration = option("--calibration", "none")
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, last + 1):
            if str(seed) not in kept:
                add_search(detp, table, seed, calibration, folder)
    table.done()
    if path:
        print_summary(path)


main()
