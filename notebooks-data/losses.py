#!/usr/bin/env python3
"""Hits that the published sphere cache loses, for each Q: writes losses.csv.

    notebooks-data/losses.py build/detp [--quick] > notebooks-data/losses.csv

20 000 samples in a cube and on its faces, discs of 1 % of the scene, 10 000 isotropic lines, all spheres that the form allows. Half a minute.
"""
from answers import Detp, Table


def main():
    detp = Detp(__doc__)
    table = Table("dimension,ratio,spheres,hits,found_by_published")
    rays = 1000 if detp.quick else 10000
    for dimension in [3, 2]:
        for step in range(5, 95, 45 if detp.quick else 5):
            line = f"run --samples 20000 --scene-side 2 --disc-radius 0.02 --rays {rays} --dimension {dimension} --ratio {step / 100} --spheres max --technique "
            exact = detp.ask(line + "sphere-cache")
            published = detp.ask(line + "sphere-cache-published")
            table.add(dimension, step / 100, exact["parameters"]["spheres"], exact["hits"], published["hits"])
    table.done()


main()
