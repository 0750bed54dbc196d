"""Meshes with dense objects that few rays reach, as OBJ files: a tiny object on a huge floor, dense objects in a closed room, clusters in space."""
import math

from philox import TESTS, uniform4


class Mesh:
    """An OBJ file of floors, walls and spheres, with the random numbers of its seed."""

    def __init__(self, seed):
        self.seed = seed
        self.drawn = 0
        self.vertices = 0
        self.lines = []

    def between(self, least, most):
        """A number between the two, with a uniform logarithm."""
        self.drawn += 1
        return least * math.pow(most / least, uniform4(self.seed, TESTS, self.drawn - 1)[0])

    def vertex(self, place):
        self.lines.append("v {:.7g} {:.7g} {:.7g}\n".format(*place))
        self.vertices += 1

    def quad(self, a, b, c, d):
        self.lines.append(f"f {a} {b} {c}\nf {a} {c} {d}\n")

    def square(self, corner, u, v, cells):
        """A parallelogram of cells² quads."""
        first = self.vertices + 1
        for i in range(cells + 1):
            for j in range(cells + 1):
                self.vertex([at + a * (i / cells) + b * (j / cells) for at, a, b in zip(corner, u, v)])
        for i in range(cells):
            for j in range(cells):
                low = first + i * (cells + 1) + j
                self.quad(low, low + 1, low + cells + 2, low + cells + 1)

    def floor(self, cells):
        self.square([0, 0, 0], [10, 0, 0], [0, 0, 10], cells)

    def room(self, height, cells):
        """Floor, ceiling and four walls."""
        x, y, z, corner = [10, 0, 0], [0, height, 0], [0, 0, 10], [0, 0, 0]
        for u, v, other in [(x, z, y), (x, y, z), (y, z, x)]:
            self.square(corner, u, v, cells)
            self.square(other, u, v, cells)

    def sphere(self, centre, radius, vertices):
        """Of about so many vertices."""
        rings = int(math.sqrt(0.5 * vertices))
        first = self.vertices + 1
        for i in range(rings + 1):
            for j in range(2 * rings):
                polar = math.pi * i / rings
                around = math.pi * j / rings
                self.vertex([centre[0] + radius * math.sin(polar) * math.cos(around), centre[1] + radius * math.cos(polar),
                             centre[2] + radius * math.sin(polar) * math.sin(around)])
        for i in range(rings):
            for j in range(2 * rings):
                following = (j + 1) % (2 * rings)
                ring = first + 2 * rings * i
                self.quad(ring + j, ring + following, ring + 2 * rings + following, ring + 2 * rings + j)

    def text(self):
        return "".join(self.lines)


def object_on_floor(mesh, radius, fewest, most):
    """Draws its numbers in the order in which GCC evaluates arguments: the last first."""
    vertices, z, x = mesh.between(fewest, most), mesh.between(1, 9), mesh.between(1, 9)
    mesh.sphere([x, radius, z], radius, vertices)


def tiny_object(seed):
    mesh = Mesh(seed)
    mesh.floor(int(mesh.between(1, 60)))
    object_on_floor(mesh, mesh.between(0.01, 0.2), 2000, 12000)
    return mesh.text()


def furnished_room(seed):
    mesh = Mesh(seed)
    height = mesh.between(2.5, 6)
    mesh.room(height, int(mesh.between(1, 20)))
    for _ in range(int(mesh.between(4, 30))):
        object_on_floor(mesh, mesh.between(0.02, 0.5), 200, 4000)
    return mesh.text()


def clusters(seed):
    mesh = Mesh(seed)
    for _ in range(int(mesh.between(3, 20))):
        radius = mesh.between(0.01, 0.5)
        vertices, z, y, x = mesh.between(500, 8000), mesh.between(1, 9), mesh.between(1, 9), mesh.between(1, 9)
        mesh.sphere([x, y, z], radius, vertices)
    return mesh.text()
