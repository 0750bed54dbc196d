#!/usr/bin/env python3
"""Does the choice hold on other machines? Calibrates and judges it with each instruction set of this machine: writes instruction_sets.csv.

    notebooks-data/studies/instruction_sets.py build/detp notebooks-data/instruction_sets.csv

For each instruction set: unit costs by `detp calibrate`, then the regret of each tier (`detp bench --regret`, one thread, the workloads of
@cornell of the effort `thorough`). `costs` says whose unit costs a tier used: its own, or those of the machine's best instruction set, as if
nobody had calibrated. The two are judged by two calls. Some ten minutes for each instruction set. Sets that the file has are kept, and not
measured again; sets that this machine lacks are left out.

The command selects the best constant box tree on scenes that are not held out, and @cornell is held out. So the figures of the row `best
constant`, which are those of the best box tree for these workloads, cannot be got from it: the row is written without them.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from answers import Detp, Table

SETS = ["AVX3", "AVX2", "SSE4", "SCALAR"]  # best first
TIERS = ["pilot", "run", "structural", "estimate", "measure"]


def calibrate(detp, instruction_set, path):
    """False if the machine lacks the set."""
    line = f"calibrate --threads 1 --instruction-set {instruction_set} --format json --quiet --output {path}"
    done = subprocess.run([detp.path, *line.split()], stdout=subprocess.PIPE, text=True)
    if done.returncode == 0:
        print(f"{instruction_set}: median error of left-out workloads {json.loads(done.stdout)['left_out_median_error']:.3f}", file=sys.stderr)
    return done.returncode == 0


def regret(detp, instruction_set, path):
    return detp.ask(f"bench @cornell --regret --effort thorough --threads 1 --instruction-set {instruction_set} --calibration {path}")["summary"]


def rounded(figures, *names):
    return [None if figures[name] is None else f"{figures[name]:.3f}" for name in names]


def add_rows(table, instruction_set, own, others):
    for costs, summary in [("own", own), ("best set's", others)]:
        for tier in TIERS:
            figures = summary["regret"][tier]
            table.add(instruction_set, tier, costs, figures["workloads"], *rounded(figures, "geometric_mean", "p95", "worst"),
                      *rounded(summary["tiers"][tier]["prediction"], "median_error", "p95_error"))
    table.add(instruction_set, "best constant", "", own["workloads"], None, None, None, None, None)
    table.add(instruction_set, "noise", "", own["noise"]["workloads"], *rounded(own["noise"], "geometric_mean", "p95", "worst"), None, None)


def main():
    detp = Detp(__doc__)
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    table = Table("instruction_set,tier,costs,workloads,geometric_mean,p95,worst,median_error,p95_error", sys.argv[2])
    kept = {row["instruction_set"] for row in table.kept}
    with tempfile.TemporaryDirectory() as folder:
        paths = {one: os.path.join(folder, one) for one in SETS}
        here = [one for one in SETS if calibrate(detp, one, paths[one])]
        for one in here:
            if one not in kept:
                add_rows(table, one, regret(detp, one, paths[one]), regret(detp, one, paths[here[0]]))
    table.done()


main()
