#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two builds of the programs write the same bytes.

    python3 tests/acceptance/same_bytes.py [--work DIR] [--real] BEFORE AFTER

BEFORE and AFTER are folders of programs. Both make the whole chain of two small scenes in air and under
water: with one and two threads, in tiles, in parts, textured in all formats, with maps, page, comparison and
refined poses. With --real also the cloud and the mesh of the fountain. The script lists the files that differ,
and the files that only one of the builds wrote. Exit code 1 if there are any. `reconstruct` is not compared,
because the results of COLMAP differ from run to run."""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import runs  # noqa: E402

SIZE = ("--truth", 0, "--width", 480, "--height", 360, "--views", 6, "--coarseness", 2, "--samples", 2)
SEED = {"closeup": 3, "reef": 4}
PLACED = ("--mesh-file", "refined.ply", "--transform-file", "transform.txt")


def chain(data, water):
    """The commands of one scene, in order. A word that begins with @ is a file of the scene."""
    port = ("--housing", "@housing.json") if water else ()
    wet = ("--refractive",) if water else ()
    truth = ("-m", "@mesh.ply", "--cameras", "@sparse", *port, "--min-views", 2)
    scene = ("-i", "scene_dense.mvs")
    densify = ("DensifyPointCloud", *wet, "--resolution-level", 0, "-i")
    refined = (*scene, "-m", "refined.ply", *wet)
    yield "InterfaceCOLMAP", "-i", "@sparse", "--image-folder", f"@{'water' if water else 'air'}", *port, "-o", \
        "scene.mvs"
    yield *densify, "scene.mvs", "-o", "scene_dense.mvs", "--estimate-uncertainty", 1, "--max-threads", 1
    yield *densify, "../scene.mvs", "-w", "two", "--max-threads", 2
    for part in (1, 2):
        yield *densify, "../scene.mvs", "-w", "parts", "--until", "photometric", "--part", f"{part}/2"
    yield *densify, "../scene.mvs", "-w", "parts"
    yield *densify, "scene.mvs", "-o", "tiles_dense.mvs", "--fusion-mode", -1, "--fusion-tiles", 3
    if water:
        yield *densify, "../scene.mvs", "-w", "pinholes", "--pinhole-export", "pinholes"
    for threads in (1, 2):
        yield "ReconstructMesh", *scene, "-o", f"mesh{threads}.ply", *wet, "--max-threads", threads
        yield "RefineMesh", *scene, "-m", "mesh1.ply", "-o", f"refined{threads}.ply", *wet, "--scales", 2, \
            "--max-threads", threads
    yield "ReconstructMesh", *scene, "-o", "mesh-tiles.ply", *wet, "--tiles", 2
    yield "RefineMesh", *scene, "-m", "mesh1.ply", "-o", "refined.ply", *wet, "--scales", 1
    for kind in ("ply", "obj", "glb"):
        yield "TextureMesh", *refined, "-o", f"textured-{kind}", "--export-type", kind
    yield "TextureMesh", *refined, "-o", "textured-tiles", "--tiles", 2
    yield "MapSurface", *refined, "-o", "map"
    yield "EvaluateReconstruction", "-i", "refined.ply", *truth, "--json", "mesh.json"
    yield "EvaluateReconstruction", "-i", "scene_dense.ply", *truth, "--json", "cloud.json"
    yield "ViewScene", *scene, "-p", "scene_dense.ply", "-m", "textured-glb.glb", "--report", "page"
    if water:
        yield "RefinePoses", "@sparse", "-o", "poses", *port, "--lens", "@sparse/cameras.txt"
    yield "TransformScene", *scene, "-p", "scene_dense.ply", *PLACED, "-o", "moved.mvs"
    yield "TransformScene", "-i", "moved.ply", "-o", "moved.las", "--epsg", 32617


def run(programs, folder, data, command):
    """Runs a command in `folder`. A failure is written into its log, which is compared, too."""
    name, *words = [str(word).replace("@", f"{data}/") if str(word).startswith("@") else str(word) for word in command]
    ended = subprocess.run([programs / name, *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                           text=True)
    if ended.returncode != 0:
        print(f"{folder.name}: {name} {' '.join(words)}: {ended.stderr.strip()}", flush=True)
    with open(folder / "failures.txt", "a") as failures:
        failures.write(f"{name}: {ended.returncode} {ended.stderr}")


def scenes(programs, work, data_of):
    for name, data in data_of.items():
        for medium in ("air", "water"):
            folder = work / f"{name}-{medium}"
            for part in ("two", "parts", "pinholes"):
                (folder / part).mkdir(parents=True)
            (folder / "transform.txt").write_text("0 -1 0 10  1 0 0 20  0 0 1 30  0 0 0 1\n")
            for command in chain(data, medium == "water"):
                run(programs, folder, data, command)
        run(programs, work / f"{name}-water", data,
            ("CompareSurveys", "-i", f"../{name}-air/refined.ply", "--other", "refined.ply", "--scene",
             f"../{name}-air/scene_dense.mvs", "--other-scene", "scene_dense.mvs", "-o", "change", "--align", "icp"))


def fountain(programs, work):
    folder = work / "fountain"
    folder.mkdir(parents=True)
    data = runs.shared("fountain-P11")
    for command in (("InterfaceCOLMAP", "-i", "@sparse", "--image-folder", "@images", "-o", "scene.mvs"),
                    ("DensifyPointCloud", "-i", "scene.mvs", "--resolution-level", 2),
                    ("ReconstructMesh", "-i", "scene_dense.mvs", "-o", "mesh.ply")):
        run(programs, folder, data, command)


# Bytes that tell when, where and by which version a file was written.
TOLD = re.compile(rb'"(seconds|cpu_seconds|memory|version|made|commit|begun|ended)"[^,}\n]*|AxialMVS [\w.+-]+'
                  rb'|\w+ [\d.]+, commit \w+|"data/scene\.js": "\w+"')


def content(file, work):
    return TOLD.sub(b"", file.read_bytes().replace(str(work).encode(), b""))


def differences(before, after):
    """What differs, a line each. Logs and locks are not compared."""
    def files(work):
        return {str(file.relative_to(work)) for file in work.rglob("*")
                if file.is_file() and file.suffix not in (".log", ".lock") and "logs" not in file.parts}
    old, new = files(before), files(after)
    yield from (f"{name}: only one build writes it" for name in sorted(old ^ new))
    yield from (f"{name}: differs" for name in sorted(old & new)
                if content(before / name, before) != content(after / name, after))


def main():
    parser = argparse.ArgumentParser(description="Compares the bytes that two builds write.")
    parser.add_argument("--work", type=pathlib.Path, default=runs.ROOT / "build" / "same-bytes")
    parser.add_argument("--real", action="store_true", help="also the fountain")
    parser.add_argument("programs", type=pathlib.Path, nargs=2, metavar="PROGRAMS")
    given = parser.parse_args()
    data_of = {name: runs.simulated(f"same-bytes-{name}", given.work, "--preset", name, "--seed", seed, *SIZE).data
               for name, seed in SEED.items()}
    works = [given.work.resolve() / name for name in ("before", "after")]
    for programs, work in zip(given.programs, works):
        if work.name == "before" and work.exists():
            continue
        shutil.rmtree(work, ignore_errors=True)
        scenes(programs.resolve(), work, data_of)
        if given.real:
            fountain(programs.resolve(), work)
    lines = list(differences(*works))
    print("\n".join(lines) or "all files have the same bytes")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
