# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of data/synthetic: their ground truth, and COLMAP models compared with it."""

import hashlib

from . import files, lenses
from .colmap_model import Calibration
from .failure import Failure
from .running import shown


def make_truth(programs, scene, folder):
    """Writes the ground truth of data/synthetic/`scene`, which is not in git, simulated again from
    its seed. Does nothing if the same SimulateUnderwater binary wrote it before."""
    binary = (programs.folder / "SimulateUnderwater").read_bytes()
    made_by, mark = hashlib.sha1(binary).hexdigest(), folder / "made-by"
    if mark.is_file() and mark.read_text().split()[:1] == [made_by]:
        return
    shown(programs.simulate(folder, "--preset", scene, "--seed", 1, "--truth-only"))
    files.write(mark, made_by + "\n")


def pinhole_parameters(data):
    """"fx,fy,cx,cy" of the PINHOLE camera of the scene in the folder `data`."""
    file = data / "sparse" / "cameras.txt"
    found = next((lens for lens in lenses.in_file(file) if lens.model == "PINHOLE"), None)
    if not found:
        raise Failure(f"{file}: has no PINHOLE camera")
    return ",".join(map(repr, found.parameters))


def true_lens(data):
    """The lens of the scene in the folder `data`, fixed."""
    return Calibration("PINHOLE", pinhole_parameters(data), refine=False)


def self_calibrated_lens(data):
    """The lens that COLMAP calibrates under water, without a model of refraction."""
    parameters = pinhole_parameters(data) + ",0,0,0,0"
    return Calibration("OPENCV", parameters, refine=True)


def align_to_truth(programs, work, data):
    """Aligns `work`/model to the true camera centres in metres. Returns the folder of the result."""
    shown(programs.align(work / "model", data / "sparse", work / "metric"))
    return work / "metric"
