# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on quality: default options on true poses, and a dome against a flat port."""

import math

import refined
from points import BASE, densified, millimetres, point, truth_of
from support import runs

# At most and at least: mean distance [mm] and F-score, which the points once reached with other
# schedules of matching. A run takes seconds from them only with a better result.
LIMITS = {"closeup air": (0.179, 0.8455), "closeup water": (0.149, 0.8931),
          "reef air": (1.318, 0.8389), "reef water": (0.727, 0.8641),
          "closeup-7 air": (0.181, 0.8892), "closeup-7 water": (0.147, 0.9047)}


def at_defaults(work, truth, medium):
    """Quality and cost of a run with default options."""
    folder = work / f"{truth.name}-defaults-{medium}"
    cost = densified(folder, truth.data / "sparse", truth.data / medium, truth.housing(medium))
    return runs.evaluate(folder, truth, medium), cost


def judged(work, truths):
    """The text and the verdict of scenes in air and in water."""
    texts, good = [], True
    for truth in truths:
        for medium in ("air", "water"):
            now, cost = at_defaults(work, truth, medium)
            mean, f = LIMITS[f"{truth.name} {medium}"]
            texts.append(f"{truth.name} {medium}: {millimetres(now)}, {cost['cpu']:.1f} CPU-s")
            good &= now["mean"] * 1e3 <= mean and now["f"] >= f
    return "; ".join(texts), good


WANTED = f"default options, true poses: mean distance [mm] and F no worse than {LIMITS}"


@point(WANTED)
def quality(work):
    return judged(work, [truth_of(scene) for scene in ("closeup", "reef")])


@point(WANTED + "; another seed at 2048 x 1536")
def quality_third(work):
    return judged(work, [runs.simulated("closeup-7", BASE, "--preset", "closeup", "--seed", 7, "--width",
                                        2048, "--height", 1536)])


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
    (flat, flat_cost), (dome, dome_cost) = (at_defaults(work, truth, "water")
                                            for truth in (truth_of("reef"), dome_scene()))
    return (f"flat port {millimetres(flat)}, {flat_cost['cpu']:.1f} CPU-s; dome {millimetres(dome)}, "
            f"{dome_cost['cpu']:.1f} CPU-s",
            dome["mean"] <= 1.1 * flat["mean"] and dome["f"] >= flat["f"] - 0.02)
