#!/usr/bin/env python3
"""Times of the sphere cache for each Q, as in the paper's figures 11 to 13: writes formulas.csv.

    notebooks-data/formulas.py build/detp [--quick] > notebooks-data/formulas.csv

20 000 samples in a cube of side 2, all spheres that the form allows. T_R and T_I for each ray, in tests (t = u = 1). Some ten seconds.
"""
from answers import Detp, Table


def main():
    detp = Detp(__doc__)
    table = Table("form,disc_radius,ratio,spheres,rebuild_tests,intersect_tests")
    ratios = "0.3,0.65" if detp.quick else ",".join(f"{0.1 + 0.01 * i:.2f}" for i in range(90))
    for form in ["published", "corrected"]:
        answer = detp.ask(
            f"model --samples 20000 --disc-radius 0.02,0.05,0.1,0.2 --scene-side 2 --rays 1e5 --technique sphere-cache --spheres max --engine plain "
            f"--form {form} --ratio {ratios}"
        )
        for row in answer["rows"]:
            table.add(form, row["inputs"]["disc_radius"], row["parameters"]["ratio"], row["k"], row["rebuild_time"] / 1e5, row["intersect_time"] / 1e5)
    table.done()


main()
