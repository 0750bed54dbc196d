"""Discs that no scene has, as validate/bench/workload.cpp makes them: clusters, a tiny object, a thin sheet, strays, mixed radii."""
import math

from philox import TESTS, uniform4

NAMES = ["clusters", "tiny-object", "thin-sheet", "strays", "mixed-radii"]


def normal(u, v):
    """Two independent standard normal numbers (Box and Muller)."""
    length = math.sqrt(-2 * math.log1p(-u))
    return length * math.cos(2 * math.pi * v), length * math.sin(2 * math.pi * v)


def direction(u, v):
    """Uniform on the sphere."""
    z = 1 - 2 * u
    rho = math.sqrt(max(0, 1 - z * z))
    return rho * math.cos(2 * math.pi * v), rho * math.sin(2 * math.pi * v), z


def position(name, seed, number):
    u = uniform4(seed, TESTS, number)
    cube = [one - 0.5 for one in u[:3]]
    if name == "clusters":  # 20; their sizes fall geometrically from 0.1 to 0.0003
        size = 0.1 * 0.003 ** (number % 20 / 19)
        centre = [0.8 * (one - 0.5) for one in uniform4(seed, TESTS, number % 20)[:3]]
        return [at + size * off for at, off in zip(centre, [*normal(u[0], u[1]), normal(u[2], u[3])[0]])]
    if name == "tiny-object":  # a ball of radius 0.005 on a floor
        if number % 2 == 0:
            return [cube[0], 0, cube[1]]
        return [at + 0.005 * off for at, off in zip([0.1, 0.005, 0.2], direction(u[0], u[1]))]
    if name == "thin-sheet":
        return [cube[0], 0, cube[2]]
    if name == "strays" and number < 5:
        return [600 * one for one in cube]
    return cube


def write_discs(file, name, count, radius, seed=1):
    """As CSV."""
    file.write("x,y,z,nx,ny,nz,radius\n")
    for number in range(count):
        u = uniform4(seed, TESTS, number, 1)
        factor = math.exp(normal(u[2], u[3])[0]) if name == "mixed-radii" else 1
        file.write(",".join(repr(float(one)) for one in [*position(name, seed, number), *direction(u[0], u[1]), radius * factor]) + "\n")
    file.flush()
