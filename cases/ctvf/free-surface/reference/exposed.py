"""Counts particles on the surface of a particle file by another rule than the program's, and compares.

Usage: python3 exposed.py FRAME.vtp SPACING

A particle is exposed if a disc of one spacing that touches it can be laid beside it without any other
particle of fluid or wall inside, the rule of alpha shapes, here for 72 directions. The file needs the fields
`surface` and `wall`.
"""

import math
import re
import struct
import sys
import zlib
from collections import defaultdict

DIRECTIONS = [(math.cos(a), math.sin(a)) for a in (2 * math.pi * k / 72 for k in range(72))]


def read(path):
    """The arrays of a particle file by name, as lists of tuples."""
    data = open(path, "rb").read()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start].decode("utf-8", "replace")
    arrays = {}
    for tag in re.findall(r"<DataArray [^>]*>", head):
        key = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        at = start + int(key["offset"])
        blocks, _, _ = struct.unpack_from("<3Q", data, at)
        sizes = struct.unpack_from(f"<{blocks}Q", data, at + 24)
        at += 24 + 8 * blocks
        raw = b""
        for size in sizes:
            raw += zlib.decompress(data[at : at + size])
            at += size
        kind, width = {"Float64": ("d", 8), "UInt32": ("I", 4), "UInt64": ("Q", 8),
                       "Int64": ("q", 8)}[key["type"]]
        count = int(key.get("NumberOfComponents", 1))
        flat = struct.unpack(f"<{len(raw) // width}{kind}", raw)
        arrays[key.get("Name", "")] = list(zip(*[iter(flat)] * count))
    return arrays


def exposed(points, a, cells, spacing):
    """Whether a disc of one spacing that touches particle `a` is empty."""
    x, y = points[a][:2]
    i, j = math.floor(x / spacing), math.floor(y / spacing)
    around = [points[b] for p in range(-2, 3) for q in range(-2, 3)
              for b in cells[i + p, j + q] if b != a]
    least = (0.999 * spacing) ** 2
    return any(all((u - x - spacing * c) ** 2 + (v - y - spacing * s) ** 2 >= least
                   for u, v, *_ in around) for c, s in DIRECTIONS)


def main():
    path, spacing = sys.argv[1], float(sys.argv[2])
    arrays = read(path)
    points = next(values for name, values in arrays.items()
                  if name.lower() in ("points", "position") and len(values[0]) == 3)
    wall = [value > 0.5 for (value,) in arrays["wall"]]
    found = [value > 0.5 for (value,) in arrays["surface"]]
    body = [value for (value,) in arrays["body"]]
    cells = defaultdict(list)
    for a, (x, y, _) in enumerate(points):
        cells[math.floor(x / spacing), math.floor(y / spacing)].append(a)
    counts = defaultdict(lambda: [0, 0, 0, 0])
    for a in range(len(points)):
        if wall[a]:
            continue
        true = exposed(points, a, cells, spacing)
        row = counts[body[a]]
        for column, holds in enumerate((True, true, found[a] and true, found[a] and not true)):
            row[column] += holds
    print("body, particles, exposed, of them found, found though not exposed")
    for number, row in sorted(counts.items()):
        print(number, *row)


if __name__ == "__main__":
    main()
