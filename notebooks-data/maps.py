#!/usr/bin/env python3
"""Which technique is fastest for each number of rays and each disc radius in @tree, and in @courtyard for one radius: writes maps.csv.

    notebooks-data/maps.py build/detp notebooks-data/maps.csv
    notebooks-data/maps.py build/detp --quick

Maps of `detp choose --map --analyze`: all techniques, and the paper's (sphere cache, octree, BSP tree), by both engines; the courtyard for the
paper's alone, X = 4/3. One row for each technique in each cell: the seconds that are predicted for its best candidate, and those measured. An
hour. Adds the maps that the file does not have; --quick prints small ones.
"""
import sys

from answers import Detp, Table

OTHERS = "brute-force,cell-spheres,sphere-tree,box-tree,grid,bvh,ray-map"


def add_cells(table, scene, techniques, engine, answer):
    for cell in answer["cells"]:
        predicted, measured = ({one["technique"]: one.get("seconds") for one in cell[kind]["techniques"]} for kind in ["predicted", "measured"])
        for technique in dict.fromkeys([*predicted, *measured]):
            table.add(scene, techniques, engine, cell["rays"], answer["inputs"]["samples"], cell["disc_radius"], cell["x"], technique,
                      predicted.get(technique), technique == cell["predicted"]["technique"],
                      measured.get(technique), technique == cell["measured"]["technique"], cell["slower"], cell["within_noise"])


def main():
    detp = Detp(__doc__)
    table = Table("scene,techniques,engine,rays,samples,disc_radius,x,technique,predicted_seconds,predicted_best,measured_seconds,measured_best,slower,within_noise",
                  None if detp.quick else sys.argv[2])
    kept = {(row["scene"], row["techniques"], row["engine"]) for row in table.kept}
    rays = "100,1000" if detp.quick else "100,300,1000,3000,10000,30000,100000"
    radii = {"@tree": "1%,4%" if detp.quick else "0.25%,0.5%,1%,2%,4%,8%", "@courtyard": "0.40521"}
    for scene, techniques in [("@tree", "all"), ("@tree", "paper"), ("@courtyard", "paper")]:
        left_out = f"--disable {OTHERS}" if techniques == "paper" else ""
        for engine in ["plain", "simd"]:
            if (scene, techniques, engine) not in kept:
                grid = f"--rays {rays} --disc-radius {radii[scene]}"
                add_cells(table, scene, techniques, engine, detp.ask(f"choose {scene} --map --analyze --threads 1 --engine {engine} {grid} {left_out}"))
    table.done()


main()
