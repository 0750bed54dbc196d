#!/usr/bin/env python3
"""Is the sphere cache fastest at the Q and k that the model chooses? Times it beside many other (Q, k): writes best_ratio.csv.

    notebooks-data/studies/best_ratio.py build/detp notebooks-data/best_ratio.csv [FOLDER OF MESHES]
    notebooks-data/studies/best_ratio.py build/detp --quick

For each workload and engine: Q and k of the closed forms with the unit costs of this machine (run `detp calibrate` before), and the seconds with
these over those with the fastest (Q, k) of a grid: Q from 0.2 to 0.92, each with three numbers of spheres around its best. The fastest is
selected on one half of the runs, and judged on the other; a half has three calls, each of three runs. The plateau is the range of Q whose
fastest k takes at most 5 % longer than the fastest of all; `noise` is the fastest, timed as if it were another candidate, over itself. One
thread; some ten minutes. Workloads that the file has are kept, and not measured again; --quick prints one. Without stanford_bunny.obj and
sponza.ply half of the workloads are left out.
"""
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from answers import Detp, Table

RATIOS = [round(0.2 + 0.04 * i, 2) for i in range(19)]
PLATEAU = 1.05
CALLS, RUNS_OF_CALL = 3, 3


def settings(folder):
    """Scene, field, number of rays, and radius in percent of the scene."""
    for radius in [0.5, 2]:
        for rays in [1000, 10000]:
            yield "@uniform", "isotropic", rays, radius
            yield "@tree", "photons", rays, radius
            if folder:
                yield f"{folder}/stanford_bunny.obj", "isotropic", rays, radius
                yield f"{folder}/sponza.ply", "photons", rays, radius


class Caches:
    """Sphere caches on one workload by one engine."""

    def __init__(self, detp, question):
        self.detp = detp
        self.line = f"run {question} --technique sphere-cache"
        self.answer = detp.ask(self.line)
        self.chosen = self.pair(self.answer)

    @staticmethod
    def pair(answer):
        return answer["parameters"]["ratio"], answer["parameters"]["spheres"]

    def seconds(self, ratios, spheres):
        """Seconds of each pair of the two lists, in one call."""
        pairs = f"--ratio {','.join(map(repr, ratios))} --spheres {','.join(map(str, spheres))}"
        answer = self.detp.ask(f"{self.line} {pairs} --repeat {RUNS_OF_CALL}")
        return [(self.pair(one), one["seconds"]["all"]) for one in answer.get("rows", [answer])]

    def selecting(self):
        """Seconds of the chosen pair and of the grid."""
        answer = self.detp.ask(f"{self.line} --ratio {','.join(map(repr, RATIOS))} --spheres best")
        best = dict(self.pair(one) for one in answer["rows"])
        spheres = range(max(1, min(best.values()) - 1), max(best.values()) + 2)
        times = {}
        for _ in range(CALLS):
            for pair, seconds in [*self.seconds([self.chosen[0]], [self.chosen[1]]), *self.seconds(RATIOS, spheres)]:
                if pair == self.chosen or abs(pair[1] - best[pair[0]]) <= 1:
                    times.setdefault(pair, []).extend(seconds)
        return times

    def judging(self, *pairs):
        """Seconds of these pairs in turns."""
        times = [[] for _ in pairs]
        for _ in range(CALLS):
            for pair, own in zip(pairs, times):
                own += self.seconds([pair[0]], [pair[1]])[0][1]
        return times


def median_ratio(above, below):
    return statistics.median(a / b for a, b in zip(above, below))


def asked(rays):
    """The power of ten that was asked for; photon paths have a few more."""
    return round(math.log10(rays))


def row_of(caches):
    selecting = caches.selecting()
    fastest = min(selecting, key=lambda pair: median_ratio(selecting[pair], selecting[caches.chosen]))
    plateau = [ratio for (ratio, _), seconds in selecting.items() if median_ratio(seconds, selecting[fastest]) <= PLATEAU]
    chosen, best, twin = caches.judging(caches.chosen, fastest, fastest)
    figures = [median_ratio(chosen, best), median_ratio(twin, best), min(plateau), max(plateau)]
    pairs = [f"{caches.chosen[0]:.3f}", caches.chosen[1], f"{fastest[0]:.3f}", fastest[1]]
    return [*pairs, f"{statistics.median(best):.4g}", *(f"{one:.3f}" for one in figures)]


def main():
    detp = Detp(__doc__)
    if not detp.quick and len(sys.argv) < 3:
        sys.exit(__doc__)
    table = Table("scene,field,engine,rays,samples,disc_radius,chosen_ratio,chosen_spheres,best_ratio,best_spheres,"
                  "best_seconds,chosen_over_best,noise,plateau_low,plateau_high", None if detp.quick else sys.argv[2])
    kept = {(row["scene"], row["engine"], asked(float(row["rays"])), row["disc_radius"]) for row in table.kept}
    folder = sys.argv[3] if len(sys.argv) > 3 and not detp.quick else ""
    for scene, field, rays, radius in list(settings(folder))[:1 if detp.quick else None]:
        for engine in ["simd", "plain"]:
            workload = f"{scene} --field {field} --rays {rays} --samples 10000 --disc-radius {radius}%"
            caches = Caches(detp, f"{workload} --engine {engine} --threads 1")
            name, given = pathlib.Path(scene).stem, caches.answer["inputs"]
            key = (name, engine, asked(given["rays"]), f"{given['disc_radius']:.5g}")
            if key in kept or caches.chosen[1] == 0:
                continue
            table.add(name, field, engine, given["rays"], given["samples"], key[-1], *row_of(caches))
    table.done()


main()
