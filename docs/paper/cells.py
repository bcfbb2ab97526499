# SPDX-License-Identifier: GPL-3.0-or-later
"""Markdown tables, and their cells from the numbers of a result. Lengths in results are in metres."""

import math


def table(rows):
    """The table with these rows of cells. The first row is the header."""
    lines = ["| " + " | ".join(row) + " |\n" for row in rows]
    lines.insert(1, "|---" * len(rows[0]) + "|\n")
    return "".join(lines)


def significant(value, digits=3):
    """The number rounded to `digits` significant digits, without an exponent: "0.267", "24600"."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    rounded = math.copysign(math.floor(abs(value) / unit + 0.5) * unit, value)
    # Rounding may have added a digit: 9.996 became 10.00.
    decimals = digits - 1 - math.floor(math.log10(abs(rounded * (1 + 1e-12))))
    return f"{rounded:.{max(0, decimals)}f}"


def millimetres(metres):
    return "-" if metres is None else significant(1e3 * metres)


def percent(fraction):
    return "-" if fraction is None else f"{100 * fraction:.1f}"


def verdicts(*rows):
    """A table of requirements: (what is asked, what is seen, whether it is met)."""
    return table([("asked", "seen", "met")] + [(asked, seen, "yes" if met else "no")
                                               for asked, seen, met in rows])


def results_of(results, part):
    return results["parts"][part]["result"]
