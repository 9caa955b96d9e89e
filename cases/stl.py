"""Writes triangulated surfaces as binary STL, for the scripts of cases that make them."""

import struct

CORNER = struct.Struct("<3f")


def rounded(facets):
    """Facets, each of three corners, as a file has them: in single precision."""
    return [[CORNER.unpack(CORNER.pack(*corner)) for corner in facet] for facet in facets]


def write(path, name, facets):
    """Facets, of three corners each, counter-clockwise as seen from outside."""
    facets = list(facets)
    with open(path, "wb") as file:
        file.write(name.encode().ljust(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            # The normal is that of the corners, whatever stands here.
            file.write(bytes(12) + b"".join(CORNER.pack(*corner) for corner in facet) + bytes(2))
