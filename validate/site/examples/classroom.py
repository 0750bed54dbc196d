"""Writes classroom.obj: 9 m × 3 m × 7 m, three windows in one wall, 20 desks. Lengths in metres; the windows shine with 2000 cd/m²."""

vertices, faces = [], []


def rectangle(corner, u, v, steps):
    """Faces with the normal u × v."""
    first = len(vertices) + 1
    for j in range(steps[1] + 1):
        for i in range(steps[0] + 1):
            vertices.append(tuple(c + i / steps[0] * a + j / steps[1] * b for c, a, b in zip(corner, u, v)))
    row = steps[0] + 1
    for j in range(steps[1]):
        for i in range(steps[0]):
            a = first + j * row + i
            faces.append(f"f {a} {a + 1} {a + row + 1} {a + row}")


def part(name, material):
    faces.append(f"o {name}\nusemtl {material}")


part("floor", "floor")
rectangle((0, 0, 7), (9, 0, 0), (0, 0, -7), (36, 28))
part("ceiling", "white")
rectangle((0, 3, 0), (9, 0, 0), (0, 0, 7), (36, 28))
part("walls", "wall")
rectangle((0, 0, 0), (9, 0, 0), (0, 3, 0), (36, 12))
rectangle((0, 0, 7), (0, 0, -7), (0, 3, 0), (28, 12))
rectangle((9, 0, 0), (0, 0, 7), (0, 3, 0), (28, 12))
rectangle((9, 0, 7), (-9, 0, 0), (0, 3, 0), (36, 12))
part("windows", "sky")
for i in range(3):
    rectangle((0.75 + 2.75 * i, 1, 0.01), (2, 0, 0), (0, 1.6, 0), (8, 6))
part("desks", "wood")
for i in range(5):
    for j in range(4):
        rectangle((1 + 1.5 * i, 0.74, 1.9 + 1.4 * j), (1.2, 0, 0), (0, 0, -0.6), (12, 6))

with open("classroom.mtl", "w", encoding="utf-8") as file:
    for name, share in (("floor", 0.3), ("white", 0.8), ("wall", 0.6), ("wood", 0.4)):
        file.write(f"newmtl {name}\nKd {share} {share} {share}\n")
    file.write("newmtl sky\nKd 0.1 0.1 0.1\nKe 2000 2000 2000\n")
with open("classroom.obj", "w", encoding="utf-8") as file:
    file.write("mtllib classroom.mtl\n")
    file.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*one) for one in vertices)
    file.write("\n".join(faces) + "\n")
