"""Tip of the bar of U1 with kappa 1e8 by Crank-Nicolson at steps of 0.1 s, exact in space.

The first mode is an oscillator: Crank-Nicolson turns it by 2 atan(w dt / 2) a step.
Run without arguments; writes tip_stiff.csv.
"""

import math

length, kappa, density, step = 10.0, 1e8, 1000.0, 0.1
frequency = math.pi * math.sqrt(kappa / density) / (2 * length)
angle = 2 * math.atan(frequency * step / 2)
with open("tip_stiff.csv", "w") as file:
    file.write("time,displacement\n")
    for number in range(21):
        file.write(f"{number * step:.1f},{math.sin(number * angle) / frequency:.12g}\n")
