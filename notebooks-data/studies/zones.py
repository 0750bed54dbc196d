#!/usr/bin/env python3
"""Where is a sphere cache faster than an index of discs, and which technique is fastest of all? Judges the paper's rule: writes zones.csv.

    notebooks-data/studies/zones.py build/detp notebooks-data/zones.csv [FOLDER OF MESHES]
    notebooks-data/studies/zones.py build/detp --quick

117 workloads (99 without sponza.ply and stanford_bunny.obj), by both engines, on one thread. Each technique gets its fastest parameters: the
script runs their neighbours, until none is faster. Then all techniques take turns in other runs, three calls of three runs each. Rows by role:

    best           the technique with its fastest parameters
    published-Q    the sphere cache with the paper's Q
    rule           the candidate of the paper's rule
    index          the faster of octree and BSP tree
    fastest        of all
    predicted      of sphere cache and octree the one that closed forms take

`over_cache` is the median of a candidate's seconds over those of the fastest sphere cache in the same round, with the range that holds the true
median with 96 % (of 9 rounds; 75 % of 3: slow runs have fewer); `over_two` is the same over the faster of sphere cache and index.
`predicted_seconds` has the technique's best candidate by closed forms, with the unit costs that the command uses (run `detp calibrate` before);
empty: it has no closed form. Techniques that take ten times as long as the fastest are abandoned; `seconds` is then a lower bound. Other
techniques than the paper's have tuned parameters only if they may win.

One to two hours, because each call makes its scene and rays again. Workloads that the file has are kept, and not measured again; --quick prints
one workload. The published seconds are the fewer of those of the processor and of the clock, of searches of one process; here they are those of
the clock.
"""
import json
import math
import pathlib
import statistics
import subprocess
import sys
import time
from random import Random

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from answers import Detp, Table
from philox import SCENE, uniform4

SEED = 51
REGIONS = [(0.25, 2), (2, 6), (6, 24)]  # of the paper's rule, by X
LEAST_RAYS, MOST_RAYS, MOST_HITS = 100, 409_600, 2e7
SURFACES_CROSSED = 4  # by a ray, to estimate hits
FAMILIES = ["room", "plant", "machine", "terrain", "shells", "details"]
PUBLISHED_RATIO = 0.65
OF_PAPER = ["sphere-cache", "octree", "bsp"]
TECHNIQUES = [*OF_PAPER, "brute-force", "cell-spheres", "sphere-tree", "box-tree", "grid", "bvh", "ray-map"]
# Parameters that are varied, each with its step (0: by one), and the least and the largest value.
STEPS = {
    "sphere-cache": {"ratio": (1.15, 1e-9, 1 - 1e-9), "spheres": (0, 1, 4096)},
    "cell-spheres": {"depth": (0, 0, 16)},
    "sphere-tree": {"fan_out": (2, 2, 2**20), "leaf": (4, 1, 2**20)},
    "box-tree": {"fan_out": (2, 2, 2**20), "leaf": (4, 1, 2**20)},
    "octree": {"depth": (0, 0, 20)},
    "grid": {"cells": (1.4, 1, 2**20)},
    "bsp": {"depth": (0, 0, 64), "leaf": (4, 1, 2**20)},
    "ray-map": {"leaf": (4, 1, 2**20)},
}
SYMBOLS = {"ratio": "Q", "spheres": "k", "fan_out": "fan-out"}
USUAL = {"order": "lebesgue", "traversal": "top-down"}  # not shown
HOPELESS = 10  # times the seconds of the fastest: a technique is abandoned
CANNOT_WIN = 3  # times the seconds of the fastest: parameters are not tuned
ALWAYS_TUNED = 0.02  # seconds
LEAST_LIMIT = 0.02  # seconds
PATIENCE = 3  # times the seconds of the fastest neighbour: a neighbour is abandoned
ENOUGH = 0.99  # a neighbour must take less than this share, to be the fastest
MOST_STEPS = 12
TURNS, RUNS_OF_TURN = 3, 3
MOST_SECONDS = 5  # no further turn begins after these
NO_LIMIT = 1e6


def workloads(folder):
    """Scene, field, X and number of rays: nine in each scene, three in each region of the rule; log-uniform at random, the same each time."""
    scenes = ["@tree", "@tree-coarse", "@courtyard", "@cornell", "@interior", *(f"@{family}:{SEED}" for family in FAMILIES)]
    if folder:
        scenes += [f"{folder}/{mesh}" for mesh in ["sponza.ply", "stanford_bunny.obj"]]
    place = 0
    for scene in scenes:
        for low, high in REGIONS:
            for i in range(3):
                of_x, of_rays, *_ = uniform4(SEED, SCENE, place)
                place += 1
                x = low * (high / low) ** of_x
                most = min(MOST_RAYS, MOST_HITS / (SURFACES_CROSSED * math.pi / x**2))
                yield scene, "photons" if i < 2 else "isotropic", x, round(LEAST_RAYS * (most / LEAST_RAYS) ** of_rays)


def describe(parameters):
    shown = {name: value for name, value in parameters.items() if USUAL.get(name) != value}
    return "; ".join(f"{SYMBOLS.get(name, name)} {f'{value:.4g}' if isinstance(value, float) else value}" for name, value in shown.items())


def neighbours(technique, parameters):
    """Parameters that differ in one, by one step up or down."""
    if technique == "bvh":
        return [{"quality": quality} for quality in ["low", "medium"] if quality != parameters["quality"]]
    found = []
    for name, (step, least, most) in STEPS.get(technique, {}).items():
        value = parameters[name]
        if isinstance(value, float):
            values = [(2 - step) * value, step * value]
        else:
            values = [round(value / step), round(value * step)] if step else [value - 1, value + 1]
        found += [{**parameters, name: other} for other in values if least <= other <= most and other != value]
    return found


class Entry:
    def __init__(self, technique, parameters, seconds, abandoned=False, predicted=None):
        self.role = "best"
        self.technique, self.parameters, self.seconds, self.abandoned, self.predicted = technique, parameters, seconds, abandoned, predicted
        self.times = []


class Runs:
    """Runs of a workload by one engine."""

    def __init__(self, detp, workload, engine):
        scene, field, x, rays = workload
        self.detp = detp
        distance = detp.ask(f"scene {scene} --field {field} --rays {min(rays, 1000)}")["sample_distance"]
        self.question = f"{scene} --field {field} --rays {rays} --disc-radius {distance / x!r} --engine {engine} --threads 1"
        begin = time.monotonic()
        self.choice = detp.ask(f"choose {self.question} --rigor estimate")
        self.overhead = time.monotonic() - begin  # of a call

    def ask(self, technique, parameters, repeat, limit):
        """The answer; stopped, if it takes too long; None if the index does not fit in memory, as the command says then."""
        line = ["run", *self.question.split(), "--technique", technique, "--repeat", str(repeat)]
        for name, value in parameters.items():
            line += ["--" + name.replace("_", "-"), str(value)]
        if limit < NO_LIMIT:
            line += ["--time-limit", f"{2 * self.overhead + (1 + repeat) * limit:.6g}"]
        done = subprocess.run([self.detp.path, *line, "--format", "json", "--quiet"], stdout=subprocess.PIPE, text=True)
        if done.returncode in (2, 3):
            return {"stopped": True} if done.returncode == 3 else None
        done.check_returncode()
        return json.loads(done.stdout)

    def first(self, technique, parameters, limit):
        """The shortest of two runs, with the parameters that the command completes; abandoned: a lower bound. None if it does not fit in memory."""
        answer = self.ask(technique, parameters, 2, limit)
        if answer is None:
            return None
        if answer["stopped"]:
            return Entry(technique, parameters, limit, abandoned=True)
        return Entry(technique, answer["parameters"], min(answer["seconds"]["all"]), predicted=answer.get("predicted_seconds"))

    def fastest(self, technique, first_limit, tuned_limit):
        """The technique with its fastest parameters: from those of the closed forms on, until no neighbour is faster."""
        best = self.first(technique, {}, max(first_limit, LEAST_LIMIT))
        if best is None or best.abandoned or best.seconds > tuned_limit:
            return best
        predicted, tried = best.predicted, [best.parameters]
        for _ in range(MOST_STEPS):
            before = best
            for parameters in neighbours(technique, before.parameters):
                if parameters in tried:
                    continue
                tried.append(parameters)
                other = self.first(technique, parameters, max(LEAST_LIMIT, PATIENCE * best.seconds))
                if other and not other.abandoned and other.seconds < ENOUGH * best.seconds:
                    best = other
            if best is before:
                break
        best.predicted = predicted
        return best

    def published_ratio(self):
        """The fastest sphere cache with the paper's Q: tries three numbers of spheres."""
        spheres = self.ask("sphere-cache", {"ratio": PUBLISHED_RATIO, "spheres": "best"}, 0, NO_LIMIT)["parameters"]["spheres"]
        numbers = [k for k in [spheres - 1, spheres, spheres + 1] if k >= 1]
        tried = [self.first("sphere-cache", {"ratio": PUBLISHED_RATIO, "spheres": k}, NO_LIMIT) for k in numbers]
        best = min(tried, key=lambda entry: entry.seconds)
        best.role, best.predicted = "published-Q", None
        return best

    def rule(self, limit):
        rule = self.choice["paper_rule"]
        entry = self.first(rule["technique"], rule["parameters"], limit)
        entry.role, entry.predicted = "rule", None
        return entry

    def entries(self):
        found = []
        fastest = NO_LIMIT
        for technique in TECHNIQUES:
            of_paper = technique in OF_PAPER
            limits = (NO_LIMIT, NO_LIMIT) if of_paper else (HOPELESS * fastest, max(CANNOT_WIN * fastest, ALWAYS_TUNED))
            entry = self.fastest(technique, *limits)
            if entry is None:
                continue
            found.append(entry)
            if not entry.abandoned:
                fastest = min(fastest, entry.seconds)
        found += [self.published_ratio(), self.rule(100 * fastest)]
        self.take_turns([entry for entry in found if not entry.abandoned])
        return found

    def take_turns(self, entries):
        order, generator = list(entries), Random(1)
        spent = 0
        for _ in range(TURNS):
            for entry in order:
                entry.times += self.ask(entry.technique, entry.parameters, RUNS_OF_TURN, NO_LIMIT)["seconds"]["all"]
                spent += sum(entry.times[-RUNS_OF_TURN:])
            if spent > MOST_SECONDS:
                break
            generator.shuffle(order)
        for entry in entries:
            entry.seconds = statistics.median(entry.times)


def median_ratio(above, below):
    return statistics.median(a / b for a, b in zip(above.times, below.times))


def over(entry, cache):
    """Median, low and high of the seconds over those of the cache, round by round."""
    ratios = sorted(a / b for a, b in zip(entry.times, cache.times))
    if not ratios:
        return None, None, None
    out = 1 if len(ratios) >= 9 else 0
    return statistics.median(ratios), ratios[out], ratios[-1 - out]


def with_roles(entries):
    """All rows: role and entry."""
    best = {entry.technique: entry for entry in entries if entry.role == "best" and entry.times}
    cache = best["sphere-cache"]
    indices = [best[technique] for technique in ["octree", "bsp"] if technique in best]
    rows = [(entry.role, entry) for entry in entries]
    if indices:
        rows.append(("index", min(indices, key=lambda entry: median_ratio(entry, cache))))
    rows.append(("fastest", min(best.values(), key=lambda entry: median_ratio(entry, cache))))
    if "octree" in best:
        rows.append(("predicted", min([cache, best["octree"]], key=lambda entry: entry.predicted)))
    return rows


def rows_of(detp, place, workload, engine):
    runs = Runs(detp, workload, engine)
    entries = runs.entries()
    cache = entries[0]
    rows = with_roles(entries)
    two = min([1, *(median_ratio(entry, cache) for role, entry in rows if role == "index")])
    given = runs.choice["inputs"]
    for role, entry in rows:
        median, low, high = over(entry, cache)
        numbers = [entry.seconds, median, low, high, median and median / two, entry.abandoned, entry.predicted]
        yield [place, pathlib.Path(workload[0]).stem, workload[1], engine, given["rays"], given["samples"], f"{given['disc_radius']:.4g}",
               f"{given['sample_distance'] / given['disc_radius']:.4g}", role, entry.technique, describe(entry.parameters),
               *(f"{number:.4g}" if isinstance(number, float) else number for number in numbers)]


def main():
    detp = Detp(__doc__)
    if not detp.quick and len(sys.argv) < 3:
        sys.exit(__doc__)
    table = Table("workload,scene,field,engine,rays,samples,disc_radius,x,role,technique,parameters,seconds,over_cache,"
                  "over_cache_low,over_cache_high,over_two,abandoned,predicted_seconds", None if detp.quick else sys.argv[2])
    kept = {int(row["workload"]) for row in table.kept}
    folder = sys.argv[3] if len(sys.argv) > 3 and not detp.quick else ""
    a_small_one = 27
    for place, workload in enumerate(workloads(folder)):
        if place in kept or (detp.quick and place != a_small_one):
            continue
        print(f"{place}: {workload[0]}, X = {workload[2]:.3g}, {workload[3]} rays", file=sys.stderr)
        rows = [row for engine in ["simd", "plain"] for row in rows_of(detp, place, workload, engine)]
        for row in rows:  # all at once, so that an interrupted run leaves no part of a workload
            table.add(*row)
    table.done()


main()
