"""The paper's figure 13: the time of the sphere cache against Q, in tests a ray, published and corrected."""

import sys

import detp
import matplotlib.pyplot as plt
import numpy as np

ratios = np.linspace(0.05, 0.95, 181)
for radius, colour in [(0.02, "C0"), (0.04, "C1"), (0.08, "C2")]:
    for published, style in [(True, "--"), (False, "-")]:
        found = [detp.predict("sphere-cache", ratio=ratio, published=published, rays=1e5, samples=2e4, disc_radius=radius,
                              scene_side=2).counts for ratio in ratios]
        tests = [(one["cull_tests"] + one["disc_tests"]) / 1e5 for one in found]
        plt.semilogy(ratios, tests, style, color=colour, label=None if published else f"d = {radius}")
plt.xlabel("Q"), plt.ylabel("tests for each ray"), plt.legend()
plt.savefig(sys.argv[1] if len(sys.argv) > 1 else "figure_13.svg")
