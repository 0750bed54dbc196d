#!/usr/bin/env python3
"""How often the bias that a pilot states is true, in scenes whose irradiance is known in closed form: adds rows to bias.csv.

    notebooks-data/studies/bias.py build/detp notebooks-data/bias.csv [--seeds 10]
    notebooks-data/studies/bias.py build/detp --quick

A row for each scene, estimator, radius and seed. bias, its interval and mean_bias are what the command states. For disc and area-corrected,
`detp run --target-error 4%` states them: its pilot goes on, with 40 000 to 2.56 million rays, until half the width of the interval is at most 1 %.
`detp run` has no target for variable-radius; there `detp accuracy --effort thorough` tries radii up to the one in question, and states the bias of
those that are best in some time. The published rows are of pilots with 640 000 rays and 1024 backward paths for each sample, which the
command cannot be asked for. true_bias and true_mean_bias come from 32 runs of 100 000 rays against the known irradiance.

The scenes are files in a temporary folder: a black floor under a lamp, with a board in between, under a point light, and in two rooms with a
door; and @furnace. Half an hour. Rows that the table has are kept and not made again. Then the script prints how often the truth is inside.
--quick prints a small table.
"""
import csv
import math
import os
import sys
import tempfile

from philox import TESTS, uniform4
from runs import Detp, Table, ask, estimates, option, split, write_discs

COLUMNS = "scene,estimator,radius,seed,bias,bias_low,bias_high,mean_bias,true_bias,true_mean_bias"
ESTIMATORS = ["disc", "variable-radius", "area-corrected"]
RADII = [0.02, 0.05, 0.1]  # of the scene's side, which is 1
RADIANCE = 10
POINT = 0.3  # height of the point light


def floor():
    """Random places of the floor z = 0."""
    places = (uniform4(3, TESTS, i) for i in range(200))
    return [[0.02 + 0.96 * place[0], 0.02 + 0.96 * place[1], 0.0, 0.0, 0.0, 1.0] for place in places]


def write_mesh(path, grids):
    """An OBJ file. A grid is corner, two edges, number of cells along each, and material."""
    with open(path[:-4] + ".mtl", "w") as file:
        file.write(f"newmtl black\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe {RADIANCE} {RADIANCE} {RADIANCE}\n")
    with open(path, "w") as file:
        file.write(f"mtllib {os.path.basename(path)[:-4]}.mtl\n")
        first = 1
        for corner, u, v, cells, material in grids:
            for j in range(cells + 1):
                for i in range(cells + 1):
                    file.write("v {!r} {!r} {!r}\n".format(*(corner[k] + i / cells * u[k] + j / cells * v[k] for k in range(3))))
            file.write(f"usemtl {material}\n")
            for j in range(cells):
                for a in range(first + j * (cells + 1), first + j * (cells + 1) + cells):
                    file.write(f"f {a} {a + 1} {a + cells + 2}\nf {a} {a + cells + 2} {a + cells + 1}\n")
            first += (cells + 1) ** 2


def by_lamp(point, corner, side, seen):
    """Irradiance of the floor by a lamp that faces down, where `seen` says what is visible: midpoints of 100 by 100 parts."""
    parts, total, height = 100, 0, corner[2]
    for i in range(parts):
        for j in range(parts):
            x, y = corner[0] + side / parts * (i + 0.5), corner[1] + side / parts * (j + 0.5)
            if seen(point, x, y):
                total += height * height / ((x - point[0]) ** 2 + (y - point[1]) ** 2 + height * height) ** 2
    return RADIANCE * total * (side / parts) ** 2


def lamp(path, board):
    """A lamp of 0.3 by 0.3 at z = 0.6 over a floor; `board`: a square board of 0.3 at z = 0.15 in between."""
    grids = [((0, 0, 0), (1, 0, 0), (0, 1, 0), 12, "black"), ((0.35, 0.65, 0.6), (0.3, 0, 0), (0, -0.3, 0), 1, "lamp")]
    if board:
        grids.append(((0.4, 0.4, 0.15), (0.3, 0, 0), (0, 0.3, 0), 1, "black"))
    write_mesh(path, grids)

    def seen(point, x, y):
        at = [point[0] + (x - point[0]) / 4, point[1] + (y - point[1]) / 4]  # where the way passes z = 0.15
        return not board or at[0] < 0.4 or at[0] > 0.7 or at[1] < 0.4 or at[1] > 0.7

    discs = floor()
    return path, discs, [by_lamp(disc, (0.35, 0.35, 0.6), 0.3, seen) for disc in discs]


def point_light(path):
    """A point light over a floor: the command places it 1 % of the height below the scene's top, which a small square makes."""
    write_mesh(path, [((0, 0, 0), (1, 0, 0), (0, 1, 0), 12, "black"), ((0, 0, POINT / 0.99), (0.01, 0, 0), (0, 0.01, 0), 1, "black")])
    discs = floor()
    power = 1 / (4 * math.pi)  # over the solid angle
    return f"{path} --light point --up z", discs, [power * POINT / math.dist((0.5, 0.5, POINT), disc[:3]) ** 3 for disc in discs]


def two_rooms(path):
    """Two black rooms of half the side, with a door; a lamp in the first one."""
    write_mesh(path, [((0, 0, 0), (1, 0, 0), (0, 1, 0), 12, "black"), ((0, 1, 0.5), (1, 0, 0), (0, -1, 0), 12, "black"),
                      ((0, 0, 0), (0, 1, 0), (0, 0, 0.5), 6, "black"), ((1, 1, 0), (0, -1, 0), (0, 0, 0.5), 6, "black"),
                      ((1, 0, 0), (-1, 0, 0), (0, 0, 0.5), 6, "black"), ((0, 1, 0), (1, 0, 0), (0, 0, 0.5), 6, "black"),
                      ((0.5, 0, 0), (0, 0.4, 0), (0, 0, 0.5), 4, "black"), ((0.5, 0.6, 0), (0, 0.4, 0), (0, 0, 0.5), 4, "black"),
                      ((0.15, 0.6, 0.48), (0.2, 0, 0), (0, -0.2, 0), 1, "lamp")])

    def seen(point, x, y):
        at = point[1] + (0.5 - point[0]) / (x - point[0]) * (y - point[1])  # where the way passes the wall
        return point[0] < 0.5 or 0.4 < at < 0.6

    discs = [disc for disc in floor() if abs(disc[0] - 0.5) >= 1e-3]
    return path, discs, [by_lamp(disc, (0.15, 0.4, 0.48), 0.2, seen) for disc in discs]


def furnace(detp, path, middle):
    """The closed diffuse box: all of its walls, edges too, or the middle of the floor alone. The irradiance is 2π everywhere."""
    if middle:
        discs = [[0.3 + 0.1 * (i % 5), 0.0, 0.3 + 0.1 * (i // 5), 0.0, 1.0, 0.0] for i in range(25)]
    else:  # the command adds random places to those at the 1734 vertices
        ask(detp, f"scene @furnace --samples 1934 --seed 5 --rays 1000 --write-discs {path}.csv")
        with open(f"{path}.csv") as file:
            discs = [[float(row[name]) for name in ["x", "y", "z", "nx", "ny", "nz"]] for row in csv.DictReader(file)][1734:]
    return "@furnace", discs, [2 * math.pi] * len(discs)


def true_bias(detp, line, discs, truth, seeds):
    runs = [estimates(detp, f"{line} --rays 100000 --seed {1_000_000 + seed}", discs)[1] for seed in range(1, seeds + 1)]
    found = split(runs, {"samples": [(exact, 0, 1 / len(truth)) for exact in truth], "judged_share": 1})
    return [f"{math.sqrt(max(0.0, found['bias'][0])):.6g}", f"{found['mean_bias']:.6g}"]


def stated_bias(detp, scene, estimator, radius, discs, seed, quick):
    """Bias, its interval, and mean bias. Exit code 3: the target is not reached, which does not matter."""
    question = f"{scene} --discs {discs} --seed {seed}"
    if estimator != "variable-radius":  # the run itself is short: its pilot comes first
        line = f"run {question} --estimator {estimator} --disc-radius {radius} --rays 1000 --target-error {'50%' if quick else '4%'}"
        answer = ask(detp, line, (0, 3))
        return [answer["bias_estimate"], *answer["bias_interval"], answer["mean_bias"]]
    for budget in [0.1, 0.01, 0.001]:  # seconds; the fewer, the larger are the discs of the answer
        effort = "quick" if quick else "thorough"
        line = f"accuracy {question} --estimators {estimator} --disc-radius {radius / 4} --time-budget {budget} --effort {effort}"
        answer = ask(detp, line, (0, 3))
        for way in [answer["answer"], *answer["points"]]:
            if math.isclose(way["disc_radius"], radius, rel_tol=1e-6):
                return [way["bias"], *way["bias_interval"], way["mean_bias"]]
    sys.exit(f"{scene}: detp accuracy does not state the bias of {estimator} with radius {radius}")


def add_rows(detp, table, name, scene, discs, truth, seeds):
    kept = {(row["estimator"], float(row["radius"]), int(row["seed"])): row for row in table.kept if row["scene"] == name}
    truths = {key[:2]: [row["true_bias"], row["true_mean_bias"]] for key, row in kept.items()}
    for seed in range(1, seeds + 1):
        for estimator in ESTIMATORS:
            for radius in RADII[-1:] if detp.quick else RADII:
                if (estimator, radius, seed) in kept:
                    continue
                line = f"{scene} --estimator {estimator} --disc-radius {radius}"
                if (estimator, radius) not in truths:
                    truths[estimator, radius] = true_bias(detp, line, discs, truth, 4 if detp.quick else 32)
                stated = stated_bias(detp, scene, estimator, radius, discs, seed, detp.quick)
                table.add(name, estimator, radius, seed, *(f"{number:.6g}" for number in stated), *truths[estimator, radius])


def print_summary(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    for name in [*dict.fromkeys(row["scene"] for row in rows), "all"]:
        own = [row for row in rows if name in [row["scene"], "all"]]
        inside = sum(float(row["bias_low"]) <= float(row["true_bias"]) <= float(row["bias_high"]) for row in own)
        widest = max(float(row["bias_high"]) - float(row["bias_low"]) for row in own) / 2
        print(f"{name}: {inside} of {len(own)} inside, half width at most {100 * widest:.2g} %")


def main():
    detp = Detp(__doc__)
    table = Table(COLUMNS, None if detp.quick else sys.argv[2])
    seeds = 1 if detp.quick else int(option("--seeds", "10"))
    scenes = {"furnace": lambda path: furnace(detp, path, False), "middle of a wall": lambda path: furnace(detp, path, True),
              "lamp": lambda path: lamp(path, False), "lamp and board": lambda path: lamp(path, True), "point": point_light, "two rooms": two_rooms}
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, make) in enumerate(scenes.items()):
            if sum(row["scene"] == name for row in table.kept) >= seeds * len(ESTIMATORS) * len(RADII):
                continue
            scene, places, truth = make(f"{folder}/{number}.obj")
            discs = f"{folder}/{number}.discs.csv"
            write_discs(discs, places)
            add_rows(detp, table, name, scene, discs, truth, seeds)
    table.done()
    if not detp.quick:
        print_summary(sys.argv[2])


main()
