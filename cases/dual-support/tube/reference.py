"""Inflation of a tube in plane strain from its ordinary differential equation: python reference.py

dP_R/dR + (P_R - P_T)/R = 0 with the stretches l_R = r', l_T = r/R, P_R = -p l_T inside (the pressure follows
the surface, or P_R = -p where it is dead) and P_R = 0 outside; integrated by the method of Runge and Kutta from
inside, where l_T is found by bisection.
"""

KAPPA, MU = 1.0e6, 0.2e6  # Pa
INNER, OUTER = 1.0, 2.0  # m


def stresses(radial, hoop):
    """First Piola-Kirchhoff stresses of psi = kappa/2 (J-1)^2 + mu/2 (J^(-2/3) I_1 - 3)."""
    volume = radial * hoop
    first = radial**2 + hoop**2 + 1.0
    pressure = KAPPA * (volume - 1.0) - MU / 3.0 * volume ** (-5 / 3) * first
    shear = MU * volume ** (-2 / 3)
    return pressure * hoop + shear * radial, pressure * radial + shear * hoop


def radial_stretch(stress, hoop):
    low, high = 1e-3, 10.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        if stresses(middle, hoop)[0] < stress:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def outside(hoop, pressure, follows, steps):
    """Radial stress and radius outside for a hoop stretch inside."""
    step = (OUTER - INNER) / steps
    radius, stress = hoop * INNER, -pressure * (hoop if follows else 1.0)

    def rates(place, radius, stress):
        radial = radial_stretch(stress, radius / place)
        return radial, (stresses(radial, radius / place)[1] - stress) / place

    for count in range(steps):
        place = INNER + count * step
        k1 = rates(place, radius, stress)
        k2 = rates(place + step / 2, radius + step / 2 * k1[0], stress + step / 2 * k1[1])
        k3 = rates(place + step / 2, radius + step / 2 * k2[0], stress + step / 2 * k2[1])
        k4 = rates(place + step, radius + step * k3[0], stress + step * k3[1])
        radius += step / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        stress += step / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
    return stress, radius


def solve(pressure, follows, steps=200):
    low, high = 1.0, 3.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if outside(middle, pressure, follows, steps)[0] < 0.0:
            low = middle
        else:
            high = middle
    return low - 1.0, outside(low, pressure, follows, steps)[1] - OUTER


if __name__ == "__main__":
    for follows in (True, False):
        for pressure in (25e3, 50e3, 75e3, 100e3):
            inner, outer = solve(pressure, follows)
            print(f"follows {follows}, p = {pressure:.0f} Pa: inside {inner:.7f} m, outside {outer:.7f} m")
