# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstructs point clouds of a simulated scene in three ways, turns two of them into textured
meshes and maps, and measures clouds and meshes against ground truth. apps/pipeline/demo.sh runs this module
after the build, in the root of the source."""

import argparse
import pathlib
import shutil
import time

from . import colmap, demo_mesh, demo_page, demo_survey, demo_table, files, truth
from .colmap_model import colmap_model
from .failure import run_main
from .programs import Programs
from .running import shown

OUT = pathlib.Path("build/demo")
TOLERANCES = {"closeup": 0.002, "reef": 0.005}  # of F-scores [m]
RESOLUTION = {"half": ("--resolution-level", 1, "--min-resolution", 320),
              "full": ("--resolution-level", 0)}
PICTURED_VIEWS = ("0000", "0005")  # whose depth maps are drawn
MESHES = ("air", "refractive")  # the runs whose clouds become meshes


def options():
    parser = argparse.ArgumentParser(prog="demo.sh", description=__doc__.split("\n\n")[0])
    parser.add_argument("scene", nargs="?", choices=("closeup", "reef"), default="closeup")
    parser.add_argument("--full", action="store_const", const="full", default="half", dest="size",
                        help="full resolution; without it, images are halved in width and height")
    parser.add_argument("--seconds", type=int, default=0, help=argparse.SUPPRESS)  # spent before
    return parser.parse_args()


class Demo:
    def __init__(self, given):
        self.scene, self.size = given.scene, given.size
        self.started = time.monotonic() - given.seconds
        self.programs = Programs("build/release/bin")
        self.data = pathlib.Path("data/synthetic") / self.scene
        self.work = OUT / "work" / self.scene
        self.truth = self.work / "truth"
        self.media = {"air": "air", "refractive": "water", "selfcalibrated": "water"}

    def stage(self, text):
        """Prints the headline of a stage, with the time since the start."""
        minutes, seconds = divmod(int(time.monotonic() - self.started), 60)
        print(f"\n[{minutes:02}:{seconds:02}] {text}", flush=True)

    def poses(self, name, medium, calibration):
        """COLMAP's model of the photographs of `medium`, in metres. COLMAP's own model is kept for
        another run, because COLMAP gives a different model in each run."""
        colmap_model(self.data / medium, self.work / name, calibration)
        return truth.align_to_truth(self.programs, self.work / name, self.data)

    def reconstruct(self, run, poses, housing=None):
        """Reconstructs the photographs of `run` from scratch. Writes the time of DensifyPointCloud
        to the file `seconds`."""
        folder = self.work / run
        files.clear(folder)
        shown(self.programs.import_scene(poses, self.data / self.media[run], folder / "scene.mvs",
                                         housing))
        begin = time.monotonic()
        refractive = ["--refractive"] if housing else []
        shown(self.programs.densify("scene.mvs", folder, *RESOLUTION[self.size], *refractive))
        (folder / "seconds").write_text(f"{time.monotonic() - begin:.1f}\n")

    def evaluate(self, run, name, *more):
        """Compares the cloud with the true mesh. Writes `name`.json, the cloud coloured by its error
        (`name`.ply) and a picture of it (`name`.png)."""
        result = self.work / run / name
        shown(self.programs.evaluate(
            self.work / run / "scene_dense.ply", self.truth / "mesh.ply", "--cameras",
            self.data / "sparse", "--tolerance", TOLERANCES[self.scene], "--json", f"{result}.json",
            "--error-cloud", f"{result}.ply", "--picture", f"{result}.png", "--picture-width", 900,
            *more))

    def depth_pictures(self, run, poses, log):
        """Draws two depth maps beside the truth."""
        for view in PICTURED_VIEWS:
            depth_map = depth_map_of(poses, f"{view}.jpg")
            if depth_map:
                folder = self.work / run
                shown(self.programs.evaluate(
                    folder / depth_map, self.truth / self.media[run] / f"{view}.distance.tiff", "--tolerance",
                    TOLERANCES[self.scene], "--picture", folder / f"depth-{view}.png"), output=log)


def depth_map_of(model, name):
    """The name of an image's depth map, which has COLMAP's image id minus one. None if the COLMAP model does not
    have the image."""
    number = colmap.images_in(model).get(name)
    return None if number is None else f"depth{number - 1:04}.dmap"


def reconstruct_three_ways(demo):
    """Returns the folder of the poses in air, which (a) and (b) share."""
    demo.stage("Poses from the photographs in air (COLMAP, true intrinsics)")
    poses = demo.poses("poses", "air", truth.true_lens(demo.data))
    demo.stage("Poses without a port: COLMAP calibrates a lens from the photographs under water")
    poses_today = demo.poses("poses-today", "water", truth.self_calibrated_lens(demo.data))
    demo.stage("(a) In air")
    demo.reconstruct("air", poses)
    demo.stage("(b) Under water, refractive, same poses")
    demo.reconstruct("refractive", poses, demo.data / "housing.json")
    demo.stage("(c) Under water, self-calibrated lens, no refraction")
    demo.reconstruct("selfcalibrated", poses_today)
    return poses


def make_meshes(demo):
    demo.stage("(a) Mesh, refined and textured, in air")
    demo_mesh.make_mesh(demo, "air")
    demo.stage("(b) Mesh, refined and textured, under water, refractive")
    demo_mesh.make_mesh(demo, "refractive", demo.data / "housing.json")


def make_surveys(demo):
    demo.stage("Maps of (a) and (b), what changed between them, and the page of (b)")
    housing = demo.data / "housing.json"
    demo_survey.make_map(demo, "air", OUT)
    demo_survey.make_map(demo, "refractive", OUT, housing)
    demo_survey.compare(demo, "air", "refractive", OUT)
    if demo.programs.has_page():
        demo_survey.make_page(demo, "refractive", OUT, housing)


def evaluate_all(demo, poses):
    demo.stage("Comparison with the ground truth")
    wet = ("--housing", demo.data / "housing.json")
    demo.evaluate("air", "evaluation")
    demo.evaluate("refractive", "evaluation", *wet)
    demo.evaluate("selfcalibrated", "evaluation", *wet)
    demo.evaluate("selfcalibrated", "evaluation-moved", *wet, "--align", "icp")
    demo_mesh.evaluate_mesh(demo, "air", TOLERANCES[demo.scene])
    demo_mesh.evaluate_mesh(demo, "refractive", TOLERANCES[demo.scene], *wet)
    with open(demo.work / "depth.log", "w") as log:
        demo.depth_pictures("air", poses, log)
        demo.depth_pictures("refractive", poses, log)
    for run in ("air", "refractive", "selfcalibrated"):
        shutil.copy(demo.work / run / "scene_dense.ply", OUT / f"{run}.ply")
    for run in MESHES:
        shutil.copy(demo.work / run / "textured.glb", OUT / f"{run}.glb")


def write_results(demo):
    rows = demo_table.load(demo.work)
    lines = [*rows, demo_table.load_best_fit(demo.work)]
    meshes = demo_mesh.load(rows, MESHES)
    files.write(OUT / "table.json", demo_table.json_table(lines, demo_mesh.kept(meshes), demo.scene,
                                                          demo.size))
    files.write(OUT / "report.html", demo_page.page(
        rows, lines, meshes, demo.data / demo.media["refractive"] / demo_mesh.LEFT_OUT,
        demo_survey.section("refractive", OUT),
        scene=demo.scene, description=demo_table.SCENES[demo.scene], size=demo.size))
    print(demo_table.text_table(demo_table.table(lines)))
    print("\n" + demo_table.text_table(demo_mesh.table(meshes)))


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
    run_main("error", lambda: run(Demo(options())), "stopped; another run keeps COLMAP's models")
