"""The workloads of effects.py: scenes with rays and discs, as the command sees them."""
import functools
import os
import tempfile

import generated_discs
from philox import SCENE, uniform4

TUNED = ["@tree", "@courtyard", "@cornell", "stanford_bunny", "sponza", "bedroom", "mountain", "grove_fine", "tangerine_fine", "cornell_box",
         "stanford_dragon", "tree"]  # thresholds of effects were selected on them
OTHER_UNITS = ["huge_scale", "tiny_scale"]  # as huge_offset
INPUTS = ["facing", "radius per disc"]  # nobody can switch them
USUAL_TREE = ("box-tree", (("fan_out", 8), ("leaf", 16)))


def tests(counts):
    return counts["cull_tests"] + counts["disc_tests"]


def candidate_of(answer):
    return answer["technique"], tuple(answer["parameters"].items())


def cell_of(candidate):
    """Such as: box-tree fan-out 8; leaf 64."""
    technique, parameters = candidate
    values = [f"{name.replace('_', '-')} {value:.4g}" if isinstance(value, float) else f"{name.replace('_', '-')} {value}"
              for name, value in parameters]
    return f"{technique} {'; '.join(values)}".strip()


class Workload:
    """A scene with rays and discs, as the command sees it."""

    def __init__(self, detp, name, source, field, rays):
        self.detp = detp
        self.name = name
        self.photons = field == "photons"
        self.line = f"{source} --field {field} --rays {rays} --threads 1"
        self.scene = detp.ask("scene " + self.line)
        self.effects = self.scene["effects"]
        self.on = [one["name"] for one in self.effects if one["on"] and one["name"] not in INPUTS]
        if self.scene["samples"] < 50:
            raise ValueError(f"fewer than 50 samples ({self.scene['samples']})")

    def row(self):
        rays, samples = round(self.scene["rays"]), round(self.scene["samples"])
        return self.name, self.name in TUNED, "photons" if self.photons else "isotropic", f"{self.scene['disc_radius']:.5g}", rays, samples

    def with_effects(self, names):
        """The option for these effects. Concave surfaces stay as they are: they change how photon paths are made, and no prediction."""
        concave = ["concave surfaces"] if "concave surfaces" in self.on else []
        return self.option([one for one in names if one != "concave surfaces"] + concave)

    def switched(self, effect):
        """The option for this effect the other way round, and all others as they are."""
        return self.option([one["name"] for one in self.effects if one["name"] not in INPUTS and one["on"] != (one["name"] == effect)])

    @staticmethod
    def option(names):
        return ",".join(name.replace(" ", "-") for name in names) or "none"

    @functools.cache
    def choice(self, effects):
        """The answer by closed forms and built-in unit costs."""
        return self.detp.ask(f"choose {self.line} --rigor estimate --calibration none --effects {effects}")

    @functools.cache
    def run(self, candidate, effects="auto"):
        """The counts and the predicted ones."""
        technique, parameters = candidate
        options = " ".join(f"--{name.replace('_', '-')} {value}" for name, value in parameters)
        answer = self.detp.ask(f"run {self.line} --calibration none --technique {technique} {options} --effects {effects}")
        return answer["counts"], answer.get("predicted")


def meshes_in(folder):
    for path, _, files in os.walk(folder):
        for file in files:
            name, kind = os.path.splitext(file)
            if kind in [".obj", ".ply"] and name not in OTHER_UNITS:
                yield name, os.path.join(path, file)


def of_scenes(folder, shares, rays):
    """Name, source, field and number of rays of each workload. Generated discs are written to a file that lasts as long as their workload."""
    scenes = [(name, name) for name in ["@tree", "@courtyard", "@cornell", "@tree-coarse", "@caustic", "@interior", "@uniform"]]
    for name, source in scenes + [(name, None) for name in generated_discs.NAMES] + sorted(meshes_in(folder)):
        for share in shares:
            with tempfile.NamedTemporaryFile("w", suffix=".csv") as discs:
                if not source:
                    generated_discs.write_discs(discs, name, 20000, share)
                of = f"{source} --disc-radius {100 * share:g}%" if source else f"--discs {discs.name}"
                for number in rays:
                    for field in ["isotropic"] if name == "@uniform" or not source else ["isotropic", "photons"]:
                        yield name, of, field, number


def of_families(seed):
    """As family_workloads of validate/bench/workload.hpp."""
    for place in range(84):
        family = ["room", "plant", "machine", "terrain", "shells", "details"][place // 14]
        name = f"@{family}:{100 * seed + place % 14 // 7}"
        random = uniform4(seed, SCENE, place)
        share = 0.0025 * (0.16 / 0.0025) ** random[0]
        most = min(1e6, 3e7 / (1e5 * share**2))
        yield name, f"{name} --disc-radius {100 * share!r}%", "photons" if place % 7 < 5 else "isotropic", round(100 * (most / 100) ** random[1])
