"""Writes the stress of Elastodynamics (5.4) at stretches from 1.25 to 6, against the time of the pull."""

import math
from pathlib import Path

YOUNG, DENSITY, LENGTH, TRANSITS = 200e9, 8000.0, 0.015, 30.0

for nu in (0.3, 0.49):
    mu = YOUNG / (2 * (1 + nu))
    lame = YOUNG * nu / ((1 + nu) * (1 - 2 * nu))
    end = TRANSITS * LENGTH / math.sqrt((lame + 2 * mu) / DENSITY)
    rows = ["time,stress"]
    for k in range(10, 201):
        stretch = 1 + 0.025 * k
        stress = mu * (stretch - 1 / stretch) + lame * math.log(stretch) / stretch
        rows.append(f"{end * k / 200:.16g},{stress:.16g}")
    Path(__file__).with_name("reference").joinpath(f"nu-{nu}.csv").write_text("\n".join(rows) + "\n")
