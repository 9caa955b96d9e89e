"""Writes left.csv and right.csv: rings of concentric rows of particles, all of the same volume."""

import math

INNER, OUTER, SPACING, DISTANCE = 0.03, 0.04, 0.001, 0.085


def ring(name, centre):
    layers = round((OUTER - INNER) / SPACING)
    points = []
    for layer in range(layers):
        radius = INNER + (layer + 0.5) * (OUTER - INNER) / layers
        count = round(2 * math.pi * radius / SPACING)
        for number in range(count):
            angle = 2 * math.pi * (number + 0.5 * (layer % 2)) / count
            points.append((centre + radius * math.cos(angle), radius * math.sin(angle)))
    volume = math.pi * (OUTER**2 - INNER**2) / len(points)
    with open(name, "w") as file:
        file.write("x,y,volume\n")
        for x, y in points:
            file.write(f"{x:.9g},{y:.9g},{volume:.12g}\n")


ring("left.csv", -DISTANCE / 2)
ring("right.csv", DISTANCE / 2)
