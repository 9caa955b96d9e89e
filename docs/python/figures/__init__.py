"""The figure of each worked example, from the variables that its script leaves behind."""

import numpy as np

from .drawing import BLUE, BOTH_SIGNS, GREY, RED, UPWARDS, Panel, colour_bar, line, particles, svg, text


def sorted_by(keys, *columns):
    order = np.argsort(keys, kind="stable")
    return [np.asarray(column)[order] for column in columns]


def cantilever(scope):
    """The beam with displacements large enough to be seen, coloured by the stress along it."""
    beam = scope["simulation"].bodies["beam"]
    moved = beam["displacement"]
    reference = beam["position"] - moved
    stress = beam["stress"][:, 0, 0] / 1e3
    limit = 60.0
    steps = np.round(stress, 3)
    scale, magnified = 72.0, 300.0
    shown = reference + magnified * moved
    places = np.stack([50 + scale * shown[:, 0], 70 - scale * shown[:, 1]], axis=1)
    places, stress = sorted_by(steps, places, stress)
    bar = colour_bar((60, 165, 260, 179), "stress along the beam, kPa", (-limit, limit), BOTH_SIGNS)
    clamp = line([(46, 22), (46, 118)], GREY, width=6)
    return svg(800, 210, [clamp, *particles(places, stress, (-limit, limit), BOTH_SIGNS, 4.6), *bar])


def convergence(scope):
    """Errors over numbers of cells, with the slope of second order."""
    counts, errors = scope["counts"], 100 * scope["errors"]
    panel = Panel((90, 20, 620, 300), ("cells along the bar", [10, 20, 40, 80, 160, 320]),
                  ("largest error of the tip, %", [0.001, 0.01, 0.1, 1]), logarithmic=True)
    ends = np.array([17, 190])
    slope = panel.curve(ends, errors[0] * (counts[0] / ends) ** 2, GREY)
    entries = [("piola", BLUE, True), ("second order", GREY, False)]
    return svg(640, 360, [*panel.axes(), slope, panel.points(counts, errors, BLUE), *panel.legend(entries, 470, 50)])


def dam_break(scope):
    """The water at the end, coloured by its speed, in its tank, with the gauge."""
    bodies = scope["simulation"].bodies
    water, tank = bodies["water"], bodies["tank"]
    scale = 150.0

    def pixels(places):
        return np.stack([70 + scale * places[:, 0], 300 - scale * places[:, 1]], axis=1)

    speed = np.linalg.norm(water["velocity"], axis=1)
    places, speed = sorted_by(speed, pixels(water["position"]), speed)
    wall = pixels(tank["position"])
    wall = wall[wall[:, 1] > 60]
    limits = (0.0, 7.0)
    walls = particles(wall, np.zeros(len(wall)), (-1, 1), [(154, 163, 173)] * 3, 9)
    gauge = line([pixels(np.array([[1.5, height]]))[0] for height in (0, 1.5)], RED, ' stroke-dasharray="6 4"')
    label = text(70 + scale * 1.5 + 8, 300 - scale * 1.5 + 10, "gauge", "start")
    bar = colour_bar((440, 50, 640, 64), "speed, m/s", limits, UPWARDS)
    return svg(740, 360, [*walls, *particles(places, speed, limits, UPWARDS, 11), gauge, label, *bar])


def fit(scope):
    """What was measured, and what is computed with the constants found."""
    stretch, values, measured = scope["stretch"], scope["values"], scope["measured"]
    parts = []
    panels = [
        ("force, kN", [0, 200, 400, 600, 800], slice(0, 10), 80),
        ("narrowing, mm", [0, 20, 40, 60, 80], slice(10, 20), 460),
    ]
    for name, ticks, rows, left in panels:
        panel = Panel((left, 20, left + 270, 280), ("stretch", [1, 1.1, 1.2, 1.3]), (name, ticks))
        parts += panel.axes()
        parts.append(panel.curve([1, *stretch], [0, *values[rows]], BLUE))
        parts.append(panel.points(stretch, measured[rows], RED))
        parts += panel.legend([("measured", RED, True), ("computed", BLUE, False)], left + 20, 45)
    return svg(760, 340, parts)


def surface(scope):
    """The pillar, coloured by its stress, beside the stress over the height."""
    pillar = scope["simulation"].bodies["pillar"]
    x, y, z = pillar["position"].T
    stress = pillar["stress"][:, 2, 2] / 1e3
    limits = (-10.0, 0.0)
    # Those on the faces hide the others: three pairs of sides, and the top.
    out = np.radians([30, 90, 150])
    from_axis = np.abs(np.outer(x, np.cos(out)) + np.outer(y, np.sin(out))).max(axis=1)
    is_outside = (from_axis > from_axis.max() - 0.01) | (z > z.max() - 0.01)
    scale, turn = 250.0, np.radians(20)
    across, depth = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
    places = np.stack([120 + scale * across, 290 - scale * (z + 0.3 * depth)], axis=1)
    # What is behind is drawn first.
    order = np.lexsort([np.round(z, 3), -np.round(depth, 3)])
    order = order[is_outside[order]]
    picture = particles(places[order], stress[order], limits, UPWARDS, 12, rim=0.7)
    panel = Panel((310, 20, 640, 290), ("stress, kPa", [-10, -8, -6, -4, -2, 0]),
                  ("height, m", [0, 0.2, 0.4, 0.6, 0.8, 1]))
    seen = np.unique(np.stack([np.round(stress, 1), np.round(z, 3)], axis=1), axis=0)
    exact = panel.curve([-10, 0], [0, 1], GREY)
    entries = [("particles", BLUE, True), ("exact", GREY, False)]
    return svg(680, 350, [*picture, *panel.axes(), panel.points(*seen.T, BLUE), exact, *panel.legend(entries, 330, 50)])


ALL = {figure.__name__: figure for figure in (cantilever, convergence, dam_break, fit, surface)}
