"""Writes the files of points of two rings: concentric rows of particles, layer on layer along z."""

import math

INNER, OUTER, DISTANCE, WIDTH = 0.03, 0.04, 0.085, 0.006


def ring(name, centre, spacing):
    rows = round((OUTER - INNER) / spacing)
    layers = round(WIDTH / spacing)
    points = []
    for layer in range(layers):
        z = (layer + 0.5) * WIDTH / layers - WIDTH / 2
        for row in range(rows):
            radius = INNER + (row + 0.5) * (OUTER - INNER) / rows
            count = round(2 * math.pi * radius / spacing)
            for number in range(count):
                angle = 2 * math.pi * (number + 0.5 * (row % 2)) / count
                points.append((centre + radius * math.cos(angle), radius * math.sin(angle), z))
    volume = math.pi * (OUTER**2 - INNER**2) * WIDTH / len(points)
    with open(name, "w") as file:
        file.write("x,y,z,volume\n")
        for x, y, z in points:
            file.write(f"{x:.7g},{y:.7g},{z:.7g},{volume:.12g}\n")


ring("left.csv", -DISTANCE / 2, 0.002)
ring("right.csv", DISTANCE / 2, 0.002)
