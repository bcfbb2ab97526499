# SPDX-License-Identifier: GPL-3.0-or-later
"""The programs of the demo: from photographs to clouds, textured meshes, maps, a comparison and a page, and what
they are measured with."""

import pathlib
import shutil
import time

from . import colmap, files, truth
from .colmap_model import colmap_model
from .programs import Programs
from .running import shown

OUT = pathlib.Path("build/demo")
TOLERANCES = {"closeup": 0.002, "reef": 0.005}  # of F-scores [m]
RESOLUTION = {"half": ("--resolution-level", 1, "--min-resolution", 320),
              "full": ("--resolution-level", 0)}
PICTURED_VIEWS = ("0000", "0005")  # whose depth maps are drawn
LEFT_OUT = "0005.jpg"  # the view that is left out of texturing, and rendered
MEDIA = {"air": "air", "refractive": "water", "selfcalibrated": "water"}  # of the photographs of each run
UP = ("--up", "0,0,1")  # in the simulated world
CHANGE = "surveys"  # begin of the names of the files of the comparison


def depth_map_of(model, name):
    """The name of an image's depth map, which has COLMAP's image id minus one. None if the COLMAP model does not
    have the image."""
    number = colmap.images_in(model).get(name)
    return None if number is None else f"depth{number - 1:04}.dmap"


class Demo:
    def __init__(self, scene, size, seconds):
        """`seconds`: spent before."""
        self.scene, self.size = scene, size
        self.started = time.monotonic() - seconds
        self.programs = Programs("build/release/bin")
        self.data = pathlib.Path("data/synthetic") / scene
        self.work = OUT / "work" / scene
        self.truth = self.work / "truth"

    def stage(self, text):
        """Prints the headline of a stage, with the time since the start."""
        minutes, seconds = divmod(int(time.monotonic() - self.started), 60)
        print(f"\n[{minutes:02}:{seconds:02}] {text}", flush=True)

    def photographs(self, run):
        return self.data / MEDIA[run]

    def refractive(self, run):
        """The option of programs that compute with the port, which "selfcalibrated" does without."""
        return ["--refractive"] if run == "refractive" else []

    def seen_through(self, run):
        """The options of EvaluateReconstruction for the true cameras of the photographs of `run`."""
        port = ["--housing", self.data / "housing.json"] if MEDIA[run] == "water" else []
        return ["--cameras", self.data / "sparse", "--tolerance", TOLERANCES[self.scene], *port]

    def poses(self, name, medium, calibration):
        """COLMAP's model of the photographs of `medium`, in metres. COLMAP's own model is kept for
        another run, because COLMAP gives a different model in each run."""
        colmap_model(self.data / medium, self.work / name, calibration)
        return truth.align_to_truth(self.programs, self.work / name, self.data)

    def reconstruct(self, run, poses):
        """Reconstructs the photographs of `run` from scratch. Writes the time of DensifyPointCloud
        to the file `seconds`."""
        folder, refractive = self.work / run, self.refractive(run)
        files.clear(folder)
        shown(self.programs.import_scene(poses, self.photographs(run), folder / "scene.mvs",
                                         self.data / "housing.json" if refractive else None))
        begin = time.monotonic()
        shown(self.programs.densify("scene.mvs", folder, *RESOLUTION[self.size], *refractive))
        (folder / "seconds").write_text(f"{time.monotonic() - begin:.1f}\n")

    def make_mesh(self, run):
        """Turns the cloud of `run` into a refined and textured mesh. Writes the time of the three
        programs to the file `mesh-seconds`."""
        folder, refractive = self.work / run, self.refractive(run)
        scene, mesh, refined = (folder / name for name in ("scene_dense.mvs", "mesh.ply", "mesh_refined.ply"))
        files.write_names(folder / "textured-views.txt", sorted(
            path.name for path in self.photographs(run).glob("*.jpg") if path.name != LEFT_OUT))
        begin = time.monotonic()
        shown(self.programs.reconstruct_mesh(scene, mesh, *refractive))
        shown(self.programs.refine_mesh(scene, mesh, refined, *refractive))
        shown(self.programs.texture_mesh(scene, refined, folder / "textured", "--export-type", "ply,glb",
                                         "--views-file", folder / "textured-views.txt", *refractive))
        files.write(folder / "mesh-seconds", f"{time.monotonic() - begin:.1f}\n")

    def make_map(self, run):
        folder = self.work / run
        shown(self.programs.map_surface(folder / "scene_dense.mvs", folder / "textured.ply", OUT / f"{run}_map",
                                        *self.refractive(run), *UP))

    def compare(self, before, after):
        """Compares the meshes of two runs, whose ground is the same."""
        meshes = (self.work / run / "mesh_refined.ply" for run in (before, after))
        shown(self.programs.compare_surveys(*meshes, OUT / CHANGE, *UP))

    def make_page(self, run):
        """Writes the page of `run`, with the maps and the comparison."""
        work, page = self.work / run, OUT / f"{run}_page"
        files.clear(page)
        shown(self.programs.view_scene(work / "scene_dense.mvs", work / "scene_dense.ply", work / "textured.glb", page,
                                       "--map", OUT / f"{run}_map", "--change", OUT / CHANGE, "--truth",
                                       self.truth / "mesh.ply", *self.refractive(run)))

    def evaluate(self, run, name, *more):
        """Compares the cloud with the true mesh. Writes `name`.json, the cloud coloured by its error
        (`name`.ply) and a picture of it (`name`.png)."""
        result = self.work / run / name
        shown(self.programs.evaluate(
            self.work / run / "scene_dense.ply", self.truth / "mesh.ply", *self.seen_through(run), "--json",
            f"{result}.json", "--error-cloud", f"{result}.ply", "--picture", f"{result}.png", "--picture-width", 900,
            *more))

    def evaluate_mesh(self, run):
        """Compares the textured mesh of `run` with the true mesh and with the photograph that was left
        out. Writes mesh.json and two pictures."""
        folder = self.work / run
        shown(self.programs.evaluate(
            folder / "textured.ply", self.truth / "mesh.ply", *self.seen_through(run), "--json", folder / "mesh.json",
            "--render", LEFT_OUT, "--photographs", self.photographs(run), "--render-folder", folder / "rendered",
            "--render-type", "jpg"))

    def depth_pictures(self, run, poses, log):
        """Draws two depth maps beside the truth."""
        for view in PICTURED_VIEWS:
            depth_map = depth_map_of(poses, f"{view}.jpg")
            if depth_map:
                folder = self.work / run
                shown(self.programs.evaluate(
                    folder / depth_map, self.truth / MEDIA[run] / f"{view}.distance.tiff", "--tolerance",
                    TOLERANCES[self.scene], "--picture", folder / f"depth-{view}.png"), output=log)

    def keep(self, run, name, kept):
        """Copies a result of `run` to the folder of results."""
        shutil.copy(self.work / run / name, OUT / kept)
