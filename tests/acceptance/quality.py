# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on quality: default options against earlier results, and a dome against a flat port."""

import math

import refined
from points import BASE, densified, millimetres, point, truth_of
from support import runs


def third_scene():
    return runs.simulated("closeup-7", BASE, "--preset", "closeup", "--seed", 7, "--width", 2048,
                          "--height", 1536)


# Mean distance [mm] and F-score of the matcher before it was made faster, with default options and
# true poses. That matcher is no longer in the source, and only these digits were kept.
BEFORE = {"closeup air": (0.178, 0.8456), "closeup water": (0.148, 0.8932),
          "reef air": (1.317, 0.8390), "reef water": (0.726, 0.8642),
          "closeup-7 air": (0.180, 0.8893), "closeup-7 water": (0.146, 0.9048)}

# One unit of the last digit: rounding changed the figures above by up to half a unit, so that
# smaller differences cannot be detected.
TOLERANCE = (0.001, 0.0001)


def no_worse(before, now):
    return now["mean"] * 1e3 <= before[0] + TOLERANCE[0] and now["f"] >= before[1] - TOLERANCE[1]


def quality_at_defaults(work, truth, medium):
    """Quality and cost of a run with default options, with the quality in BEFORE, as text; and
    whether the quality is no worse."""
    name, folder = f"{truth.name} {medium}", work / f"{truth.name}-defaults-{medium}"
    cost = densified(folder, truth.data / "sparse", truth.data / medium, truth.housing(medium))
    now, before = runs.evaluate(folder, truth, medium), BEFORE[name]
    seen = (f"{name}: mean {now['mean'] * 1e3:.4f} mm ({before[0]:.3f}), F {now['f']:.5f} "
            f"({before[1]:.4f}), {now['points']:,} points, {cost['cpu']:.1f} CPU-s")
    return seen, no_worse(before, now)


def all_no_worse(results):
    return "; ".join(seen for seen, _ in results), all(good for _, good in results)


QUALITY_WANTED = ("default options, true poses: mean distance and F no worse than before matching was "
                  "made faster (in brackets), within the digits kept")


@point(QUALITY_WANTED)
def quality(work):
    return all_no_worse([quality_at_defaults(work, truth_of(scene), medium)
                         for scene in ("closeup", "reef") for medium in ("air", "water")])


@point(QUALITY_WANTED + "; another seed at 2048 x 1536")
def quality_third(work):
    return all_no_worse([quality_at_defaults(work, third_scene(), medium)
                         for medium in ("air", "water")])


def dome_scene():
    """The reef behind a dome that is decentred by 5 mm. The field of view is what the flat port
    leaves of the reef's 80 degrees."""
    field = math.degrees(2 * math.asin(math.sin(math.radians(40)) / 1.333))
    return runs.simulated("reef-dome-as-flat", BASE, "--preset", "reef", "--medium", "water",
                          "--truth", 0, "--fov-degrees", round(field, 2), *refined.SCENES["reef-dome"],
                          tolerance=runs.TOLERANCES["reef"])


@point("a decentred dome, same field of view, true poses: mean at most 1.1 times the flat port's, F at "
       "most 0.02 lower")
def dome_as_flat(work):
    results, costs = [], []
    for truth in (truth_of("reef"), dome_scene()):
        folder = work / f"{truth.name}-defaults-water"
        costs.append(densified(folder, truth.data / "sparse", truth.data / "water",
                               truth.housing("water"))["cpu"])
        results.append(runs.evaluate(folder, truth, "water"))
    flat, dome = results
    seen = "; ".join(f"{name} {millimetres(result)}, {cpu:.1f} CPU-s" for name, result, cpu
                     in zip(("flat port", "dome"), results, costs))
    return seen, dome["mean"] <= 1.1 * flat["mean"] and dome["f"] >= flat["f"] - 0.02
