"""Writes trough.obj: a parabolic mirror, 5 m × 8 m, with a tube of 10 cm along its focus 1 m above. It faces the sun of `--light directional`."""

import math

FOCUS, HALF_WIDTH, LENGTH, RADIUS = 1.0, 2.5, 8.0, 0.05
FACETS, SIDES, PARTS = 200, 48, 24
SUN = (-0.48, 0.8, -0.36)  # from the mirror to the sun


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.hypot(*a)
    return tuple(one / length for one in a)


ACROSS = unit(cross(SUN, (0, 0, 1)))
ALONG = cross(ACROSS, SUN)


def point(x, y, z):
    return tuple(x * ACROSS[i] + y * SUN[i] + z * ALONG[i] for i in range(3))


vertices, faces = [], []


def strip(name, material, profile, parts):
    """Quadrilaterals along the trough, over a profile across it."""
    faces.append(f"o {name}\nusemtl {material}")
    first = len(vertices) + 1
    for j in range(parts + 1):
        vertices.extend(point(x, y, LENGTH * (j / parts - 0.5)) for x, y in profile)
    count = len(profile)
    for j in range(parts):
        for i in range(count - 1):
            a = first + j * count + i
            faces.append(f"f {a} {a + 1} {a + count + 1} {a + count}")


width = [HALF_WIDTH * (2 * i / FACETS - 1) for i in range(FACETS + 1)]
strip("mirror", "silver", [(x, x * x / (4 * FOCUS)) for x in width], 20)
turn = [2 * math.pi * i / SIDES for i in range(SIDES + 1)]
strip("tube", "absorber", [(RADIUS * math.cos(t), FOCUS + RADIUS * math.sin(t)) for t in turn], PARTS)

with open("trough.mtl", "w", encoding="utf-8") as file:
    file.write("newmtl silver\nKd 0 0 0\nKs 0.94 0.94 0.94\nillum 3\nnewmtl absorber\nKd 0.05 0.05 0.05\n")
with open("trough.obj", "w", encoding="utf-8") as file:
    file.write("mtllib trough.mtl\n")
    file.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*one) for one in vertices)
    file.write("\n".join(faces) + "\n")
