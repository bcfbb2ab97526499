# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstructs point clouds of a simulated scene in three ways, turns two of them into textured
meshes and maps, and measures clouds and meshes against ground truth. apps/pipeline/demo.sh runs this module
after the build, in the root of the source."""

import argparse

from . import demo_page, demo_table, files, truth
from .demo_runs import LEFT_OUT, OUT, Demo
from .failure import run_main

MESHES = ("air", "refractive")  # the runs whose clouds become meshes


def options():
    parser = argparse.ArgumentParser(prog="demo.sh", description=__doc__.split("\n\n")[0])
    parser.add_argument("scene", nargs="?", choices=("closeup", "reef"), default="closeup")
    parser.add_argument("--full", action="store_const", const="full", default="half", dest="size",
                        help="full resolution; without it, images are halved in width and height")
    parser.add_argument("--seconds", type=int, default=0, help=argparse.SUPPRESS)  # spent before
    return parser.parse_args()


def reconstruct_three_ways(demo):
    """Returns the folder of the poses in air, which (a) and (b) share."""
    demo.stage("Poses from the photographs in air (COLMAP, true intrinsics)")
    poses = demo.poses("poses", "air", truth.true_lens(demo.data))
    demo.stage("Poses without a port: COLMAP calibrates a lens from the photographs under water")
    poses_today = demo.poses("poses-today", "water", truth.self_calibrated_lens(demo.data))
    demo.stage("(a) In air")
    demo.reconstruct("air", poses)
    demo.stage("(b) Under water, refractive, same poses")
    demo.reconstruct("refractive", poses)
    demo.stage("(c) Under water, self-calibrated lens, no refraction")
    demo.reconstruct("selfcalibrated", poses_today)
    return poses


def make_meshes(demo):
    demo.stage("(a) Mesh, refined and textured, in air")
    demo.make_mesh("air")
    demo.stage("(b) Mesh, refined and textured, under water, refractive")
    demo.make_mesh("refractive")


def make_surveys(demo):
    demo.stage("Maps of (a) and (b), what changed between them, and the page of (b)")
    for run in MESHES:
        demo.make_map(run)
    demo.compare(*MESHES)
    if demo.programs.has_page():
        demo.make_page("refractive")


def evaluate_all(demo, poses):
    demo.stage("Comparison with the ground truth")
    for run in ("air", "refractive", "selfcalibrated"):
        demo.evaluate(run, "evaluation")
        demo.keep(run, "scene_dense.ply", f"{run}.ply")
    demo.evaluate("selfcalibrated", "evaluation-moved", "--align", "icp")
    with open(demo.work / "depth.log", "w") as log:
        for run in MESHES:
            demo.evaluate_mesh(run)
            demo.depth_pictures(run, poses, log)
            demo.keep(run, "textured.glb", f"{run}.glb")


def write_results(demo):
    rows = demo_table.load(demo.work)
    lines = [*rows, demo_table.load_best_fit(demo.work)]
    meshes = demo_table.load_meshes(rows, MESHES)
    files.write(OUT / "table.json", demo_table.json_table(lines, meshes, demo.scene, demo.size))
    files.write(OUT / "report.html", demo_page.page(
        rows, lines, meshes, demo.photographs("refractive") / LEFT_OUT, demo_page.survey("refractive", OUT),
        scene=demo.scene, description=demo_table.SCENES[demo.scene], size=demo.size))
    print(demo_table.text_table(demo_table.of_clouds(lines)))
    print("\n" + demo_table.text_table(demo_table.of_meshes(meshes)))


def run(demo):
    demo.work.mkdir(parents=True, exist_ok=True)
    demo.stage(f"Ground truth of the scene '{demo.scene}', simulated again from its seed")
    truth.make_truth(demo.programs, demo.scene, demo.truth)
    poses = reconstruct_three_ways(demo)
    make_meshes(demo)
    make_surveys(demo)
    evaluate_all(demo, poses)
    demo.stage(f"Done: {OUT}/{{air,refractive,selfcalibrated}}.ply, {OUT}/{{air,refractive}}.glb, "
               f"{OUT}/{{air,refractive}}_map.*, {OUT}/surveys.change.*, {OUT}/refractive_page/index.html, "
               f"{OUT}/table.json, {OUT}/report.html")
    write_results(demo)


if __name__ == "__main__":
    run_main("error", lambda: run(Demo(**vars(options()))), "stopped; another run keeps COLMAP's models")
