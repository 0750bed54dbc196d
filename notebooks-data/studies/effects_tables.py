#!/usr/bin/env python3
"""Prints the tables of effects.md from effects.csv, effects_choice.csv or effects_families.csv.

    notebooks-data/studies/effects_tables.py notebooks-data/effects_choice.csv

The rows "no effects" and "hits" of the table "Predicted over counted" are not made: effects.csv has no columns for them. Evidence is left out of the
prices where its seconds are empty.
"""
import csv
import math
import statistics
import sys


def off_by(text):
    return max(float(text), 1 / float(text))


def mean(values):
    return math.exp(statistics.fmean(math.log(value) for value in values))


def quantile(values, share):
    values = sorted(values)
    place = share * (len(values) - 1)
    below = int(place)
    return values[below] + (place - below) * (values[min(below + 1, len(values) - 1)] - values[below])


def print_changes(rows):
    """What switching each effect changes."""
    print("| effect | on | close | tests change, where on | where off | hits change, where on | where off | choice, where on | where off "
          "| evidence, µs |\n" + "|---" * 10 + "|")
    for effect in dict.fromkeys(row["effect"] for row in rows if row["tests_if_switched"]):
        of = [row for row in rows if row["effect"] == effect]
        parts = [[row for row in of if row["on"] == on] for on in ["true", "false"]]
        cells = [len(parts[0]), sum(row["close"] == "true" for row in of)]
        for what in ["tests_if_switched", "hits_if_switched"]:
            ratios = [[off_by(row[what]) for row in part if float(row[what] or 0) > 0] for part in parts]
            cells += [f"{statistics.median(one):.2f}, {max(one):.2f}" if one else "" for one in ratios]
        cells += [sum(row["choice"] != row["choice_if_switched"] for row in part) for part in parts]
        cells.append(f"{1e6 * statistics.median(float(row['evidence_seconds']) for row in of):.0f}")
        print(f"| {effect} | {' | '.join(map(str, cells))} |")


def print_predictions(rows):
    """Predicted over counted tests."""
    print("\n| | workloads | median | worst | within 25 % | within a factor of 2 |\n|---|---|---|---|---|---|")
    for tuned, half in [("true", "tuned"), ("false", "held out")]:
        for field, name in [("isotropic", "isotropic lines"), ("photons", "photon paths")]:
            off = [off_by(row["predicted_over_counted_tests"]) for row in rows
                   if row["effect"] == "facing" and row["tuned"] == tuned and row["field"] == field]
            if off:
                shares = (f"{100 * sum(one <= most for one in off) / len(off):.0f} %" for most in [1.25, 2])
                print(f"| tests, {name}, {half}, auto | {len(off)} | {statistics.median(off):.3f} | {max(off):.2f} | {' | '.join(shares)} |")


def cells_of_choices(rows):
    """What a half of the workloads has to show: names and values."""
    tests = [off_by(row["tests_over_all"]) for row in rows]
    yield "workloads", len(rows)
    for share in [0.5, 0.95, 1]:
        yield f"predicted tests, auto over all, quantile {share}", f"{quantile(tests, share):.3f}"
    yield "within 2 %", sum(one <= 1.02 for one in tests)
    causes = [row["largest_off"] or "none" for row, one in zip(rows, tests) if one > 1.02]
    yield ("not within 2 %, by the effect that is off and changes the most",
           ", ".join(f"{cause} {causes.count(cause)}" for cause in sorted(set(causes))))
    for selection in ["auto", "all", "none"]:
        off = [off_by(row["predicted_over_counted_" + selection]) for row in rows]
        yield f"predicted over counted tests, {selection}: median, worst", f"{statistics.median(off):.3f}, {max(off):.2f}"
    for name in ["time over the best", "with the evidence"]:
        for selection in ["auto", "all", "none"]:
            evidence = [float(row.get("evidence_seconds_" + selection) or 0) if name == "with the evidence" else 0 for row in rows]
            times = [1 + float(row["regret_" + selection]) + seconds / float(row["best_seconds"]) for row, seconds in zip(rows, evidence)]
            yield f"{name}, {selection}: geometric mean, worst", f"{mean(times):.4f}, {max(times):.2f}"
    evidence = [[1e3 * float(row["evidence_seconds_" + one]) for row in rows if row["evidence_seconds_" + one]] for one in ["auto", "all"]]
    yield "evidence, auto and all: median, ms", ", ".join(f"{statistics.median(one):.3f}" for one in evidence if one)


def print_choices(rows):
    halves = {name: [row for row in rows if row["tuned"] == tuned] for name, tuned in [("tuned", "true"), ("held out", "false")]}
    halves = {name: list(cells_of_choices(half)) for name, half in halves.items() if half}
    print(f"| | {' | '.join(halves)} |\n|---{'|---' * len(halves)}|")
    for cells in zip(*halves.values()):
        print(f"| {cells[0][0]} | {' | '.join(str(value) for _, value in cells)} |")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        rows = list(csv.DictReader(file))
    if "effect" in rows[0]:
        print_changes(rows)
        print_predictions(rows)
    else:
        print_choices(rows)


main()
