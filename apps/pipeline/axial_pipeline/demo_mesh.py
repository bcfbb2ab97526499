# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of the demo: from a run's cloud to a textured mesh, its numbers, and their table."""

import json
import time

from . import files
from .running import shown

LEFT_OUT = "0005.jpg"  # the view that is left out of texturing, and rendered


def make_mesh(demo, run, housing=None):
    """Turns the cloud of `run` into a refined and textured mesh. Writes the time of the three
    programs to the file `mesh-seconds`."""
    programs, folder = demo.programs, demo.work / run
    scene, mesh, refined = (folder / name for name in
                            ("scene_dense.mvs", "mesh.ply", "mesh_refined.ply"))
    refractive = ["--refractive"] if housing else []
    photographs = sorted((demo.data / demo.media[run]).glob("*.jpg"))
    files.write(folder / "textured-views.txt",
                "".join(f"{path.name}\n" for path in photographs if path.name != LEFT_OUT))
    begin = time.monotonic()
    shown(programs.reconstruct_mesh(scene, mesh, *refractive))
    shown(programs.refine_mesh(scene, mesh, refined, *refractive))
    shown(programs.texture_mesh(scene, refined, folder / "textured", "--export-type", "ply,glb",
                                "--views-file", folder / "textured-views.txt", *refractive))
    files.write(folder / "mesh-seconds", f"{time.monotonic() - begin:.1f}\n")


def evaluate_mesh(demo, run, tolerance, *more):
    """Compares the textured mesh of `run` with the true mesh and with the photograph that was left
    out. Writes mesh.json and two pictures."""
    folder = demo.work / run
    shown(demo.programs.evaluate(
        folder / "textured.ply", demo.truth / "mesh.ply", "--cameras", demo.data / "sparse",
        "--tolerance", tolerance, "--json", folder / "mesh.json", "--render", LEFT_OUT,
        "--photographs", demo.data / demo.media[run], "--render-folder", folder / "rendered",
        "--render-type", "jpg", *more))


def numbers(folder):
    result = json.loads((folder / "mesh.json").read_text())
    score = result["seen"]["scores"][0]
    return {"folder": folder, "vertices": result["topology"]["vertices"],
            "median_m": result["seen"]["accuracy"]["median"], "tolerance_m": score["tolerance"],
            "precision": score["precision"], "recall": score["recall"], "f_score": score["f_score"],
            "normals_within_10": result["seen"]["normals"]["within_10_20_30"][0],
            "psnr_db": result["render"]["psnr"],
            "seconds": float((folder / "mesh-seconds").read_text())}


def load(rows, runs):
    """`rows`: of the clouds (demo_table.load). Returns a row for the mesh of each of `runs`."""
    return [{**{key: row[key] for key in ("run", "title", "mark", "color")}, **numbers(row["folder"])}
            for row in rows if row["run"] in runs]


def cells(row):
    return [f"{row['mark']} {row['title']}", f"{row['vertices']:,}", f"{row['median_m'] * 1e3:.2f}",
            f"{row['precision']:.3f}", f"{row['recall']:.3f}", f"{row['f_score']:.3f}",
            f"{100 * row['normals_within_10']:.0f} %", f"{row['psnr_db']:.1f}",
            f"{row['seconds']:.0f}"]


def headings(rows):
    return ["mesh", "vertices", "median [mm]", "precision", "completeness",
            f"F-score at {rows[0]['tolerance_m'] * 1e3:g} mm", "normals to 10 deg", "PSNR [dB]",
            "seconds"]


def table(rows):
    return [headings(rows), *map(cells, rows)]


KEPT = ("run", "vertices", "median_m", "tolerance_m", "precision", "recall", "f_score",
        "normals_within_10", "psnr_db", "seconds")


def kept(rows):
    """The numbers of the rows for table.json."""
    return [{key: row[key] for key in KEPT} for row in rows]
