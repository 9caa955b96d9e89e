"""Charts and particles as SVG, a few kilobytes each."""

import math
from xml.sax.saxutils import escape

BLUE, RED, GREY = "#1f5fa8", "#c23b22", "#9aa3ad"
# Low, middle and high values: all of them for fields of both signs, two of them for others.
BOTH_SIGNS = [(33, 81, 158), (222, 222, 222), (190, 45, 30)]
UPWARDS = [(33, 60, 130), (40, 160, 150), (250, 215, 70)]
SHADES = 24


def number(value):
    """A coordinate, to a tenth of a pixel."""
    text = f"{value:.1f}"
    return "0" if float(text) == 0 else text.removesuffix(".0")


def tick_label(value):
    return f"{value:g}".replace("-", "\u2212")


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{number(x)}" y="{number(y)}" text-anchor="{anchor}"{more}>{escape(words)}</text>'


def line(points, colour, more="", width=2):
    path = " ".join(f"{number(x)},{number(y)}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"{more}/>'


def svg(width, height, parts):
    """The parts on white ground, which dark themes need."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
    font = ' font-family="sans-serif" font-size="14" fill="#222222"'
    ground = f'<rect width="{width}" height="{height}" fill="white"/>'
    return "\n".join([f"{head}{font}>", ground, *parts, "</svg>"]) + "\n"


class Panel:
    """Axes in a rectangle of the figure, from (left, top) to (right, bottom), linear or logarithmic."""

    def __init__(self, box, x, y, logarithmic=False):
        """x and y: the name of the axis, and the places of its ticks, of which the outer ones are its ends."""
        self.left, self.top, self.right, self.bottom = box
        self.scale = math.log if logarithmic else float
        (self.x_name, self.x_ticks), (self.y_name, self.y_ticks) = x, y

    def at(self, x, y):
        def share(value, ticks):
            low, high = self.scale(ticks[0]), self.scale(ticks[-1])
            return (self.scale(value) - low) / (high - low)

        across, up = share(x, self.x_ticks), share(y, self.y_ticks)
        return self.left + across * (self.right - self.left), self.bottom - up * (self.bottom - self.top)

    def axes(self):
        parts = []
        for tick in self.x_ticks:
            x, _ = self.at(tick, self.y_ticks[0])
            parts.append(line([(x, self.top), (x, self.bottom)], "#e3e6e9", width=1))
            parts.append(text(x, self.bottom + 20, tick_label(tick)))
        for tick in self.y_ticks:
            _, y = self.at(self.x_ticks[0], tick)
            parts.append(line([(self.left, y), (self.right, y)], "#e3e6e9", width=1))
            parts.append(text(self.left - 8, y + 5, tick_label(tick), "end"))
        middle = (self.top + self.bottom) / 2
        turned = f' transform="rotate(-90 {number(self.left - 56)} {number(middle)})"'
        parts.append(text((self.left + self.right) / 2, self.bottom + 44, self.x_name))
        parts.append(text(self.left - 56, middle, self.y_name, more=turned))
        return parts

    def curve(self, xs, ys, colour, more=""):
        return line([self.at(x, y) for x, y in zip(xs, ys)], colour, more)

    def points(self, xs, ys, colour):
        places = (self.at(x, y) for x, y in zip(xs, ys))
        rings = (f'<circle cx="{number(x)}" cy="{number(y)}" r="4"/>' for x, y in places)
        return f'<g fill="white" stroke="{colour}" stroke-width="2">{"".join(rings)}</g>'

    def legend(self, entries, x, y):
        """Entries of a name, a colour and whether they are points, from the place (x, y) of the figure downwards."""
        parts = []
        for index, (name, colour, is_points) in enumerate(entries):
            height = y + 22 * index
            if is_points:
                parts.append(
                    f'<circle cx="{x + 14}" cy="{height - 5}" r="4" fill="white" stroke="{colour}" stroke-width="2"/>'
                )
            else:
                parts.append(line([(x, height - 5), (x + 28, height - 5)], colour))
            parts.append(text(x + 36, height, name, "start"))
        return parts


def shade(share, colours):
    """The colour at a share from 0 to 1 of a row of three."""
    place = 2 * min(max(share, 0.0), 1.0)
    first = min(int(place), 1)
    mixed = (a + (b - a) * (place - first) for a, b in zip(colours[first], colours[first + 1]))
    return "#" + "".join(f"{round(part):02x}" for part in mixed)


def particles(places, values, limits, colours, size, rim=0):
    """Discs in the order of `places`, which are in pixels, coloured by their values in `SHADES` shades. With a rim they
    stand out from those behind them."""
    low, high = limits
    parts = []
    last = None
    for (x, y), value in zip(places, values):
        # Values that differ by rounding only have the same shade.
        share = round((value - low) / (high - low), 6)
        step = min(max(int(share * SHADES), 0), SHADES - 1)
        if step != last:
            parts.append([shade((step + 0.5) / SHADES, colours), []])
            last = step
        parts[-1][1].append(f"M{number(x)} {number(y)}h0")
    paths = []
    for colour, moves in parts:
        path = "".join(moves)
        if rim:
            paths.append(f'<path d="{path}" stroke="#2b2b2b" stroke-width="{number(size + 2 * rim)}"/>')
        paths.append(f'<path d="{path}" stroke="{colour}"/>')
    return [f'<g fill="none" stroke-linecap="round" stroke-width="{number(size)}">', *paths, "</g>"]


def colour_bar(box, name, limits, colours):
    """A bar with its limits, and its name above."""
    left, top, right, bottom = box
    width = (right - left) / SHADES
    parts = [
        f'<rect x="{number(left + index * width)}" y="{number(top)}" width="{number(width + 0.5)}" '
        f'height="{number(bottom - top)}" fill="{shade((index + 0.5) / SHADES, colours)}"/>'
        for index in range(SHADES)
    ]
    low, high = map(tick_label, limits)
    ends = [text(left, bottom + 18, low, "start"), text(right, bottom + 18, high, "end")]
    return [*parts, *ends, text((left + right) / 2, top - 8, name)]
