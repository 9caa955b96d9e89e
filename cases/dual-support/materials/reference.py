"""Forces of homogeneous stretching for this case and `materials-3d`: python reference.py

Writes reference/LAW-STATE.csv: load factor and nominal stress in Pa of a block that is stretched
along one axis while its other sides are free, or held where the state is plane strain. The stretches
across are those at which the stress across is zero, by bisection on the closed forms of the
principal stresses, theory (38), (41) and (42), and Gent's, theory (99).
"""

from math import pi, sin
from pathlib import Path

YOUNG, POISSON = 1e6, 0.25
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))


def saint_venant_kirchhoff(stretches):
    strains = [(l * l - 1) / 2 for l in stretches]
    return [l * (LAME * sum(strains) + 2 * SHEAR * e) for l, e in zip(stretches, strains)]


def volumetric(bulk, stretches):
    j = stretches[0] * stretches[1] * stretches[2]
    return j, [bulk * (j - 1) * j / l for l in stretches]


def mooney_rivlin(stretches, c10=0.2e6, c01=0.05e6, bulk=1e6):
    j, volume = volumetric(bulk, stretches)
    a, b, c = (l * l for l in stretches)
    first, second = a + b + c, a * b + b * c + c * a
    return [
        c10 * j ** (-2 / 3) * (2 * l - 2 / 3 * first / l)
        + c01 * j ** (-4 / 3) * (2 * l * (first - l * l) - 4 / 3 * second / l)
        + p
        for l, p in zip(stretches, volume)
    ]


def ogden(stretches, moduli=(0.63e6, 1.2e3, -1e4), exponents=(1.3, 5.0, -2.0), bulk=2e6):
    j, volume = volumetric(bulk, stretches)
    stresses = volume
    for modulus, exponent in zip(moduli, exponents):
        powers = [(j ** (-1 / 3) * l) ** exponent for l in stretches]
        mean = sum(powers) / 3
        stresses = [s + modulus * (power - mean) / l for s, power, l in zip(stresses, powers, stretches)]
    return stresses


def gent(stretches, shear=0.4e6, limit=30.0, bulk=1e6):
    j, volume = volumetric(bulk, stretches)
    first = sum(l * l for l in stretches)
    isochoric = j ** (-2 / 3)
    stiffening = shear * limit / (limit - (isochoric * first - 3))
    return [stiffening * isochoric * (l - first / (3 * l)) + p for l, p in zip(stretches, volume)]


def across(law, stretch, states):
    """The stretch across, one for all free directions, without stress there."""
    low, high = 0.05, 3.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if law(states(stretch, middle))[1] < 0 else (low, middle)
    return middle


LAWS = {f.__name__: f for f in (saint_venant_kirchhoff, mooney_rivlin, ogden, gent)}
STATES = {
    "strain": lambda stretch, free: [stretch, free, 1.0],
    "stress": lambda stretch, free: [stretch, free, free],
}


def stretch(t):
    return 1 - 0.35 * sin(2 * pi * min(t, 0.5)) + 1.6 * max(0, t - 0.5)


if __name__ == "__main__":
    folder = Path(__file__).parent / "reference"
    folder.mkdir(exist_ok=True)
    for name, law in LAWS.items():
        for state, stretches in STATES.items():
            with open(folder / f"{name}-{state}.csv", "w") as file:
                file.write("t,nominal_stress\n")
                for k in range(26):
                    t = k / 25
                    l = stretch(t)
                    file.write(f"{t:.2f},{law(stretches(l, across(law, l, stretches)))[0]:.9g}\n")
