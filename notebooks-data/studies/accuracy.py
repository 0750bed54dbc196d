#!/usr/bin/env python3
"""Noise, bias and total error of each estimator, against references, in several scenes: adds rows to accuracy.csv.

    notebooks-data/studies/accuracy.py build/detp notebooks-data/accuracy.csv [--scenes @cornell,bunny.obj]
    notebooks-data/studies/accuracy.py build/detp notebooks-data/accuracy_answers.csv --answers [--scenes …] [--seeds 1:5] [--seconds 45]
    notebooks-data/studies/accuracy.py build/detp --quick [--answers]

A row for each scene, estimator, setting and number of rays (of gather: backward paths of each sample). Eight runs with their own seeds are
judged at up to 2000 of the scene's samples, by the reference that `detp accuracy --reference` makes and keeps for the time of the script.
trace_seconds is the mean of the eight runs. estimate_seconds is that of the first seed at all samples of the scene, and of gather that of the judged
samples, in proportion. A scene as @cornell or @tree takes about five minutes on one core: a run of a million rays takes about a second there, and a
reference up to a minute. Rows that the table has are kept and not made again. Then the script prints the settings with the least error in each
scene, as tables of a page.

--answers asks `detp accuracy` for 5 % noise and for 10, 5 and 2 % total error in each scene, and runs each answer again with other seeds
(rows `run`). It runs the printed command of an answer that takes less than 6 s three times, each time as a process of its own (rows `command`). Four
times the limit of --seconds for each scene, at most, besides a reference of up to a minute. Questions that the table has are kept.

In names of scenes and in commands, $DETP_SCENES stands for the folder of meshes. --quick prints a small table of @furnace.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

from runs import Detp, Table, ask, estimates, interval, option, quantile, split, write_discs

COLUMNS = ("scene,estimator,reference,radius_over_distance,nearest,rays,photons,noise,noise_low,noise_high,bias,bias_low,bias_high,"
           "total,total_low,total_high,within_5_percent,error_95,worst,trace_seconds,estimate_seconds,reference_error")
ANSWERS = ("scene,role,target_kind,target,reached,reference,reference_error,estimator,setting,quantity,disc_radius,nearest,rays,paths,photons,"
           "noise,noise_low,noise_high,bias,bias_low,bias_high,mean_bias,error,error_low,error_high,predicted_seconds,on_frontier,seed,work,"
           "measured_noise,measured_error,measured_seconds,planning_seconds,correction,command")
SCENES = "@cornell,@caustic,@interior,@tree"
FOLDER = os.environ.get("DETP_SCENES", "").rstrip("/")
RADII = [0.25, 0.5, 1, 2]  # over the mean edge of the triangles
SEARCH = "--technique box-tree --fan-out 8 --leaf 16"
RUNS = 8


def settings(rays):
    """Estimator, radius over the mean edge, and k, each 0 if it is not used."""
    for radius in RADII:
        for estimator in ["disc", "variable-radius", "area-corrected"]:
            yield estimator, radius, 0
        if radius == RADII[0]:
            for nearest in [10, 50, 200]:
                if 4 * nearest <= rays:
                    yield "nearest", 0, nearest
            yield "triangle-hits", 0, 0


def read_reference(detp, scene, path):
    """Makes the file's reference if there is none; target and estimator do not matter."""
    if not os.path.exists(path):
        ask(detp, f"accuracy {scene} --reference {path} --estimators disc --effort quick", (0, 3))
    with open(path) as file:
        reference = json.load(file)
    reference["discs"] = reference["samples"]
    reference["samples"] = [disc[6:9] for disc in reference["discs"]]
    reference["judged_share"] = len(reference["samples"]) / reference["population"]
    return reference


def line_of(scene, distance, setting, rays):
    """The words of `detp run`, without the seed."""
    estimator, radius, nearest = setting
    line = f"{scene} --estimator {estimator} --disc-radius {(radius or RADII[0]) * distance!r}"
    if estimator == "gather":
        return f"{line} --paths {rays}"
    line += f" --rays {rays}"
    if estimator in ["disc", "variable-radius"]:
        line += f" {SEARCH}"
    return f"{line} --nearest {nearest}" if nearest else line


def add_row(detp, table, label, line, setting, rays, reference, discs, of_all):
    answers, found = zip(*(estimates(detp, f"{line} --seed {1000 + run}", discs) for run in range(1, RUNS + 1)))
    parts = split(found, reference)
    gathers = setting[0] == "gather"
    if gathers:
        estimate_seconds = of_all / len(reference["samples"]) * sum(answer["seconds"]["total"] for answer in answers) / RUNS
    else:
        estimate_seconds = ask(detp, f"run {line} --seed 1001")["seconds"]["total"]
    trace_seconds = 0 if gathers else sum(answer["trace_seconds"] for answer in answers) / RUNS
    photons = 0 if gathers else sum(answer["photons"] for answer in answers) / RUNS
    errors = parts["errors"]
    numbers = [setting[1], setting[2], rays, photons, *interval(parts["noise"]), *interval(parts["bias"]), *interval(parts["total"]),
               sum(error <= 0.05 for error in errors) / len(errors), quantile(errors, 0.95), max(errors), trace_seconds, estimate_seconds,
               reference["error"]]
    table.add(label, setting[0], reference["kind"], *(f"{number:.6g}" for number in numbers))


def add_errors(detp, table, scene, folder):
    label = os.path.basename(scene)
    kept = {(row["estimator"], float(row["radius_over_distance"]), int(row["nearest"]), float(row["rays"]))
            for row in table.kept if row["scene"] == label}
    numbers = [10_000] if detp.quick else [10_000, 100_000, 1_000_000]
    cases = [(setting, rays) for rays in numbers for setting in settings(rays)]
    cases += [(("gather", 0, 0), paths) for paths in ([16] if detp.quick else [16, 64, 256])]
    missing = [(setting, rays) for setting, rays in cases if (*setting, rays) not in kept]
    if not missing:
        return
    reference = read_reference(detp, scene, f"{folder}/{label}.reference")
    discs = f"{folder}/{label}.csv"
    write_discs(discs, reference["discs"])
    about = ask(detp, f"scene {scene} --rays 1000")["inputs"]
    for setting, rays in missing:  # the usual radius is half the mean edge
        add_row(detp, table, label, line_of(scene, 2 * about["disc_radius"], setting, rays), setting, rays, reference, discs, about["samples"])


def best(rows, total):
    """The row with the least total error, as a cell: "11.7 % (d = 1 h)"."""
    if not rows:
        return ""
    row = min(rows, key=total)
    radius, nearest = float(row["radius_over_distance"]), int(row["nearest"])
    setting = f" (d = {radius:g} h)" if radius else f" (k = {nearest})" if nearest else ""
    return f"{100 * total(row):.1f} %{setting}"


def total_in_a_second(row):
    """Bias² + noise², with the rays that a second allows: seconds grow in proportion."""
    seconds = float(row["trace_seconds"]) + float(row["estimate_seconds"])
    return (float(row["bias"]) ** 2 + float(row["noise"]) ** 2 * seconds) ** 0.5


def print_summary(path):
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if float(row["rays"]) == 1e6 and row["estimator"] != "gather"]
    estimators = list(dict.fromkeys(row["estimator"] for row in rows))
    for title, total in [("Least total error with 10⁶ pieces of photon paths (h: sample distance)", lambda row: float(row["total"])),
                         ("Least total error in one second, tracing included", total_in_a_second)]:
        print(f"\n{title}\n\n| scene | {' | '.join(estimators)} | disc, d = h/2 |\n|---|{'---|' * len(estimators)}---|")
        for scene in dict.fromkeys(row["scene"] for row in rows):
            own = [row for row in rows if row["scene"] == scene]
            half = [row for row in own if row["estimator"] == "disc" and float(row["radius_over_distance"]) == 0.5]
            cells = [best([row for row in own if row["estimator"] == estimator], total) for estimator in estimators]
            print(f"| {scene} | {' | '.join(cells)} | {best(half, total).split(' (')[0]} |")


def rows_of_answer(detp, question):
    """The rows of an answer, its rivals and its runs. Exit code 3: the error is not reached, or not all seeds were run in time."""
    words = [detp.path, *question.split(), "--format", "csv", "--quiet"]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 3):
        sys.exit(f"detp {question}: exit code {done.returncode}")
    return [row for row in csv.DictReader(done.stdout.splitlines()) if row["role"] in ["answer", "rival", "run"]]


def rows_of_command(detp, answer):
    """Its printed command with other seeds. Seconds are those of the run, tracing included."""
    kept = {name: answer[name] for name in ["scene", "target_kind", "target"]}
    for seed in [5001, 5002, 5003]:
        found = ask(detp, f"{answer['command'].removeprefix('detp ')} --seed {seed}")
        yield kept | {"role": "command", "seed": seed, "measured_seconds": found["seconds"]["total"] + (found.get("trace_seconds") or 0)}


def add_answers(detp, table, scene, folder):
    reference = f"{folder}/{os.path.basename(scene)}.reference"
    label = scene.removeprefix(f"{FOLDER}/") if FOLDER else scene
    kept = {(row["target_kind"], row["target"]) for row in table.kept if row["scene"] == label}
    for kind, target in [("noise", "0.1")] if detp.quick else [("noise", "0.05"), ("error", "0.1"), ("error", "0.05"), ("error", "0.02")]:
        if (kind, target) in kept:
            continue
        read_reference(detp, scene, reference)  # before the limit of seconds begins
        rows = rows_of_answer(detp, f"accuracy {scene} --target-{kind} {target} --reference {reference} --check "
                              f"--seeds {option('--seeds', '1:5')} --time-limit {option('--seconds', '45')}")
        answer = rows[0]
        if answer["predicted_seconds"] and float(answer["predicted_seconds"]) < 6:
            rows += rows_of_command(detp, answer)
        for row in rows:
            row["scene"] = label
            if FOLDER and "command" in row:
                row["command"] = row["command"].replace(f"{FOLDER}/", "$DETP_SCENES/")
            table.add(*(row.get(name, "") for name in ANSWERS.split(",")))


def main():
    detp = Detp(__doc__)
    answers = "--answers" in sys.argv
    table = Table(ANSWERS if answers else COLUMNS, None if detp.quick else sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        for scene in option("--scenes", "@furnace" if detp.quick else SCENES).split(","):
            (add_answers if answers else add_errors)(detp, table, scene, folder)
    table.done()
    if not answers and not detp.quick:
        print_summary(sys.argv[2])


main()
