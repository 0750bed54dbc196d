#!/usr/bin/env python3
"""How often is the error at the end of a run below its target, and inside its interval? The same of a naive rule: writes stopping.csv.

    notebooks-data/studies/stopping.py build/detp notebooks-data/stopping.csv
    notebooks-data/studies/stopping.py build/detp --quick

Each run is `detp run SCENE --target-noise E --seed S`. The error at its end is that against a run of 40 times the rays with the same discs,
whose own noise is subtracted. The naive rule looks after each pair of batches of 2048 rays, and takes the noise that it finds for the error. Its
batches are runs with seeds of their own, and its noise follows from the differences of the pairs as in validate/stopping/paired_batches.hpp.

Some four hours, most of it for the naive rule, which calls the command a quarter of a million times. Cases that the file has are kept, and not
made again; --quick prints two seeds of one case. Needs numpy and scipy.

Rays, photons and noise of the rule `pairs of batches` are counts, which depend on the seed alone: they are those that are published. The naive
rule has other photons than in the published rows, because a call cannot go on where another one ended. The errors are against a long run of
other photons; they differ from the published ones within its noise.
"""
import itertools
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.special import fdtri

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from answers import Detp, Table

CASES = [  # name, scene, estimator, target, number of seeds
    ("@furnace", "@furnace", "disc", 0.05, 50),
    ("@cornell", "@cornell", "disc", 0.1, 50),
    ("@cornell", "@cornell", "disc", 0.05, 100),
    ("@caustic", "@caustic", "disc", 0.1, 50),
    ("@tree", "@tree", "disc", 0.2, 50),
    ("lines in @cornell", "@cornell --field isotropic", "disc", 0.1, 50),
    ("@interior", "@interior", "disc", 0.1, 50),
    ("@cornell", "@cornell", "area-corrected", 0.1, 50),
    ("@caustic", "@caustic", "triangle-hits", 0.1, 50),
]
SEED_OF_REFERENCE = 987654
REFERENCE_OVER_RUN = 40  # rays
RAYS_OF_BATCH = 2048  # of the naive rule
MOST_BATCHES = 100_000  # of a seed, whose batches have seeds of their own
KEPT_PAIRS = 8  # with which a new one is compared
REFERENCE_NOISE = "0.01%"  # less than can be reached, so that the limit of rays ends the run
EFFECTS = ["surface-samples", "clustered-samples", "concave-surfaces", "finite-paths", "uneven-rays", "occlusion", "directional-bias"]


class Runs:
    """Runs of a case, with the irradiance of each disc."""

    def __init__(self, detp, scene, estimator, folder):
        self.detp, self.found = detp, os.path.join(folder, "found.csv")
        self.lines = "isotropic" in scene
        self.question = ["run", *scene.split(), "--estimator", estimator, "--per-disc", self.found, "--format", "json", "--quiet"]

    def ask(self, line):
        """The answer; its irradiance is that of all photons, or of one line."""
        stopped_by_limit = 3
        done = subprocess.run([self.detp.path, *self.question, *line.split()], stdout=subprocess.PIPE, text=True)
        if done.returncode not in (0, stopped_by_limit):
            done.check_returncode()
        answer = json.loads(done.stdout)
        answer["irradiance"] = numpy.loadtxt(self.found, delimiter=",", skiprows=1, usecols=10) / (answer["photons"] if self.lines else 1)
        return answer

    def to_target(self, target, seed):
        return self.ask(f"--target-noise {target} --seed {seed}")

    def batch(self, effects, seed):
        return self.ask(f"--rays {RAYS_OF_BATCH} --effects {effects} --seed {seed}")

    def reference(self, rays):
        return self.ask(f"--target-noise {REFERENCE_NOISE} --rays {rays} --seed {SEED_OF_REFERENCE}")


def mesh_of(detp, scene, folder):
    """Positions of the samples, positions of the vertices, and triangles."""
    mesh, discs = os.path.join(folder, "mesh.ply"), os.path.join(folder, "discs.npy")
    detp.ask(f"scene {scene} --rays 100 --write-mesh {mesh} --write-discs {discs}")
    samples = numpy.load(discs)
    with open(mesh, "rb") as file:
        header = b""
        while not header.endswith(b"end_header\n"):
            header += file.readline()
        words = header.split()
        vertices, faces = (int(words[words.index(name) + 1]) for name in [b"vertex", b"face"])
        positions = numpy.fromfile(file, dtype="<f8", count=6 * vertices).reshape(-1, 6)[:, :3]
        triangles = numpy.fromfile(file, dtype=[("corners", "u1"), ("corner", "<i4", 3)], count=faces)["corner"]
    return numpy.column_stack([samples[axis] for axis in "xyz"]), positions, triangles


def mirrors_of(positions, triangles, area, share):
    """Which triangles are mirrors: the one or two parts of the mesh that have their share of the area. A part is what shared vertices connect."""
    edges = numpy.concatenate([triangles[:, :2], triangles[:, 1:]])
    graph = coo_matrix((numpy.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(len(positions), len(positions)))
    part = connected_components(graph, directed=False)[1][triangles[:, 0]]
    shares = numpy.bincount(part, area) / area.sum()
    parts = numpy.flatnonzero(shares)
    found = [some for number in [1, 2] for some in itertools.combinations(parts, number) if abs(sum(shares[i] for i in some) - share) < 1e-9]
    if len(found) != 1:
        sys.exit(f"{len(found)} choices of parts of the mesh have {share} of its area")
    return numpy.isin(part, found[0])


def weights_of(samples, positions, triangles, mirror_share):
    """The area around each sample, without mirrors."""
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    area = 0.5 * numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1)
    if mirror_share > 0:
        area[mirrors_of(positions, triangles, area, mirror_share)] = 0
    around = numpy.bincount(triangles.ravel(), numpy.repeat(area / 3, 3), len(positions))
    weights = around[vertices_of(samples, positions, numpy.unique(triangles))]
    return weights / weights.sum()


def vertices_of(samples, positions, used):
    """The vertex of each sample. Both are in the same order; some vertices have no sample."""
    places = []
    left = iter(used)
    for sample in samples:
        places.append(next(vertex for vertex in left if (positions[vertex] == sample).all()))
    return places


class PairedBatches:
    """The noise over all discs, by the differences of pairs of batches."""

    def __init__(self, weights):
        self.weights = weights
        self.sums = numpy.zeros(len(weights))
        self.photons = 0
        self.squares, self.differences = [], []  # of the pairs; differences of the last ones
        self.products_of_squares = self.squares_of_products = 0

    def add(self, first, second):
        """Two batches: irradiance and photons of each."""
        (x, n), (y, m) = first, second
        self.sums += n * x + m * y
        self.photons += n + m
        difference = (y - x) * (n * m / (n + m)) ** 0.5
        square = self.weights @ difference**2
        for earlier, its_square in zip(self.differences, self.squares[-KEPT_PAIRS:]):
            self.squares_of_products += (self.weights @ (difference * earlier)) ** 2
            self.products_of_squares += square * its_square
        self.squares.append(square)
        self.differences = [*self.differences, difference][-KEPT_PAIRS:]

    def irradiance(self):
        return self.sums / self.photons

    def noise(self):
        """0 if it is not known."""
        if len(self.squares) < 2:
            return 0
        variance = statistics.fmean(self.squares) / self.photons
        square = self.weights @ self.irradiance()**2 - variance
        return (variance / square) ** 0.5 if square > 0 else 0

    def interval(self):
        """The ends, each with 95 %."""
        discs_freedom = max(1, self.products_of_squares / self.squares_of_products)
        mean, count = statistics.fmean(self.squares), len(self.squares)
        most = discs_freedom * count
        error = statistics.stdev(self.squares) / count**0.5
        variance_freedom = min(max(2 * (mean / error) ** 2, 0.1), most) if error > 0 else most
        return [self.noise() * fdtri(discs_freedom, variance_freedom, share) ** 0.5 for share in [0.05, 0.95]]


def naive(runs, weights, effects, target, seed):
    sums = PairedBatches(weights)
    rays, batch = 0, seed * MOST_BATCHES
    while not 0 < sums.noise() <= target:
        pair = []
        for _ in range(2):
            found = runs.batch(effects, batch)
            pair.append((found["irradiance"], found["photons"]))
            rays += found["rays"]
            batch += 1
        sums.add(*pair)
    low, high = sums.interval()
    return {"rays": rays, "photons": sums.photons, "noise": sums.noise(), "noise_interval": [low, high], "irradiance": sums.irradiance()}


def error_of(irradiance, reference, weights):
    """Root mean square over the discs by area, over that of the reference without its noise."""
    own = reference["noise"] ** 2
    mean_square = weights @ reference["irradiance"] ** 2 / (1 + own)
    return max(0, weights @ (irradiance - reference["irradiance"]) ** 2 / mean_square - own) ** 0.5


def effects_of(answer):
    """Those that a run has, so that its batches are made in the same way."""
    found = [one["name"].replace(" ", "-") for one in answer["effects"] if one["on"]]
    return ",".join(name for name in found if name in EFFECTS) or "none"


def rows_of(detp, case, folder):
    name, scene, estimator, target, seeds = case
    runs = Runs(detp, scene, estimator, folder)
    results = []
    weights = None
    for seed in range(1, (2 if detp.quick else seeds) + 1):
        planned = runs.to_target(target, seed)
        if weights is None:
            weights = weights_of(*mesh_of(detp, scene.split()[0], folder), planned.get("mirror_share", 0))
        results.append((seed, "pairs of batches", planned))
        results.append((seed, "naive", naive(runs, weights, effects_of(planned), target, seed)))
    rays = statistics.median(found["rays"] for _, rule, found in results if rule != "naive")
    reference = runs.reference(round(REFERENCE_OVER_RUN * rays))
    for seed, rule, found in results:
        error = error_of(found["irradiance"], reference, weights)
        numbers = [found["noise"], *found["noise_interval"], error]
        yield [name, estimator, target, rule, seed, found["rays"], round(found["photons"]), *(repr(float(one)) for one in numbers)]


def main():
    detp = Detp(__doc__)
    if not detp.quick and len(sys.argv) < 3:
        sys.exit(__doc__)
    table = Table("scene,estimator,target,rule,seed,rays,photons,noise,noise_low,noise_high,error", None if detp.quick else sys.argv[2])
    kept = {(row["scene"], row["estimator"], float(row["target"])) for row in table.kept}
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES[1:2] if detp.quick else CASES:
            if (case[0], case[2], case[3]) in kept:
                continue
            for row in list(rows_of(detp, case, folder)):
                table.add(*row)
    table.done()


main()
