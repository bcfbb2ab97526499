# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on memory, on surveys with 0.3 megapixels per view, or 0.08 for the mesh programs."""

import hashlib
import re
import subprocess

from points import BASE, densified, point
from support import runs
from support.runs import BIN, PROGRAMS, measured


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


def fingerprint(file):
    with open(file, "rb") as content:
        return hashlib.file_digest(content, "sha1").hexdigest()


def results_of(folder):
    """Hashes of the cloud and of the depth maps by file name."""
    files = [folder / "scene_dense.ply", *sorted(folder.glob("depth????.dmap"))]
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


def files_of(result):
    """Hashes of a mesh file and of its textures by file name."""
    return {file.name: fingerprint(file) for file in sorted(result.parent.glob(f"{result.stem}*"))
            if file.suffix in (".ply", ".png", ".jpg")}


def capped(command, result, cap, expected):
    """Runs a mesh program with --max-memory. Returns what was seen, and whether it is good: a peak
    of at most the cap and 10 % with the files `expected`, or a refusal."""
    for name in expected:
        (result.parent / name).unlink(missing_ok=True)
    command = [*map(str, command), "--max-memory", str(cap)]
    try:
        cost = measured(result.with_suffix(".log"), *command)
    except RuntimeError:
        refused = subprocess.run(command, capture_output=True, text=True)
        clear = re.fullmatch(r"\w+: (--max-memory: .* needs (at least )?\d+ MB( more)?)\n",
                             refused.stderr)
        good = refused.returncode == 1 and clear is not None and not result.exists()
        return f"exit {refused.returncode}, {refused.stderr.strip()}", good
    peak, same = cost["memory"] / 1e6, files_of(result) == expected
    return (f"{peak:.0f} MB, {cost['wall']:.0f} s, {'same' if same else 'OTHER'} bytes",
            same and peak <= 1.1 * cap)


@point("meshes of 100 views of 320 x 240 with --max-memory: the same bytes, at most 10 % above the "
       "cap, or one line with the memory needed and exit 1")
def mesh_memory_cap(work):
    data = runs.simulated("survey-320", BASE, "--preset", "survey", "--views", 100, "--width", 320,
                          "--height", 240, "--samples", 1, "--truth", 0, "--medium", "air").data
    folder = work / "survey-320"
    densified(folder, data / "sparse", data / "air", None, *runs.ONE_SWEEP)
    scene, free = folder / "scene_dense.mvs", folder / "free"
    mesh, refined, textured = (free / f"{name}.ply" for name in ("mesh", "refined", "textured"))
    programs = {"ReconstructMesh": (mesh, lambda out: PROGRAMS.reconstruct_mesh(scene, out)),
                "RefineMesh": (refined, lambda out: PROGRAMS.refine_mesh(scene, mesh, out)),
                "TextureMesh": (textured, lambda out: PROGRAMS.texture_mesh(scene, refined, out))}
    seen, all_good = [], True
    for name, (result, command) in programs.items():
        cost = measured(result.with_suffix(".log"), *command(result))
        rows = [(name, "none", f"{cost['memory'] / 1e6:.0f} MB, {cost['wall']:.0f} s")]
        for cap in (40, 100, 130, 200, 300):
            limited = folder / "capped" / result.name
            row, good = capped(command(limited), limited, cap, files_of(result))
            good &= cap < 300 or not row.startswith("exit")  # the largest cap is enough for all
            rows.append((name, cap, row if good else f"{row} BAD"))
            all_good &= good
        print("\n".join(f"| {' | '.join(map(str, row))} |" for row in rows), flush=True)
        seen.append(f"{name}: " + ", ".join(f"{cap}: {row}" for _, cap, row in rows))
    return "; ".join(seen), all_good
