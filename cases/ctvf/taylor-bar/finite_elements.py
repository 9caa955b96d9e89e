"""Axisymmetric finite elements for the bar of the case: four nodes, one point, the same material law.

Needs NumPy: `python3 finite_elements.py 8 16 24` prints final length, radius of the foot and largest plastic
strain for as many elements along the radius.
"""

import sys

import numpy as np

LENGTH, RADIUS, SPEED, END = 0.0324, 0.0032, 227.0, 80e-6
RHO, E, NU, YIELD, HARDENING = 8930.0, 117e9, 0.35, 400e6, 100e6
K, G = E / (3 * (1 - 2 * NU)), E / (2 * (1 + NU))
LINEAR, QUADRATIC, HOURGLASS = 0.06, 1.2, 0.05
SIGNS = np.array([1.0, -1.0, 1.0, -1.0])


def shape(x):
    """Area, gradients of the four shape functions, and mean radius of elements."""
    r, z = x[:, :, 0], x[:, :, 1]
    area = 0.5 * ((r[:, 2] - r[:, 0]) * (z[:, 3] - z[:, 1]) + (r[:, 1] - r[:, 3]) * (z[:, 2] - z[:, 0]))
    along_r = np.stack([z[:, 1] - z[:, 3], z[:, 2] - z[:, 0], z[:, 3] - z[:, 1], z[:, 0] - z[:, 2]], 1)
    along_z = np.stack([r[:, 3] - r[:, 1], r[:, 0] - r[:, 2], r[:, 1] - r[:, 3], r[:, 2] - r[:, 0]], 1)
    half = 0.5 / area[:, None]
    return area, along_r * half, along_z * half, r.mean(1)


def run(across):
    up = round(across * LENGTH / RADIUS)
    r, z = np.meshgrid(np.linspace(0, RADIUS, across + 1), np.linspace(0, LENGTH, up + 1))
    x = np.stack([r.ravel(), z.ravel()], 1)
    first = (np.arange(up)[:, None] * (across + 1) + np.arange(across)).ravel()
    nodes = np.stack([first, first + 1, first + across + 2, first + across + 1], 1)
    count, axis = len(x), x[:, 0] == 0
    area, _, _, mean = shape(x[nodes])
    mass = RHO * 2 * np.pi * mean * area
    lumped = np.bincount(nodes.ravel(), np.repeat(mass / 4, 4), count)
    v = np.zeros_like(x)
    v[:, 1] = -SPEED
    # Deviatoric stress rr, zz, across, rz; plastic strain; pressure with bulk viscosity.
    s, plastic, pressure = np.zeros((len(nodes), 4)), np.zeros(len(nodes)), np.zeros(len(nodes))
    time, speed = 0.0, np.sqrt((K + 4 / 3 * G) / RHO)
    while time < END:
        area, dr, dz, mean = shape(x[nodes])
        edges = x[nodes] - x[np.roll(nodes, -1, 1)]
        dt = min(0.3 * np.sqrt((area**2 / (edges**2).sum(2).max(1)).min()) / speed, END - time)
        density = mass / (2 * np.pi * mean * area)
        stress = s.copy()
        stress[:, :3] -= pressure[:, None]
        ring = (2 * np.pi * mean * area)[:, None]
        force = np.empty((len(nodes), 4, 2))
        force[:, :, 0] = ring * (stress[:, :1] * dr + stress[:, 3:] * dz + stress[:, 2:3] / (4 * mean[:, None]))
        force[:, :, 1] = ring * (stress[:, 3:] * dr + stress[:, 1:2] * dz)
        local, there = v[nodes], x[nodes]
        gamma = SIGNS - (there[:, :, 0] @ SIGNS)[:, None] * dr - (there[:, :, 1] @ SIGNS)[:, None] * dz
        strength = HOURGLASS * density * speed * np.sqrt(area) * 2 * np.pi * mean / 4
        force += (strength[:, None] * gamma)[:, :, None] * np.einsum("ea,eai->ei", gamma, local)[:, None, :]
        total = np.stack([np.bincount(nodes.ravel(), force[:, :, i].ravel(), count) for i in (0, 1)], 1)
        v = v - dt * total / lumped[:, None]
        v[axis, 0] = 0.0
        # The wall lets slide and lets go.
        v[:, 1] = np.maximum(v[:, 1], -x[:, 1] / dt)
        _, dr, dz, mean = shape(x[nodes] + 0.5 * dt * v[nodes])
        x = x + dt * v
        time += dt
        local = v[nodes]
        rr, rz = (local[:, :, 0] * dr).sum(1), (local[:, :, 0] * dz).sum(1)
        zr, zz = (local[:, :, 1] * dr).sum(1), (local[:, :, 1] * dz).sum(1)
        across_ = local[:, :, 0].mean(1) / mean
        trace = rr + zz + across_
        strain = np.stack([rr - trace / 3, zz - trace / 3, across_ - trace / 3, 0.5 * (rz + zr)], 1)
        angle = np.arctan(0.25 * dt * (rz - zr)) * 2
        c, n = np.cos(angle), np.sin(angle)
        a, b, d = s[:, 0], s[:, 1], s[:, 3]
        turned = [c * c * a + 2 * c * n * d + n * n * b, n * n * a - 2 * c * n * d + c * c * b]
        turned += [s[:, 2], c * n * (b - a) + (c * c - n * n) * d]
        s = np.stack(turned, 1) + 2 * G * dt * strain
        mises = np.sqrt(1.5 * ((s[:, :3] ** 2).sum(1) + 2 * s[:, 3] ** 2))
        more = np.maximum(mises - YIELD - HARDENING * plastic, 0) / (3 * G + HARDENING)
        s *= (1 - 3 * G * more / np.maximum(mises, 1.0))[:, None]
        plastic += more
        area, _, _, mean = shape(x[nodes])
        density = mass / (2 * np.pi * mean * area)
        size, closing = np.sqrt(area), np.minimum(trace, 0)
        viscous = density * size * (QUADRATIC**2 * size * closing**2 - LINEAR * speed * closing)
        pressure = K * (density / RHO - 1) + viscous
    return x[:, 1].max(), x[: across + 1, 0].max(), plastic.max()


for argument in sys.argv[1:]:
    length, foot, strain = run(int(argument))
    print(f"{argument}: length {1e3 * length:.3f} mm, foot {1e3 * foot:.3f} mm, plastic strain {strain:.3f}")
