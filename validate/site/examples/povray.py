"""Reads wall.ph, a photon map of POV-Ray 3.7, and writes photons.csv; writes wall.obj, the part of the wall that matters.

The file has the number of photons, and of each its place (three floats), its power (three bytes of red, green and blue, and the exponent less 250), a byte of flags,
and the angles of the direction to where it came from, in 127ths of half a turn: above the plane of x and z, and in it.
"""

import math
import struct

with open("wall.ph", "rb") as file:
    data = file.read()
(count,) = struct.unpack_from("<I", data)
with open("photons.csv", "w", encoding="utf-8") as file:
    file.write("x,y,z,wx,wy,wz,r,g,b\n")
    for number in range(count):
        x, y, z, red, green, blue, exponent, _, up, around = struct.unpack_from("<fff4BBbb", data, 4 + 20 * number)
        elevation, azimuth = math.pi * up / 127, math.pi * around / 127
        direction = (math.cos(elevation) * math.cos(azimuth), math.sin(elevation), math.cos(elevation) * math.sin(azimuth))
        power = [(one + 0.5) / 256 * 2.0 ** (exponent - 250) for one in (red, green, blue)]
        file.write(",".join(f"{one:.9g}" for one in (x, y, z, *direction, *power)) + "\n")

STEPS, SIDE = 100, 2.0
with open("wall.obj", "w", encoding="utf-8") as file:
    for j in range(STEPS + 1):
        for i in range(STEPS + 1):
            file.write(f"v {-0.7 + SIDE * (i / STEPS - 0.5):.9g} {0.3 + SIDE * (j / STEPS - 0.5):.9g} 1\n")
    for j in range(STEPS):
        for i in range(STEPS):
            a = j * (STEPS + 1) + i + 1
            file.write(f"f {a} {a + STEPS + 1} {a + STEPS + 2} {a + 1}\n")
