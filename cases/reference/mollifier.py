"""The modified mollifier, Elastodynamics (2.19), for the sums of E1 and E2."""

import math


def bell(q):
    """(2.19) without its factor."""
    return math.exp(-1 / (1 - q * q)) * (1 - q * q) ** 8 if abs(q) < 1 else 0.0


def slope(q):
    s = 1 - q * q
    return -2 * q * math.exp(-1 / s) * (s**6 + 8 * s**7) if s > 0 else 0.0


# The trapezoidal rule converges faster than any power: the function is flat at its ends.
INTEGRAL = sum(bell(k / 1000 - 1) for k in range(2001)) / 1000


def weights(cover):
    """V W and V dW/dx of the neighbours, by their distance in spacings; the second times the spacing."""
    reach = range(-int(cover), int(cover) + 1)
    return ({m: bell(m / cover) / (INTEGRAL * cover) for m in reach},
            {m: slope(m / cover) / (INTEGRAL * cover**2) for m in reach})
