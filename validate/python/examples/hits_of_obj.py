"""All hits of rays on discs at the vertices of an OBJ file, each exactly once: python3 hits_of_obj.py mesh.obj"""

import sys

import detp
import numpy as np

bumpy = [f"v {x} {y} {0.3 * np.sin(x) * np.cos(y):.4f}" for x in range(20) for y in range(20)]
bumpy += [f"f {a} {a + 20} {a + 21} {a + 1}" for a in range(1, 380) if a % 20]
lines = open(sys.argv[1], encoding="utf-8").read().splitlines() if len(sys.argv) > 1 else bumpy

vertices = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
normals = np.zeros_like(vertices)
for line in lines:
    if line.startswith("f "):
        corners = [int(word.split("/")[0]) for word in line.split()[1:]]
        corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
        for a, b in zip(corners[1:], corners[2:]):
            normals[[corners[0], a, b]] += np.cross(vertices[a] - vertices[corners[0]], vertices[b] - vertices[corners[0]])
used = np.linalg.norm(normals, axis=1) > 0
low, high = vertices.min(axis=0), vertices.max(axis=0)
random = np.random.default_rng(1)
origins = random.uniform(low, high, (100_000, 3))
directions = random.normal(size=origins.shape)
radius = 0.01 * np.max(high - low)
found = detp.find_hits(detp.Discs(vertices[used], normals[used], radius), detp.Rays(origins, directions))
print(f"{found.total_hits} pairs of {len(origins)} lines and {used.sum()} vertices")
most = int(np.argmax(found.hits))
print(f"vertex {np.flatnonzero(used)[most]} is crossed by the lines {found.rays_of(most)[:5]} and {max(0, int(found.hits[most]) - 5)} more")
