#!/usr/bin/env python3
"""What switching each effect changes, and whether `auto` chooses as well as `all`: writes effects.csv, effects_choice.csv or effects_families.csv.

    notebooks-data/studies/effects.py build/detp notebooks-data/effects.csv FOLDER_OF_MESHES
    notebooks-data/studies/effects.py build/detp notebooks-data/effects_choice.csv FOLDER_OF_MESHES
    notebooks-data/studies/effects.py build/detp notebooks-data/effects_families.csv [--seed 42]
    notebooks-data/studies/effects.py build/detp --quick

The file's name says which table it is. The scenes are built-in ones, generated discs and the meshes in the folder, or those that the seed makes.
One thread. By the time of single workloads (0.5 s in small scenes, 8 to 14 s in sponza), effects.csv takes five minutes, effects_choice.csv
20 minutes, effects_families.csv two. Workloads that the file has are kept and not made again. --quick prints effects.csv of one small workload.
effects_tables.py prints the tables of effects.md.

A C++ program made the published rows. The rows of effects.csv mean the same. Those of the other two tables differ:
- The command collects all evidence. The program collected less for shorter searches. So effects near their thresholds may be switched otherwise.
- evidence_seconds_auto and evidence_seconds_all stay empty: the command cannot collect the evidence that the program timed.
- Times have what it takes to touch memory for the first time. The program left it out.
- Of more than a block of rays (32 768 or more), the command looks at the first 65 536 for evidence.
"""
import math
import os
import subprocess
import sys

import unit_costs
from effects_workloads import INPUTS, USUAL_TREE, Workload, candidate_of, cell_of, of_families, of_scenes, tests
from runs import Detp, Table, option

WORKLOAD = "scene,tuned,field,disc_radius,rays,samples,"
EFFECTS = WORKLOAD + ("effect,value,standard_error,threshold,tolerance,on,close,evidence_seconds,tests_if_switched,hits_if_switched,"
                      "counted_tests_if_switched,counted_hits_if_switched,predicted_over_counted_tests,predicted_over_counted_hits,"
                      "choice,choice_if_switched")
CHOICES = WORKLOAD + ("on,tests_over_all,hits_over_all,tests_none_over_all,predicted_over_counted_auto,predicted_over_counted_all,"
                      "predicted_over_counted_none,largest_off,largest_off_change,choice_auto,choice_all,choice_none,best,"
                      "regret_auto,regret_all,regret_none,best_seconds,evidence_seconds_auto,evidence_seconds_all")
MOST_BRUTE = 3e9  # tests by brute force; more are not counted but computed


def ratio(value, divisor):
    return f"{value / divisor:.4g}" if divisor > 0 else None


def off_by(value):
    return max(value, 1 / value)


def add_effects(table, workload):
    """A row for each effect."""
    counted, predicted = workload.run(USUAL_TREE)
    choice = cell_of(candidate_of(workload.choice("auto")["choice"]))
    over_counted = ratio(tests(predicted), tests(counted)), ratio(predicted["hits"], counted["hits"])
    rows = []
    for one in workload.effects:
        apart = one["on_if"].partition(" by more than ")[2]  # the tolerance, if there is one
        changes, choice_if_switched = [None] * 4, None
        if one["name"] not in INPUTS:
            effects = workload.switched(one["name"])
            counted_now, now = workload.run(USUAL_TREE, effects)
            changes = [ratio(tests(now), tests(predicted)), ratio(now["hits"], predicted["hits"]), None, None]
            if one["name"] == "concave surfaces" and workload.photons:
                changes[2:] = ratio(tests(counted_now), tests(counted)), ratio(counted_now["hits"], counted["hits"])
            choice_if_switched = cell_of(candidate_of(workload.choice(effects)["choice"]))
        rows.append([one["name"], f"{one['value']:.4g}", f"{one['standard_error']:.2g}", f"{one['threshold']:.4g}", f"{float(apart or 0):.4g}",
                     one["on"], one["close"], f"{one['seconds']:.3g}", *changes, *over_counted, choice, choice_if_switched])
    for row in rows:
        table.add(*workload.row(), *row)


def priced(workload, answers):
    """Seconds by exact counts and built-in unit costs: of the choices, of the first three that are ranked with `auto`, and of the usual shape."""
    power = min(max(math.log2(24) + 0.3 * math.log2(workload.scene["samples"] / workload.scene["rays"]), 3), 9)
    candidates = {candidate_of(one): one for one in [answer["choice"] for answer in answers] + answers[0]["candidates"][:3]}
    candidates.setdefault(("box-tree", (("fan_out", 8), ("leaf", 2 ** math.floor(power + 0.5)))))
    found = {}
    for candidate, one in candidates.items():
        technique = candidate[0]
        too_long = technique == "brute-force" and workload.scene["samples"] * workload.scene["rays"] > MOST_BRUTE
        counts = one["predicted"] if too_long else workload.run(candidate)[0]
        found[candidate] = unit_costs.seconds(counts, answers[0]["inputs"]["unit_costs"][technique])
    return found


def add_choice(table, workload):
    """A row with the predicted tests and the choices with the effects that evidence calls for, with all and with none."""
    every = [one["name"] for one in workload.effects if one["name"] not in INPUTS]
    selections = ["auto", workload.with_effects(every), workload.with_effects([])]
    predicted = [workload.run(USUAL_TREE, effects)[1] for effects in selections]
    answers = [workload.choice(effects) for effects in selections]
    seconds = priced(workload, answers)
    best = min(seconds, key=seconds.get)
    counted = tests(workload.run(USUAL_TREE)[0])
    largest = "", 1
    for one in workload.effects:
        if not one["on"] and one["name"] not in INPUTS and off_by(one["tests_if_switched"]) > off_by(largest[1]):
            largest = one["name"], one["tests_if_switched"]
    chosen = [candidate_of(answer["choice"]) for answer in answers]
    table.add(*workload.row(), "; ".join(one["name"] for one in workload.effects if one["on"]),
              tests(predicted[0]) / tests(predicted[1]), predicted[0]["hits"] / predicted[1]["hits"], tests(predicted[2]) / tests(predicted[1]),
              *(f"{tests(one) / counted:.4g}" for one in predicted), largest[0], f"{largest[1]:.4g}",
              *(cell_of(one) for one in [*chosen, best]),
              *(f"{seconds[one] / seconds[best] - 1:.4g}" for one in chosen), f"{seconds[best]:.4g}", None, None)


def main():
    detp = Detp(__doc__)
    path = None if detp.quick else sys.argv[2]
    kind = "effects.csv" if detp.quick else os.path.basename(path)
    folder = sys.argv[3] if len(sys.argv) > 3 else ""
    if detp.quick:
        workloads = [("@cornell", "@cornell --disc-radius 2%", "photons", 2000)]
    elif kind == "effects.csv":
        workloads = of_scenes(folder, [0.0025, 0.02], [20000])
    elif kind == "effects_choice.csv":
        workloads = of_scenes(folder, [0.0025, 0.01, 0.04], [1000, 30000])
    else:
        workloads = of_families(int(option("--seed", "42")))
    table = Table(EFFECTS if kind == "effects.csv" else CHOICES, path)
    kept = {tuple(row[name] for name in ["scene", "field", "disc_radius", "rays"]) for row in table.kept}
    for name, source, field, rays in workloads:
        try:
            workload = Workload(detp, name, source, field, rays)
        except (subprocess.CalledProcessError, ValueError) as error:
            print(f"left out: {name}: {error}", file=sys.stderr)
            continue
        scene, _, field, radius, rays, _ = workload.row()
        if (scene, field, radius, str(rays)) not in kept:
            (add_effects if kind == "effects.csv" else add_choice)(table, workload)
    table.done()


main()
