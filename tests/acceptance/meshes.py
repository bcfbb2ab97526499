# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on meshes: from clouds of three scenes of each kind, with other seeds than those of the
scenes in git, to refined and textured meshes."""

import json
import statistics

from points import BASE, densified, kept, point_of_each_scene
from support import runs
from support.runs import PROGRAMS, measured

SEEDS = (41, 42, 43)
VIEWS = {"closeup": 12, "reef": 10}
LEFT_OUT = "0005.jpg"  # of texturing

# In air: medians [m] and F-scores of the reconstructed and of the refined mesh.
WANTED = {"closeup": ((0.45e-3, 0.76), (0.35e-3, 0.80)), "reef": ((1.5e-3, 0.82), (1.1e-3, 0.86))}
CPU = {"reconstruct": 15, "refine": 60, "texture": 15}  # [s], for closeup
MEGABYTES = {"reconstruct": 450, "refine": 450, "texture": 300}
WATER, REFINED, PSNR = 0.85, 0.85, 28  # ratios of medians at most; [dB] at least


def made(folder, truth, medium):
    """Makes the meshes of a scene in `folder`. Returns the costs of the programs."""
    refractive = ["--refractive"] if truth.housing(medium) else []
    densified(folder, truth.data / "sparse", truth.data / medium, truth.housing(medium),
              "--resolution-level", 0)
    names = sorted(path.name for path in (truth.data / medium).glob("*.jpg"))
    (folder / "textured-views.txt").write_text(
        "".join(f"{name}\n" for name in names if name != LEFT_OUT))
    scene, mesh, refined = (folder / name
                            for name in ("scene_dense.mvs", "mesh.ply", "refined.ply"))
    commands = {
        "reconstruct": PROGRAMS.reconstruct_mesh(scene, mesh, *refractive),
        "refine": PROGRAMS.refine_mesh(scene, mesh, refined, *refractive),
        "texture": PROGRAMS.texture_mesh(scene, refined, folder / "textured", "--views-file",
                                         folder / "textured-views.txt", *refractive)}
    return {name: measured(folder / f"{name}.log", *command) for name, command in commands.items()}


def judged(folder, name, truth, medium, *more):
    """Compares a mesh with the truth, where at least two views see the surface. Returns the whole
    report."""
    housing = truth.housing(medium)
    report = folder / f"{name}.json"
    measured(folder / f"evaluate-{name}.log", *PROGRAMS.evaluate(
        folder / f"{name}.ply", truth.mesh, "--cameras", truth.data / "sparse", "--min-views", 2,
        "--tolerance", truth.tolerance, "--samples", 300000, "--json", report,
        *(["--housing", housing] if housing else []), *more))
    return json.loads(report.read_text())


SOUND = ("non_manifold_edges", "non_manifold_vertices", "inconsistent_edges", "self_intersecting_faces")


def result(work, scene, seed, medium):
    """The costs and the quality of the meshes of one scene in one medium."""
    folder = work / f"{scene}-{seed}-{medium}-meshes"
    return kept(folder / "meshes.json", lambda: measured_meshes(folder, scene, seed, medium))


def measured_meshes(folder, scene, seed, medium):
    truth = runs.simulated(f"{scene}-{seed}", BASE, "--preset", scene, "--views", VIEWS[scene],
                           "--seed", seed, tolerance=runs.TOLERANCES[scene])
    found = {"cost": made(folder, truth, medium)}
    reports = {name: judged(folder, name, truth, medium) for name in ("mesh", "refined")}
    for name, report in reports.items():
        found[name] = {"median": report["seen"]["accuracy"]["median"],
                       "median_of_all": report["accuracy"]["median"],
                       "f": report["seen"]["scores"][0]["f_score"],
                       "f_of_all": report["scores"][0]["f_score"],
                       "sound": all(report["topology"][key] == 0 for key in SOUND)}
    render = judged(folder, "textured", truth, medium, "--render", LEFT_OUT, "--photographs",
                    truth.data / medium, "--render-folder", folder / "rendered")["render"]
    found["psnr"], found["grey_levels"] = render["psnr"], render["mean_difference"]
    return found


def middle(results, *keys):
    def value(entry):
        for key in keys:
            entry = entry[key]
        return entry
    return statistics.median(map(value, results))


def described(results):
    parts = []
    for name in ("mesh", "refined"):
        median, f, median_all, f_all = (middle(results, name, key) for key in
                                        ("median", "f", "median_of_all", "f_of_all"))
        parts.append(f"{name} {median * 1e3:.3f} mm F {f:.4f} (all of it {median_all * 1e3:.3f} mm "
                     f"F {f_all:.4f})")
    costs = ", ".join(f"{name} {middle(results, 'cost', name, 'cpu'):.1f} CPU-s "
                      f"{middle(results, 'cost', name, 'memory') / 1e6:.0f} MB" for name in CPU)
    return (f"{'; '.join(parts)}; PSNR {middle(results, 'psnr'):.1f} dB, "
            f"{middle(results, 'grey_levels'):.1f} grey levels; {costs}")


def good_in_air(scene, results):
    for name, (median, f) in zip(("mesh", "refined"), WANTED[scene]):
        if middle(results, name, "median") > median or middle(results, name, "f") < f:
            return False
    slow = scene == "closeup" and any(
        middle(results, "cost", name, "cpu") > limit for name, limit in CPU.items())
    large = any(middle(results, "cost", name, "memory") > limit * 1e6
                for name, limit in MEGABYTES.items())
    return not slow and not large


def good_in_water(air, water):
    for name in ("mesh", "refined"):
        if middle(water, name, "median") > WATER * middle(air, name, "median"):
            return False
        if middle(water, name, "f") < middle(air, name, "f"):
            return False
    return middle(water, "refined", "median") <= REFINED * middle(water, "mesh", "median")


@point_of_each_scene(
    "medians of three seeds: in air the errors, times and memory of meshes.py; behind "
    f"the port errors at most {WATER} times those in air, F no lower, and refining improves the "
    f"median by 15 %; PSNR of a view left out at least {PSNR} dB; sound meshes")
def meshes(work, scene):
    air, water = ([result(work, scene, seed, medium) for seed in SEEDS]
                  for medium in ("air", "water"))
    good = good_in_air(scene, air) and good_in_water(air, water)
    good &= all(r["psnr"] >= PSNR and r["mesh"]["sound"] and r["refined"]["sound"] for r in air + water)
    return f"air: {described(air)}. Water: {described(water)}", good
