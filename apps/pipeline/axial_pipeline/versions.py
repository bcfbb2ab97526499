# SPDX-License-Identifier: GPL-3.0-or-later
"""The versions of the programs that steps run."""

import pathlib
import subprocess

# How a program is asked for its version, which is the first line that it prints.
QUESTIONS = {"colmap": "help", **dict.fromkeys(
    ("RefinePoses", "InterfaceCOLMAP", "DensifyPointCloud", "ReconstructMesh", "RefineMesh", "TextureMesh",
     "MapSurface", "CompareSurveys", "ViewScene", "EvaluateReconstruction"), "--version")}
MOST_SECONDS = 20


def version_of(command):
    """The line by which the program of `command` states its version; None if it states none."""
    program = str(command[0])
    question = QUESTIONS.get(pathlib.Path(program).name)
    if question is None:
        return None
    try:
        said = subprocess.run([program, question], capture_output=True, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, timeout=MOST_SECONDS)
    except (OSError, subprocess.TimeoutExpired):
        return None
    lines = said.stdout.strip().splitlines()
    return lines[0].strip() if said.returncode == 0 and lines else None
