# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts of lines through labelled points, as self-contained SVG."""

import dataclasses
import html
import math

WIDTH, HEIGHT = 860, 520
LEFT, RIGHT, TOP, BOTTOM = 76, 210, 48, 60
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#000000")
STYLE = """
text { font: 13px system-ui, sans-serif; fill: #333 }
.title { font-size: 16px; font-weight: 600 }
.grid { stroke: #e3e3e3 } .axis { stroke: #888 }
"""


@dataclasses.dataclass(frozen=True)
class Point:
    x: float
    y: float
    label: str


@dataclasses.dataclass(frozen=True)
class Axis:
    """Maps values in [low, high] to drawing coordinates in [begin, end]."""
    low: float
    high: float
    begin: float
    end: float
    logarithmic: bool = False

    def at(self, value):
        scale = math.log if self.logarithmic else float
        low, high = scale(self.low), scale(self.high)
        return self.begin + (scale(value) - low) / (high - low) * (self.end - self.begin)

    def ticks(self):
        if self.logarithmic:
            ticks = [m * 10**e for e in range(-6, 7) for m in (1, 2, 5)
                     if self.low <= m * 10**e <= self.high]
            if len(ticks) >= 3:
                return ticks
        step = nice_step((self.high - self.low) / 5)
        first = math.ceil(self.low / step)
        return [i * step for i in range(first, math.floor(self.high / step) + 1)]


def nice_step(rough):
    power = 10 ** math.floor(math.log10(rough))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= rough)


def axis_around(values, begin, end, logarithmic=False):
    low, high = min(values), max(values)
    if logarithmic:
        return Axis(low / 1.3, high * 1.3, begin, end, True)
    margin = 0.1 * (high - low) or 0.1
    return Axis(low - margin, high + margin, begin, end)


def text(x, y, content, anchor="start", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{html.escape(content)}</text>'


def line(x1, y1, x2, y2, kind):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{kind}"/>'


def frame(x_axis, y_axis, title, x_title, y_title):
    bottom, right = HEIGHT - BOTTOM, WIDTH - RIGHT
    parts = [text(LEFT, 28, title, extra='class="title"'),
             text((LEFT + right) / 2, HEIGHT - 14, x_title, "middle"),
             text(0, 0, y_title, "middle",
                  f'transform="translate(20 {(TOP + bottom) / 2}) rotate(-90)"')]
    for tick in x_axis.ticks():
        parts += [line(x_axis.at(tick), TOP, x_axis.at(tick), bottom, "grid"),
                  text(x_axis.at(tick), bottom + 20, f"{tick:g}", "middle")]
    for tick in y_axis.ticks():
        parts += [line(LEFT, y_axis.at(tick), right, y_axis.at(tick), "grid"),
                  text(LEFT - 8, y_axis.at(tick) + 4, f"{tick:.4g}", "end")]
    return parts + [line(LEFT, bottom, right, bottom, "axis"), line(LEFT, TOP, LEFT, bottom, "axis")]


def series(points, color, x_axis, y_axis, marked):
    places = [(x_axis.at(p.x), y_axis.at(p.y)) for p in points]
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    parts = [f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.5"/>']
    for point, (x, y) in zip(points, places):
        tip = html.escape(f"{point.label}: {point.x:.4g}, {point.y:.4g}")
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{color}">'
                     f'<title>{tip}</title></circle>')
        if (point.x, point.y) != (marked.x, marked.y):
            parts.append(text(x + 6, y - 6, point.label, extra=f'style="fill:{color}"'))
    return parts


def mark(point, name, x_axis, y_axis):
    x, y = x_axis.at(point.x), y_axis.at(point.y)
    return [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="8" fill="none" stroke="#000" stroke-width="2"/>',
            text(x, y + 24, name, "middle", 'font-weight="600"')]


def legend(names):
    parts = []
    for i, (name, color) in enumerate(zip(names, COLORS)):
        y = TOP + 12 + 22 * i
        parts += [f'<rect x="{WIDTH - RIGHT + 18}" y="{y - 10}" width="12" height="12" fill="{color}"/>',
                  text(WIDTH - RIGHT + 36, y, name)]
    return parts


def chart(groups, marked, title, x_title, y_title):
    """The SVG of a chart. `groups`: {name: [Point, ...]}. `marked`: the Point of the default, which
    all groups share. The x axis is logarithmic."""
    points = [point for group in groups.values() for point in group]
    x_axis = axis_around([p.x for p in points], LEFT, WIDTH - RIGHT, logarithmic=True)
    y_axis = axis_around([p.y for p in points], HEIGHT - BOTTOM, TOP)
    parts = frame(x_axis, y_axis, title, x_title, y_title) + legend(groups)
    for color, group in zip(COLORS, groups.values()):
        parts += series(group, color, x_axis, y_axis, marked)
    parts += mark(marked, "default", x_axis, y_axis)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
            f'width="{WIDTH}" height="{HEIGHT}">\n<style>{STYLE}</style>\n'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")
