"""Period of an elastic slab on a column of water that is closed below: plane waves in both.

In the water (density rho, wave speed c, height L) the displacement is sin(w y/c), in the slab (density r rho,
wave speed 5 c, thickness l) cos(w (L + l - y)/(5 c)) times a constant. Both displacements and both stresses are the same at
y = L, which gives

    rho c cot(w L/c) = r rho 5 c tan(w l/(5 c)).

python3 slab.py
"""

from math import pi, tan

L, l, c = 1.0, 0.25, 10.0
for r in (10.0, 1.0, 0.5, 0.1):
    low, high = 1e-9, 0.5 * pi * c / L - 1e-9
    for _ in range(200):
        w = 0.5 * (low + high)
        if c / tan(w * L / c) > r * 5 * c * tan(w * l / (5 * c)):
            low = w
        else:
            high = w
    print(f"density ratio {r}: period {2 * pi / w:.7f} s")
