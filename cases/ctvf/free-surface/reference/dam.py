"""Writes `dam.csv`: the water of the breaking dam, case T4, at 0.6 s, in twice its size.

Usage: python3 dam.py FRAME.vtp, in this folder, with a particle file of

    piola run cases/ctvf/dam-break/case.toml --set parameters.dx=0.05
"""

import sys

from exposed import read

arrays = read(sys.argv[1])
points = next(values for name, values in arrays.items()
              if name.lower() in ("points", "position") and len(values[0]) == 3)
with open("../dam.csv", "w") as file:
    file.write("x,y,volume\n")
    for (x, y, _), (wall,) in zip(points, arrays["wall"]):
        if wall < 0.5:
            file.write(f"{3 + 2 * x:.6f},{-6 + 2 * y:.6f},0.01\n")
