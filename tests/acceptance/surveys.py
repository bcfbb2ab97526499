# SPDX-License-Identifier: GPL-3.0-or-later
"""The point on two surveys of a reef under water between which a known change happened."""

import json
import re

from points import BASE, meshed, point
from support import runs
from support.runs import BIN, measured

# The rules of CompareSurveys were chosen with the seeds 41, 42 and 43. In the reef of seed 46, the
# views see no boulder that could move.
SEEDS = (44, 45, 47)
VOLUME, FALSE = 5, 1  # at most [%]


def survey(work, seed, *options):
    """The folder of a survey with scene_dense.mvs and mesh.ply, and the folder of its truth."""
    name = f"reef-{seed}-survey" + ("-changed" if options else "")
    truth = runs.simulated(name, BASE, "--preset", "reef", "--seed", seed, "--medium", "water",
                           "--truth", 0, *options)
    meshed(work / name, truth, "water", 1)
    return work / name, truth.data


def compared(before, after, seed, align):
    """The report of CompareSurveys, and the numbers that change_check.cpp prints."""
    change = after / f"change-{align}"
    measured(after / f"{change.name}.log", BIN / "CompareSurveys", "-i", before / "mesh.ply",
             "--other", after / "mesh.ply", "--scene", before / "scene_dense.mvs", "--other-scene",
             after / "scene_dense.mvs", "-o", change, "--up", "0,0,1", "--align", align)
    checked = after / f"{change.name}.check.log"
    measured(checked, BIN / "change_check", seed, change)
    said = checked.read_text()
    volumes = re.search(r"volumes: came (\S+) gone (\S+) others: came (\S+) gone (\S+)", said)
    areas = re.search(r"compared (\S+) changed (\S+) false (\S+)", said)
    return (json.loads(change.with_suffix(".change.json").read_text()),
            [float(v) for v in volumes.groups()], [float(v) for v in areas.groups()])


def largest_in_patch(report, patch):
    """The volume of the largest region that came in the patch."""
    half = 0.5 * patch["width"], 0.5 * patch["length"]
    return max((region["volume"] for region in report["regions"] if region["change"] == "came"
                and abs(region["x"] - patch["x"]) < half[0]
                and abs(region["y"] - patch["y"]) < half[1]), default=0)


def judged(work, seed, align):
    """The deviations of a comparison as text, and whether they are small enough."""
    before, _ = survey(work, seed)
    after, data = survey(work, seed, "--changed")
    truth = json.loads((data / "change.json").read_text())
    report, (came, gone, hidden_came, hidden_gone), (area, changed, wrong) = compared(
        before, after, seed, align)
    patch = truth["patch_came"]
    deviations = {"came": report["came"]["volume"] / came - 1,
                  "gone": report["gone"]["volume"] / gone - 1,
                  "net": report["net"]["volume"] / (came - gone) - 1,
                  "patch": largest_in_patch(report, patch) / patch["volume"] - 1}
    deviations = {name: 100 * value for name, value in deviations.items()}
    false = 100 * wrong / (area - changed)
    text = ", ".join(f"{name} {value:+.1f} %" for name, value in deviations.items())
    hidden = 100 * hidden_came / truth["came"], 100 * hidden_gone / truth["gone"]
    whole = [100 * (report[kind]["volume"] / truth[kind] - 1) for kind in ("came", "gone")]
    return (f"{seed} {align}: {text}; of the whole truth: came {whole[0]:+.1f} %, gone {whole[1]:+.1f} %, "
            f"of which {hidden[0]:.1f} and {hidden[1]:.1f} % were not compared; "
            f"false {false:.2f} % of {area - changed:.1f} m2",
            max(map(abs, deviations.values())) <= VOLUME and false <= FALSE)


@point(f"a boulder moved and 1 m2 grew by 20 mm, seeds {SEEDS}: volumes that came and went, net and "
       f"of the patch within {VOLUME} % of the truth at the places that are compared; false change "
       f"at most {FALSE} % of the area that did not change")
def survey_change(work):
    results = [judged(work, seed, align) for seed in SEEDS for align in ("none", "icp")]
    return "; ".join(text for text, _ in results), all(good for _, good in results)
