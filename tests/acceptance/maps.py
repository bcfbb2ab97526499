# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the maps of MapSurface, of a reef photographed through a port."""

import re

from meshes import judged
from points import BASE, densified, point
from support import runs
from support.runs import BIN, PROGRAMS, measured

SEED = 41
HEIGHTS, PSNR, DISPLACEMENT = 1.2, 28, 0.5  # at most, of the mesh's RMS; [dB] at least; [px] at most
CAP = 1000  # [MB]


def reef(work):
    """The folder of a reef with scene_dense.mvs and mesh.ply, and its truth."""
    truth = runs.simulated(f"reef-{SEED}", BASE, "--preset", "reef", "--views", 10, "--seed", SEED,
                           tolerance=runs.TOLERANCES["reef"])
    folder = work / f"reef-{SEED}-water-maps"
    densified(folder, truth.data / "sparse", truth.data / "water", truth.housing("water"),
              "--resolution-level", 1)
    if not (folder / "mesh.ply").exists():
        measured(folder / "mesh.log", *PROGRAMS.reconstruct_mesh(
            folder / "scene_dense.mvs", folder / "mesh.ply", "--refractive"))
    return folder, truth


def mapped(folder, name, *options):
    """Makes the map `name` of a reef. Returns the cost, and the size of the map [px]."""
    log = folder / f"{name}.log"
    cost = measured(log, *PROGRAMS.map_surface(folder / "scene_dense.mvs", folder / "mesh.ply",
                                               folder / name, "--refractive", "--up", "0,0,1", *options))
    return cost, tuple(map(int, re.search(r"map of (\d+) x (\d+) pixels", log.read_text()).groups()))


@point(f"RMS of the heights at most {HEIGHTS} times that of the mesh where views see it; PSNR of the "
       f"orthomosaic at least {PSNR} dB, its displacement at most {DISPLACEMENT} px")
def map_quality(work):
    folder, truth = reef(work)
    cost, size = mapped(folder, "map")
    checked = folder / "check.log"
    measured(checked, BIN / "map_check", "reef", SEED, 1, folder / "map")
    said = checked.read_text()
    number = lambda pattern: float(re.search(pattern, said)[1])
    heights, psnr, displacement = (number(pattern) for pattern in (
        r"distances: RMS (\S+)", r"PSNR (\S+)", r"displacement: RMS (\S+)"))
    mesh = 1000 * judged(folder, "mesh", truth, "water")["seen"]["accuracy"]["rms"]
    return (f"{size[0]} x {size[1]} pixels; heights {heights:.2f} mm RMS, mesh {mesh:.2f} mm; PSNR "
            f"{psnr:.1f} dB; displacement {displacement:.2f} px; {cost['cpu']:.0f} CPU-s, "
            f"{cost['memory'] / 1e6:.0f} MB",
            heights <= HEIGHTS * mesh and psnr >= PSNR and displacement <= DISPLACEMENT)


@point(f"a map of 900 million pixels with --max-memory {CAP}: at most 10 % above the cap")
def map_memory_cap(work):
    folder, _ = reef(work)
    cost, size = mapped(folder, "large", "--gsd", 0.00014, "--max-memory", CAP)
    for file in folder.glob("large.*"):
        if file.suffix != ".log":
            file.unlink()
    peak = cost["memory"] / 1e6
    return (f"{size[0]} x {size[1]} pixels: {peak:.0f} MB, {cost['wall']:.0f} s",
            size[0] * size[1] > 8e8 and peak <= 1.1 * CAP)
