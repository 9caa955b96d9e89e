# A case from an STL file
# =======================
#
# A pillar with a hexagonal section stands on the ground and is compressed by its own weight. Its shape comes from an
# STL file, as a CAD program would write it; here the script writes it. With a Poisson's ratio of zero its state is
# exact, whatever the section is: at the height z the stress is -rho g (L - z), and the pillar is shorter by rho g L^2 /
# (2 E).

import numpy as np

import piola

HEIGHT, RADIUS = 1.0, 0.2  # m
YOUNG, DENSITY, GRAVITY = 1e7, 1000.0, 10.0  # Pa, kg/m^3, m/s^2

# Triangles, each three corners counter-clockwise as seen from outside: two for each side, one for each side of a cap.

turn = np.arange(6) * np.pi / 3
foot = np.stack([RADIUS * np.cos(turn), RADIUS * np.sin(turn), 0 * turn], axis=-1)
up = np.array([0, 0, HEIGHT])
triangles = []
for a, b in zip(foot, np.roll(foot, -1, axis=0)):
    triangles += [[a, b, b + up], [a, b + up, a + up], [0 * up, b, a], [up, a + up, b + up]]

# A binary STL: 80 bytes of heading, the number of triangles, and for each its normal, its corners and two bytes.

facets = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
facets["corners"] = triangles
with open("pillar.stl", "wb") as file:
    file.write(b"a pillar".ljust(80))
    file.write(np.uint32(len(facets)).tobytes())
    file.write(facets.tobytes())

case = piola.Case(
    {
        "version": 1,
        "title": "A pillar under its own weight",
        "dimension": 3,
        "body": [
            {
                "name": "pillar",
                "shape": {"kind": "surface", "file": "pillar.stl"},
                "spacing": 0.05,
                "lattice": {"on": "boundary"},
                "material": {
                    "kind": "linear_elastic",
                    "density": DENSITY,
                    "young_modulus": YOUNG,
                    "poisson_ratio": 0.0,
                },
            }
        ],
        "scheme": {"kind": "dual_support"},
        "load": [{"kind": "body_force", "acceleration": ["0", "0", f"-{GRAVITY} * t"]}],
        "boundary": [
            {
                "name": "ground",
                "where": {"kind": "plane", "point": [0, 0, 0], "normal": [0, 0, -1]},
                "displacement": {"x": "0", "y": "0", "z": "0"},
            }
        ],
        "time": {"integrator": "static", "end": 1.0, "step": 1.0},
        "probe": [
            {"name": "top", "kind": "particle", "at": [0, 0, HEIGHT], "fields": ["displacement"]},
            {
                "name": "ground",
                "kind": "sum",
                "field": "reaction",
                "where": {"kind": "plane", "point": [0, 0, 0], "normal": [0, 0, -1]},
            },
        ],
        "output": {"every": 1.0, "table_every": 1.0},
    }
)

# Problems with the surface (holes, facets that cross, thin parts) would be among the warnings of the plan.

plan = case.check()
print(plan.bodies[0]["particles"], "particles; warnings:", plan.warnings or "none")
assert not any("pillar.stl" in warning for warning in plan.warnings)

simulation = case.start()
run = simulation.run()

# The mass is that of the surface in the file, whose numbers have seven digits, and the ground carries its weight.

weight = DENSITY * GRAVITY * HEIGHT * 1.5 * np.sqrt(3) * RADIUS**2
_, ground = run.tables.curve("ground.reaction.z")
print(f"weight {weight:.3f} N, the ground carries {ground[-1]:.3f} N")
assert abs(ground[-1] / weight - 1) < 1e-6

# The shortening is of second order in the spacing over the height, 1/20.

shortening = DENSITY * GRAVITY * HEIGHT**2 / (2 * YOUNG)
_, top = run.tables.curve("top.displacement.z")
print(f"shorter by {-1e3 * top[-1]:.4f} mm, by theory {1e3 * shortening:.4f} mm")
assert abs(-top[-1] / shortening - 1) < 1 / 20**2

# Fields are NumPy arrays. The stress is off by less than the weight of one layer of particles.

height = simulation.bodies["pillar"]["position"][:, 2]
stress = simulation.bodies["pillar"]["stress"][:, 2, 2]
exact = -DENSITY * GRAVITY * (HEIGHT - height)
print(f"stress off by {np.abs(stress - exact).max():.0f} Pa at most, of {DENSITY * GRAVITY * HEIGHT:.0f} Pa")
assert np.abs(stress - exact).max() < DENSITY * GRAVITY * 0.05

# ![The pillar, and its stress over the height](surface.svg)
