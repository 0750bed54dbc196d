#!/usr/bin/env python3
"""Measures what the statements of the paper's sections 2 to 5 say: writes statements.csv.

    notebooks-data/statements.py build/detp [--quick] > notebooks-data/statements.csv

One row for each quantity: the statement's number in statements.md, the quantity, its value, and the command whose answer it was taken from.
Ratios of times are medians of runs in turns, on one thread. --quick takes few rays: for a look at the columns.
"""
import collections
import csv
import math
import pathlib
import statistics

from answers import Detp, Table


class Study(Detp):
    def __init__(self):
        super().__init__(__doc__)
        self.table = Table("statement,id,quantity,value,command")
        self.numbers = collections.Counter()

    def timed(self, line):
        return self.ask(f"{line} --threads 1 --repeat {1 if self.quick else 2}")["seconds"]

    def rays(self, number):
        return max(100, number // 10) if self.quick else number

    def seconds(self, line):
        return self.timed(line)["total"]

    def ratio(self, above, below, turns=3):
        """Median of the seconds of `above` over those of `below`, in turns."""
        return statistics.median(self.seconds(above) / self.seconds(below) for _ in range(1 if self.quick else turns))

    def add(self, statement, quantity, value, command):
        self.numbers[statement] += 1
        self.table.add(statement, f"{statement}.{self.numbers[statement]}", quantity, float(value), command if command.endswith(".csv") else f"detp {command}")


def tests(answer):
    return answer["counts"]["cull_tests"] + answer["counts"]["disc_tests"]


def slope(xs, ys):
    """The power of x that y is proportional to: least squares of the logarithms."""
    x = [math.log(value) for value in xs]
    y = [math.log(value) for value in ys]
    mean_x, mean_y = statistics.mean(x), statistics.mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def half_distance(s):
    """From accuracy.csv: the radius, of four, with which an image has the least error."""
    errors = collections.defaultdict(dict)
    with open(pathlib.Path(__file__).parent / "accuracy.csv") as file:
        for row in csv.DictReader(file):
            if row["estimator"] == "disc":
                errors[row["scene"], float(row["rays"])][row["radius_over_distance"]] = float(row["total"])
    for rays in [1e4, 1e5, 1e6]:
        best = [min(of, key=of.get) for (scene, number), of in errors.items() if number == rays]
        for radius in ["0.25", "0.5", "1", "2"]:
            s.add(1, f"scenes of {len(best)} with the least error at d = {radius} distances, {rays:.0f} rays", best.count(radius), "accuracy.csv")


def second_intersection(s):
    for scene in ["@shells:7", "@cornell"]:
        line = f"run {scene} --rays {s.rays(200000)} --front-facing --effects none"
        first = s.ask(line)["mean_irradiance"]
        second = s.ask(line + " --second-intersection")["mean_irradiance"]
        s.add(3, f"irradiance by the first over that by the second intersection {scene}", first / second, line)


def cache_tests(s):
    line = f"run @tree --rays {s.rays(10000)} --disc-radius 1% --technique sphere-cache --ratio 0.65"
    answer = s.ask(line)
    s.add(5, "tests of the cache over those of brute force", tests(answer) / answer["rays"] / 85967, line)
    for order in ["lebesgue", "none"]:
        line = f"run @uniform --samples 20000 --rays 1000 --disc-radius 1% --technique sphere-cache --ratio 0.65 --spheres max --order {order}"
        answer = s.ask(line)
        s.add(6, f"tests of the cache over those of brute force, order {order}", tests(answer) / answer["rays"] / 20000, line)
    for samples in [2000, 20000, 200000]:
        line = f"run @uniform --samples {samples} --rays 300 --disc-radius 1% --technique sphere-cache --ratio 0.65 --spheres max --order none"
        answer = s.ask(line)
        s.add(25, f"tests of the unsorted cache over those of brute force, {samples} samples", tests(answer) / answer["rays"] / samples, line)
    line = "run @uniform --samples 5000 --rays 1000 --disc-radius 1% --technique brute-force"
    s.add(24, "tests of brute force over rays times samples", tests(s.ask(line)) / 5e6, line)


def octree_depths(s):
    for radius, depths in [("0.5%", range(3, 9)), ("4%", range(2, 7)), ("16%", range(1, 6))]:
        lines = [f"run @tree --rays {s.rays(3000)} --disc-radius {radius} --technique octree --depth {depth}" for depth in depths]
        seconds = [s.seconds(line + " --engine plain") for line in lines]
        best = min(range(len(lines)), key=lambda i: seconds[i])
        s.add(8, f"best depth, d = {radius}", depths[best], lines[best] + " --engine plain")
        s.add(9, f"seconds of the deepest over those of the best, d = {radius}", seconds[-1] / seconds[best], lines[-1] + " --engine plain")


def best_bsp(s, question):
    lines = [f"{question} --technique bsp --leaf {leaf} --engine plain" for leaf in [16, 128, 1024, 8192]]
    return min(lines, key=lambda line: s.ask(f"{line} --threads 1")["seconds"]["total"])


def figure_7(s):
    for scene, first in [("@tree", 10), ("@tree-coarse", 12)]:
        for photons in [10000, 20000]:
            cache_seconds, index_seconds, radii = [], [], [1, 2, 4, 8, 16]
            for radius in radii:
                question = f"run {scene} --rays {s.rays(photons)} --disc-radius {radius}%"
                index = best_bsp(s, question)
                cache = f"{question} --technique sphere-cache --ratio 0.65 --engine plain"
                s.add(first + (photons == 20000 and scene == "@tree"), f"BSP tree over cache {scene} {photons} rays d = {radius}%", s.ratio(index, cache), index)
                index_seconds.append(s.seconds(index))
                cache_seconds.append(s.seconds(cache))
            if scene == "@tree" and photons == 10000:
                s.add(13, "power of d of the seconds, BSP tree", slope(radii, index_seconds), index)
                s.add(13, "power of d of the seconds, sphere cache", slope(radii, cache_seconds), cache)


def linear_in_rays(s):
    numbers = [s.rays(number) for number in [1000, 10000, 100000]]
    for statement, technique in [(14, "octree --depth 5"), (14, "octree --depth 7"), (15, "sphere-cache --ratio 0.65")]:
        lines = [f"run @tree --rays {number} --disc-radius 1% --technique {technique} --engine plain" for number in numbers]
        seconds = [s.timed(line)["search"] for line in lines]
        s.add(statement, f"power of the number of rays, 10 000 to 100 000, {technique}", slope(numbers[1:], seconds[1:]), lines[-1])
        s.add(statement, f"power of the number of rays, 1000 to 10 000, {technique}", slope(numbers[:2], seconds[:2]), lines[0])


def courtyard(s):
    for photons in [10000, 100000]:
        scene = s.ask("scene @courtyard")
        distance = scene["workload"]["sample_distance"] if "workload" in scene else scene["inputs"]["sample_distance"]
        question = f"run @courtyard --rays {s.rays(photons)} --disc-radius {distance / (4 / 3):.5g}"
        cache = f"{question} --technique sphere-cache --ratio 0.65 --engine plain"
        index = best_bsp(s, question)
        s.add(20, f"BSP tree over cache in the courtyard, {photons} rays, X = 4/3", s.ratio(index, cache), index)


def index_memory(s):
    radii = [1, 2, 4, 8]
    answers = []
    for radius in radii:
        line = f"run @tree --rays 100 --disc-radius {radius}% --technique octree --depth 6"
        answers.append(s.ask(line)["counts"]["references"])
        s.add(22, f"references for each disc, octree of depth 6, d = {radius}%", answers[-1] / 85967, line)
    s.add(22, "power of d of the references, 4 to 8 %", slope(radii[2:], answers[2:]), line)


def small_discs(s):
    for rays in [1000, 10000, 100000]:
        question = f"run @tree --rays {s.rays(rays)} --disc-radius 0.1% --engine plain"
        cache = f"{question} --technique sphere-cache --ratio 0.65"
        index = f"{question} --technique octree --depth 9"
        s.add(23, f"octree of depth 9 over cache, d = 0.1%, {rays} rays", s.ratio(index, cache), index)


def optimal_ratios(s):
    base = "model --samples 20000 --disc-radius 0.02 --scene-side 2 --rays 1e5 --technique sphere-cache"
    radius = s.ask(base)["inputs"]["sphere_radius"]
    least = 1e5 * 20000 * (0.02 / radius) ** 2
    for spheres in [4, 6, 8, 10]:
        ratio = (0.02 / radius) ** (1 / spheres) * (1 + 1e-12)
        line = f"{base} --ratio {ratio:.17g} --spheres max"
        s.add(32, f"T_I over its least, Q for {spheres} spheres", s.ask(line)["intersect_time"] / least, line)
    total = [s.ask(f"{base} --ratio {ratio} --spheres max")["total_time"] for ratio in [0.98, 0.99, 0.995]]
    spheres = [s.ask(f"{base} --ratio {ratio} --spheres max")["k"] for ratio in [0.98, 0.99, 0.995]]
    s.add(34, "power of 1 - Q of T as Q approaches 1", slope([0.02, 0.01, 0.005], total), f"{base} --ratio 0.99 --spheres max")
    s.add(35, "power of 1 - Q of k as Q approaches 1", slope([0.02, 0.01, 0.005], spheres), f"{base} --ratio 0.99 --spheres max")


def rebuilds(s):
    for samples in [10000, 100000, 1000000]:
        line = f"model --samples {samples} --disc-radius 0.02 --scene-side 2 --rays 1e5 --technique sphere-cache --ratio 0.65 --spheres 4"
        answer = s.ask(line)
        s.add(36, f"T_R of 4 spheres over the rays, {samples} samples", answer["rebuild_time"] / 1e5, line)


def orders_of_growth(s):
    """The samples of a cube of side 2 are 2d apart, and the cells of indices are 2d wide."""
    samples = [8**level for level in [4, 5, 6]]
    for statement, name, parameters in [
        (37, "sphere cache", lambda level: "sphere-cache --ratio 0.65 --spheres max"),
        (38, "octree", lambda level: f"octree --depth {level}"),
        (40, "grid", lambda level: f"grid --cells {2 ** level}"),
        (40, "BSP tree", lambda level: f"bsp --depth {3 * level} --leaf 1"),
    ]:
        operations = []
        for level in [4, 5, 6]:
            question = f"run @uniform --samples {8 ** level} --disc-radius {2 ** -level} --rays {s.rays(3000)} --engine plain --technique {parameters(level)}"
            answer = s.ask(question)
            operations.append(sum(answer["counts"][name] for name in ["cull_tests", "disc_tests", "steps", "nodes"]) / answer["rays"])
        s.add(statement, f"power of n_P of the operations a ray, d half the distance, {name}", slope(samples, operations), question)
        s.add(statement, f"operations a ray, 262144 samples, {name}", operations[-1], question)


def balanced(s):
    for traversal in ["top-down", "neighbour-links"]:
        line = f"run @uniform --samples 100000 --disc-radius 0.5% --rays {s.rays(10000)} --technique octree --depth 7 --traversal {traversal}"
        answer = s.ask(line)
        s.add(39, f"nodes a ray, {traversal}", answer["counts"]["nodes"] / answer["rays"], line)
    links, down = (f"run @uniform --samples 100000 --disc-radius 0.5% --rays {s.rays(10000)} --technique octree --depth 7 --traversal {one} --engine plain" for one in ["neighbour-links", "top-down"])
    s.add(39, "seconds with links over those without", s.ratio(links, down), links)


def main():
    study = Study()
    for part in [half_distance, second_intersection, cache_tests, octree_depths, figure_7, linear_in_rays, courtyard, index_memory, small_discs, optimal_ratios, rebuilds, orders_of_growth, balanced]:
        part(study)
    study.table.done()


main()
