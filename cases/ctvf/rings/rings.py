"""Writes the files of points of two rings: concentric rows a spacing apart, from the inner radius to
the outer one, each particle of the volume of a square of the lattice, as in the authors' own run of CTVF."""

import math

INNER, OUTER, CENTRE = 0.03, 0.04, 0.041


def ring(name, side, spacing):
    points = []
    for row in range(round((OUTER - INNER) / spacing) + 1):
        radius = INNER + row * spacing
        count = math.ceil(2 * math.pi * radius / spacing)
        for number in range(count):
            angle = 2 * math.pi * number / count
            x = side * (CENTRE + radius * math.cos(angle))
            points.append((x, radius * math.sin(angle)))
    with open(name, "w") as file:
        file.write("x,y,volume\n")
        for x, y in points:
            file.write(f"{x:.9g},{y:.9g},{spacing**2:.12g}\n")


for suffix, spacing in ("", 0.001), ("-coarse", 0.002):
    ring(f"left{suffix}.csv", -1, spacing)
    ring(f"right{suffix}.csv", 1, spacing)
