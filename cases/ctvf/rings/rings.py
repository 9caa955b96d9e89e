"""Writes the files of points of two rings, of concentric rows of particles, all of the same volume."""

import math

INNER, OUTER, DISTANCE = 0.03, 0.04, 0.085


def ring(name, centre, spacing):
    layers = round((OUTER - INNER) / spacing)
    points = []
    for layer in range(layers):
        radius = INNER + (layer + 0.5) * (OUTER - INNER) / layers
        count = round(2 * math.pi * radius / spacing)
        for number in range(count):
            angle = 2 * math.pi * (number + 0.5 * (layer % 2)) / count
            points.append((centre + radius * math.cos(angle), radius * math.sin(angle)))
    volume = math.pi * (OUTER**2 - INNER**2) / len(points)
    with open(name, "w") as file:
        file.write("x,y,volume\n")
        for x, y in points:
            file.write(f"{x:.9g},{y:.9g},{volume:.12g}\n")


for suffix, spacing in ("", 0.001), ("-coarse", 0.002):
    ring(f"left{suffix}.csv", -DISTANCE / 2, spacing)
    ring(f"right{suffix}.csv", DISTANCE / 2, spacing)
