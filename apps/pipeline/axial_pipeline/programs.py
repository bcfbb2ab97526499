# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of AxialMVS's programs, as lists of words, and the versions of programs."""

import pathlib
import shlex

from .failure import Failure
from .running import answer_of

NAMES = ("RefinePoses", "InterfaceCOLMAP", "DensifyPointCloud", "ReconstructMesh", "RefineMesh", "RestoreColors",
         "TextureMesh", "MapSurface", "CompareSurveys", "ViewScene")  # of the programs that every run may need
# How a program is asked for its version, which is the first line that it prints.
QUESTIONS = {"colmap": "help", **dict.fromkeys((*NAMES, "EvaluateReconstruction"), "--version")}
MOST_SECONDS = 20
PACKAGE = pathlib.Path(__file__).resolve().parent


def default_folder(script_folder):
    """The folder of the programs: that of the script if they are installed beside it, otherwise
    that of the release build."""
    if (script_folder / "DensifyPointCloud").exists():
        return script_folder
    return PACKAGE.parents[2] / "build" / "release" / "bin"


def words_of(name, given):
    """The words in the value of the option --`name`, which are options for a program."""
    value = getattr(given, name.replace("-", "_"))
    try:
        return shlex.split(value)
    except ValueError as error:
        raise Failure(f"--{name} {value}: {error}") from None


def require(folder, names):
    """Fails if one of the programs is not in the `folder` of --programs."""
    for name in names:
        if not (pathlib.Path(folder) / name).is_file():
            raise Failure(f"--programs {folder}: {name} not found; build the programs first")


def version_of(command):
    """The line by which the program of `command` states its version; None if it states none."""
    program = str(command[0])
    question = QUESTIONS.get(pathlib.Path(program).name)
    if question is None:
        return None
    said = answer_of([program, question], MOST_SECONDS)
    lines = said.stdout.strip().splitlines()
    return lines[0].strip() if said.returncode == 0 and lines else None


class Programs:
    """The programs in one folder. Every method returns a command. `options` are words that the
    command gets in addition."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def extract_frames(self, clips, folder, file, *options):
        """Frames of videos as photographs in `folder`; `file`: what is known about them."""
        return [self.folder / "ExtractFrames", *(word for clip in clips for word in ("-i", clip)), "-o", folder,
                "--json", file, *options]

    def import_scene(self, model, images, scene, housing=None):
        """A COLMAP model and its photographs to the scene file `scene`."""
        port = ["--housing", housing] if housing else []
        return [self.folder / "InterfaceCOLMAP", "-i", model, "--image-folder", images, *port, "-o",
                scene]

    def colmap_masks(self, images, masks, folder, label):
        """The masks of photographs as COLMAP wants them, in `folder`. `label`: of masked pixels."""
        return [self.folder / "InterfaceCOLMAP", "-i", images, "--mask-path", masks,
                "--ignore-mask-label", label, "-o", folder]

    def effective_lens(self, lens, housing, file):
        """The lens in air behind its port to one lens for COLMAP, `file`."""
        return [self.folder / "RefinePoses", "--effective-lens", file, "--lens", lens, "--housing", housing]

    def find_targets(self, images, file, *options):
        return [self.folder / "FindTargets", "-i", images, "-o", file, *options]

    def densify(self, scene, folder, *options):
        """`scene` to depth maps and a dense cloud in `folder`."""
        return [self.folder / "DensifyPointCloud", "-i", scene, "-w", folder, *options]

    def reconstruct_mesh(self, scene, mesh, *options):
        """The cloud beside `scene` to the mesh file `mesh`."""
        return [self.folder / "ReconstructMesh", "-i", scene, "-o", mesh, *options]

    def refine_mesh(self, scene, mesh, refined, *options):
        return [self.folder / "RefineMesh", "-i", scene, "-m", mesh, "-o", refined, *options]

    def restore_colors(self, scene, mesh, folder, *options):
        """The photographs of `scene` without water in `folder`."""
        return [self.folder / "RestoreColors", "-i", scene, "-m", mesh, "-o", folder, *options]

    def texture_mesh(self, scene, mesh, textured, *options):
        """`textured`: without extension; see --export-type."""
        return [self.folder / "TextureMesh", "-i", scene, "-m", mesh, "-o", textured, *options]

    def map_surface(self, scene, mesh, output, *options):
        """`output`: the begin of the names of the maps."""
        return [self.folder / "MapSurface", "-i", scene, "-m", mesh, "-o", output, *options]

    def compare_surveys(self, before, after, output, *options):
        """`before`, `after`: meshes. `output`: the begin of the names of the results."""
        return [self.folder / "CompareSurveys", "-i", before, "--other", after, "-o", output, *options]

    def view_scene(self, scene, cloud, mesh, folder, *options):
        """`folder`: of the page. `options`: for the maps, the depth maps and the run, too."""
        return [self.folder / "ViewScene", "-i", scene, "-p", cloud, "-m", mesh, "--report", folder,
                *options]

    def has_page(self):
        """Whether the build had what the page of ViewScene needs."""
        program = (self.folder / "ViewScene").resolve()
        return (program.parent.parent / "share" / "axialmvs" / "view" / "viewer.js").exists()

    def write_as_las(self, cloud, las, *options):
        return [self.folder / "TransformScene", "-i", cloud, "-o", las, *options]

    def refine_poses(self, model, lens, housing, output, *options):
        return [self.folder / "RefinePoses", "-i", model, "--lens", lens, "--housing", housing, "-o",
                output, *options]

    def align(self, model, reference, output):
        """`model` aligned to the camera centres of the model `reference`."""
        return [self.folder / "AlignModel", "-i", model, "--reference", reference, "-o", output]

    def evaluate(self, estimate, truth, *options):
        """A cloud against a true mesh, or a depth map against true distances."""
        return [self.folder / "EvaluateReconstruction", "-i", estimate, "-m", truth, *options]

    def simulate(self, output, *options):
        return [self.folder / "SimulateUnderwater", *options, "-o", output]
