"""Writes plant.obj: soil, and a stem with 14 leaves, each an object. Lengths in metres."""

import math

LEAVES, HEIGHT, STEPS = 14, 0.8, 8
vertices, faces = [], []


def grid(rows):
    """Quadrilaterals between rows of points."""
    first, count = len(vertices) + 1, len(rows[0])
    for row in rows:
        vertices.extend(row)
    for j in range(len(rows) - 1):
        for i in range(count - 1):
            a = first + j * count + i
            faces.append(f"f {a} {a + 1} {a + count + 1} {a + count}")


def part(name, material):
    faces.append(f"o {name}\nusemtl {material}")


part("soil", "soil")
grid([[(x / 10, 0, -z / 10) for x in range(-6, 7)] for z in range(-6, 7)])
part("stem", "stem")
turn = [2 * math.pi * i / 8 for i in range(9)]
grid([[(0.01 * math.cos(t), HEIGHT * j / 16, -0.01 * math.sin(t)) for t in turn] for j in range(17)])
for leaf in range(LEAVES):
    part(f"leaf_{leaf + 1:02}", "leaf")
    angle, level = math.radians(137.5) * leaf, HEIGHT * (0.2 + 0.8 * leaf / (LEAVES - 1))
    length = 0.42 - 0.022 * leaf
    rows = []
    for j in range(STEPS + 1):
        along = j / STEPS
        reach, sag = length * along, level + 0.12 * along - 0.3 * length * along * along
        half = 0.16 * length * math.sin(math.pi * min(1, 0.08 + 0.92 * along)) + 0.002
        rows.append([(reach * math.cos(angle) - side * half * math.sin(angle), sag - 0.3 * half * (1 - abs(side)),
                      reach * math.sin(angle) + side * half * math.cos(angle)) for side in (1, 0.5, 0, -0.5, -1)])
    grid(rows)

with open("plant.mtl", "w", encoding="utf-8") as file:
    for name, colour in (("soil", "0.2 0.13 0.08"), ("stem", "0.12 0.2 0.06"), ("leaf", "0.07 0.16 0.05")):
        file.write(f"newmtl {name}\nKd {colour}\n")
with open("plant.obj", "w", encoding="utf-8") as file:
    file.write("mtllib plant.mtl\n")
    file.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*one) for one in vertices)
    file.write("\n".join(faces) + "\n")
