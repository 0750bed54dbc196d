"""Runs of the command with seeds of their own, and their error against a reference, split into noise and bias."""
import csv
import json
import math
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from answers import Detp, Table

STUDENT = 2.3646242510103  # 97.5 % of Student's t with 7 degrees of freedom: intervals of 95 % from 8 runs


def ask(detp, line, codes=(0,)):
    """The answer of `detp LINE` as JSON. Exit code 3 says that a run or an answer did not reach its target."""
    done = subprocess.run([detp.path, *line.split(), "--format", "json", "--quiet"], stdout=subprocess.PIPE, text=True)
    if done.returncode not in codes:
        sys.exit(f"detp {line}: exit code {done.returncode}")
    return json.loads(done.stdout)


def option(name, default):
    """The word behind an option of the script."""
    return sys.argv[sys.argv.index(name) + 1] if name in sys.argv else default


def write_discs(path, discs):
    """Discs are places and normals: lists that begin with six numbers."""
    with open(path, "w") as file:
        file.write("x,y,z,nx,ny,nz\n")
        file.writelines(",".join(repr(number) for number in disc[:6]) + "\n" for disc in discs)


def estimates(detp, line, discs):
    """The answer of `detp run LINE` at the discs of a file, and the irradiance of each disc."""
    found = discs + ".found.csv"
    answer = ask(detp, f"run {line} --discs {discs} --per-disc {found}")
    with open(found) as file:
        return answer, [float(row["irradiance"]) for row in csv.DictReader(file)]


def quantile(values, share):
    values = sorted(values)
    place = share * (len(values) - 1)
    below = int(place)
    return values[below] + (place - below) * (values[min(below + 1, len(values) - 1)] - values[below])


def moments(values):
    mean = sum(values) / len(values)
    return mean, sum((value - mean) ** 2 for value in values) / (len(values) - 1)


def sums(runs, reference):
    """Weighted sums over the samples: noise², bias² and mean bias, not yet relative, and what each sample adds to the bias."""
    noise = bias = mean_bias = 0
    samples = []
    for i, (exact, variance, weight) in enumerate(reference["samples"]):
        mean, spread = moments([run[i] for run in runs])
        off = mean - exact
        square = off * off - spread / len(runs) - variance
        samples.append((off, spread, square))
        noise += weight * spread
        bias += weight * square
        mean_bias += weight * off
    return {"noise": noise, "bias": bias, "total": noise + bias, "mean_bias": mean_bias, "samples": samples}


def between_samples(reference, all_runs, runs):
    """Variances of bias² and noise²: of bias² by the reference, and of both by the choice of the samples if not all of them are judged."""
    count = len(reference["samples"])
    unseen = (1 - reference["judged_share"]) * count / max(1, count - 1)
    by_reference = by_noise = bias = noise = 0
    for (_, variance, weight), (_, spread, square) in zip(reference["samples"], all_runs["samples"]):
        square_weight = weight * weight
        of_mean = spread / runs
        sure = max(0.0, square)
        by_reference += square_weight * (4 * sure * variance + 2 * variance * variance)
        by_noise += square_weight * (4 * sure * of_mean + 2 * of_mean * of_mean + 4 * of_mean * variance)
        bias += square_weight * (square - all_runs["bias"]) ** 2
        noise += square_weight * ((spread - all_runs["noise"]) ** 2 - 2 * spread * spread / (runs - 1))
    return by_reference + unseen * max(0.0, bias - by_noise - by_reference), unseen * max(0.0, noise)


def split(runs, reference):
    """Noise, bias and total error of one run, relative to the root mean square irradiance; validate/accuracy/error_split.hpp has the formulas.

    `reference`: samples (irradiance, its variance, weight) and judged_share, the share of the samples in question that these are. The first
    three are squares with their standard errors.
    """
    mean_square = sum(weight * (exact * exact - variance) for exact, variance, weight in reference["samples"])
    mean = sum(weight * exact for exact, _, weight in reference["samples"])
    all_runs = sums(runs, reference)
    of_bias, of_noise = between_samples(reference, all_runs, len(runs))
    left_out = [sums(runs[:r] + runs[r + 1:], reference) for r in range(len(runs))]  # the jackknife
    found = {"mean_bias": all_runs["mean_bias"] / mean}
    for name, more in [("noise", of_noise), ("bias", of_bias), ("total", of_bias + of_noise)]:
        _, spread = moments([one[name] for one in left_out])
        jackknife = (len(runs) - 1) ** 2 / len(runs) * spread
        found[name] = all_runs[name] / mean_square, math.sqrt(jackknife + more) / mean_square
    root = math.sqrt(mean_square)
    found["errors"] = [abs(run[i] - exact) / root for i, (exact, _, _) in enumerate(reference["samples"]) if exact != 0 for run in runs]
    return found


def interval(square):
    """The root of a square and its interval of 95 %."""
    value, error = square
    return [math.sqrt(max(0.0, one)) for one in (value, value - STUDENT * error, value + STUDENT * error)]
