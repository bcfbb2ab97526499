# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on memory, on a survey with 0.3 megapixels per view."""

import hashlib
import subprocess

from points import BASE, densified, point
from support import runs
from support.runs import BIN


def survey_run(work, views, *options):
    """Densifies the first `views` views of the survey. Returns the folder, which is different for
    other options, and the cost."""
    model, images = runs.survey(views, BASE)
    folder = work / "-".join(["survey", str(views), *map(str, options[1::2])])
    return folder, densified(folder, model, images, None, *runs.ONE_SWEEP, *options)


@point("peak memory at 200 views of 0.3 MP at most 1.3 times that at 50")
def memory_growth(work):
    peaks, seen = {}, []
    for views in (50, 200):
        _, cost = survey_run(work, views)
        peaks[views] = cost["memory"]
        seen.append(f"{views} views: {cost['memory'] / 1e6:.0f} MB, {cost['cpu']:.0f} CPU-s, "
                    f"{cost['points']:,} points")
    ratio = peaks[200] / peaks[50]
    return "; ".join(seen) + f"; ratio {ratio:.2f}", ratio <= 1.3


def results_of(folder):
    """Hashes of the cloud and of the depth maps by file name."""
    files = [folder / "scene_dense.ply", *sorted(folder.glob("depth????.dmap"))]
    def fingerprint(file):
        with open(file, "rb") as content:
            return hashlib.file_digest(content, "sha1").hexdigest()

    return {file.name: fingerprint(file) for file in files}


@point("200 views with --max-memory 512 and 1000: the same bytes, at most 10 % above the cap; below "
       "the minimum one line and exit 1")
def memory_cap(work):
    free, cost = survey_run(work, 200)
    expected, seen, good = results_of(free), [f"no cap: {cost['memory'] / 1e6:.0f} MB"], True
    for cap in (512, 1000):
        folder, cost = survey_run(work, 200, "--max-memory", cap)
        same, peak = results_of(folder) == expected, cost["memory"] / 1e6
        good &= same and len(expected) == 201 and peak <= 1.1 * cap
        seen.append(f"{cap}: {peak:.0f} MB, {cost['cpu']:.0f} CPU-s, "
                    f"{'same' if same else 'OTHER'} bytes")
    refused = subprocess.run([BIN / "DensifyPointCloud", "-i", "scene.mvs", "-w", free,
                              "--max-memory", "30"], capture_output=True, text=True)
    good &= refused.returncode == 1 and refused.stderr.count("\n") == 1
    return "; ".join([*seen, f"30: exit {refused.returncode}, {refused.stderr.strip()}"]), good
