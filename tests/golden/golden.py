#!/usr/bin/env python3
"""Answers of every command before and after a change: golden.py BINARY FOLDER writes them, golden.py --compare BEFORE AFTER compares.

What depends on the clock or the machine is masked. All else must be equal: keys (JSON objects have no order), numbers to the last digit, columns
and their order, text of CSV. Questions use --calibration none, so that choices do not depend on the machine's costs.
"""

import argparse
import csv
import difflib
import io
import json
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, List

numbers = "--rays 1e5 --samples 1e4 --disc-radius 0.02 --scene-side 2"
questions = {
    "model": [numbers, f"{numbers} --ratio 0.65 --form published", f"{numbers} --technique octree", f"{numbers} --technique grid",
              f"{numbers} --technique box-tree --fan-out 8 --leaf 16", f"{numbers} --technique cell-spheres",
              f"{numbers} --technique sphere-tree", f"{numbers} --ratio 0.3:0.9:0.1 --form published,corrected",
              "@cornell --rays 5000", f"{numbers} --target-error 5% --curvature -3", f"{numbers} --costs t=2e-9,u=3e-9"],
    "choose": [numbers, f"{numbers} --rigor estimate", "@cornell --rays 20k", "@tree-coarse --rays 100k --disc-radius 1%",
               "@cornell --rays 20k --verbose", "@uniform --samples 5000 --rays 5000", "@cornell --rays 20k --engine plain",
               "@cornell --rays 20k --disable box-tree", "@cornell --rays 20k --effects none", "@cornell --rays 20k --ranks 4",
               "@cornell --map --rays 1e3,1e4 --disc-radius 1%,4%", "@cornell --rays 5M"],
    "run": ["@cornell --rays 20k", "@cornell --rays 20k --technique octree", "@cornell --rays 20k --technique sphere-cache --ratio 0.65",
            "@cornell --rays 20k --technique sphere-cache --ratio 0.65 --form published",
            "@cornell --rays 20k --technique sphere-cache-published", "@cornell --rays 20k --technique box-tree,grid,bsp,bvh,ray-map",
            "@cornell --rays 20k --estimator triangle-hits", "@cornell --rays 20k --estimator variable-radius",
            "@cornell --rays 20k --estimator nearest --nearest 20", "@cornell --rays 20k --estimator area-corrected",
            "@cornell --estimator gather --paths 4", "@cornell --rays 2M", "@cornell --rays 20k --seeds 1:3",
            "@cornell --target-noise 20%", "@cornell --target-error 30%", "@uniform --samples 5000 --rays 5000 --technique grid",
            "@cornell --rays 20k --technique box-tree --per-disc d.csv --standard-error", "@cornell --rays 1000 --technique grid --pairs p.csv",
            "@cornell --rays 20k --front-facing", "@cornell --rays 20k --light area,spot", "@cornell --field isotropic --rays 20k",
            "@furnace --rays 20k --field mixed", "@tree-coarse --rays 20k --technique cell-spheres"],
    "validate": ["--rays 32000 --samples 500 --disc-radius 0.05", "--experiments sphere-cache --rays 32000 --samples 500 --ratio 0.5",
                 "@cornell --rays 20k --experiments choice,effects", "--experiments lines --until-relative-error 5%"],
    "scene": ["@cornell --rays 20k", "@uniform --samples 2000", "@cornell --write-discs d.ply --write-rays r.csv --rays 1000",
              "@tree-coarse --rays 20k --disc-radius 1%"],
    "accuracy": ["@cornell --target-noise 10% --effort quick", "@cornell --target-error 15% --effort quick",
                 "@cornell --time-budget 0.5 --effort quick --estimators disc,gather"],
    "bench": ["@cornell --rays 1000 --disc-radius 4% --repeat 1 --techniques grid,box-tree"],
}
without_calibration = ("choose", "run")

# Depends on the clock, the machine or the load.
clock = re.compile(r"seconds|spread|_bytes_measured|peak_bytes|cpu|date|whole|^processor|share_of_time|choosing|planning|given_up|"
                   r"merit|ratio_error|^best$|imbalance|version|fastest|regret|against_embree|worst|geometric_mean|p95|instruction|threads")


def masked(value: Any, key: str = "", hidden: bool = False) -> Any:
    hidden = hidden or clock.search(key) is not None
    if isinstance(value, dict):
        return {name: masked(one, name, hidden) for name, one in value.items()}
    if isinstance(value, list):
        return "clock" if hidden else [masked(one) for one in value]
    return "clock" if hidden and value is not None else value


def masked_csv(text: str) -> str:
    rows = list(csv.reader(io.StringIO(text)))
    hidden = [clock.search(name) is not None for name in rows[0]] if rows else []
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    for i, row in enumerate(rows):
        writer.writerow(["clock" if i > 0 and hidden[j] else cell for j, cell in enumerate(row)])
    return out.getvalue()


def ask(binary: Path, folder: Path, number: int, command: str, options: str) -> None:
    line = f"{command} {options} --seed 3 --threads 1 --quiet" + (" --calibration none" if command in without_calibration else "")
    if "--seeds" in options:
        line = line.replace(" --seed 3", "")
    with tempfile.TemporaryDirectory() as place:
        for form in ("json", "csv"):
            ran = subprocess.run([str(binary), *line.split(), "--format", form], cwd=place, capture_output=True, text=True)
            text = ran.stdout
            if form == "json" and text:
                text = json.dumps(masked(json.loads(text)), indent=1, ensure_ascii=False, sort_keys=True) + "\n"
            elif text:
                text = masked_csv(text)
            (folder / f"{number:02}-{command}.{form}").write_text(f"{line}\nexit {ran.returncode}\n{ran.stderr}{text}", encoding="utf-8")
        for written in sorted(Path(place).iterdir()):
            (folder / f"{number:02}-{command}-{written.name}").write_bytes(written.read_bytes())


def compare(before: Path, after: Path) -> int:
    names = sorted({path.name for folder in (before, after) for path in folder.iterdir()})
    different: List[str] = []
    for name in names:
        texts = [(folder / name).read_bytes() if (folder / name).exists() else b"(none)" for folder in (before, after)]
        if texts[0] == texts[1]:
            continue
        different.append(name)
        lines = [text.decode("utf-8", "replace").splitlines() for text in texts]
        for line in list(difflib.unified_diff(*lines, f"before/{name}", f"after/{name}", lineterm="", n=1))[:40]:
            print(line)
    print(f"{len(names)} answers, {len(different)} differ")
    return 1 if different or not names else 0


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--compare", action="store_true")
    options.add_argument("first", type=Path)
    options.add_argument("second", type=Path)
    asked = options.parse_args()
    if asked.compare:
        return compare(asked.first, asked.second)
    asked.second.mkdir(parents=True, exist_ok=True)
    all_of = [(command, one) for command, lines in questions.items() for one in lines]
    with ThreadPoolExecutor(2) as workers:
        list(workers.map(lambda i: ask(asked.first.resolve(), asked.second, i, *all_of[i]), range(len(all_of))))
    print(f"{len(all_of)} questions answered")
    return 0


if __name__ == "__main__":
    sys.exit(main())
